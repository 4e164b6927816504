/* lanes.h - node vectors to lanes and back: whole nodes (x y z 0) are loaded and
 * turned in registers, four at a time; results are added node by node, one lane
 * after another, so that lanes may share nodes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STORAGE_LANES_H
#define CB_STORAGE_LANES_H

#include "kernels/arithmetic.h"

/* Elements keep their nodes as places in a vector, in units that the processor can
 * scale an index by: no instruction is spent on that. */
enum { PLACE_BYTES = LANES == 1 ? sizeof(S) : 8, PLACES = STRIDE * sizeof(S) / PLACE_BYTES };
INLINE const S *node_at(const S *vector, uint32_t place) {
  return (const S *)((const char *)vector + PLACE_BYTES * (size_t)place);
}
INLINE size_t node_number(uint32_t place) { return place / PLACES; }

#if CB_LANES == 1
/* p[3] := x, y, z of the node at place[0]. */
INLINE void load_nodes(const S *vector, const uint32_t *place, T *p) {
  const S *node = node_at(vector, *place);
  for (int i = 0; i < 3; i++) p[i] = node[i];
}

/* vector += f[3] at the node at place[0]. */
INLINE void add_to_nodes(S *vector, const uint32_t *place, size_t live, const T *f) {
  S *node = (S *)node_at(vector, *place);
  (void)live;
  for (int i = 0; i < 3; i++) node[i] += f[i];
}
#else
enum { QUADS = LANES / 4 };
/* One node; aligned as a scalar only, as callers' vectors may be. */
typedef S NODE __attribute__((vector_size(4 * sizeof(S))));
typedef NODE LOOSE_NODE __attribute__((aligned(sizeof(S)), may_alias));

/* Four numbers of (a, b) in each quad of lanes: 0-3 are a's, 4-7 b's. */
#define QUAD_AT(q, i) ((i) < 4 ? 4 * (q) + (i) : LANES + 4 * (q) + (i)-4)
#define QUAD_OF(q, i, j, k, l) QUAD_AT(q, i), QUAD_AT(q, j), QUAD_AT(q, k), QUAD_AT(q, l)
#if CB_LANES == 4
#define SHUFFLE(a, b, i, j, k, l) __builtin_shufflevector(a, b, QUAD_OF(0, i, j, k, l))
#elif CB_LANES == 8
#define SHUFFLE(a, b, i, j, k, l)                                                                  \
  __builtin_shufflevector(a, b, QUAD_OF(0, i, j, k, l), QUAD_OF(1, i, j, k, l))
#elif CB_LANES == 16
#define SHUFFLE(a, b, i, j, k, l)                                                                  \
  __builtin_shufflevector(a, b, QUAD_OF(0, i, j, k, l), QUAD_OF(1, i, j, k, l),                    \
                          QUAD_OF(2, i, j, k, l), QUAD_OF(3, i, j, k, l))
#else
#error "lanes come in 4, 8 or 16"
#endif

/* One T of QUADS nodes side by side, and the q-th node of it. */
INLINE T join_nodes(const NODE *n) {
#if CB_LANES == 4
  return n[0];
#else
  typedef S PAIR __attribute__((vector_size(8 * sizeof(S))));
#if CB_LANES == 16 && defined __AVX512F__ /* gcc 12 would load all four apart */
  PAIR first = (PAIR)_mm256_insertf128_ps(_mm256_castps128_ps256((__m128)n[0]), (__m128)n[1], 1);
  PAIR second = (PAIR)_mm256_insertf128_ps(_mm256_castps128_ps256((__m128)n[2]), (__m128)n[3], 1);
  return (T)_mm512_insertf32x8(_mm512_castps256_ps512((__m256)first), (__m256)second, 1);
#else
  PAIR first = __builtin_shufflevector(n[0], n[1], 0, 1, 2, 3, 4, 5, 6, 7);
#if CB_LANES == 8
  return first;
#else
  PAIR second = __builtin_shufflevector(n[2], n[3], 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(first, second, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14,
                                 15);
#endif
#endif
#endif
}
#if CB_LANES == 4
#define NODE_OF(t, q) (t)
#elif CB_LANES == 16 && defined __AVX512F__ /* gcc 12 would shuffle all sixteen lanes for each */
#define HALF_OF(t, h)                                                                              \
  ((h) ? _mm512_extractf32x8_ps((__m512)(t), 1) : _mm512_castps512_ps256((__m512)(t)))
#define NODE_OF(t, q)                                                                              \
  ((NODE)((q) % 2 ? _mm256_extractf128_ps(HALF_OF(t, (q) / 2), 1)                                  \
                  : _mm256_castps256_ps128(HALF_OF(t, (q) / 2))))
#else
#define NODE_OF(t, q) __builtin_shufflevector(t, t, 4 * (q), 4 * (q) + 1, 4 * (q) + 2, 4 * (q) + 3)
#endif

/* p[3] := x, y, z of the nodes at place[LANES]. Floats are interleaved within 128
 * bits, doubles within 256: what the shuffle units do without crossing. */
INLINE void load_nodes(const S *vector, const uint32_t *place, T *p) {
  T g[4];
  for (int k = 0; k < 4; k++) {
    NODE n[QUADS];
    for (int q = 0; q < QUADS; q++) n[q] = *(const LOOSE_NODE *)node_at(vector, place[4 * q + k]);
    g[k] = join_nodes(n);
  }
  if (sizeof(S) == 4) {
    T low = SHUFFLE(g[0], g[1], 0, 4, 1, 5), high = SHUFFLE(g[0], g[1], 2, 6, 3, 7);
    T low2 = SHUFFLE(g[2], g[3], 0, 4, 1, 5), high2 = SHUFFLE(g[2], g[3], 2, 6, 3, 7);
    p[0] = SHUFFLE(low, low2, 0, 1, 4, 5);
    p[1] = SHUFFLE(low, low2, 2, 3, 6, 7);
    p[2] = SHUFFLE(high, high2, 0, 1, 4, 5);
  } else {
    T even = SHUFFLE(g[0], g[1], 0, 4, 2, 6), odd = SHUFFLE(g[0], g[1], 1, 5, 3, 7);
    T even2 = SHUFFLE(g[2], g[3], 0, 4, 2, 6), odd2 = SHUFFLE(g[2], g[3], 1, 5, 3, 7);
    p[0] = SHUFFLE(even, even2, 0, 1, 4, 5);
    p[1] = SHUFFLE(odd, odd2, 0, 1, 4, 5);
    p[2] = SHUFFLE(even, even2, 2, 3, 6, 7);
  }
}

/* g[4] := f[3] turned into nodes: lane 4 q + k is NODE_OF(g[k], q). */
INLINE void nodes_of_lanes(const T *f, T *g) {
  T zero = LIT(0);
  if (sizeof(S) == 4) {
    T low = SHUFFLE(f[0], f[1], 0, 4, 1, 5), high = SHUFFLE(f[0], f[1], 2, 6, 3, 7);
    T low2 = SHUFFLE(f[2], zero, 0, 4, 1, 5), high2 = SHUFFLE(f[2], zero, 2, 6, 3, 7);
    g[0] = SHUFFLE(low, low2, 0, 1, 4, 5), g[1] = SHUFFLE(low, low2, 2, 3, 6, 7);
    g[2] = SHUFFLE(high, high2, 0, 1, 4, 5), g[3] = SHUFFLE(high, high2, 2, 3, 6, 7);
  } else {
    T even = SHUFFLE(f[0], f[1], 0, 4, 2, 6), odd = SHUFFLE(f[0], f[1], 1, 5, 3, 7);
    /* Not shuffled with zero: gcc 12 makes that a duplication for 8 lanes. */
    MASK is_even = zero < zero;
    for (int l = 0; l < LANES; l += 2) is_even[l] = -1;
    T even2 = SELECT(is_even, f[2], zero);
    T odd2 = SELECT(is_even, SHUFFLE(f[2], f[2], 1, 1, 3, 3), zero);
    g[0] = SHUFFLE(even, even2, 0, 1, 4, 5), g[2] = SHUFFLE(even, even2, 2, 3, 6, 7);
    g[1] = SHUFFLE(odd, odd2, 0, 1, 4, 5), g[3] = SHUFFLE(odd, odd2, 2, 3, 6, 7);
  }
}

/* vector += f[3] at the nodes at place[live]. */
INLINE void add_to_nodes(S *vector, const uint32_t *place, size_t live, const T *f) {
  T g[4];
  nodes_of_lanes(f, g);
#define ADD_QUAD(q, some)                                                                          \
  for (int k = 0; k < 4; k++)                                                                      \
    if (!(some) || 4 * (q) + k < (int)live)                                                        \
  *(LOOSE_NODE *)node_at(vector, place[4 * (q) + k]) += NODE_OF(g[k], q)
#if CB_LANES == 4
#define ADD_QUADS(some) ADD_QUAD(0, some)
#elif CB_LANES == 8
#define ADD_QUADS(some)                                                                            \
  ADD_QUAD(0, some);                                                                               \
  ADD_QUAD(1, some)
#else
#define ADD_QUADS(some)                                                                            \
  ADD_QUAD(0, some);                                                                               \
  ADD_QUAD(1, some);                                                                               \
  ADD_QUAD(2, some);                                                                               \
  ADD_QUAD(3, some)
#endif
  if (live == LANES) {
    ADD_QUADS(0);
  } else {
    ADD_QUADS(1);
  }
#undef ADD_QUADS
#undef ADD_QUAD
}
#endif

#endif
