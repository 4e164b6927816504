/* node_warp.c - stiffness warping: one rotation per node, and each node's force
 * computed as if the whole element had turned with it.
 * Source: Mueller, Dorsey, McMillan, Jagnow, Cutler 2002, section 4; a node's
 *         rotation is the polar factor of the volume-weighted mean of its
 *         elements' deformation gradients.
 * Trade:  one frame a node instead of one an element; the four shares of an
 *         element no longer sum to zero (Newton), and the operator is not
 *         symmetric, so it is offered unassembled only.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "kernels/frames/polar_higham.h"
#include "kernels/models/forms.h"
#include "kernels/models/strain.h"
#include "kernels/storage/gradients.h"

INLINE void sum_node_gradients(struct cb_elements *E, size_t thread, const S *x) {
  size_t first, last;
  cb_team_share(9 * E->nodes, E->packs->threads, thread, &first, &last);
  for (size_t i = first; i < last; i++) E->node_sum[i] = (S)0;
  cb_team_barrier(E->team, thread);
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      const T *rest = E->rest + p * E->rest_numbers;
      T e[9], F[9];
      STAGE(STAGE_FRAME);
      T weight = rest[REST_FORCE] * rest[REST_FORCE];
      gather_edges(x, tet, e);
      deformation_gradient(POLICY_PRECOMPUTED, rest, e, F);
      for (int i = 0; i < 9; i++) F[i] = weight * F[i];
      for (size_t l = 0; l < live_lanes(&r, p); l++)
        for (int j = 0; j < 4; j++) {
          S *sum = E->node_sum + 9 * node_number(tet[j * LANES + (int)l]);
          for (int i = 0; i < 9; i++) sum[i] += LANE(F[i], l);
        }
    }
    part_end(E, thread, part);
  }
  cb_team_barrier(E->team, thread);
}

/* A node of no element keeps whatever comes out: nobody reads it. */
INLINE void turn_nodes(struct cb_elements *E, size_t thread) {
  size_t first, last;
  cb_team_share(E->nodes, E->packs->threads, thread, &first, &last);
  for (size_t n = first; n < last; n += LANES) {
    T F[9], R[9];
    size_t live = last - n < LANES ? last - n : LANES;
    S numbers[9][LANES];
    for (size_t l = 0; l < LANES; l++)
      for (int i = 0; i < 9; i++)
        numbers[i][l] = E->node_sum[9 * (n + (l < live ? l : live - 1)) + (size_t)i];
    memcpy(F, numbers, sizeof F);
    frame_polar_higham(F, R);
    for (size_t l = 0; l < live; l++)
      for (int i = 0; i < 9; i++) E->node_frame[9 * (n + l) + (size_t)i] = LANE(R[i], l);
  }
  cb_team_barrier(E->team, thread);
}

/* f[12] := for each vertex i, R_i (scale D : (sym(R_i^T F) - I)
 *                                   + D : sym(R_i^T H)) g_i, with F or H NULL. */
INLINE void warped_forces(const struct cb_elements *E, int ortho, const T *rest,
                          const uint32_t *tet, T scale, const T *F, const T *H, T *f) {
  const T *G = rest + REST_G;
  for (int j = 0; j < 4; j++) {
    T R[9], g[3], p[3], A[9], P[9], N[9];
    S numbers[9][LANES];
    for (int l = 0; l < LANES; l++)
      for (int i = 0; i < 9; i++)
        numbers[i][l] = E->node_frame[9 * node_number(tet[j * LANES + l]) + (size_t)i];
    memcpy(R, numbers, sizeof R);
    for (int i = 0; i < 3; i++) g[i] = j == 0 ? -(G[i] + G[3 + i] + G[6 + i]) : G[3 * (j - 1) + i];
    for (int i = 0; i < 9; i++) P[i] = LIT(0);
    if (F) {
      corotated_stress(E->k, rest, ortho, R, F, A, P);
      for (int i = 0; i < 9; i++) P[i] = scale * P[i];
    }
    if (H) {
      multiply3_tn(R, H, A);
      stress(ortho, E->k, rest + REST_D, A, N);
      for (int i = 0; i < 9; i++) P[i] = F ? P[i] + N[i] : N[i];
    }
    apply3(P, g, p);
    apply3(R, p, f + 3 * j);
  }
}

/* y += sign * f[12] on the four vertices. */
INLINE void scatter_nodes(const uint32_t *tet, size_t live, S *y, int sign, T *f) {
  for (int i = 0; sign < 0 && i < 12; i++) f[i] = -f[i];
  STAGE(STAGE_SCATTER);
  for (int j = 0; j < 4; j++) add_to_nodes(y, tet + j * LANES, live, f + 3 * j);
}

INLINE void warp_update(struct cb_elements *E, size_t thread, int ortho, const S *x, const S *v,
                        double h, S *out) {
  sum_node_gradients(E, thread, x);
  turn_nodes(E, thread);
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      const T *rest = E->rest + p * E->rest_numbers;
      T e[9], F[9], H[9], f[12];
      STAGE(STAGE_FORCE);
      gather_edges(x, tet, e);
      deformation_gradient(POLICY_PRECOMPUTED, rest, e, F);
      if (v) {
        gather_edges(v, tet, e);
        gradient3(e, rest + REST_G, H);
      }
      warped_forces(E, ortho, rest, tet, LIT(h) * rest[REST_FORCE], F, v ? H : NULL, f);
      scatter_nodes(tet, live_lanes(&r, p), out, -1, f);
    }
    part_end(E, thread, part);
  }
}

INLINE void warp_product(const struct cb_elements *E, size_t thread, int ortho, const S *u, S *y) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      const T *rest = E->rest + p * E->rest_numbers;
      T e[9], H[9], f[12];
      STAGE(STAGE_PRODUCT);
      gather_edges(u, tet, e);
      gradient3(e, rest + REST_G, H);
      warped_forces(E, ortho, rest, tet, LIT(1), NULL, H, f);
      scatter_nodes(tet, live_lanes(&r, p), y, 1, f);
    }
    part_end(E, thread, part);
  }
}

UPDATE_FUNCTION(node_warp_update_iso, warp_update(E, thread, 0, x, v, h, out))
UPDATE_FUNCTION(node_warp_update_ortho, warp_update(E, thread, 1, x, v, h, out))
PRODUCT_FUNCTION(node_warp_run_iso, warp_product(E, thread, 0, u, y))
PRODUCT_FUNCTION(node_warp_run_ortho, warp_product(E, thread, 1, u, y))

#define NODE_WARP_LAWS (CB_KEEPS(CB_LAW_ROTATION) | LAWS_ORDER)

const struct cb_model CB_NAME(cb_model_node_warp) = {
    .name = "node-warp",
    .summary = "stiffness warping, one polar frame a node, rest B",
    .source = "Mueller, Dorsey, McMillan, Jagnow, Cutler 2002",
    .laws = {NODE_WARP_LAWS, NODE_WARP_LAWS},
    .policy = POLICY_PRECOMPUTED,
    .node_frames = true,
    .keeps_rest = true,
    .form = {[CB_EBE] = {{node_warp_update_iso, node_warp_run_iso, 0},
                         {node_warp_update_ortho, node_warp_run_ortho, 0}}}};
