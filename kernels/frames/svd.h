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

/* R := U V^T, det R = +1.
 * in   F[9]  row-major, 1
 * fail       rank F < 2: NaN in that lane */
INLINE void frame_svd(const T *F, T *R) {
  static const int plane[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  T A[9], V[9], n[3];
  for (int i = 0; i < 9; i++) A[i] = F[i];
  identity3(V);
  for (int sweep = 0; sweep < JACOBI_SWEEPS; sweep++)
    for (int m = 0; m < 3; m++) {
      int j = plane[m][0], k = plane[m][1];
      T c, s, p = LIT(0), q = LIT(0), r = LIT(0);
      for (int i = 0; i < 9; i += 3) {
        p = p + A[i + j] * A[i + j];
        q = q + A[i + k] * A[i + k];
        r = r + A[i + j] * A[i + k];
      }
      jacobi_angle(p, q, r, &c, &s);
      jacobi_columns(A, j, k, c, s);
      jacobi_columns(V, j, k, c, s);
    }
  for (int j = 0; j < 3; j++) n[j] = A[j] * A[j] + A[3 + j] * A[3 + j] + A[6 + j] * A[6 + j];
  frame_from_principal(n, A, V, R);
}

#endif
