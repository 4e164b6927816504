/* products.c - the unassembled products that every model shares; inlined into
 * their loops, however many elements a pack has.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/products.h"

#include "kernels/storage/drive.h"
#include "kernels/storage/gradients.h"

INLINE void by_gradients(const struct cb_elements *E, const T *rest, const T *w, const T *u, T *f) {
  (void)rest;
  gradients_product(E->k, w, u, f);
}

INLINE void by_rest(const struct cb_elements *E, const T *rest, const T *w, const T *u, T *f) {
  (void)w;
  gradients_product(E->k, rest + REST_G, u, f);
}

/* For each edge (i, j): f_i += K_ij (u_j - u_i), f_j -= K_ij^T (u_j - u_i). */
INLINE void by_matrix(const struct cb_elements *E, const T *rest, const T *K, const T *u, T *f) {
  (void)E, (void)rest;
  T y[3];
  for (int n = 0; n < 3; n++) { /* edges from a: only the far end is kept */
    apply3_transposed(K + 9 * n, u + 3 * n, y);
    for (int i = 0; i < 3; i++) f[3 * n + i] = -y[i];
  }
  for (int n = 3; n < 6; n++) {
    int p = cb_tet_edge[n][0] - 1, q = cb_tet_edge[n][1] - 1;
    T d[3];
    for (int i = 0; i < 3; i++) d[i] = u[3 * q + i] - u[3 * p + i];
    apply3(K + 9 * n, d, y);
    for (int i = 0; i < 3; i++) f[3 * p + i] = f[3 * p + i] + y[i];
    apply3_transposed(K + 9 * n, d, y);
    for (int i = 0; i < 3; i++) f[3 * q + i] = f[3 * q + i] - y[i];
  }
}

void CB_NAME(cb_product_gradients)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y) {
  product_loop(E, thread, u, y, by_gradients);
}

void CB_NAME(cb_product_rest)(const struct cb_elements *E, size_t thread, const void *u, void *y) {
  product_loop(E, thread, u, y, by_rest);
}

void CB_NAME(cb_product_matrix)(const struct cb_elements *E, size_t thread, const void *u,
                                void *y) {
  product_loop(E, thread, u, y, by_matrix);
}
