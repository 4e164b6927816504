/* cluster.h - the loops over units of clusters (kernels/cluster_joins.h): nodes are
 * gathered and scattered once a unit, and its elements take them from there. Numbers
 * of a pack's nodes stay in the first cache: u[3 j] to u[3 j + 2] are x, y, z of its
 * local node j; struct cb_corners has the bytes from u to them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CLUSTER_H
#define CB_CLUSTER_H

#include "kernels/storage/drive.h"
#include "kernels/team.h"

enum { NODE_NUMBERS = 3 * CB_UNIT_NODES, SUM_NUMBERS = NODE_NUMBERS + 3 };
/* Sums are half a page away from what is loaded, whose places a small unit then does
 * not share in the lowest 12 bits: loads would wait for the stores. */
enum { PAGE = 4096 / sizeof(T), LOADED = (NODE_NUMBERS + PAGE - 1) / PAGE * PAGE };

INLINE void load_cluster(const S *vector, const uint32_t *node, size_t nodes, T *u) {
  for (size_t j = 0; j < nodes; j++) load_nodes(vector, node + j * LANES, u + 3 * j);
}

INLINE void add_cluster(S *vector, const uint32_t *node, size_t nodes, size_t live, const T *f) {
  STAGE(STAGE_SCATTER);
  for (size_t j = 0; j < nodes; j++) add_to_nodes(vector, node + j * LANES, live, f + 3 * j);
}

INLINE const T *local_at(const T *u, uint16_t place) {
  return (const T *)((const char *)u + place);
}

/* The zero that sums begin with: what is stored binds, and so nothing is cleared. */
INLINE void prepare_sums(T *sum) {
  for (size_t i = NODE_NUMBERS; i < SUM_NUMBERS; i++) sum[i] = LIT(0);
}

INLINE void local_edges(const T *u, const uint16_t *vertex, T *e) {
  const T *a = local_at(u, vertex[0]);
  for (int j = 0; j < 3; j++) {
    const T *b = local_at(u, vertex[j + 1]);
    for (int i = 0; i < 3; i++) e[3 * j + i] = b[i] - a[i];
  }
}

/* sum += f on b, c, d and minus their sum on a. */
INLINE void add_locally(T *sum, const struct cb_corners *corners, const T *f) {
  T all[12];
  for (int i = 0; i < 3; i++) all[i] = -(f[i] + f[3 + i] + f[6 + i]);
  for (int i = 0; i < 9; i++) all[3 + i] = f[i];
  STAGE(STAGE_SCATTER);
  for (int j = 0; j < 4; j++) {
    const T *before = local_at(sum, corners->sum[j]);
    T *at = (T *)local_at(sum, corners->vertex[j]);
    for (int i = 0; i < 3; i++) at[i] = before[i] + all[3 * j + i];
  }
}

/* ---- the vertices' own order -------------------------------------------------- */

/* is[4 j + s]: the own vertex j is vertex s of the shape. */
INLINE void own_order(const uint8_t *order, CHOICE *is) {
  WHOLES code = load_bytes(order);
  for (int n = 0; n < 16; n++) is[n] = EQUAL(code >> (n / 4 * 2) & 3, n % 4);
}

/* own rows b, c, d := edges in the vertices' own order, of e in that of the shape,
 * whose vertex a is the origin. */
INLINE void own_edges(const uint8_t *order, const T *e, T *own) {
  CHOICE is[16];
  own_order(order, is);
  for (int i = 0; i < 3; i++) {
    T p[4];
    for (int j = 0; j < 4; j++)
      p[j] = CHOOSE(is[4 * j + 1], e[i],
                    CHOOSE(is[4 * j + 2], e[3 + i], CHOOSE(is[4 * j + 3], e[6 + i], LIT(0))));
    for (int j = 0; j < 3; j++) own[3 * j + i] = p[j + 1] - p[0];
  }
}

/* g rows b, c, d: gradients, which sum to zero over the vertices, in the vertices'
 * own order, then in that of the shape. */
INLINE void gradients_to_shape(const uint8_t *order, T *g) {
  CHOICE is[16];
  own_order(order, is);
  for (int i = 0; i < 3; i++) {
    T b = g[i], c = g[3 + i], d = g[6 + i], a = -(b + c + d);
    for (int s = 1; s < 4; s++)
      g[3 * (s - 1) + i] = CHOOSE(is[s], a, CHOOSE(is[4 + s], b, CHOOSE(is[8 + s], c, d)));
  }
}

/* ---- update -------------------------------------------------------------------- */

/* Numbers of a pack's nodes. */
struct cluster_work {
  const struct cb_pack *pack;
  const struct cb_pack_shape *shape;
  _Alignas(64) T X[LOADED], x[LOADED], v[LOADED], gap[PAGE / 2], f[SUM_NUMBERS];
};

/* Rest data of a slot: kept, or made in made[REST_ISOTROPIC]. */
INLINE const T *rest_of_slot(const struct cb_elements *E, size_t slot, const T *X,
                             const uint16_t *vertex, const uint8_t *order, T *made) {
  if (E->rest) return E->rest + slot * E->rest_numbers;
  T e[9], own[9];
  STAGE(STAGE_REST);
  local_edges(X, vertex, e);
  if (order) own_edges(order, e, own);
  rest_called(E, order ? own : e, made);
  if (order) {
    T c[9]; /* the sign that cofactors of the current edges will have */
    gradients_to_shape(order, made + REST_G);
    edge_cofactors(e, c);
    if (E->policy == POLICY_UPDATED)
      made[REST_FORCE] = SELECT(dot3(e, c) < LIT(0), -ABS(made[REST_FORCE]), ABS(made[REST_FORCE]));
  }
  return made;
}

/* A slot's numbers, as update_pack_fn names them. */
struct slot {
  const T *rest, *e, *own, *ev;
  T *memory, *state, *f;
};

/* Some packs in a hurry: as update_pack_fn, but without a call for what is rare, which would
 * cost the loop its registers. False where they are to be made again by that. */
typedef bool quick_packs_fn(const struct cb_elements *E, size_t count, const struct slot *slot,
                            T h);
enum { SLOTS_AT_ONCE = 3 }; /* at most */

/* `count` tetrahedra of a pack's clusters, from the i-th; quick or, if that is NULL, update. */
INLINE bool update_slots(struct cb_elements *E, struct cluster_work *W, size_t i, size_t count,
                         bool moving, T h, quick_packs_fn *quick, update_pack_fn *update,
                         bool keep_state) {
  struct slot slots[SLOTS_AT_ONCE];
  T made[SLOTS_AT_ONCE][REST_ISOTROPIC], e[SLOTS_AT_ONCE][9], own[SLOTS_AT_ONCE][9],
      ev[SLOTS_AT_ONCE][9], f[SLOTS_AT_ONCE][9], lost[18];
  const struct cb_corners *corners = E->packs->corners + W->shape->corners + i;
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) {
    const size_t slot = W->pack->slot + i + k;
    const uint8_t *order = E->packs->order ? E->packs->order + slot * LANES : NULL;
    T *state = E->state + slot * E->state_numbers;
    fetch_for_update(E, slot);
    const T *rest = rest_of_slot(E, slot, W->X, corners[k].vertex, order, made[k]);
    STAGE(STAGE_FRAME);
    local_edges(W->x, corners[k].vertex, e[k]);
    if (order) own_edges(order, e[k], own[k]);
    if (moving) local_edges(W->v, corners[k].vertex, ev[k]);
    if (!keep_state) state[0] = rest[REST_W];
    slots[k] = (struct slot){rest,
                             e[k],
                             order ? own[k] : e[k],
                             moving ? ev[k] : NULL,
                             E->memory + slot * E->memory_numbers,
                             keep_state ? state : lost,
                             f[k]};
  }
  bool done = true;
  if (quick)
    done = quick(E, count, slots, h);
  else
    update(E, slots->rest, slots->e, slots->own, slots->ev, h, slots->memory, slots->state,
           slots->f);
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) add_locally(W->f, corners + k, f[k]);
  return done;
}

#define update_unit_again CB_NAME(cb_update_unit_again)
/* All tetrahedra of W's pack once more, by update: W->f, state and memory are overwritten;
 * h, s. In cluster.c. */
void update_unit_again(struct cb_elements *E, struct cluster_work *W, bool moving, double h,
                       update_pack_fn *update);

/* So many units that follow one which quick was in vain for are made by update at once: what
 * collapses has neighbours that do. */
enum { CAREFUL_UNITS = 7 };

/* By quick, `count` tetrahedra at once, and by update where that is not enough, or quick is NULL.
 * Keeps REST_W in the state's place, and the positions, if there is room for them
 * (ebe-recompute). Inlined wherever it stands: with it the model's function, whose
 * numbers then stay in registers, which takes a third off the time. */
INLINE void update_clusters_quickly(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                    double h, S *out, quick_packs_fn *quick, size_t count,
                                    update_pack_fn *update) {
  const struct cb_packs *P = E->packs;
  struct cluster_work W;
  size_t careful = 0;
  prepare_sums(W.f);
  if (E->x) {
    size_t first, last;
    cb_team_share(STRIDE * E->nodes, P->threads, thread, &first, &last);
    for (size_t i = first; i < last; i++) E->x[i] = x[i];
  }
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      W.pack = &P->pack[p];
      W.shape = &P->shape[W.pack->shape];
      const uint32_t *node = P->node + (size_t)W.pack->node * LANES;
      if (!E->rest) load_cluster(E->X, node, W.shape->nodes, W.X);
      load_cluster(x, node, W.shape->nodes, W.x);
      if (v) load_cluster(v, node, W.shape->nodes, W.v);
      bool done = true;
      size_t i = careful ? W.shape->tets : 0;
      for (; i + count <= W.shape->tets; i += count)
        done &= update_slots(E, &W, i, count, v != NULL, LIT(h), quick, update, E->x == NULL);
      for (; count > 1 && i < W.shape->tets; i++)
        done &= update_slots(E, &W, i, 1, v != NULL, LIT(h), quick, update, E->x == NULL);
      if (__builtin_expect(!done || careful, 0)) {
        update_unit_again(E, &W, v != NULL, h, update);
        careful = careful ? careful - 1 : CAREFUL_UNITS;
      }
      add_cluster(out, node, W.shape->nodes, W.pack->live, W.f);
    }
    part_end(E, thread, part);
  }
}

INLINE void update_clusters(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                            S *out, update_pack_fn *update) {
  update_clusters_quickly(E, thread, x, v, h, out, NULL, 1, update);
}

/* ---- product ------------------------------------------------------------------- */

/* One slot of a product, for edges du[9] and, if it is read, edges e[9] of the last
 * update's positions: f[9] := share on b, c, d. Its `numbers` from `ahead` on are fetched. */
typedef void slot_product_fn(const struct cb_elements *E, size_t slot, product_pack_fn *model,
                             const T *e, const T *du, T *f);

INLINE void product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                             slot_product_fn *product, bool positions, const T *ahead,
                             size_t numbers, product_pack_fn *model) {
  const struct cb_packs *P = E->packs;
  struct {
    T u[LOADED], x[LOADED], gap[PAGE / 2], sum[SUM_NUMBERS];
  } W;
  prepare_sums(W.sum);
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const struct cb_pack *pack = &P->pack[p];
      const struct cb_pack_shape *shape = &P->shape[pack->shape];
      const uint32_t *node = P->node + (size_t)pack->node * LANES;
      load_cluster(u, node, shape->nodes, W.u);
      if (positions) load_cluster(E->x, node, shape->nodes, W.x);
      for (size_t i = 0; i < shape->tets; i++) {
        const struct cb_corners *corners = P->corners + shape->corners + i;
        T e[9], du[9], f[9];
        STAGE(STAGE_PRODUCT);
        if (numbers) fetch(ahead + (pack->slot + i + AHEAD) * numbers, numbers);
        if (positions) local_edges(W.x, corners->vertex, e);
        local_edges(W.u, corners->vertex, du);
        product(E, pack->slot + i, model, e, du, f);
        add_locally(W.sum, corners, f);
      }
      add_cluster(y, node, shape->nodes, pack->live, W.sum);
    }
    part_end(E, thread, part);
  }
}

INLINE void by_model(const struct cb_elements *E, size_t slot, product_pack_fn *model, const T *e,
                     const T *du, T *f) {
  (void)e;
  fetch_for_product(E, slot);
  model(E, E->rest + slot * E->rest_numbers, E->state + slot * E->state_numbers, du, f);
}

/* Inlined wherever it stands, like update_clusters. */
INLINE void product_clusters_of_model(const struct cb_elements *E, size_t thread, const S *u, S *y,
                                      product_pack_fn *product) {
  product_clusters(E, thread, u, y, by_model, false, NULL, 0, product);
}

#define drive_update_clusters CB_NAME(cb_drive_update_clusters)
#define drive_product_clusters CB_NAME(cb_drive_product_clusters)
/* One copy an arithmetic, in cluster.c, for what nothing is timed with. */
void drive_update_clusters(struct cb_elements *E, size_t thread, const S *x, const S *v, double h,
                           S *out, update_pack_fn *update);
void drive_product_clusters(const struct cb_elements *E, size_t thread, const S *u, S *y,
                            product_pack_fn *product);
/* cb_product_fn: state = nine world gradients, or what ebe-recompute keeps. */
void CB_NAME(cb_product_cluster_gradients)(const struct cb_elements *E, size_t thread,
                                           const void *u, void *y);
void CB_NAME(cb_product_recompute)(const struct cb_elements *E, size_t thread, const void *u,
                                   void *y);
/* The same with the rest data's gradients as world gradients. */
void CB_NAME(cb_product_cluster_rest)(const struct cb_elements *E, size_t thread, const void *u,
                                      void *y);

#endif
