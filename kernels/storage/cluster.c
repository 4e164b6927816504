/* cluster.c - see cluster.h: the loops that models share.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/cluster.h"

void drive_update_clusters(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                           S *out, update_pack_fn *update) {
  update_clusters(E, thread, x, v, h, out, update);
}

/* One slot of a product, for edges du[9] and, if it is read, edges e[9] of the last
 * update's positions: f[9] := share on b, c, d. */
typedef void slot_product_fn(const struct cb_elements *E, size_t slot, product_pack_fn *model,
                             const T *e, const T *du, T *f);

INLINE void product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                             slot_product_fn *product, bool positions, product_pack_fn *model) {
  const struct cb_packs *P = E->packs;
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const struct cb_pack *pack = &P->pack[p];
      const struct cb_template *shape = &P->shape[pack->shape];
      const uint32_t *node = P->node + (size_t)pack->node * LANES;
      T local[NODE_NUMBERS], x[NODE_NUMBERS], sum[NODE_NUMBERS];
      load_cluster(u, node, shape->nodes, local);
      if (positions) load_cluster(E->x, node, shape->nodes, x);
      for (size_t n = 0; n < 3u * shape->nodes; n++) sum[n] = LIT(0);
      for (size_t i = 0; i < shape->tets; i++) {
        const uint8_t *vertex = shape->vertex[i];
        T e[9], du[9], f[9];
        STAGE(STAGE_PRODUCT);
        if (positions) local_edges(x, vertex, e);
        local_edges(local, vertex, du);
        product(E, pack->slot + i, model, e, du, f);
        add_locally(sum, vertex, f);
      }
      add_cluster(y, node, shape->nodes, pack->live, sum);
    }
    part_end(E, thread, part);
  }
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

INLINE void by_model(const struct cb_elements *E, size_t slot, product_pack_fn *model, const T *e,
                     const T *du, T *f) {
  (void)e;
  model(E, E->rest + slot * E->rest_numbers, E->state + slot * E->state_numbers, du, f);
}

void CB_NAME(cb_product_cluster_gradients)(const struct cb_elements *E, size_t thread,
                                           const void *u, void *y) {
  product_clusters(E, thread, u, y, by_gradients, false, NULL);
}

void CB_NAME(cb_product_cluster_rest)(const struct cb_elements *E, size_t thread, const void *u,
                                      void *y) {
  product_clusters(E, thread, u, y, by_rest, false, NULL);
}

void CB_NAME(cb_product_recompute)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y) {
  product_clusters(E, thread, u, y, by_positions, true, NULL);
}

void drive_product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                            product_pack_fn *product) {
  product_clusters(E, thread, u, y, by_model, false, product);
}
