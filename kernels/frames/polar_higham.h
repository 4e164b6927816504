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

#include "kernels/frames/inversion.h"

/* Q := orthogonal polar factor of F, a reflection where det F < 0. Returns det Q,
 * +1 or -1.
 * in   F[9]  row-major, 1
 * fail       rank F < 2: NaN in that lane */
INLINE T orthogonal_higham(const T *F, T *Q) {
  T C[9], sign = LIT(0);
  for (int i = 0; i < 9; i++) Q[i] = F[i];
  /* With g^2 = |Q^-1| / |Q| and Q^-T = C / det Q an iterate is a multiple of
   * Q / |Q| +- C / |C|: no division by the volume of a flat element. The factor
   * makes it orthogonal once all singular values are equal. */
  for (int n = 0; n < HIGHAM_SCALED; n++) {
    cofactor3(Q, C);
    if (n == 0) sign = SELECT(dot3(Q, C) < LIT(0), LIT(-1), LIT(1));
    const T half_root_3 = LIT(0.8660254037844386);
    T keep = half_root_3 * RSQRT(square9(Q)), turn = sign * half_root_3 * RSQRT(square9(C));
    for (int i = 0; i < 9; i++) Q[i] = keep * Q[i] + turn * C[i];
  }
  for (int n = 0; n < HIGHAM_PLAIN; n++) {
    cofactor3(Q, C);
    T turn = LIT(0.5) / dot3(Q, C);
    for (int i = 0; i < 9; i++) Q[i] = LIT(0.5) * Q[i] + turn * C[i];
  }
  return sign;
}

/* R := nearest rotation to F, an inversion moved to the smallest singular value. */
INLINE void frame_polar_higham(const T *F, T *R) {
  T Q[9], sign = orthogonal_higham(F, Q);
  rotation_of_orthogonal(F, Q, sign, R);
}

#endif
