/* blocks.h - storages that keep stiffness as 3x3 blocks: ebe-matrix (six blocks
 * an element), csr and bcsr (assembled). K is symmetric and its rows sum to
 * zero, so the six off-diagonal blocks of an element, and the blocks of the
 * mesh's edges, are all there is: K_ji = K_ij^T, K_ii = -sum_j K_ij.
 * Assembly sums what elements kept, edge by edge, and expands once.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_BLOCKS_H
#define CB_BLOCKS_H

#include "kernels/storage/drive.h"
#include "kernels/team.h"

/* One pack in an update, as update_pack_fn; X[6][9] are blocks, or what
 * edge_products makes; or X[9] are gradients. */
typedef void blocks_pack_fn(const struct cb_elements *E, const T *rest, const T *e, const T *own,
                            const T *ev, T h, T *memory, T *X, T *f);

/* K := k X + X^T + tr(X) I; a macro, because X is T in elements and S in sums. */
#define BLOCK_FROM_PRODUCT(k, X, K)                                                                \
  do {                                                                                             \
    __typeof__((X)[0]) k_ = (k), t_ = (X)[0] + (X)[4] + (X)[8];                                    \
    for (int i_ = 0; i_ < 3; i_++)                                                                 \
      for (int j_ = 0; j_ < 3; j_++) {                                                             \
        (K)[3 * i_ + j_] = k_ * (X)[3 * i_ + j_] + (X)[3 * j_ + i_];                               \
        if (i_ == j_) (K)[3 * i_ + j_] = (K)[3 * i_ + j_] + t_;                                    \
      }                                                                                            \
  } while (0)

/* Update of ebe-matrix (state = six blocks); products: they come as edge products. */
DRIVER void drive_update_matrix(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                double h, S *out, blocks_pack_fn *blocks, int products);
/* Update of the assembled storages (state = what terms makes, TERMS_*); gradients:
 * nine world gradients w_j, whose blocks are k w_i w_j^T + w_j w_i^T + (w_i . w_j) I;
 * else six blocks. */
DRIVER void drive_update_assembled(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                   double h, S *out, blocks_pack_fn *terms, int gradients);
enum { TERMS_GRADIENTS = 4 * STRIDE, TERMS_BLOCKS = 54 };

/* One thread's rows of an assembled matrix, from the state of all elements. */
void CB_NAME(cb_assemble)(struct cb_elements *E, size_t thread, bool gradients);

#if CB_LANES == 1 || defined(CB_DEFINE_DRIVERS)
/* Gather, blocks X[54] and forces of one pack, scatter. */
INLINE void update_blocks(struct cb_elements *E, const struct range *r, size_t p, const S *x,
                          const S *v, double h, S *out, blocks_pack_fn *blocks, T *X) {
  const uint32_t *tet = E->packs->node + p * 4 * LANES;
  T made[REST_ISOTROPIC], e[9], ev[9], f[9];
  const T *rest = rest_of(E, tet, p, made);
  STAGE(STAGE_FRAME);
  gather_edges(x, tet, e);
  if (v) gather_edges(v, tet, ev);
  blocks(E, rest, e, e, v ? ev : NULL, LIT(h), E->memory + p * E->memory_numbers, X, f);
  scatter_edges(out, tet, live_lanes(r, p), f);
  STAGE(STAGE_ASSEMBLY);
}

DRIVER void drive_update_matrix(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                double h, S *out, blocks_pack_fn *blocks, int products) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      T X[54], *K = E->state + p * E->state_numbers;
      update_blocks(E, &r, p, x, v, h, out, blocks, X);
      for (int n = 0; n < 54; n += 9)
        if (products)
          BLOCK_FROM_PRODUCT(E->k, X + n, K + n);
        else
          for (int i = 0; i < 9; i++) K[n + i] = X[n + i];
    }
    part_end(E, thread, part);
  }
}

/* w[9] of b, c, d, and minus their sum of a, as whole nodes: [lanes][4]. */
INLINE void keep_gradients(const T *w, S *to) {
  T all[12];
  for (int i = 0; i < 3; i++) all[i] = -(w[i] + w[3 + i] + w[6 + i]);
  for (int i = 0; i < 9; i++) all[3 + i] = w[i];
#if CB_LANES == 1
  for (int i = 0; i < 12; i++) to[i] = all[i];
#else
  for (int j = 0; j < 4; j++) {
    T g[4];
    nodes_of_lanes(all + 3 * j, g);
#define KEEP_QUAD(q)                                                                               \
  for (int k = 0; k < 4; k++) *(LOOSE_NODE *)(to + 4 * (4 * (4 * (q) + k) + j)) = NODE_OF(g[k], q)
    KEEP_QUAD(0);
#if CB_LANES > 4
    KEEP_QUAD(1);
#endif
#if CB_LANES > 8
    KEEP_QUAD(2);
    KEEP_QUAD(3);
#endif
#undef KEEP_QUAD
  }
#endif
}

DRIVER void drive_update_assembled(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                   double h, S *out, blocks_pack_fn *terms, int gradients) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      T *state = E->state + p * E->state_numbers, w[9];
      update_blocks(E, &r, p, x, v, h, out, terms, gradients ? w : state);
      if (gradients) keep_gradients(w, (S *)state);
    }
    part_end(E, thread, part);
  }
  cb_team_barrier(E->team, thread);
  CB_NAME(cb_assemble)(E, thread, gradients);
}
#endif

#endif
