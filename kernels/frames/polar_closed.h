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

#include <stddef.h>

#include "kernels/frames/inversion.h"

/* I1 = tr S and I2 = tr cof S solve
 *   I1^2 = n + 2 I2,  I2^2 = m + 2 d I1.
 * Started from I1 <= sqrt(3 n), once through both equations ...
 * in   n = |F|^2, m = |cof F|^2, d = |det F| */
INLINE void invariants_near(T n, T m, T d, T *I1, T *I2) {
  T x = ROUGH_SQRT(LIT(3) * n);
  *I2 = ROUGH_SQRT(m + (d + d) * x);
  *I1 = ROUGH_SQRT(n + (*I2 + *I2));
}

/* ... then by Newton's iteration, whose divisor is
 * I1 I2 - d = (s_1 + s_2)(s_2 + s_3)(s_3 + s_1). */
INLINE void invariants_nearer(T n, T m, T d, T *I1, T *I2) {
  T x = *I1, y = *I2, f = x * x - n - LIT(2) * y, g = y * y - m - (d + d) * x;
  T half = LIT(0.5) / (x * y - d), dx = half * (f * y + g);
  *I2 = y - half * (g * x + f * d);
  *I1 = x - dx;
}

enum { CLOSED_AT_ONCE = 2 };

/* Q := orthogonal polar factors of F, reflections where det F < 0, of some packs turn about:
 * the operations of each wait for each other, those of another are there to be done meanwhile.
 * in   F[count][9]  row-major, 1; count <= CLOSED_AT_ONCE
 *      upright       of det F > 0 alone, which takes fewer operations; constant
 * out  sign[count]  det Q, +1 or -1
 *      usual[count] where Q is that to rounding: F is neither too small nor too large for
 *                   the powers of it that are formed, and no needle */
INLINE void closed_factors(size_t count, const T (*F)[9], T (*Q)[9], bool upright, T *sign,
                           CHOICE *usual) {
  T C[CLOSED_AT_ONCE][9], X[CLOSED_AT_ONCE][9], n[CLOSED_AT_ONCE], m[CLOSED_AT_ONCE],
      d[CLOSED_AT_ONCE], I1[CLOSED_AT_ONCE], I2[CLOSED_AT_ONCE];
#pragma GCC unroll 2
  for (size_t k = 0; k < count; k++) {
    cofactor3(F[k], C[k]);
    T det = dot3(F[k], C[k]);
    sign[k] = upright ? LIT(1) : SELECT(det < LIT(0), LIT(-1), LIT(1));
    d[k] = upright ? det : sign[k] * det;
    n[k] = square9(F[k]), m[k] = square9(C[k]);
    invariants_near(n[k], m[k], d[k], I1 + k, I2 + k);
  }
#pragma GCC unroll 3
  for (int i = 0; i < CLOSED_NEWTON; i++)
#pragma GCC unroll 2
    for (size_t k = 0; k < count; k++) invariants_nearer(n[k], m[k], d[k], I1 + k, I2 + k);
      /* det F > 0: Q = F / I1 + cof(F + C / I1) / (I2 - d / I1); in the axes of S,
       * where s_1 -> s_1 / I1 + (s_2 + s_3 s_1 / I1)(s_3 + s_1 s_2 / I1) / ..., all
       * terms are positive. det F < 0: the same of -F. */
#pragma GCC unroll 2
  for (size_t k = 0; k < count; k++) {
    usual[k] = within(n[k], BY_PRECISION(1e-12, 1e-40), BY_PRECISION(1e13, 1e40)) &
               LESS(BY_PRECISION(1e-2, 1e-3) * n[k], I2[k]);
    if (upright) usual[k] = usual[k] & LESS(LIT(0), d[k]);
    T half = LIT(0.5) / I1[k], turn = sign[k] * (half + half);
    for (int i = 0; i < 9; i++) X[k][i] = F[k][i] + turn * C[k][i];
    cofactor3(X[k], C[k]);
    turn = sign[k] * I1[k] / (I1[k] * I2[k] - d[k]) * LIT(0.5);
    for (int i = 0; i < 9; i++) X[k][i] = half * F[k][i] + turn * C[k][i];
  }
  /* One plain iteration (polar_higham.h) from X = Q / 2, 1 / det Q = 2 - det Q:
   * it squares what the invariants miss and the cofactors lose. */
#pragma GCC unroll 2
  for (size_t k = 0; k < count; k++) {
    cofactor3(X[k], C[k]);
    T turn = LIT(4) * sign[k] - LIT(16) * dot3(X[k], C[k]);
    for (int i = 0; i < 9; i++) Q[k][i] = X[k][i] + turn * C[k][i];
  }
}

/* The same of one pack, inverted or not; returns sign. */
INLINE T closed_factor(const T *F, T *Q, CHOICE *usual) {
  T sign;
  closed_factors(1, (const T(*)[9])F, (T(*)[9])Q, false, &sign, usual);
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

/* Those of some packs, count <= CLOSED_AT_ONCE; false where one is inverted or not usual. */
INLINE bool frames_polar_closed(size_t count, const T (*F)[9], T (*R)[9]) {
  T sign[CLOSED_AT_ONCE];
  CHOICE usual[CLOSED_AT_ONCE];
  bool all = true;
  closed_factors(count, F, R, true, sign, usual);
  for (size_t k = 0; k < count; k++) all &= ALL(usual[k]);
  return all;
}

#endif
