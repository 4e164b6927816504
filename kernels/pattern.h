/* pattern.h - the sparsity of an assembled stiffness matrix: 3x3 blocks by rows,
 * and, for each edge of the mesh, the elements whose shares make its block. A block
 * above the diagonal is summed there, where it is stored; the one below is its
 * transpose. So rows are filled by whoever owns them. Made once per mesh.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PATTERN_H
#define CB_PATTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/packs.h"

/* The six edges of a tetrahedron (a, b, c, d) = (0, 1, 2, 3). */
static const uint8_t cb_tet_edge[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

/* The rows of one thread: about as many blocks as any other's. */
struct cb_rows {
  size_t first, last; /* rows [first, last) */
  size_t reach;       /* their columns end before; at least last */
  size_t beyond;      /* where its rows [last, reach) begin in a list of all threads' */
};

/* Every list ends with so many zeros more, so that loops may look ahead. */
enum { CB_PATTERN_AHEAD = 128 };

struct cb_pattern {
  size_t nodes, edges, blocks; /* blocks = nodes + 2 edges; symmetric: nodes + edges */
  bool symmetric;              /* only the diagonal and what is above it */
  uint32_t *row_start;         /* [nodes+1] first block of a block row */
  uint32_t *column;            /* [blocks] ascending in each row */
  uint32_t *edge_start;        /* [nodes+1] edges of which a node is the low end; they
                                  are in the order of the blocks above the diagonal */
  uint32_t *lower_start;       /* [nodes+1] ... the high end; into mirror */
  uint32_t *mirror;            /* [edges] the block above the diagonal whose transpose
                                  is below it, in the order of columns of each row */
  uint32_t *term_start;        /* [edges+1] */
  uint32_t *term;              /* [6 tets][2] an edge's elements, each by two of its
                                  vertices, of the low and of the high node; vertex j of
                                  pack p's lane l is stride * (4 * (p * lanes + l) + j) */
  size_t threads, beyond;      /* all rows beyond threads' own */
  struct cb_rows *rows;        /* [threads] */
  size_t bytes;
};

/* The diagonal block of a row. */
static inline uint32_t cb_pattern_diagonal(const struct cb_pattern *p, size_t row) {
  return p->row_start[row + 1] - 1 - (p->edge_start[row + 1] - p->edge_start[row]);
}

/* packs: of single tetrahedra; stride: numbers that are kept of a vertex, at most 4.
 * CB_MEMORY; CB_INPUT when the numbers of the blocks or of the elements' vertices do
 * not fit 32 bits. */
enum cb_status cb_pattern_create(const struct cb_mesh *mesh, const struct cb_packs *packs,
                                 size_t stride, bool symmetric, struct cb_pattern **out);
void cb_pattern_free(struct cb_pattern *p); /* NULL is allowed */

#endif
