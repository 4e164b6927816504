/* arithmetic.h - the one place where a type-generic source learns its numbers.
 * Every file of kernels/models, storage and solver is compiled once per
 * arithmetic: CB_SCALAR (double, float, __float128), CB_LANES (elements handled
 * at once), CB_SUFFIX (its name). T is one number per lane, S its scalar.
 * Formulas use T, LIT, SQRT, RSQRT, SELECT, ANY and the operators; nothing else.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ARITHMETIC_H
#define CB_ARITHMETIC_H

#include <math.h>
#include <stdint.h>

#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "kernels/stages.h"

#define CB_PASTE_(a, b) a##_##b
#define CB_PASTE(a, b) CB_PASTE_(a, b)
#define CB_NAME(stem) CB_PASTE(stem, CB_SUFFIX) /* the only mangler */
#define CB_STRING_(a) #a
#define CB_STRING(a) CB_STRING_(a)

/* CB_IS(float): whether CB_SCALAR is float, for the preprocessor. */
#define CB_IS_float_float 1
#define CB_IS_double_double 1
#define CB_IS_(type, scalar) CB_IS_##type##_##scalar
#define CB_IS_EXPAND(type, scalar) CB_IS_(type, scalar)
#define CB_IS(type) CB_IS_EXPAND(type, CB_SCALAR)
#define CB_BYTES (CB_LANES * (CB_IS(float) ? 4 : CB_IS(double) ? 8 : 16))

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
typedef int WHOLES, CHOICE;
INLINE WHOLES load_bytes(const uint8_t *b) { return *b; }
#define EQUAL(w, n) ((w) == (n))
#define LESS(a, b) ((a) < (b))
#define CHOOSE SELECT
INLINE int ALL(CHOICE m) { return m; }
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
/* WHOLES: a whole number a lane, from LANES bytes; CHOICE: what EQUAL makes of one, LESS of
 * numbers, and CHOOSE and ALL take for a mask, in the registers that the processor has for
 * that. */
typedef MASK WHOLES;
#if CB_BYTES == 64 && defined __AVX512F__ && CB_IS(float)
typedef __mmask16 CHOICE;
INLINE WHOLES load_bytes(const uint8_t *b) {
  return (WHOLES)_mm512_cvtepu8_epi32(_mm_loadu_si128((const __m128i *)b));
}
#define EQUAL(w, n) _mm512_cmpeq_epi32_mask((__m512i)(w), _mm512_set1_epi32(n))
#define LESS(a, b) _mm512_cmp_ps_mask((__m512)(a), (__m512)(b), _CMP_LT_OQ)
#define CHOOSE(m, a, b) ((T)_mm512_mask_blend_ps(m, (__m512)(b), (__m512)(a)))
INLINE int ALL(CHOICE m) { return m == 0xffff; }
#elif CB_BYTES == 64 && defined __AVX512F__
typedef __mmask8 CHOICE;
INLINE WHOLES load_bytes(const uint8_t *b) {
  return (WHOLES)_mm512_cvtepu8_epi64(_mm_loadl_epi64((const __m128i *)b));
}
#define EQUAL(w, n) _mm512_cmpeq_epi64_mask((__m512i)(w), _mm512_set1_epi64(n))
#define LESS(a, b) _mm512_cmp_pd_mask((__m512d)(a), (__m512d)(b), _CMP_LT_OQ)
#define CHOOSE(m, a, b) ((T)_mm512_mask_blend_pd(m, (__m512d)(b), (__m512d)(a)))
INLINE int ALL(CHOICE m) { return m == 0xff; }
#else
typedef MASK CHOICE;
INLINE WHOLES load_bytes(const uint8_t *b) {
  WHOLES w;
  for (int l = 0; l < LANES; l++) w[l] = b[l];
  return w;
}
#define EQUAL(w, n) ((w) == (n))
#define LESS(a, b) ((a) < (b))
#define CHOOSE SELECT
#if CB_BYTES == 32 && defined __AVX2__
INLINE int ALL(CHOICE m) { return _mm256_movemask_epi8((__m256i)m) == -1; }
#else
INLINE int ALL(CHOICE m) {
  int all = 1;
  for (int l = 0; l < LANES; l++) all &= m[l] != 0;
  return all;
}
#endif
#endif
#if CB_BYTES == 64 && defined __AVX512F__
INLINE int ANY(MASK m) { return _mm512_test_epi32_mask((__m512i)m, (__m512i)m) != 0; }
#elif CB_BYTES == 32 && defined __AVX2__
INLINE int ANY(MASK m) { return !_mm256_testz_si256((__m256i)m, (__m256i)m); }
#else
INLINE int ANY(MASK m) {
  int any = 0;
  for (int l = 0; l < LANES; l++) any |= m[l] != 0;
  return any;
}
#endif
#endif
#define LIT(x) splat((S)(x))

/* RSQRT: 1 / sqrt(a), a >= 0, to about one rounding. 1/0 is infinite, 1/infinity 0, of a < 0 NaN;
 * with AVX2 float lanes take a < 2^-126 for 0. Where the processor has an estimate y, this is it
 * times (1 - e)^(-1/2), e = 1 - a y^2, by the binomial series; where a y is not a number, y is
 * exact. ROUGH_SQRT and ROUGH_INVERSE: sqrt(a), a > 0, and 1 / a to 2^-11 at least, for what is
 * iterated on. */
#if CB_IS(float) && CB_BYTES == 64 && defined __AVX512F__
INLINE T RSQRT_ESTIMATE(T a) { return (T)_mm512_rsqrt14_ps((__m512)a); }
INLINE T ROUGH_SQRT(T a) { return a * RSQRT_ESTIMATE(a); }
INLINE T ROUGH_INVERSE(T a) { return (T)_mm512_rcp14_ps((__m512)a); }
INLINE T RSQRT(T a) {
  T y = RSQRT_ESTIMATE(a), ay = a * y, series = LIT(0.5) * (LIT(1) - ay * y);
  __mmask16 refine = _mm512_cmp_ps_mask((__m512)ay, (__m512)ay, _CMP_ORD_Q);
  return (T)_mm512_mask_fmadd_ps((__m512)y, refine, (__m512)series, (__m512)y);
}
#elif CB_IS(double) && CB_BYTES == 64 && defined __AVX512F__
INLINE T RSQRT_ESTIMATE(T a) { return (T)_mm512_rsqrt14_pd((__m512d)a); }
INLINE T ROUGH_SQRT(T a) { return a * RSQRT_ESTIMATE(a); }
INLINE T ROUGH_INVERSE(T a) { return (T)_mm512_rcp14_pd((__m512d)a); }
INLINE T RSQRT(T a) {
  T y = RSQRT_ESTIMATE(a), ay = a * y, e = LIT(1) - ay * y;
  T series = e * (LIT(0.5) + e * (LIT(0.375) + e * (LIT(0.3125) + e * LIT(0.2734375))));
  __mmask8 refine = _mm512_cmp_pd_mask((__m512d)ay, (__m512d)ay, _CMP_ORD_Q);
  return (T)_mm512_mask_fmadd_pd((__m512d)y, refine, (__m512d)series, (__m512d)y);
}
#elif CB_IS(float) && CB_BYTES == 32 && defined __AVX2__
INLINE T RSQRT_ESTIMATE(T a) { return (T)_mm256_rsqrt_ps((__m256)a); }
INLINE T ROUGH_SQRT(T a) { return a * RSQRT_ESTIMATE(a); }
INLINE T ROUGH_INVERSE(T a) { return (T)_mm256_rcp_ps((__m256)a); }
INLINE T RSQRT(T a) {
  T y = RSQRT_ESTIMATE(a), ay = a * y, e = LIT(1) - ay * y;
  return SELECT(ay == ay, y + y * (e * (LIT(0.5) + e * LIT(0.375))), y);
}
#else
INLINE T RSQRT(T a) { return LIT(1) / SQRT(a); }
INLINE T ROUGH_SQRT(T a) { return SQRT(a); }
INLINE T ROUGH_INVERSE(T a) { return LIT(1) / a; }
#endif

/* SIGNED_AS(b, a): a, or -a where b is negative. */
#if CB_LANES == 1
INLINE T ABS(T a) {
  return sizeof(S) == 4 ? (T)fabsf((float)a) : sizeof(S) == 8 ? (T)fabs((double)a) : a < 0 ? -a : a;
}
INLINE T SIGNED_AS(T b, T a) { return b < 0 ? -a : a; }
#else
INLINE T ABS(T a) { return (T)((MASK)a & ~(MASK)LIT(-0.0)); }
INLINE T SIGNED_AS(T b, T a) { return (T)((MASK)a ^ ((MASK)b & (MASK)LIT(-0.0))); }
#endif

#endif
