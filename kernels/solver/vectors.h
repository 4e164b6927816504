/* vectors.h - passes over node vectors, one thread's share at a time, and sums in
 * double, for float too. A vector is handled in blocks: LANES scalars of several
 * nodes, or the three of one node where there are no lanes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SOLVER_VECTORS_H
#define CB_SOLVER_VECTORS_H

#include "kernels/arithmetic.h"
#include "kernels/team.h"

enum { BLOCK_TS = LANES == 1 ? 3 : 1, BLOCK_SCALARS = BLOCK_TS * LANES };

INLINE size_t blocks_of(size_t nodes) {
  return (STRIDE * nodes + BLOCK_SCALARS - 1) / BLOCK_SCALARS;
}

/* Numbers of T [first, last) of padded vectors that are thread's. */
struct share {
  size_t first, last;
};
INLINE struct share share_of(size_t nodes, size_t threads, size_t thread) {
  struct share s;
  cb_team_share(blocks_of(nodes), threads, thread, &s.first, &s.last);
  s.first *= BLOCK_TS, s.last *= BLOCK_TS;
  return s;
}
/* The same in scalars of a vector without padding. */
INLINE struct share scalars_of(size_t nodes, struct share s) {
  const size_t length = STRIDE * nodes;
  s.first *= LANES, s.last *= LANES;
  if (s.last > length) s.last = length;
  if (s.first > length) s.first = length;
  return s;
}

/* Products of T summed in ACC: in several sums, which do not wait for each other. */
#if CB_LANES == 1
enum { SUM_PARTS = 3 };
typedef ACC PART;
#define PART_OF(t, n) ((ACC)(t))
#elif CB_IS(float)
enum { SUM_PARTS = 2 };
typedef ACC PART __attribute__((vector_size(sizeof(ACC) * CB_LANES / 2)));
#if CB_LANES == 8
#define HALF(t, n) __builtin_shufflevector(t, t, 4 * n, 4 * n + 1, 4 * n + 2, 4 * n + 3)
#else
#define HALF(t, n)                                                                                 \
  __builtin_shufflevector(t, t, 8 * n, 8 * n + 1, 8 * n + 2, 8 * n + 3, 8 * n + 4, 8 * n + 5,      \
                          8 * n + 6, 8 * n + 7)
#endif
#if CB_BYTES == 64 && defined __AVX512F__ /* gcc 12 would convert by quarters */
#define PART_OF(t, n) (PART) _mm512_cvtps_pd((__m256)HALF(t, n))
#else
#define PART_OF(t, n) __builtin_convertvector(HALF(t, n), PART)
#endif
#else
enum { SUM_PARTS = 1 };
typedef T PART;
#define PART_OF(t, n) (t)
#endif

struct sum {
  PART part[SUM_PARTS];
};

/* n: which number of its block (no lanes), else 0. */
INLINE void sum_product(struct sum *s, size_t n, T a, T b) {
#if CB_LANES == 1
  s->part[n % SUM_PARTS] += PART_OF(a, 0) * PART_OF(b, 0);
#else
  (void)n;
  s->part[0] += PART_OF(a, 0) * PART_OF(b, 0);
#if CB_IS(float)
  s->part[1] += PART_OF(a, 1) * PART_OF(b, 1);
#endif
#endif
}

INLINE ACC sum_total(const struct sum *s) {
  ACC numbers[sizeof *s / sizeof(ACC)], total = 0;
  __builtin_memcpy(numbers, s, sizeof *s);
  for (size_t i = 0; i < sizeof *s / sizeof(ACC); i++) total += numbers[i];
  return total;
}

#endif
