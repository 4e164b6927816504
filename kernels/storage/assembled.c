/* assembled.c - from edge sums to csr or bcsr numbers, and their products.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/storage/blocks.h"
#include "kernels/storage/products.h"
#include "kernels/team.h"

/* Block (row, slot) of the values: its nine numbers go to first[r*step + c]. */
static S *block_at(const struct cb_elements *E, bool blocked, uint32_t row, uint32_t slot,
                   size_t *step) {
  const struct cb_pattern *p = E->pattern;
  uint32_t start = p->row_start[row];
  *step = blocked ? 3 : 3 * (size_t)(p->row_start[row + 1] - start);
  return blocked ? E->values + 9 * (size_t)slot
                 : E->values + 9 * (size_t)start + 3 * (size_t)(slot - start);
}

void CB_NAME(cb_assemble)(struct cb_elements *E, size_t thread, bool products) {
  if (thread != 0) return; /* replaced in the next commit */
  const struct cb_pattern *p = E->pattern;
  const bool blocked = !E->scalar_row;
  STAGE(STAGE_ASSEMBLY);
  for (size_t i = 0; i < 9 * p->blocks; i++) E->values[i] = (S)0;
#if CB_LANES == 1
  const S k = E->k;
#else
  const S k = E->k[0];
#endif
  for (size_t e = 0; e < p->edges; e++) {
    const S *X = E->edge_sum + 9 * e;
    S K[9];
    if (products)
      BLOCK_FROM_PRODUCT(k, X, K);
    else
      for (int i = 0; i < 9; i++) K[i] = X[i];
    size_t su, sl, si, sj;
    S *upper = block_at(E, blocked, p->low[e], p->upper[e], &su);
    S *lower = block_at(E, blocked, p->high[e], p->lower[e], &sl);
    S *low = block_at(E, blocked, p->low[e], p->diagonal[p->low[e]], &si);
    S *high = block_at(E, blocked, p->high[e], p->diagonal[p->high[e]], &sj);
    for (size_t r = 0; r < 3; r++)
      for (size_t c = 0; c < 3; c++) {
        upper[r * su + c] = K[3 * r + c];
        lower[r * sl + c] = K[3 * c + r];
        low[r * si + c] -= K[3 * r + c];
        high[r * sj + c] -= K[3 * c + r];
      }
  }
}

void CB_NAME(cb_product_bcsr)(const struct cb_elements *E, size_t thread, const void *vector,
                              void *result) {
  const struct cb_pattern *p = E->pattern;
  const S *restrict u = vector, *restrict K = E->values;
  S *restrict y = result;
  STAGE(STAGE_PRODUCT);
  size_t first, last;
  cb_team_share(p->nodes, E->packs->threads, thread, &first, &last);
  for (size_t i = first; i < last; i++) {
    S a = 0, b = 0, c = 0;
    for (size_t n = p->row_start[i]; n < p->row_start[i + 1]; n++) {
      const S *B = K + 9 * n, *q = u + STRIDE * (size_t)p->column[n];
      a += B[0] * q[0] + B[1] * q[1] + B[2] * q[2];
      b += B[3] * q[0] + B[4] * q[1] + B[5] * q[2];
      c += B[6] * q[0] + B[7] * q[1] + B[8] * q[2];
    }
    S *out = y + STRIDE * i;
    out[0] += a, out[1] += b, out[2] += c;
  }
}

/* Scalar rows: each number has a column index of its own, as in textbook csr. */
void CB_NAME(cb_product_csr)(const struct cb_elements *E, size_t thread, const void *vector,
                             void *result) {
  const struct cb_pattern *p = E->pattern;
  const S *restrict u = vector, *restrict K = E->values;
  const uint32_t *restrict row = E->scalar_row, *restrict column = E->scalar_column;
  S *restrict y = result;
  STAGE(STAGE_PRODUCT);
  size_t first, last;
  cb_team_share(p->nodes, E->packs->threads, thread, &first, &last);
  for (size_t i = 3 * first; i < 3 * last; i++) {
    S sum = 0;
    for (size_t n = row[i]; n < row[i + 1]; n++) sum += K[n] * u[column[n]];
    y[STRIDE * (i / 3) + i % 3] += sum;
  }
}
