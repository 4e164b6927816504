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
struct place {
  S *first;
  size_t step, row_step;
};

INLINE struct place row_at(const struct cb_elements *E, size_t row) {
  const size_t start = E->pattern->row_start[row];
  const size_t blocks = E->pattern->row_start[row + 1] - start;
  const bool scalar = E->scalar_row;
  return (struct place){E->values + 9 * start, scalar ? 3 : 9, scalar ? 3 * blocks : 3};
}

/* Sum of the elements' w_low w_high^T at one edge, expanded. */
INLINE struct block sum_gradients(const struct cb_elements *E, size_t edge) {
  const struct cb_pattern *p = E->pattern;
  const S *w = (const S *)E->state;
  struct block X = {0};
  for (size_t n = p->term_start[edge]; n < p->term_start[edge + 1]; n++) {
    const size_t low = p->term[n] / 4, high = p->term[n] / 16 * 4 + p->term[n] % 4;
    block_add_product(&X, w + STRIDE * low, w + STRIDE * high);
  }
  return block_from_products(LANE(E->k, 0), &X);
}

/* Sum of the elements' blocks at one edge, turned where their low vertex is the
 * higher one. */
INLINE struct block sum_blocks(const struct cb_elements *E, size_t edge) {
  static const uint8_t edge_of[16] = {0, 0, 1, 2, 0, 0, 3, 4, 1, 3, 0, 5, 2, 4, 5, 0};
  const struct cb_pattern *p = E->pattern;
  S sum[9 + BLOCK_MARGIN] = {0};
  for (size_t n = p->term_start[edge]; n < p->term_start[edge + 1]; n++) {
    const size_t element = p->term[n] / 16, ends = p->term[n] % 16;
    const size_t down = ends / 4 < ends % 4 ? 3 : 1, across = 4 - down;
    const S *X = (const S *)(E->state + element / LANES * E->state_numbers + 9 * edge_of[ends]) +
                 element % LANES;
    for (size_t i = 0; i < 9; i++) sum[i] += X[LANES * (i / 3 * down + i % 3 * across)];
  }
  return block_load(sum, 3);
}

/* Blocks above the diagonal; minus their sum goes to the diagonal. */
INLINE void fill_upper(const struct cb_elements *E, size_t row, bool gradients) {
  const struct cb_pattern *p = E->pattern;
  const struct place own = row_at(E, row);
  S *diagonal = own.first + own.step * (cb_pattern_diagonal(p, row) - p->row_start[row]);
  S *at = diagonal + own.step;
  struct block rest = {0};
  for (size_t e = p->edge_start[row]; e < p->edge_start[row + 1]; e++, at += own.step) {
    const struct block K = gradients ? sum_gradients(E, e) : sum_blocks(E, e);
    block_store(&K, at, own.row_step);
    block_subtract(&rest, &K);
  }
  block_store(&rest, diagonal, own.row_step);
}

/* The block above the diagonal whose transpose is the n-th of that column's rows. */
INLINE struct block mirror_block(const struct cb_elements *E, size_t n, size_t column) {
  const size_t slot = E->pattern->mirror[n];
  if (!E->scalar_row) return block_load(E->values + 9 * slot, 3);
  const struct place other = row_at(E, column);
  return block_load(other.first + 3 * (slot - E->pattern->row_start[column]), other.row_step);
}

/* Blocks below the diagonal, if they are kept, and what they leave for it. */
INLINE void fill_lower(const struct cb_elements *E, size_t row) {
  const struct cb_pattern *p = E->pattern;
  const struct place own = row_at(E, row);
  S *at = own.first;
  struct block rest = {0};
  for (size_t n = p->lower_start[row]; n < p->lower_start[row + 1]; n++) {
    const size_t k = n - p->lower_start[row];
    const struct block upper =
        mirror_block(E, n, p->symmetric ? 0 : p->column[p->row_start[row] + k]);
    block_subtract(&rest, &upper);
    if (p->symmetric) continue;
    const struct block K = block_transposed(&upper);
    block_store(&K, at, own.row_step);
    at += own.step;
  }
  struct block K = block_load(at, own.row_step); /* the diagonal follows */
  rest = block_transposed(&rest);
  block_add(&K, &rest);
  block_store(&K, at, own.row_step);
}

void CB_NAME(cb_assemble)(struct cb_elements *E, size_t thread, bool gradients) {
  const struct cb_rows *own = &E->pattern->rows[thread];
  STAGE(STAGE_ASSEMBLY);
  if (gradients)
    for (size_t i = own->first; i < own->last; i++) fill_upper(E, i, true);
  else
    for (size_t i = own->first; i < own->last; i++) fill_upper(E, i, false);
  cb_team_barrier(E->team);
  for (size_t i = own->first; i < own->last; i++) fill_lower(E, i);
}
