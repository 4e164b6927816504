/* assembled.c - products with assembled matrices, one thread's rows. Blocks are
 * row-major everywhere: three rows times a whole node, their sums added up last.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/block.h"
#include "kernels/storage/blocks.h"
#include "kernels/storage/products.h"
#include "kernels/team.h"

#if CB_LANES == 1
typedef struct {
  S at[3];
} ROW_SUM;

/* sum += K u */
INLINE void add_block(ROW_SUM *sum, const S *K, const S *u) {
  for (int r = 0; r < 3; r++)
    sum->at[r] += K[3 * r] * u[0] + K[3 * r + 1] * u[1] + K[3 * r + 2] * u[2];
}

INLINE void add_row(const ROW_SUM *sum, S *y) {
  for (int r = 0; r < 3; r++) y[r] += sum->at[r];
}

/* x, y and z of a node, each as often as a row has numbers. */
typedef struct {
  S at[3];
} SPREAD;

INLINE SPREAD spread_node(const S *u) { return (SPREAD){{u[0], u[1], u[2]}}; }

/* y += K^T u */
INLINE void add_transposed(const S *K, const SPREAD *u, S *y) {
  for (int c = 0; c < 3; c++) y[c] += K[c] * u->at[0] + K[3 + c] * u->at[1] + K[6 + c] * u->at[2];
}
#else
typedef struct block ROW_SUM;

INLINE void add_block(ROW_SUM *sum, const S *K, const S *u) {
  const NODE whole = node_load(u);
  for (int r = 0; r < 3; r++) sum->row[r] += node_load(K + 3 * r) * whole;
}

/* The fourth column, which is no part of the block, is left out. */
INLINE void add_row(const ROW_SUM *sum, S *y) {
  NODE t[3];
  block_columns(sum, node_splat(0), t);
  *(LOOSE_NODE *)y += t[0] + t[1] + t[2];
}

typedef struct block SPREAD;

INLINE SPREAD spread_node(const S *u) {
  return (SPREAD){{node_splat(u[0]), node_splat(u[1]), node_splat(u[2])}};
}

INLINE void add_transposed(const S *K, const SPREAD *u, S *y) {
  NODE sum = node_load(K) * u->row[0] + node_load(K + 3) * u->row[1] + node_load(K + 6) * u->row[2];
  sum[3] = 0;
  *(LOOSE_NODE *)y += sum;
}
#endif

/* What is far is asked for so many numbers before it is needed. */
enum { NUMBERS_AHEAD = 4096 / sizeof(S) };

INLINE void product_bcsr(const struct cb_elements *E, size_t thread, const void *vector,
                         void *result, bool far) {
  const struct cb_pattern *p = E->pattern;
  const struct cb_rows own = p->rows[thread];
  const S *restrict u = vector, *restrict K = E->values;
  const uint32_t *restrict row = p->row_start, *restrict column = p->column;
  S *restrict y = result;
  STAGE(STAGE_PRODUCT);
  for (size_t i = own.first; i < own.last; i++) {
    ROW_SUM sum = {0};
    for (size_t n = row[i], end = row[i + 1]; n < end; n++) {
      if (far) __builtin_prefetch(K + 9 * n + NUMBERS_AHEAD);
      add_block(&sum, K + 9 * n, u + STRIDE * (size_t)column[n]);
    }
    add_row(&sum, y + STRIDE * i);
  }
}

void CB_NAME(cb_product_bcsr)(const struct cb_elements *E, size_t thread, const void *vector,
                              void *result) {
  if (LANES > 1 && E->kept_bytes >= PRODUCT_FETCHES)
    product_bcsr(E, thread, vector, result, true);
  else
    product_bcsr(E, thread, vector, result, false);
}

/* y += what earlier threads' rows add to this one's. */
static void add_beyond(const struct cb_elements *E, size_t thread, S *y) {
  const struct cb_rows *own = &E->pattern->rows[thread];
  for (const struct cb_rows *r = E->pattern->rows; r < own; r++) {
    const size_t last = r->reach < own->last ? r->reach : own->last;
    for (size_t i = own->first; i < last; i++)
      for (size_t k = 0; k < STRIDE; k++)
        y[STRIDE * i + k] += E->beyond[STRIDE * (r->beyond + i - r->last) + k];
  }
}

/* What its rows add to other threads' is kept apart until all are there. */
INLINE void product_bcsr_symmetric(const struct cb_elements *E, size_t thread, const void *vector,
                                   void *result, bool far) {
  const struct cb_pattern *p = E->pattern;
  const struct cb_rows own = p->rows[thread];
  const S *restrict u = vector, *restrict K = E->values;
  const uint32_t *restrict row = p->row_start, *restrict column = p->column;
  S *y = result, *beyond = E->beyond + STRIDE * own.beyond;
  STAGE(STAGE_PRODUCT);
  for (size_t i = 0; i < STRIDE * (own.reach - own.last); i++) beyond[i] = 0;
  for (size_t i = own.first; i < own.last; i++) {
    const SPREAD spread = spread_node(u + STRIDE * i);
    const size_t end = row[i + 1];
    size_t n = row[i];
    ROW_SUM sum = {0};
    add_block(&sum, K + 9 * n, u + STRIDE * i);
    for (n++; n < end; n++) {
      const size_t j = column[n];
      if (far) __builtin_prefetch(K + 9 * n + NUMBERS_AHEAD);
      add_block(&sum, K + 9 * n, u + STRIDE * j);
      add_transposed(K + 9 * n, &spread,
                     j < own.last ? y + STRIDE * j : beyond + STRIDE * (j - own.last));
    }
    add_row(&sum, y + STRIDE * i);
  }
  if (p->threads == 1) return;
  cb_team_barrier(E->team, thread);
  add_beyond(E, thread, y);
}

void CB_NAME(cb_product_bcsr_symmetric)(const struct cb_elements *E, size_t thread,
                                        const void *vector, void *result) {
  if (LANES > 1 && E->kept_bytes >= PRODUCT_FETCHES)
    product_bcsr_symmetric(E, thread, vector, result, true);
  else
    product_bcsr_symmetric(E, thread, vector, result, false);
}

/* Scalar rows: each number has a column index of its own, as in textbook csr. */
void CB_NAME(cb_product_csr)(const struct cb_elements *E, size_t thread, const void *vector,
                             void *result) {
  const struct cb_pattern *p = E->pattern;
  const S *restrict u = vector, *restrict K = E->values;
  const uint32_t *restrict row = E->scalar_row, *restrict column = E->scalar_column;
  S *restrict y = result;
  STAGE(STAGE_PRODUCT);
  const struct cb_rows *own = &p->rows[thread];
  for (size_t i = 3 * own->first; i < 3 * own->last; i++) {
    S sum = 0;
    for (size_t n = row[i]; n < row[i + 1]; n++) sum += K[n] * u[column[n]];
    y[STRIDE * (i / 3) + i % 3] += sum;
  }
}
