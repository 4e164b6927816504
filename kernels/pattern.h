/* pattern.h - the sparsity of an assembled stiffness matrix: 3x3 blocks by
 * rows, and the map from an element's six edges to them. Made once per mesh.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PATTERN_H
#define CB_PATTERN_H

#include <stddef.h>
#include <stdint.h>

#include "kernels/packs.h"

/* The six edges of a tetrahedron (a, b, c, d) = (0, 1, 2, 3). */
static const uint8_t cb_tet_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

struct cb_pattern {
  size_t nodes, edges, blocks; /* blocks = nodes + 2 edges */
  uint32_t *row_start;         /* [nodes+1] first block of a block row */
  uint32_t *column;            /* [blocks] ascending in each row */
  uint32_t *diagonal;          /* [nodes] block (i, i) */
  uint32_t *upper, *lower;     /* [edges] blocks (lo, hi) and (hi, lo) */
  uint32_t *low, *high;        /* [edges] end nodes, low < high */
  uint32_t *edge_of;           /* [packs][6][lanes] 2*edge + (1 if its low node
                                  is the second of cb_tet_edge) */
  size_t bytes;
};

/* packs: of single tetrahedra. CB_MEMORY; CB_INPUT when the blocks do not fit 32
 * bits. */
enum cb_status cb_pattern_create(const struct cb_mesh *mesh, const struct cb_packs *packs,
                                 struct cb_pattern **out);
void cb_pattern_free(struct cb_pattern *p);

#endif
