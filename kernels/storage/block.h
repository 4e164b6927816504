/* block.h - one 3x3 block of an assembled matrix in registers: three rows, each
 * a whole node (lanes), or nine numbers. What is in a fourth column is undefined.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STORAGE_BLOCK_H
#define CB_STORAGE_BLOCK_H

#include "kernels/storage/blocks.h"

/* Rows are read four numbers at a time: so many are read after the last block. */
enum { BLOCK_MARGIN = 1 };

#if CB_LANES == 1
struct block {
  S at[9];
};

/* Rows of three numbers, `step` apart. */
INLINE struct block block_load(const S *first, size_t step) {
  struct block b;
  for (size_t i = 0; i < 9; i++) b.at[i] = first[i / 3 * step + i % 3];
  return b;
}

INLINE void block_store(const struct block *b, S *first, size_t step) {
  for (size_t i = 0; i < 9; i++) first[i / 3 * step + i % 3] = b->at[i];
}

INLINE void block_subtract(struct block *b, const struct block *a) {
  for (int i = 0; i < 9; i++) b->at[i] -= a->at[i];
}

INLINE void block_add(struct block *b, const struct block *a) {
  for (int i = 0; i < 9; i++) b->at[i] += a->at[i];
}

INLINE struct block block_transposed(const struct block *b) {
  struct block t;
  for (int i = 0; i < 9; i++) t.at[i] = b->at[i % 3 * 3 + i / 3];
  return t;
}

/* b += v w^T */
INLINE void block_add_product(struct block *b, const S *v, const S *w) {
  for (int i = 0; i < 9; i++) b->at[i] += v[i / 3] * w[i % 3];
}

/* k X + X^T + tr(X) I */
INLINE struct block block_from_products(S k, const struct block *X) {
  struct block b;
  BLOCK_FROM_PRODUCT(k, X->at, b.at);
  return b;
}
#else
struct block {
  NODE row[3];
};

INLINE NODE node_load(const S *at) { return *(const LOOSE_NODE *)at; }

INLINE NODE node_splat(S a) { return (NODE){a, a, a, a}; }

/* Not a number beyond the block is read: another thread may be writing it. */
INLINE struct block block_load(const S *first, size_t step) {
  struct block b;
  if (step == 3) {
    const NODE last = node_load(first + 5);
    b.row[0] = node_load(first), b.row[1] = node_load(first + 3);
    b.row[2] = __builtin_shufflevector(last, last, 1, 2, 3, 3);
  } else
    for (size_t r = 0; r < 3; r++)
      b.row[r] = (NODE){first[r * step], first[r * step + 1], first[r * step + 2], 0};
  return b;
}

INLINE void block_store(const struct block *b, S *first, size_t step) {
  for (size_t r = 0; r < 3; r++)
    if (step == 3 && r < 2) /* the fourth number is the next row's first */
      *(LOOSE_NODE *)(first + 3 * r) = b->row[r];
    else
      for (size_t c = 0; c < 3; c++) first[r * step + c] = b->row[r][c];
}

INLINE void block_subtract(struct block *b, const struct block *a) {
  for (int r = 0; r < 3; r++) b->row[r] -= a->row[r];
}

INLINE void block_add(struct block *b, const struct block *a) {
  for (int r = 0; r < 3; r++) b->row[r] += a->row[r];
}

/* t[3] := columns of b; their fourth numbers are those of `fourth`. */
INLINE void block_columns(const struct block *b, NODE fourth, NODE *t) {
  const NODE *r = b->row;
  NODE low = __builtin_shufflevector(r[0], r[1], 0, 4, 1, 5);
  NODE high = __builtin_shufflevector(r[0], r[1], 2, 6, 3, 7);
  NODE low2 = __builtin_shufflevector(r[2], fourth, 0, 4, 1, 5);
  NODE high2 = __builtin_shufflevector(r[2], fourth, 2, 6, 3, 7);
  t[0] = __builtin_shufflevector(low, low2, 0, 1, 4, 5);
  t[1] = __builtin_shufflevector(low, low2, 2, 3, 6, 7);
  t[2] = __builtin_shufflevector(high, high2, 0, 1, 4, 5);
}

INLINE struct block block_transposed(const struct block *b) {
  struct block t;
  block_columns(b, b->row[2], t.row);
  return t;
}

INLINE void block_add_product(struct block *b, const S *v, const S *w) {
  const NODE whole = node_load(w);
  for (int r = 0; r < 3; r++) b->row[r] += node_splat(v[r]) * whole;
}

INLINE struct block block_from_products(S k, const struct block *X) {
  const S trace = X->row[0][0] + X->row[1][1] + X->row[2][2];
  struct block b = block_transposed(X);
  for (int r = 0; r < 3; r++) {
    NODE unit = {r == 0, r == 1, r == 2, 0};
    b.row[r] = node_splat(k) * X->row[r] + b.row[r] + node_splat(trace) * unit;
  }
  return b;
}
#endif

#endif
