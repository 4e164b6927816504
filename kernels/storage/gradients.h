/* gradients.h - the stiffness product from nothing but gradients. For an
 * isotropic material R B^T D B R^T does not depend on R: it is the standard
 * operator on the world gradients w_j (kernels/elements.h), and no frame is
 * stored. An orthotropic material needs R, and local gradients b_j = R^T w_j.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_GRADIENTS_H
#define CB_GRADIENTS_H

#include "kernels/material.h"

/* w rows := cofactors of the edges: 6 V grad N_j for b, c, d, m^2. */
INLINE void edge_cofactors(const T *e, T *w) {
  cross3(e + 3, e + 6, w);
  cross3(e + 6, e, w + 3);
  cross3(e, e + 3, w + 6);
}

/* H := sum_j u_j (x) w_j, from rows u_j, w_j. */
INLINE void gradient3(const T *u, const T *w, T *H) { multiply3_tn(u, w, H); }

/* f_j := M w_j for b, c, d; M symmetric or not. */
INLINE void forces3(const T *M, const T *w, T *f) {
  for (int j = 0; j < 9; j += 3) apply3(M, w + j, f + j);
}

/* f := c K u for edges u[9]: f_j = [k tr(H) I + H + H^T] w_j. */
INLINE void gradients_product(T k, const T *w, const T *u, T *f) {
  T H[9], M[9];
  gradient3(u, w, H);
  stress(0, k, NULL, H, M);
  forces3(M, w, f);
}

/* f := c K u through the frame: R (D : sym(sum R^T u_j (x) b_j)) b_j. */
INLINE void local_product(const T *D, const T *R, const T *b, const T *u, T *f) {
  T q[9], H[9], P[9], p[9];
  for (int j = 0; j < 9; j += 3) apply3_transposed(R, u + j, q + j);
  gradient3(q, b, H);
  stress(1, LIT(0), D, H, P);
  forces3(P, b, p);
  for (int j = 0; j < 9; j += 3) apply3(R, p + j, f + j);
}

/* ---- the six off-diagonal blocks of the element matrix -------------------- */

/* X[6][9] := w_i (x) w_j for each edge (i, j) of cb_tet_edge. Linear in what is
 * summed over elements: K_ij = k X + X^T + tr(X) I is formed after the sum. */
INLINE void edge_products(const T *w, T *X) {
  T all[12];
  for (int i = 0; i < 3; i++) all[i] = -(w[i] + w[3 + i] + w[6 + i]);
  for (int i = 0; i < 9; i++) all[3 + i] = w[i];
  for (int e = 0; e < 6; e++)
    for (int i = 0; i < 9; i++)
      X[9 * e + i] = all[3 * cb_tet_edge[e][0] + i / 3] * all[3 * cb_tet_edge[e][1] + i % 3];
}

/* X[6][9] := c K_ij = R B_i^T D B_j R^T, orthotropic, from b_j = R^T w_j. */
INLINE void edge_blocks_local(const T *D, const T *R, const T *b, T *X) {
  /* B_j has three numbers in each column c: row[c][m] holds b_j[part[c][m]]. */
  static const uint8_t row[3][3] = {{0, 3, 5}, {1, 3, 4}, {2, 4, 5}};
  static const uint8_t part[3][3] = {{0, 1, 2}, {1, 0, 2}, {2, 1, 0}};
  T all[12], DB[3][18];
  for (int i = 0; i < 3; i++) all[i] = -(b[i] + b[3 + i] + b[6 + i]);
  for (int i = 0; i < 9; i++) all[3 + i] = b[i];
  for (int j = 0; j < 3; j++)
    for (int r = 0; r < 6; r++)
      for (int c = 0; c < 3; c++)
        DB[j][3 * r + c] = D[packed6(r, row[c][0])] * b[3 * j + part[c][0]] +
                           D[packed6(r, row[c][1])] * b[3 * j + part[c][1]] +
                           D[packed6(r, row[c][2])] * b[3 * j + part[c][2]];
  for (int e = 0; e < 6; e++) {
    T K[9], RK[9];
    const T *bi = all + 3 * cb_tet_edge[e][0], *DBj = DB[cb_tet_edge[e][1] - 1];
    for (int r = 0; r < 3; r++)
      for (int c = 0; c < 3; c++)
        K[3 * r + c] = bi[part[r][0]] * DBj[3 * row[r][0] + c] +
                       bi[part[r][1]] * DBj[3 * row[r][1] + c] +
                       bi[part[r][2]] * DBj[3 * row[r][2] + c];
    multiply3(R, K, RK);
    multiply3_nt(RK, R, X + 9 * e);
  }
}

#endif
