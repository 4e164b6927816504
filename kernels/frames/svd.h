/* svd.h - nearest rotation R = U V^T from F = U diag(s) V^T, an inversion moved
 * to the smallest singular value.
 * Source: Irving, Teran, Fedkiw 2004, section 4; the decomposition by one-sided
 *         Jacobi (Hestenes 1958), which never forms F^T F.
 * Trade:  the dearest frame; it has every digit, flat and inverted too.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_SVD_H
#define CB_FRAME_SVD_H

#include <stddef.h>

#include "kernels/frames/principal.h"

enum { SVD_AT_ONCE = 3 };

/* R := U V^T, det R = +1, of some packs turn about: the operations of a turn wait for each
 * other, those of another pack are there to be done meanwhile.
 * in   F[count][9]  row-major, 1; count <= SVD_AT_ONCE */
INLINE void frames_svd(size_t count, const T (*F)[9], T (*R)[9]) {
  T A[SVD_AT_ONCE][9], V[SVD_AT_ONCE][9], e[SVD_AT_ONCE][3], n[3];
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) {
    for (int i = 0; i < 9; i++) A[k][i] = F[k][i];
    for (int i = 0; i < 3; i++) e[k][i] = LIT(1);
    identity3(V[k]);
  }
#pragma GCC unroll 12
  for (int m = 0; m < JACOBI_TURNS; m++)
#pragma GCC unroll 3
    for (size_t k = 0; k < count; k++)
      jacobi_columns_turn(m, A[k], V[k], e[k], m % 3 == 2, m % 3 == 0 ? 1 : 2);
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) {
    jacobi_normalise(V[k], e[k]);
    for (int j = 0; j < 3; j++) n[j] = column_square(A[k], j) * (e[k][j] * e[k][j]);
    frame_from_principal(F[k], LEAST_SQUARE, n, A[k], V[k], R[k]);
  }
}

INLINE void frame_svd(const T *F, T *R) { frames_svd(1, (const T(*)[9])F, (T(*)[9])R); }

#endif
