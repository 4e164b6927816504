/* block_system.h - random symmetric block systems for the tests of reference/:
 * springs along the edges of a grid of nodes, each with some resistance across,
 * every node in skew axes of its own, so that off-diagonal blocks are not
 * symmetric and exactly three motions cost nothing.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_BLOCK_SYSTEM_H
#define CB_TESTS_BLOCK_SYSTEM_H

#include "tests/vectors.h"

#include <stdlib.h>

struct block_system {
  size_t nodes;
  uint32_t *row_start, *column;
  double *blocks;
};

static inline void block_system_free(struct block_system *s) {
  free(s->row_start);
  free(s->column);
  free(s->blocks);
}

/* k (d d^T + I/10), d the unit vector of a random direction */
static inline void random_spring(gsl_rng *rng, double block[9]) {
  double d[3], k = exp(3 * gsl_rng_uniform(rng)), length = 0;
  for (int i = 0; i < 3; i++) {
    d[i] = gsl_rng_uniform(rng) - 0.5;
    length += d[i] * d[i];
  }
  for (int i = 0; i < 9; i++) block[i] = k * (d[i / 3] * d[i % 3] / length + (i % 4 == 0) * 0.1);
}

/* C := A^T B */
static inline void multiply_transposed(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

/* Of K_ii = sum of P^T S P: symmetric to the last bit. */
static inline void add_diagonal(const double spring[9], const double axes[9], double block[9]) {
  double SP[9], PSP[9];
  multiply_transposed(spring, axes, SP);
  multiply_transposed(axes, SP, PSP);
  for (int e = 0; e < 9; e++) block[e] += (PSP[e] + PSP[3 * (e % 3) + e / 3]) / 2;
}

/* nodes = n^3; neighbours share an edge or a diagonal of a grid's cells. */
static inline struct block_system block_system_new(gsl_rng *rng, int n) {
  size_t nodes = (size_t)(n * n * n);
  struct block_system s = {nodes, calloc(nodes + 1, sizeof(uint32_t)),
                           calloc(27 * nodes, sizeof(uint32_t)),
                           calloc(9 * 27 * nodes, sizeof(double))};
  uint32_t *diagonal = calloc(nodes, sizeof *diagonal), count = 0;
  double *axes = calloc(9 * nodes, sizeof *axes);
  assert_true(s.row_start && s.column && s.blocks && diagonal && axes);
  for (size_t i = 0; i < 9 * nodes; i++)
    axes[i] = (i % 9 % 4 == 0) + 0.4 * (gsl_rng_uniform(rng) - 0.5);
  for (int i = 0; i < (int)nodes; i++) {
    for (int k = 0; k < 27; k++) {
      int x = i % n + k % 3 - 1, y = i / n % n + k / 3 % 3 - 1, z = i / n / n + k / 9 - 1;
      if (x < 0 || y < 0 || z < 0 || x >= n || y >= n || z >= n) continue;
      if (k == 13) diagonal[i] = count;
      s.column[count++] = (uint32_t)(x + n * (y + n * z));
    }
    s.row_start[i + 1] = count;
  }
  for (uint32_t i = 0; i < nodes; i++) {
    for (uint32_t k = s.row_start[i]; k < s.row_start[i + 1]; k++) {
      uint32_t j = s.column[k], back = s.row_start[j];
      double spring[9], SP[9], block[9];
      if (j <= i) continue;
      while (s.column[back] != i) back++;
      random_spring(rng, spring);
      add_diagonal(spring, axes + 9 * i, s.blocks + 9 * diagonal[i]);
      add_diagonal(spring, axes + 9 * j, s.blocks + 9 * diagonal[j]);
      multiply_transposed(spring, axes + 9 * j, SP);
      multiply_transposed(axes + 9 * i, SP, block);
      for (int e = 0; e < 9; e++) {
        s.blocks[9 * k + e] = -block[e];
        s.blocks[9 * back + 3 * (e % 3) + e / 3] = -block[e];
      }
    }
  }
  free(axes);
  free(diagonal);
  return s;
}

/* Row-major [3 nodes][3 nodes]; fixed (or NULL): identity rows and columns;
 * diagonal (or NULL): added per node. To be freed. */
static inline double *block_system_dense(const struct block_system *s, const uint8_t *fixed,
                                         const double *diagonal) {
  size_t n = 3 * s->nodes;
  double *A = calloc(n * n, sizeof *A);
  assert_non_null(A);
  for (size_t i = 0; i < n; i++) {
    for (uint32_t k = s->row_start[i / 3]; k < s->row_start[i / 3 + 1]; k++)
      for (size_t c = 0; c < 3; c++)
        if (!fixed || (!fixed[i / 3] && !fixed[s->column[k]]))
          A[i * n + 3 * s->column[k] + c] = s->blocks[9 * k + 3 * (i % 3) + c];
    A[i * n + i] = fixed && fixed[i / 3] ? 1 : A[i * n + i] + (diagonal ? diagonal[i / 3] : 0);
  }
  return A;
}

#endif
