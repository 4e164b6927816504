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

INLINE void sum_node_gradients(struct cb_elements *E, const S *x) {
  for (size_t i = 0; i < 9 * E->nodes; i++) E->node_sum[i] = (S)0;
  for (size_t p = 0; p < E->packs; p++) {
    const uint32_t *tet = E->tet + p * 4 * LANES;
    const T *rest = E->rest + p * E->rest_numbers;
    T e[9], F[9];
    STAGE(STAGE_FRAME);
    T weight = rest[REST_FORCE] * rest[REST_FORCE];
    gather_edges(x, tet, e);
    deformation_gradient(POLICY_PRECOMPUTED, rest, e, F);
    for (int i = 0; i < 9; i++) F[i] = weight * F[i];
    for (size_t l = 0; l < live_lanes(E, p); l++)
      for (int j = 0; j < 4; j++) {
        S *sum = E->node_sum + 9 * (size_t)tet[j * LANES + (int)l];
        for (int i = 0; i < 9; i++) sum[i] += LANE(F[i], l);
      }
  }
}

/* A node of no element keeps whatever comes out: nobody reads it. */
INLINE void turn_nodes(struct cb_elements *E) {
  for (size_t n = 0; n < E->nodes; n += LANES) {
    T F[9], R[9];
    size_t live = E->nodes - n < LANES ? E->nodes - n : LANES;
    S numbers[9][LANES];
    for (size_t l = 0; l < LANES; l++)
      for (int i = 0; i < 9; i++)
        numbers[i][l] = E->node_sum[9 * (n + (l < live ? l : live - 1)) + (size_t)i];
    memcpy(F, numbers, sizeof F);
    frame_polar_higham(F, R);
    for (size_t l = 0; l < live; l++)
      for (int i = 0; i < 9; i++) E->node_frame[9 * (n + l) + (size_t)i] = LANE(R[i], l);
  }
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
        numbers[i][l] = E->node_frame[9 * (size_t)tet[j * LANES + l] + (size_t)i];
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

INLINE void scatter_nodes(const struct cb_elements *E, size_t pack, S *y, int sign, const T *f) {
  const uint32_t *tet = E->tet + pack * 4 * LANES;
  STAGE(STAGE_SCATTER);
  for (size_t l = 0; l < live_lanes(E, pack); l++)
    for (int j = 0; j < 4; j++) {
      S *node = y + STRIDE * (size_t)tet[j * LANES + (int)l];
      for (int i = 0; i < 3; i++)
        if (sign < 0)
          node[i] -= LANE(f[3 * j + i], l);
        else
          node[i] += LANE(f[3 * j + i], l);
    }
}

INLINE void warp_update(struct cb_elements *E, int ortho, const S *x, const S *v, double h,
                        S *out) {
  sum_node_gradients(E, x);
  turn_nodes(E);
  clear_vector(E, out);
  for (size_t p = 0; p < E->packs; p++) {
    const uint32_t *tet = E->tet + p * 4 * LANES;
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
    scatter_nodes(E, p, out, -1, f);
  }
}

INLINE void warp_product(const struct cb_elements *E, int ortho, const S *u, S *y) {
  clear_vector(E, y);
  for (size_t p = 0; p < E->packs; p++) {
    const uint32_t *tet = E->tet + p * 4 * LANES;
    const T *rest = E->rest + p * E->rest_numbers;
    T e[9], H[9], f[12];
    STAGE(STAGE_PRODUCT);
    gather_edges(u, tet, e);
    gradient3(e, rest + REST_G, H);
    warped_forces(E, ortho, rest, tet, LIT(1), NULL, H, f);
    scatter_nodes(E, p, y, 1, f);
  }
}

UPDATE_FUNCTION(node_warp_update_iso, warp_update(E, 0, x, v, h, out))
UPDATE_FUNCTION(node_warp_update_ortho, warp_update(E, 1, x, v, h, out))
PRODUCT_FUNCTION(node_warp_run_iso, warp_product(E, 0, u, y))
PRODUCT_FUNCTION(node_warp_run_ortho, warp_product(E, 1, u, y))

#define NODE_WARP_LAWS (CB_KEEPS(CB_LAW_ROTATION) | LAWS_ORDER)

const struct cb_model CB_NAME(cb_model_node_warp) = {
    .name = "node-warp",
    .summary = "stiffness warping, one polar frame a node, rest B",
    .source = "Mueller, Dorsey, McMillan, Jagnow, Cutler 2002",
    .laws = {NODE_WARP_LAWS, NODE_WARP_LAWS},
    .policy = POLICY_PRECOMPUTED,
    .node_frames = true,
    .form = {[CB_EBE] = {{node_warp_update_iso, node_warp_run_iso, 0},
                         {node_warp_update_ortho, node_warp_run_ortho, 0}}}};
