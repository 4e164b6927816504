/* drive.h - the loops over elements: gather, one element function, scatter.
 * A model hands its functions over as constants, so that they are inlined.
 * Vertex a's share is minus the sum of the others (Newton's law, and
 * translations drop out): element functions see edges b-a, c-a, d-a only.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_DRIVE_H
#define CB_DRIVE_H

#include "kernels/elements.h"
#include "kernels/storage/lanes.h"
#include "kernels/tensor3.h"

/* One pack in an update.
 * in      rest, e[9] edges (m), ev[9] edges of velocity (m/s) or NULL, h (s)
 * in/out  memory
 * out     state, f[9] = share of h f - c K v on b, c, d */
typedef void update_pack_fn(const struct cb_elements *E, const T *rest, const T *e, const T *ev,
                            T h, T *memory, T *state, T *f);
/* One pack in a product: f[9] := share of c K u on b, c, d for edges du[9]. */
typedef void product_pack_fn(const struct cb_elements *E, const T *rest, const T *state,
                             const T *du, T *f);

/* e[9] := differences of the node vector x along b-a, c-a, d-a. */
INLINE void gather_edges(const S *x, const uint32_t *tet, T *e) {
  T p[12];
  for (int j = 0; j < 4; j++) load_nodes(x, tet + j * LANES, p + 3 * j);
  for (int j = 0; j < 9; j++) e[j] = p[3 + j] - p[j % 3];
}

/* y += f on b, c, d and minus their sum on a, for the live lanes. */
INLINE void scatter_edges(S *y, const uint32_t *tet, size_t live, const T *f) {
  T a[3];
  for (int i = 0; i < 3; i++) a[i] = -(f[i] + f[3 + i] + f[6 + i]);
  STAGE(STAGE_SCATTER);
  add_to_nodes(y, tet, live, a);
  for (int j = 1; j < 4; j++) add_to_nodes(y, tet + j * LANES, live, f + 3 * (j - 1));
}

INLINE void clear_vector(const struct cb_elements *E, S *y) {
  for (size_t i = 0; i < STRIDE * E->nodes; i++) y[i] = (S)0;
}

/* y := the product over all packs; inlined wherever it stands. */
INLINE void product_loop(const struct cb_elements *E, const S *u, S *y, product_pack_fn *product) {
  clear_vector(E, y);
  for (size_t p = 0; p < E->packs; p++) {
    const uint32_t *tet = E->tet + p * 4 * LANES;
    T du[9], f[9];
    STAGE(STAGE_PRODUCT);
    gather_edges(u, tet, du);
    product(E, E->rest + p * E->rest_numbers, E->state + p * E->state_numbers, du, f);
    scatter_edges(y, tet, live_lanes(E, p), f);
  }
}

/* The loops of one element are inlined into each model; those of many elements
 * are one copy an arithmetic (drivers.c), which calls the work of a pack. */
#if CB_LANES == 1
#define DRIVER INLINE
#else
#define DRIVER
#define drive_update CB_NAME(cb_drive_update)
#define drive_product CB_NAME(cb_drive_product)
#define drive_update_matrix CB_NAME(cb_drive_update_matrix)
#define drive_update_assembled CB_NAME(cb_drive_update_assembled)
#endif
DRIVER void drive_update(struct cb_elements *E, const S *x, const S *v, double h, S *out,
                         update_pack_fn *update);
DRIVER void drive_product(const struct cb_elements *E, const S *u, S *y, product_pack_fn *product);

#if CB_LANES == 1 || defined(CB_DEFINE_DRIVERS)
DRIVER void drive_update(struct cb_elements *E, const S *x, const S *v, double h, S *out,
                         update_pack_fn *update) {
  clear_vector(E, out);
  for (size_t p = 0; p < E->packs; p++) {
    const uint32_t *tet = E->tet + p * 4 * LANES;
    T e[9], ev[9], f[9];
    STAGE(STAGE_FRAME);
    gather_edges(x, tet, e);
    if (v) gather_edges(v, tet, ev);
    update(E, E->rest + p * E->rest_numbers, e, v ? ev : NULL, LIT(h),
           E->memory + p * E->memory_numbers, E->state + p * E->state_numbers, f);
    scatter_edges(out, tet, live_lanes(E, p), f);
  }
}

DRIVER void drive_product(const struct cb_elements *E, const S *u, S *y, product_pack_fn *product) {
  product_loop(E, u, y, product);
}
#endif

#endif
