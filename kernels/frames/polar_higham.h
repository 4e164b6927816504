/* polar_higham.h - the orthogonal factor of F = Q S by Newton's iteration
 * Q <- (g Q + Q^-T / g) / 2, and the nearest rotation made of it.
 * Source: Higham, Computing the polar decomposition - with applications, SIAM
 *         J. Sci. Stat. Comput. 7 (1986), eq. 3.1; g: the Frobenius scaling of
 *         Higham, Functions of Matrices (2008), section 8.6.
 * Trade:  every iterate is F times a function of F^T F, so a truncated one
 *         makes no ghost torque; det F < 0 costs an eigenvector.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_HIGHAM_H
#define CB_FRAME_POLAR_HIGHAM_H

#include "kernels/frames/jacobi.h"

/* Q := orthogonal polar factor of F, a reflection where det F < 0. Returns a
 * number with the sign of det Q.
 * in   F[9]  row-major, 1
 * fail       rank F < 2: NaN in that lane */
INLINE T orthogonal_higham(const T *F, T *Q) {
  T det = LIT(0);
  for (int i = 0; i < 9; i++) Q[i] = F[i];
  for (int n = 0; n < HIGHAM_SCALED + HIGHAM_PLAIN; n++) {
    T C[9];
    cofactor3(Q, C);
    det = dot3(Q, C);
    /* A flat element has no volume: the smallest one with a normal stands in. */
    det = SELECT(det == LIT(0), LIT(1e-30), det);
    T keep = LIT(0.5), turn = LIT(0.5) / det;
    if (n < HIGHAM_SCALED) {
      T norm = LIT(0), conorm = LIT(0);
      for (int i = 0; i < 3; i++) {
        norm = norm + dot3(Q + 3 * i, Q + 3 * i);
        conorm = conorm + dot3(C + 3 * i, C + 3 * i);
      }
      T g = SQRT(SQRT(conorm / norm) / ABS(det)); /* det^2 would underflow in float */
      keep = keep * g;
      turn = turn / g;
    }
    for (int i = 0; i < 9; i++) Q[i] = keep * Q[i] + turn * C[i];
  }
  return det;
}

/* R := nearest rotation to F (det R = +1). Where det F < 0 the direction of the
 * smallest singular value is turned round: R = Q (I - 2 v v^T), S v = s_min v. */
INLINE void frame_polar_higham(const T *F, T *R) {
  T Q[9];
  MASK inverted = orthogonal_higham(F, Q) < LIT(0);
  for (int i = 0; i < 9; i++) R[i] = Q[i];
  if (ANY(inverted)) {
    T stretch[9], V[9], s[3], v[3], Qv[3];
    multiply3_tn(Q, F, stretch);
    jacobi_eigen(stretch, V, s);
    for (int i = 0; i < 3; i++) v[i] = V[3 * i];
    T least = s[0];
    for (int j = 1; j < 3; j++) {
      MASK less = s[j] < least;
      least = SELECT(less, s[j], least);
      for (int i = 0; i < 3; i++) v[i] = SELECT(less, V[3 * i + j], v[i]);
    }
    apply3(Q, v, Qv);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        R[3 * i + j] = SELECT(inverted, Q[3 * i + j] - LIT(2) * (Qv[i] * v[j]), Q[3 * i + j]);
  }
}

#endif
