/* svd.h - nearest rotation R = U V^T from F = U diag(s) V^T, an inversion moved
 * to the smallest singular value.
 * Source: Irving, Teran, Fedkiw 2004, section 4; the decomposition by one-sided
 *         Jacobi (Hestenes 1958), which never forms F^T F.
 * Trade:  the dearest frame; it has every digit, flat and inverted too.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_SVD_H
#define CB_FRAME_SVD_H

#include "kernels/frames/jacobi.h"

/* Columns j, k of A = F V, and with them V, turned until orthogonal. */
INLINE void svd_turn(T *A, T *V, T *e, int j, int k) {
  T t, u, r = A[j] * A[k] + A[3 + j] * A[3 + k] + A[6 + j] * A[6 + k];
  jacobi_turn(column_square(A, j), column_square(A, k), r, j, k, e, &t, &u);
  jacobi_columns(A, j, k, t, u);
  jacobi_columns(V, j, k, t, u);
}

/* R := U V^T, det R = +1.
 * in   F[9]  row-major, 1
 * fail       rank F < 2: NaN in that lane */
INLINE void frame_svd(const T *F, T *R) {
  T A[9], V[9], n[3], e[3] = {LIT(1), LIT(1), LIT(1)};
  for (int i = 0; i < 9; i++) A[i] = F[i];
  identity3(V);
  for (int m = 0; m < JACOBI_TURNS; m += 3) {
    svd_turn(A, V, e, 0, 1);
    if (m + 1 < JACOBI_TURNS) svd_turn(A, V, e, 0, 2);
    if (m + 2 < JACOBI_TURNS) svd_turn(A, V, e, 1, 2);
  }
  jacobi_normalise(V, e);
  for (int j = 0; j < 3; j++) n[j] = column_square(A, j) * (e[j] * e[j]);
  frame_from_principal(n, A, V, R);
}

#endif
