/* polar_closed.h - the orthogonal factor of F = Q S from the invariants of S,
 * and the nearest rotation made of it.
 * Source: Hoger & Carlson 1984: Q by Cayley-Hamilton from F and tr S; the product
 *         form below and the iteration for tr S: this project.
 * Trade:  the cheapest nearest rotation, no sum cancels; but of a needle s_1 : s_2 it
 *         is orthogonal to rounding only up to 100 : 1 in float, 1000 : 1 in double,
 *         and beyond costs a decomposition. det F < 0 costs an eigenvector.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_CLOSED_H
#define CB_FRAME_POLAR_CLOSED_H

#include "kernels/frames/inversion.h"

/* I1 = tr S and I2 = tr cof S solve
 *   I1^2 = n + 2 I2,  I2^2 = m + 2 d I1.
 * Started from I1 <= sqrt(3 n), once through both equations, then Newton's
 * iteration, whose divisor I1 I2 - d = (s_1 + s_2)(s_2 + s_3)(s_3 + s_1).
 * in   n = |F|^2, m = |cof F|^2, d = |det F| */
INLINE void stretch_invariants(T n, T m, T d, T *I1, T *I2) {
  T x = ROUGH_SQRT(LIT(3) * n), y = ROUGH_SQRT(m + (d + d) * x);
  x = ROUGH_SQRT(n + (y + y));
  for (int k = 0; k < CLOSED_NEWTON; k++) {
    T f = x * x - n - LIT(2) * y, g = y * y - m - (d + d) * x;
    T half = LIT(0.5) / (x * y - d), dx = half * (f * y + g);
    y = y - half * (g * x + f * d);
    x = x - dx;
  }
  *I1 = x, *I2 = y;
}

/* Q := orthogonal polar factor of F, a reflection where det F < 0. Returns det Q,
 * +1 or -1.
 * in   F[9]    row-major, 1
 * out  *usual  where Q is that to rounding: F is neither too small nor too large for
 *              the powers of it that are formed, and no needle */
INLINE T closed_factor(const T *F, T *Q, CHOICE *usual) {
  T C[9], X[9], I1, I2;
  cofactor3(F, C);
  T det = dot3(F, C), sign = SELECT(det < LIT(0), LIT(-1), LIT(1)), d = sign * det;
  T n = square9(F);
  stretch_invariants(n, square9(C), d, &I1, &I2);
  *usual = within(n, BY_PRECISION(1e-12, 1e-40), BY_PRECISION(1e13, 1e40)) &
           LESS(BY_PRECISION(1e-2, 1e-3) * n, I2);
  /* det F > 0: Q = F / I1 + cof(F + C / I1) / (I2 - d / I1); in the axes of S,
   * where s_1 -> s_1 / I1 + (s_2 + s_3 s_1 / I1)(s_3 + s_1 s_2 / I1) / ..., all
   * terms are positive. det F < 0: the same of -F. */
  T half = LIT(0.5) / I1, turn = sign * (half + half);
  for (int i = 0; i < 9; i++) X[i] = F[i] + turn * C[i];
  cofactor3(X, C);
  turn = sign * I1 / (I1 * I2 - d) * LIT(0.5);
  for (int i = 0; i < 9; i++) X[i] = half * F[i] + turn * C[i];
  /* One plain iteration (polar_higham.h) from X = Q / 2, 1 / det Q = 2 - det Q:
   * it squares what the invariants miss and the cofactors lose. */
  cofactor3(X, C);
  turn = LIT(4) * sign - LIT(16) * dot3(X, C);
  for (int i = 0; i < 9; i++) Q[i] = X[i] + turn * C[i];
  return sign;
}

/* Q := orthogonal polar factor of F, a reflection where det F < 0. */
INLINE void orthogonal_closed(const T *F, T *Q) {
  CHOICE usual;
  (void)closed_factor(F, Q, &usual);
  repair(usual, F, true, Q);
}

/* R := nearest rotation to F, an inversion moved to the smallest singular value. */
INLINE void frame_polar_closed(const T *F, T *R) {
  T Q[9];
  CHOICE usual;
  T sign = closed_factor(F, Q, &usual);
  rotation_of_orthogonal(F, Q, sign, usual, R);
}

#endif
