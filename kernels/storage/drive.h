/* drive.h - the loops over single elements: gather, one element function, scatter.
 * A model hands its functions over as constants, so that they are inlined.
 * Vertex a's share is minus the sum of the others (Newton's law, and
 * translations drop out): element functions see edges b-a, c-a, d-a only.
 * Every loop is one thread's chunk, and adds to the vector that it is given.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_DRIVE_H
#define CB_DRIVE_H

#include "kernels/elements.h"
#include "kernels/spin.h"
#include "kernels/storage/lanes.h"
#include "kernels/storage/rest.h"
#include "kernels/tensor3.h"

/* One pack in an update.
 * in      rest; e[9] edges, m, and the same in the vertices' own order, the mesh's,
 *         if clusters have another (packs->order), else own = e;
 *         ev[9] edges of velocity, m/s, or NULL; h, s
 * in/out  memory
 * out     state, f[9] = share of h f - c K v on b, c, d */
typedef void update_pack_fn(const struct cb_elements *E, const T *rest, const T *e, const T *own,
                            const T *ev, T h, T *memory, T *state, T *f);
/* One pack in a product: f[9] := share of c K u on b, c, d for edges du[9]. */
typedef void product_pack_fn(const struct cb_elements *E, const T *rest, const T *state,
                             const T *du, T *f);

/* ---- whose turn it is: kernels/packs.h ------------------------------------- */

struct range {
  size_t first, last; /* packs */
  size_t tail, tail_live;
};

/* Thread's packs of part 0, 1 or 2, once they may add to the nodes. */
INLINE struct range part_begin(const struct cb_elements *E, size_t thread, int part) {
  const struct cb_chunk *c = &E->packs->chunk[thread];
  if (part == 0) E->turn[thread].begun++;
  uint64_t wait = part == 1 ? 0 : c->after[part / 2];
  for (size_t earlier = 0; wait; earlier++, wait >>= 1)
    for (size_t n = 0;
         (wait & 1) && atomic_load_explicit(&E->turn[earlier].done, memory_order_acquire) !=
                           E->turn[thread].begun;
         n++)
      cb_spin(n);
  return (struct range){c->part[part], c->part[part + 1], c->part[3] - 1, c->last_live};
}

INLINE void part_end(const struct cb_elements *E, size_t thread, int part) {
  if (part == 0 && E->packs->threads > 1)
    atomic_store_explicit(&E->turn[thread].done, E->turn[thread].begun, memory_order_release);
}

INLINE size_t live_lanes(const struct range *r, size_t pack) {
  return pack == r->tail ? r->tail_live : LANES;
}

/* ---- what is needed in a while ---------------------------------------------- */

/* Slots ahead. The processor sees such streams too, but begins anew at each page. */
enum { AHEAD = 2 };

INLINE void fetch(const T *numbers, size_t count) {
  for (size_t i = 0; LANES > 1 && i < count; i += 64 / sizeof(T)) __builtin_prefetch(numbers + i);
}

/* What an update soon comes to, and a product; asked for only where that pays
 * (struct cb_elements). */
INLINE void fetch_all(const struct cb_elements *E, size_t slot) {
  fetch(E->state + (slot + AHEAD) * E->state_numbers, E->state_numbers);
  if (E->rest) fetch(E->rest + (slot + AHEAD) * E->rest_numbers, E->rest_numbers);
}
INLINE void fetch_for_update(const struct cb_elements *E, size_t slot) {
  if (E->kept_bytes >= UPDATE_FETCHES) fetch_all(E, slot);
}
INLINE void fetch_for_product(const struct cb_elements *E, size_t slot) {
  if (E->kept_bytes >= PRODUCT_FETCHES) fetch_all(E, slot);
}

/* ---- gather and scatter ----------------------------------------------------- */

/* e[9] := differences of the node vector x along b-a, c-a, d-a. */
INLINE void gather_edges(const S *x, const uint32_t *tet, T *e) {
  T p[12];
#pragma GCC unroll 4
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

OUTLINE void rest_called(const struct cb_elements *E, const T *e, T *rest) {
  rest_of_edges(E, e, rest);
}

/* Rest data of a pack of single elements: kept, or made in own[REST_ISOTROPIC]. */
INLINE const T *rest_of(const struct cb_elements *E, const uint32_t *tet, size_t slot, T *own) {
  if (E->rest) return E->rest + slot * E->rest_numbers;
  T e[9];
  STAGE(STAGE_REST);
  gather_edges(E->X, tet, e);
  rest_called(E, e, own);
  return own;
}

/* ---- loops ------------------------------------------------------------------- */

/* y += the product over one thread's packs; inlined wherever it stands. */
INLINE void product_loop(const struct cb_elements *E, size_t thread, const S *u, S *y,
                         product_pack_fn *product) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      T du[9], f[9];
      STAGE(STAGE_PRODUCT);
      fetch_for_product(E, p);
      gather_edges(u, tet, du);
      product(E, E->rest + p * E->rest_numbers, E->state + p * E->state_numbers, du, f);
      scatter_edges(y, tet, live_lanes(&r, p), f);
    }
    part_end(E, thread, part);
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
DRIVER void drive_update(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                         S *out, update_pack_fn *update);
DRIVER void drive_product(const struct cb_elements *E, size_t thread, const S *u, S *y,
                          product_pack_fn *product);

#if CB_LANES == 1 || defined(CB_DEFINE_DRIVERS)
DRIVER void drive_update(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                         S *out, update_pack_fn *update) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      T made[REST_ISOTROPIC], e[9], ev[9], f[9];
      fetch_for_update(E, p);
      const T *rest = rest_of(E, tet, p, made);
      STAGE(STAGE_FRAME);
      gather_edges(x, tet, e);
      if (v) gather_edges(v, tet, ev);
      update(E, rest, e, e, v ? ev : NULL, LIT(h), E->memory + p * E->memory_numbers,
             E->state + p * E->state_numbers, f);
      scatter_edges(out, tet, live_lanes(&r, p), f);
    }
    part_end(E, thread, part);
  }
}

DRIVER void drive_product(const struct cb_elements *E, size_t thread, const S *u, S *y,
                          product_pack_fn *product) {
  product_loop(E, thread, u, y, product);
}
#endif

#endif
