/* svd.h - nearest rotation R = U V^T from F = U diag(s) V^T, an inversion moved
 * to the smallest singular value.
 * Source: Irving, Teran, Fedkiw 2004, section 4; the decomposition by one-sided
 *         Jacobi (Hestenes 1958), which never forms F^T F.
 * Trade:  the dearest frame; it has every digit, flat and inverted too.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_SVD_H
#define CB_FRAME_SVD_H

#include "kernels/frames/principal.h"

/* R := U V^T, det R = +1.
 * in   F[9]  row-major, 1 */
INLINE void frame_svd(const T *F, T *R) {
  T A[9], V[9], n[3], e[3] = {LIT(1), LIT(1), LIT(1)};
  for (int i = 0; i < 9; i++) A[i] = F[i];
  identity3(V);
  for (int m = 0; m < JACOBI_TURNS; m += 3) {
    jacobi_columns_turn(A, V, e, 0, 1);
    if (m + 1 < JACOBI_TURNS) jacobi_columns_turn(A, V, e, 0, 2);
    if (m + 2 < JACOBI_TURNS) jacobi_columns_turn(A, V, e, 1, 2);
  }
  jacobi_normalise(V, e);
  for (int j = 0; j < 3; j++) n[j] = column_square(A, j) * (e[j] * e[j]);
  frame_from_principal(F, LEAST_SQUARE, n, A, V, R);
}

#endif
