/* assembly.c - the values of csr, bcsr and bcsr-symmetric from what the elements
 * kept. Every thread fills its own rows: blocks above the diagonal from the sums
 * of their edges; then, when all are there, those below from their transposes,
 * and the diagonal, minus the sum of the row.
 * Trade:  no element writes to a block, so none has to wait for another.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/block.h"
#include "kernels/storage/blocks.h"

/* Where the blocks of a row are: the first of them, how far they are apart, and how
 * far a block's rows are. */
struct block_row {
  S *first;
  size_t step, row_step;
};

INLINE struct block_row row_at(const struct cb_elements *E, bool scalar, size_t row) {
  const size_t start = E->pattern->row_start[row];
  if (!scalar) return (struct block_row){E->values + 9 * start, 9, 3};
  return (struct block_row){E->values + 9 * start, 3, 3 * (E->pattern->row_start[row + 1] - start)};
}

/* What is far is asked for so many terms, or blocks, before it is needed: elements are not in
 * the order of the edges, so that no processor foresees it. */
enum { TERMS_AHEAD = CB_PATTERN_AHEAD / 2, BLOCKS_AHEAD = 16 };

/* Sum of the elements' w_low w_high^T at one edge, expanded. */
INLINE struct block sum_gradients(const struct cb_elements *E, size_t edge, bool far) {
  const struct cb_pattern *p = E->pattern;
  const S *w = (const S *)E->state;
  struct block X = {0};
  for (size_t n = p->term_start[edge]; n < p->term_start[edge + 1]; n++) {
    const uint32_t *term = p->term + 2 * n, *later = term + 2 * TERMS_AHEAD;
    if (far) __builtin_prefetch(w + later[0]);
    if (far && 4 * STRIDE * sizeof(S) > 64) __builtin_prefetch(w + later[1]); /* another line */
    block_add_product(&X, w + term[0], w + term[1]);
  }
  return block_from_products(LANE(E->k, 0), &X);
}

/* Sum of the elements' blocks at one edge, turned where their low vertex is the
 * higher one. */
INLINE struct block sum_blocks(const struct cb_elements *E, size_t edge) {
  static const uint8_t edge_of[4][4] = {{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}};
  const struct cb_pattern *p = E->pattern;
  S sum[9 + BLOCK_MARGIN] = {0};
  for (size_t n = p->term_start[edge]; n < p->term_start[edge + 1]; n++) {
    const size_t element = p->term[2 * n] / (4 * STRIDE);
    const size_t low = p->term[2 * n] / STRIDE % 4, high = p->term[2 * n + 1] / STRIDE % 4;
    const size_t down = low < high ? 3 : 1, across = 4 - down;
    const S *X =
        (const S *)(E->state + element / LANES * E->state_numbers + 9 * edge_of[low][high]) +
        element % LANES;
    for (size_t i = 0; i < 9; i++) sum[i] += X[LANES * (i / 3 * down + i % 3 * across)];
  }
  return block_load(sum, 3);
}

/* Blocks above the diagonal; minus their sum goes to the diagonal. */
INLINE void fill_upper(const struct cb_elements *E, bool scalar, bool gradients, bool far,
                       size_t row) {
  const struct cb_pattern *p = E->pattern;
  const struct block_row own = row_at(E, scalar, row);
  S *diagonal = own.first + own.step * (cb_pattern_diagonal(p, row) - p->row_start[row]);
  S *at = diagonal + own.step;
  struct block rest = {0};
  for (size_t e = p->edge_start[row]; e < p->edge_start[row + 1]; e++, at += own.step) {
    const struct block K = gradients ? sum_gradients(E, e, far) : sum_blocks(E, e);
    block_store(&K, at, own.row_step);
    block_subtract(&rest, &K);
  }
  block_store(&rest, diagonal, own.row_step);
}

/* The block above the diagonal whose transpose is the n-th of that column's rows. */
INLINE struct block mirror_block(const struct cb_elements *E, bool scalar, size_t n,
                                 const uint32_t *column) {
  const size_t slot = E->pattern->mirror[n];
  if (!scalar) return block_load(E->values + 9 * slot, 3);
  const struct block_row other = row_at(E, true, *column);
  return block_load(other.first + 3 * (slot - E->pattern->row_start[*column]), other.row_step);
}

/* Blocks below the diagonal, if they are kept, and what they leave for it. */
INLINE void fill_lower(const struct cb_elements *E, bool scalar, bool symmetric, bool far,
                       size_t row) {
  const struct cb_pattern *p = E->pattern;
  const struct block_row own = row_at(E, scalar, row);
  const uint32_t *column = p->column + p->row_start[row];
  S *at = own.first;
  struct block rest = {0};
  for (size_t n = p->lower_start[row]; n < p->lower_start[row + 1]; n++, column++) {
    if (far && !scalar) __builtin_prefetch(E->values + 9 * (size_t)p->mirror[n + BLOCKS_AHEAD]);
    const struct block upper = mirror_block(E, scalar, n, column);
    block_subtract(&rest, &upper);
    if (symmetric) continue;
    const struct block K = block_transposed(&upper);
    block_store(&K, at, own.row_step);
    at += own.step;
  }
  struct block K = block_load(at, own.row_step); /* the diagonal follows */
  rest = block_transposed(&rest);
  block_add(&K, &rest);
  block_store(&K, at, own.row_step);
}

INLINE void fill_rows(const struct cb_elements *E, size_t thread, bool scalar, bool symmetric,
                      bool gradients, bool far) {
  const struct cb_rows *own = &E->pattern->rows[thread];
  for (size_t i = own->first; i < own->last; i++) fill_upper(E, scalar, gradients, far, i);
  cb_team_barrier(E->team, thread);
  for (size_t i = own->first; i < own->last; i++) fill_lower(E, scalar, symmetric, far, i);
}

void CB_NAME(cb_assemble)(struct cb_elements *E, size_t thread, bool gradients) {
  const bool scalar = E->scalar_row, symmetric = E->pattern->symmetric;
  const bool far = E->kept_bytes >= UPDATE_FETCHES;
  STAGE(STAGE_ASSEMBLY);
#define FILL(scalar, symmetric)                                                                    \
  !gradients ? fill_rows(E, thread, scalar, symmetric, false, false)                               \
  : far      ? fill_rows(E, thread, scalar, symmetric, true, true)                                 \
             : fill_rows(E, thread, scalar, symmetric, true, false)
  if (scalar)
    FILL(true, false);
  else if (symmetric)
    FILL(false, true);
  else
    FILL(false, false);
#undef FILL
}
