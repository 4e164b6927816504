/* arithmetic.h - the one place where a type-generic source learns its numbers.
 * Every file of kernels/models, storage and solver is compiled once per
 * arithmetic: CB_SCALAR (double, float, __float128), CB_LANES (elements handled
 * at once), CB_SUFFIX (its name). T is one number per lane, S its scalar.
 * Formulas use T, LIT, SQRT, SELECT, ANY and the operators; nothing else.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ARITHMETIC_H
#define CB_ARITHMETIC_H

#include <math.h>
#include <stdint.h>

#include "kernels/stages.h"

#define CB_PASTE_(a, b) a##_##b
#define CB_PASTE(a, b) CB_PASTE_(a, b)
#define CB_NAME(stem) CB_PASTE(stem, CB_SUFFIX) /* the only mangler */
#define CB_STRING_(a) #a
#define CB_STRING(a) CB_STRING_(a)

#define INLINE static inline __attribute__((always_inline))
/* One copy in a file, for what nothing is timed with: builds are faster. */
#define OUTLINE static __attribute__((noinline, unused))
/* The work of one pack: inlined where a pack is one element, called where it is
 * many, so that the storages of a model share it. */
#if CB_LANES == 1
#define PACK_LINKAGE INLINE
#else
#define PACK_LINKAGE OUTLINE
#endif
#define LANES CB_LANES
typedef CB_SCALAR S;
/* Node vectors: x y z, padded to four where whole nodes are loaded as one. */
#define STRIDE (LANES == 1 ? 3 : 4)

#ifdef CB_COUNTED
/* Quad precision whose every operation is a library call that the linker
 * redirects to harness/verify/counter.c. A mark says to which stage the following
 * operations belong. */
typedef __float128 REAL; /* rest data are computed in this and rounded to S */
typedef __float128 ACC;  /* sums over many numbers */
__float128 sqrtq(__float128);
void cb_counter_stage(int stage);
#define STAGE(stage) cb_counter_stage(stage)
INLINE S scalar_sqrt(S a) { return sqrtq(a); }
INLINE REAL real_sqrt(REAL a) { return sqrtq(a); }
#else
typedef double REAL, ACC;
#define STAGE(stage) ((void)0)
INLINE S scalar_sqrt(S a) { return sizeof(S) == sizeof(float) ? (S)sqrtf((float)a) : (S)sqrt(a); }
INLINE REAL real_sqrt(REAL a) { return sqrt(a); }
#endif

#if CB_LANES == 1
typedef S T;
typedef int MASK;
#define LANE(t, l) (t)
INLINE T splat(S a) { return a; }
INLINE T SQRT(T a) { return scalar_sqrt(a); }
INLINE T SELECT(MASK m, T a, T b) { return m ? a : b; }
INLINE int ANY(MASK m) { return m; }
INLINE MASK load_bytes(const uint8_t *b) { return *b; }
#else
typedef S T __attribute__((vector_size(sizeof(S) * CB_LANES)));
typedef __typeof__((T){0} < (T){0}) MASK;
#define LANE(t, l) ((t)[l])
INLINE T splat(S a) {
  T t;
  for (int l = 0; l < LANES; l++) t[l] = a;
  return t;
}
INLINE T SQRT(T a) {
  T t;
  for (int l = 0; l < LANES; l++) t[l] = scalar_sqrt(a[l]);
  return t;
}
INLINE T SELECT(MASK m, T a, T b) { return (T)((m & (MASK)a) | (~m & (MASK)b)); }
/* One number a lane, from LANES bytes. */
INLINE MASK load_bytes(const uint8_t *b) {
  uint8_t bytes __attribute__((vector_size(CB_LANES)));
  __builtin_memcpy(&bytes, b, sizeof bytes);
  return __builtin_convertvector(bytes, MASK);
}
INLINE int ANY(MASK m) {
  int any = 0;
  for (int l = 0; l < LANES; l++) any |= m[l] != 0;
  return any;
}
#endif
#define LIT(x) splat((S)(x))

INLINE T ABS(T a) { return SELECT(a < LIT(0), -a, a); }

#endif
