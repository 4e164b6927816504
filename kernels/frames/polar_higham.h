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

#include <stddef.h>

#include "kernels/frames/inversion.h"

/* What the cofactors C of F lose is seen in |F|^4 / |C|^2, from 3 to (s_1/s_2)^2: of
 * needles, digits, in float up to the sign of det F. That of a flat element does not
 * matter. Iterates of F grow eight-fold; their fourth powers are to be numbers. */
INLINE CHOICE higham_usual(T square, T ratio) {
  return within(square, BY_PRECISION(1e-16, 1e-150), BY_PRECISION(1e16, 1e150)) &
         LESS(ratio * square, BY_PRECISION(1e4, 1e6));
}

enum { HIGHAM_AT_ONCE = 2 };

/* Q := orthogonal polar factors of F, reflections where det F < 0, of some packs turn about:
 * the operations of each wait for each other, those of another are there to be done meanwhile.
 * in   F[count][9]   row-major, 1; count <= HIGHAM_AT_ONCE
 * out  sign[count]   det Q, +1 or -1
 *      usual[count]  where Q is that to rounding: F is no needle, and neither too small nor
 *                    too large for its fourth powers */
INLINE void higham_factors(size_t count, const T (*F)[9], T (*Q)[9], T *sign, CHOICE *usual) {
  T C[9], keep[HIGHAM_AT_ONCE] = {LIT(0)};
#pragma GCC unroll 2
  for (size_t k = 0; k < count; k++)
    for (int i = 0; i < 9; i++) Q[k][i] = F[k][i];
      /* With g^2 = |Q^-1| / |Q| and Q^-T = C / det Q an iterate is a multiple of
       * Q / |Q| +- C / |C|: no division by the volume of a flat element. A rough g is
       * as good; the length of Q matters only to what comes after. */
#pragma GCC unroll 3
  for (int n = 0; n < HIGHAM_SCALED; n++)
#pragma GCC unroll 2
    for (size_t k = 0; k < count; k++) {
      cofactor3(Q[k], C);
      if (n == 0) sign[k] = SELECT(dot3(Q[k], C) < LIT(0), LIT(-1), LIT(1));
      T square = square9(Q[k]), ratio = square / square9(C), turn = sign[k] * ROUGH_SQRT(ratio);
      if (n == 0) usual[k] = higham_usual(square, ratio);
      if (n == HIGHAM_SCALED - 1) keep[k] = RSQRT(square);
      for (int i = 0; i < 9; i++) Q[k][i] = Q[k][i] + turn * C[i];
    }
    /* Orthogonal once all singular values are equal; halved as often as the plain
     * iterations would halve it. */
#pragma GCC unroll 2
  for (size_t k = 0; k < count; k++) {
    keep[k] = keep[k] * LIT(0.8660254037844386 / (1 << HIGHAM_PLAIN));
    for (int i = 0; i < 9; i++) Q[k][i] = keep[k] * Q[k][i];
  }
#pragma GCC unroll 3
  for (int n = HIGHAM_PLAIN; n > 0; n--)
#pragma GCC unroll 2
    for (size_t k = 0; k < count; k++) {
      cofactor3(Q[k], C);
      T turn = LIT(1.0 / (1 << 2 * n)) / dot3(Q[k], C);
      for (int i = 0; i < 9; i++) Q[k][i] = Q[k][i] + turn * C[i];
    }
}

/* The same of one pack; returns sign. */
INLINE T higham_factor(const T *F, T *Q, CHOICE *usual) {
  T sign = LIT(0);
  *usual = LESS(sign, LIT(1));
  higham_factors(1, (const T(*)[9])F, (T(*)[9])Q, &sign, usual);
  return sign;
}

/* Q := orthogonal polar factor of F, a reflection where det F < 0. */
INLINE void orthogonal_higham(const T *F, T *Q) {
  CHOICE usual;
  (void)higham_factor(F, Q, &usual);
  repair(usual, F, true, Q);
}

/* Q := as higham_factor by at most `iterations` scaled ones, each of length sqrt(3), fewer
 * if one moves none of the lanes by more than tolerance: for measuring what an iteration is
 * worth. */
INLINE T higham_factor_tuned(const T *F, size_t iterations, T tolerance, T *Q, CHOICE *usual) {
  T C[9], sign = LIT(0);
  *usual = LESS(sign, LIT(1));
  for (int i = 0; i < 9; i++) Q[i] = F[i];
  for (size_t n = 0; n < iterations; n++) {
    T next[9], far = LIT(0);
    cofactor3(Q, C);
    if (n == 0) sign = SELECT(dot3(Q, C) < LIT(0), LIT(-1), LIT(1));
    T square = square9(Q), ratio = square / square9(C), turn = sign * SQRT(ratio);
    if (n == 0) *usual = higham_usual(square, ratio);
    for (int i = 0; i < 9; i++) next[i] = Q[i] + turn * C[i];
    T scale = SQRT(LIT(3)) * RSQRT(square9(next));
    for (int i = 0; i < 9; i++) {
      next[i] = scale * next[i];
      T d = ABS(next[i] - Q[i]);
      far = SELECT(d > far, d, far);
      Q[i] = next[i];
    }
    if (!ANY(far > tolerance)) break;
  }
  return sign;
}

/* R := nearest rotation to F, an inversion moved to the smallest singular value. */
INLINE void frame_polar_higham(const T *F, T *R) {
  T Q[9];
  CHOICE usual;
  T sign = higham_factor(F, Q, &usual);
  rotation_of_orthogonal(F, Q, sign, usual, R);
}

/* Those of some packs, count <= HIGHAM_AT_ONCE; false where one is inverted or not usual. */
INLINE bool frames_polar_higham(size_t count, const T (*F)[9], T (*R)[9]) {
  T sign[HIGHAM_AT_ONCE];
  CHOICE usual[HIGHAM_AT_ONCE];
  bool all = true;
  higham_factors(count, F, R, sign, usual);
  for (size_t k = 0; k < count; k++) all &= ALL(usual[k] & LESS(LIT(0), sign[k]));
  return all;
}

#endif
