/* polar_quaternion.h - rotation of F by a quaternion that is carried from step
 * to step and turned a few times towards F.
 * Source: Mueller, Bender, Chentanez, Macklin 2016, eq. 7; the turn by omega is
 *         made with the quaternion (1, omega/2), no sine, and computed with the
 *         matrix of Horn 1987.
 * Trade:  cheap and never singular, but never converged either: the error left
 *         after the last iteration is a ghost torque.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_QUATERNION_H
#define CB_FRAME_POLAR_QUATERNION_H

#include <stddef.h>

#include "kernels/frames/degenerate.h"

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

INLINE T dot4(const T *a, const T *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
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
  T inverse = RSQRT(dot4(q, q));
  for (int i = 0; i < 4; i++) q[i] = q[i] * inverse;
}

/* q[4] := q turned by omega = a / |tr F R^T|, a the axial vector of F R^T = the sum of
 * r x f over the columns of R and F. K[16]: Horn's matrix, symmetric, for which
 * q . K q = |q|^2 tr F R^T; then (0, a) q = K q - q tr F R^T. q need not be unit. */
INLINE void quaternion_turn(const T *K, T *q) {
  T p[4];
  for (int i = 0; i < 4; i++) p[i] = dot4(K + 4 * i, q);
  T trace = dot4(q, p), square = dot4(q, q);
  T half = LIT(0.5) / (ABS(trace) + LIT(1e-30) * square);
  T keep = LIT(1) - half * trace, turn = half * square;
  for (int i = 0; i < 4; i++) q[i] = keep * q[i] + turn * p[i];
}

/* Horn's matrix of F, for quaternion_turn. */
INLINE void horn_matrix(const T *F, T *K) {
  T xw = F[7] - F[5], yw = F[2] - F[6], zw = F[3] - F[1];
  T xy = F[1] + F[3], xz = F[2] + F[6], yz = F[5] + F[7];
  T plus = F[0] + F[4], minus = F[0] - F[4];
  T all[16] = {plus + F[8],   xw, yw, zw, xw, minus - F[8], xy, xz, yw, xy,
               -minus - F[8], yz, zw, xz, yz, F[8] - plus};
  for (int i = 0; i < 16; i++) K[i] = all[i];
}

RARE void quaternion_of_any(const T *F, T *q) {
  T R[9];
  orthogonal_of_any(F, false, R);
  quaternion_from(R, q);
}

/* But where warm, q := by the full decomposition (a cold guess can be far off after few turns). */
INLINE void quaternion_start(CHOICE warm, const T *F, T *q) {
  if (ALL(warm)) return;
  const T from[9] = {F[0], F[1], F[2], F[3], F[4], F[5], F[6], F[7], F[8]};
  T start[4];
  quaternion_of_any(from, start);
  q[0] = CHOOSE(warm, q[0], start[0]);
  choose3(warm, start + 1, q + 1);
}

/* ... where q is all zero. */
INLINE void quaternion_warm(const T *F, T *q) { quaternion_start(LESS(LIT(0), dot4(q, q)), F, q); }

/* Where tr F R^T = 0 a turn may have carried q beyond all numbers: by how much F has to
 * be turned is not known from there. */
INLINE void quaternion_end(const T *F, T *q, T *R) {
  T square = dot4(q, q), inverse = RSQRT(square);
  for (int i = 0; i < 4; i++) q[i] = q[i] * inverse;
  quaternion_start(within(square, LIT(1e-30), LIT(1e30)), F, q);
  quaternion_matrix(q, R);
}

/* R := rotation of F, q[4] := its quaternion for the next call.
 * in/out  q[4]  last result, or all zero: a cold start */
INLINE void frame_polar_quaternion(const T *F, T *q, T *R) {
  T K[16];
  quaternion_warm(F, q);
  horn_matrix(F, K);
  for (int n = 0; n < QUATERNION_TURNS; n++) quaternion_turn(K, q);
  quaternion_end(F, q, R);
}

/* The same by at most so many turns, fewer if one moves none of the lanes' quaternions by
 * more than tolerance. */
INLINE void frame_polar_quaternion_tuned(const T *F, size_t turns, T tolerance, T *q, T *R) {
  T K[16];
  quaternion_warm(F, q);
  horn_matrix(F, K);
  for (size_t n = 0; n < turns; n++) {
    T last[4], far = LIT(0);
    for (int i = 0; i < 4; i++) last[i] = q[i];
    quaternion_turn(K, q);
    T inverse = RSQRT(dot4(q, q));
    for (int i = 0; i < 4; i++) {
      q[i] = q[i] * inverse;
      T d = ABS(q[i] - last[i]);
      far = SELECT(d > far, d, far);
    }
    if (!ANY(far > tolerance)) break;
  }
  quaternion_end(F, q, R);
}

#endif
