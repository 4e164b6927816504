/* polar_quaternion.h - rotation of F by a quaternion that is carried from step
 * to step and turned a few times towards F.
 * Source: Mueller, Bender, Chentanez, Macklin 2016, eq. 7; the turn by omega is
 *         made with the normalised quaternion (1, omega/2), no sine.
 * Trade:  cheap and never singular, but never converged either: the error left
 *         after the last iteration is a ghost torque.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_QUATERNION_H
#define CB_FRAME_POLAR_QUATERNION_H

#include "kernels/frames/polar_higham.h"

/* R := matrix of the unit quaternion q = (w, x, y, z). */
INLINE void quaternion_matrix(const T *q, T *R) {
  T x2 = q[1] + q[1], y2 = q[2] + q[2], z2 = q[3] + q[3];
  T xx = x2 * q[1], yy = y2 * q[2], zz = z2 * q[3];
  T xy = x2 * q[2], xz = x2 * q[3], yz = y2 * q[3];
  T wx = x2 * q[0], wy = y2 * q[0], wz = z2 * q[0];
  R[0] = LIT(1) - (yy + zz), R[1] = xy - wz, R[2] = xz + wy;
  R[3] = xy + wz, R[4] = LIT(1) - (xx + zz), R[5] = yz - wx;
  R[6] = xz - wy, R[7] = yz + wx, R[8] = LIT(1) - (xx + yy);
}

/* q := unit quaternion of the rotation R, from its largest component
 * (Shepperd 1978): the row of 4 q q^T with the largest diagonal. */
INLINE void quaternion_from(const T *R, T *q) {
  T d[4] = {LIT(1) + R[0] + R[4] + R[8], LIT(1) + R[0] - R[4] - R[8], LIT(1) - R[0] + R[4] - R[8],
            LIT(1) - R[0] - R[4] + R[8]};
  T wx = R[7] - R[5], wy = R[2] - R[6], wz = R[3] - R[1];
  T xy = R[1] + R[3], xz = R[2] + R[6], yz = R[5] + R[7];
  T rows[4][4] = {{d[0], wx, wy, wz}, {wx, d[1], xy, xz}, {wy, xy, d[2], yz}, {wz, xz, yz, d[3]}};
  T best = d[0];
  for (int i = 0; i < 4; i++) q[i] = rows[0][i];
  for (int n = 1; n < 4; n++) {
    MASK more = d[n] > best;
    best = SELECT(more, d[n], best);
    for (int i = 0; i < 4; i++) q[i] = SELECT(more, rows[n][i], q[i]);
  }
  T inverse = RSQRT(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  for (int i = 0; i < 4; i++) q[i] = q[i] * inverse;
}

/* R := rotation of F, q[4] := its quaternion for the next call.
 * in/out  q[4]  last result, or all zero: then the first guess is the full
 *               decomposition (a cold guess can be far off after few turns) */
INLINE void frame_polar_quaternion(const T *F, T *q, T *R) {
  T norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  MASK cold = norm == LIT(0);
  if (ANY(cold)) {
    T start[4];
    frame_polar_higham(F, R);
    quaternion_from(R, start);
    for (int i = 0; i < 4; i++) q[i] = SELECT(cold, start[i], q[i]);
  }
  quaternion_matrix(q, R);
  for (int n = 0; n < QUATERNION_TURNS; n++) {
    T G[9], p[4]; /* G = F R^T; sum of r x a over columns = its axial vector */
    multiply3_nt(F, R, G);
    T half = LIT(0.5) / (ABS(G[0] + G[4] + G[8]) + LIT(1e-9));
    T x = half * (G[7] - G[5]), y = half * (G[2] - G[6]), z = half * (G[3] - G[1]);
    p[0] = q[0] - x * q[1] - y * q[2] - z * q[3];
    p[1] = q[1] + x * q[0] + y * q[3] - z * q[2];
    p[2] = q[2] + y * q[0] + z * q[1] - x * q[3];
    p[3] = q[3] + z * q[0] + x * q[2] - y * q[1];
    T inverse = RSQRT(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    for (int i = 0; i < 4; i++) q[i] = p[i] * inverse;
    quaternion_matrix(q, R);
  }
}

#endif
