/* elements.h - one arithmetic's view of all elements of a mesh: the arrays that
 * the storages run over. Elements come in packs of LANES (kernels/packs.h); a
 * number of LANES elements is one T. Lanes without an element of their own repeat
 * another one: they are computed and never scattered.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ELEMENTS_H
#define CB_ELEMENTS_H

#include <stdatomic.h>

#include "kernels/arithmetic.h"
#include "kernels/kernel.h"
#include "kernels/packs.h"
#include "kernels/pattern.h"

/* Which strain-displacement matrix. Every one is a choice of gradients w_j of
 * the shape functions, here already scaled by sqrt(c mu W), W = share |V0|:
 * then c K du = [k tr(H) I + H + H^T] w_j, H = sum du_j (x) w_j, k = lambda/mu,
 * and f = -(stress/mu) w_j sqrt(mu W / c). For an orthotropic material mu is
 * its G_xy and the bracket is D : sym(H) / mu. */
enum cb_policy {
  POLICY_PRECOMPUTED,    /* w_j = R grad0_j: rest gradients, turned */
  POLICY_UPDATED,        /* w_j = cofactors of the current edges / (6 V0) */
  POLICY_UPDATED_VOLUME, /* w_j = cofactors of the current edges / (6 V) */
  POLICY_LAZY            /* updated in the frame's axes when the stretch has moved, else kept
                            there; stored as POLICY_UPDATED is */
};

/* In which axes an element keeps its rest shape. */
enum cb_axes {
  AXES_WORLD,
  AXES_EDGES, /* Gram-Schmidt frame of the rest edges (qr) */
  AXES_POLAR  /* polar factor of the matrix of rest edges (polar-edges) */
};

/* Numbers of one element's rest data, in this order. */
enum {
  REST_G = 0,      /* 9: rows grad0 of N_b, N_c, N_d in rest axes; 1/m, or scaled
                      by sqrt(c mu W) for POLICY_PRECOMPUTED */
  REST_EDGE = 9,   /* scale of the edges: precomputed 1/sqrt(c mu W), so that
                      F = sum (REST_EDGE e_j) (x) REST_G_j */
  REST_W = 9,      /* in the same place, updated: sqrt(c mu W)/|6 V0| (its root where
                      the edges are scaled instead); updated-volume: sqrt(c mu W) */
  REST_FORCE = 10, /* sqrt(mu W / c), with the sign of V0 for updated B */
  REST_ISOTROPIC = 11,
  REST_D = 11, /* 21: D/mu in rest axes, upper triangle by rows; orthotropic */
  REST_ORTHOTROPIC = 32
  /* ebe-paper with precomputed B appends B0 (12 numbers, or 9 for qr) */
};

/* Which turn of adding to the nodes a thread is in, and has ended the part of that
 * its successors wait for; see kernels/packs.h. */
struct cb_turn {
  _Alignas(64) atomic_size_t done;
  size_t begun;
};

struct cb_elements {
  size_t nodes, tets;
  int policy, axes;
  struct cb_packs *packs;
  struct cb_turn *turn; /* [threads] */
  struct cb_team *team; /* not owned */
  S *X;                 /* rest positions, a node vector; rest data come from it ... */
  T *rest;              /* ... or are kept, [slots][rest_numbers]; else NULL */
  T *memory;            /* [slots][memory_numbers], zero = cold */
  T *state;             /* [slots][state_numbers] */
  size_t rest_numbers, memory_numbers, state_numbers;
  size_t bytes;                    /* of every array here but X and x */
  size_t kept_bytes;               /* of rest, memory and state */
  T k;                             /* lambda/mu = 2 nu/(1 - 2 nu) */
  T root, inverse_root, inverse_c; /* of c mu share / 6; of c: for rest data made of X */
  size_t frame_iterations;         /* struct cb_tuning */
  T frame_tolerance, lazy;
  S *x; /* ebe-recompute: positions of the last update, a node vector */
  /* assembled storages */
  struct cb_pattern *pattern;
  S *values; /* numbers of c K: [blocks][9], or (csr) rows of numbers */
  S *beyond; /* bcsr-symmetric: what threads add to rows of others, node vectors */
  uint32_t *scalar_row, *scalar_column; /* csr: [3 nodes + 1], [9 blocks] into node vectors */
  bool assembled;                       /* values are there (constant operators keep them) */
  /* node-warp */
  S *node_frame; /* [nodes][9] */
  S *node_sum;   /* [nodes][9] */
};

/* From so many bytes that are kept on, which is beyond a core's second cache and its share of
 * the third, updates and products ask for them ahead of time: it takes 4 % of the time where
 * they are near, and 20 % off where they are not. */
enum { UPDATE_FETCHES = 2000000, PRODUCT_FETCHES = 8000000 };

/* Are gradients and edges in the vertices' own order? */
INLINE bool in_own_order(const struct cb_elements *E) { return !E->packs->order; }
#endif
