/* direct.h - the implicit step system solved directly: sparse supernodal
 * Cholesky, analysed once, refactored with new numbers at every step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_DIRECT_H
#define CB_DIRECT_H

#include "kernels/kernel.h"

struct cb_direct;

/* Analyse A = diag(m_i I3) + K with the unknowns of fixed nodes removed.
 * in   row_start[nodes+1], column[]  3x3 block pattern (cb_operator_pattern):
 *        symmetric, diagonal blocks present, columns ascending in each row;
 *        not checked. It may go away afterwards.
 *      fixed[nodes]  nonzero: that node does not move (NULL: none). A node that
 *        no element uses and that has no mass must be fixed.
 * out  *out        to be freed with cb_direct_free
 * CB_MEMORY. */
enum cb_status cb_direct_create(size_t nodes, const uint32_t *row_start, const uint32_t *column,
                                const uint8_t *fixed, struct cb_direct **out);
void cb_direct_free(struct cb_direct *d); /* NULL allowed */

/* Factor with new numbers.
 * in   blocks[9*count]  K block by block in the pattern's order, row-major;
 *        only the blocks with column >= row and, of the diagonal blocks, the
 *        upper triangle are read: symmetry is not checked
 *      diagonal[nodes]  m_i, added to the three diagonal entries of node i, in
 *        the unit of K (NULL: 0)
 * CB_MEMORY; CB_NUMERIC when A is not positive definite to rounding (or holds
 * NaN). After either there is no factor until a later call succeeds. */
enum cb_status cb_direct_factor(struct cb_direct *d, const double *blocks, const double *diagonal);

/* x := A^-1 b with one step of iterative refinement; exactly 0 at fixed nodes,
 * whose b is ignored. b[3*nodes], x[3*nodes]; x may be b. The first solve
 * allocates its work vectors, the later ones nothing. CB_MEMORY; CB_NUMERIC
 * without a factor; x is untouched then. */
enum cb_status cb_direct_solve(struct cb_direct *d, const double *b, double *x);

/* Bytes allocated now: matrix, factor, map, work vectors. */
size_t cb_direct_bytes(const struct cb_direct *d);

#endif
