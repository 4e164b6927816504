/* cluster.c - see cluster.h: the loops that models share.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/cluster.h"

void update_unit_again(struct cb_elements *E, struct cluster_work *W, bool moving, double h,
                       update_pack_fn *update) {
  for (size_t i = 0; i < W->shape->tets; i++)
    update_slots(E, W, i, 1, moving, LIT(h), NULL, update, E->x == NULL);
}

void drive_update_clusters(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                           S *out, update_pack_fn *update) {
  update_clusters(E, thread, x, v, h, out, update);
}

INLINE void by_gradients(const struct cb_elements *E, size_t slot, product_pack_fn *model,
                         const T *e, const T *du, T *f) {
  (void)model, (void)e;
  gradients_product(E->k, E->state + 9 * slot, du, f);
}

/* The same where the world gradients are those of the rest shape (linear). */
INLINE void by_rest(const struct cb_elements *E, size_t slot, product_pack_fn *model, const T *e,
                    const T *du, T *f) {
  (void)model, (void)e;
  gradients_product(E->k, E->rest + slot * E->rest_numbers + REST_G, du, f);
}

INLINE void by_positions(const struct cb_elements *E, size_t slot, product_pack_fn *model,
                         const T *e, const T *du, T *f) {
  T w[9], scale = E->state[slot];
  (void)model;
  edge_cofactors(e, w);
  if (E->policy == POLICY_UPDATED_VOLUME) scale = scale / dot3(e, w);
  for (int i = 0; i < 9; i++) w[i] = scale * w[i];
  gradients_product(E->k, w, du, f);
}

/* Twice: a question in every slot would take 3 % of a product that all is near for. */
void CB_NAME(cb_product_cluster_gradients)(const struct cb_elements *E, size_t thread,
                                           const void *u, void *y) {
  if (E->kept_bytes < PRODUCT_FETCHES)
    product_clusters(E, thread, u, y, by_gradients, false, NULL, 0, NULL);
  else
    product_clusters(E, thread, u, y, by_gradients, false, E->state, 9, NULL);
}

void CB_NAME(cb_product_cluster_rest)(const struct cb_elements *E, size_t thread, const void *u,
                                      void *y) {
  if (E->kept_bytes < PRODUCT_FETCHES)
    product_clusters(E, thread, u, y, by_rest, false, NULL, 0, NULL);
  else
    product_clusters(E, thread, u, y, by_rest, false, E->rest, E->rest_numbers, NULL);
}

void CB_NAME(cb_product_recompute)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y) {
  product_clusters(E, thread, u, y, by_positions, true, NULL, 0, NULL);
}

void drive_product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                            product_pack_fn *product) {
  product_clusters_of_model(E, thread, u, y, product);
}
