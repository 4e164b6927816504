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

INLINE void svd_swap(MASK m, T *n, T *A, T *V, int j, int k) {
  T t = n[j];
  n[j] = SELECT(m, n[k], t), n[k] = SELECT(m, t, n[k]);
  /* (a, b) -> (b, -a) keeps V a rotation */
  for (int i = 0; i < 3; i++) {
    T a = A[3 * i + j], v = V[3 * i + j];
    A[3 * i + j] = SELECT(m, A[3 * i + k], a), A[3 * i + k] = SELECT(m, -a, A[3 * i + k]);
    V[3 * i + j] = SELECT(m, V[3 * i + k], v), V[3 * i + k] = SELECT(m, -v, V[3 * i + k]);
  }
}

/* R := U V^T, det R = +1.
 * in   F[9]  row-major, 1
 * fail       rank F < 2: NaN in that lane */
INLINE void frame_svd(const T *F, T *R) {
  static const int plane[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  T A[9], V[9], U[9], n[3];
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
  svd_swap(n[0] < n[1], n, A, V, 0, 1);
  svd_swap(n[1] < n[2], n, A, V, 1, 2);
  svd_swap(n[0] < n[1], n, A, V, 0, 1);
  /* The two longest columns give the frame; the third follows, and with it the
   * sign of the smallest singular value. */
  T first = LIT(1) / SQRT(n[0]), along = LIT(0), u[3], v[3], w[3];
  for (int i = 0; i < 3; i++) u[i] = A[3 * i] * first;
  for (int i = 0; i < 3; i++) along = along + u[i] * A[3 * i + 1];
  for (int i = 0; i < 3; i++) v[i] = A[3 * i + 1] - along * u[i];
  T second = LIT(1) / SQRT(dot3(v, v));
  for (int i = 0; i < 3; i++) v[i] = v[i] * second;
  cross3(u, v, w);
  for (int i = 0; i < 3; i++) U[3 * i] = u[i], U[3 * i + 1] = v[i], U[3 * i + 2] = w[i];
  multiply3_nt(U, V, R);
}

#endif
