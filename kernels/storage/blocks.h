/* blocks.h - storages that keep stiffness as 3x3 blocks: ebe-matrix (six blocks
 * an element), csr and bcsr (assembled). K is symmetric and its rows sum to
 * zero, so the six off-diagonal blocks of an element, and the blocks of the
 * mesh's edges, are all there is: K_ji = K_ij^T, K_ii = -sum_j K_ij.
 * Assembly sums per edge and expands once.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_BLOCKS_H
#define CB_BLOCKS_H

#include <string.h>

#include "kernels/storage/drive.h"
#include "kernels/team.h"

/* One pack in an update, as update_pack_fn; X[6][9] are blocks, or what
 * edge_products makes. */
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

/* Update of ebe-matrix (state = six blocks), and of csr and bcsr; products: the
 * blocks come as edge products. */
DRIVER void drive_update_matrix(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                double h, S *out, blocks_pack_fn *blocks, int products);
DRIVER void drive_update_assembled(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                   double h, S *out, blocks_pack_fn *blocks, int products);

/* One thread's share of the values of csr or bcsr, from the edge sums. */
void CB_NAME(cb_assemble)(struct cb_elements *E, size_t thread, bool products);

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

/* Sums X[6][9] into the edges, turned where the edge runs from high to low node. */
INLINE void sum_edges(struct cb_elements *E, size_t pack, size_t live, const T *X) {
  const uint32_t *edge_of = E->pattern->edge_of + pack * 6 * LANES;
  S numbers[54 * LANES]; /* [6][9][LANES] */
  memcpy(numbers, X, sizeof numbers);
  for (size_t l = 0; l < live; l++)
    for (size_t n = 0; n < 6; n++) {
      uint32_t edge = edge_of[n * LANES + l];
      S *sum = E->edge_sum + 9 * (size_t)(edge >> 1);
      const S *block = numbers + 9 * LANES * n + l;
      for (size_t i = 0; i < 9; i++) sum[i] += block[LANES * (edge & 1 ? i % 3 * 3 + i / 3 : i)];
    }
}

DRIVER void drive_update_assembled(struct cb_elements *E, size_t thread, const S *x, const S *v,
                                   double h, S *out, blocks_pack_fn *blocks, int products) {
  size_t first, last;
  cb_team_share(9 * E->pattern->edges, E->packs->threads, thread, &first, &last);
  for (size_t i = first; i < last; i++) E->edge_sum[i] = (S)0;
  cb_team_barrier(E->team);
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      T X[54];
      update_blocks(E, &r, p, x, v, h, out, blocks, X);
      sum_edges(E, p, live_lanes(&r, p), X);
    }
    part_end(E, thread, part);
  }
  cb_team_barrier(E->team);
  CB_NAME(cb_assemble)(E, thread, products);
}
#endif

#endif
