/* loops_body.h - the loops of one instruction set: included by loops.c once for
 * each, with NAME(x), TARGET and BYTES (of a vector) defined.
 *
 * SPDX-License-Identifier: BSD-3-Clause */

typedef float NAME(f32) __attribute__((vector_size(BYTES)));
typedef double NAME(f64) __attribute__((vector_size(BYTES)));

/* The chains start from different numbers, or they would be one to the compiler. */
#define MULTIPLY_ADD(function, V, T)                                                               \
  TARGET static double NAME(function)(size_t repeats, double factor, double addend) {              \
    const V f = (V){0} + (T)factor, d = (V){0} + (T)addend;                                        \
    V a[CB_LOOP_CHAINS], sum = {0};                                                                \
    double total = 0;                                                                              \
    for (int k = 0; k < CB_LOOP_CHAINS; k++) a[k] = (V){0} + (T)k;                                 \
    for (size_t i = 0; i < repeats; i++)                                                           \
      for (int k = 0; k < CB_LOOP_CHAINS; k++) a[k] = a[k] * f + d;                                \
    for (int k = 0; k < CB_LOOP_CHAINS; k++) sum += a[k];                                          \
    for (size_t k = 0; k < BYTES / sizeof(T); k++) total += (double)sum[k];                        \
    return total;                                                                                  \
  }
MULTIPLY_ADD(multiply_add_f32, NAME(f32), float)
MULTIPLY_ADD(multiply_add_f64, NAME(f64), double)
#undef MULTIPLY_ADD

TARGET static double NAME(read)(size_t repeats, size_t n, const double *x) {
  enum { PARTS = 8, PER_VECTOR = BYTES / sizeof(double) };
  NAME(f64) sum[PARTS] = {{0}};
  double total = 0;
  for (size_t r = 0; r < repeats; r++) {
    const NAME(f64) *v = (const NAME(f64) *)x;
    for (size_t i = 0; i < n / PER_VECTOR; i += PARTS)
      for (size_t k = 0; k < PARTS; k++) sum[k] += v[i + k];
    BARRIER;
  }
  for (size_t k = 1; k < PARTS; k++) sum[0] += sum[k];
  for (size_t k = 0; k < PER_VECTOR; k++) total += sum[0][k];
  return total;
}

TARGET static void NAME(triad)(size_t repeats, size_t n, double factor, const double *b,
                               const double *c, double *a) {
  enum { PARTS = 4, PER_VECTOR = BYTES / sizeof(double) };
  const NAME(f64) f = (NAME(f64)){0} + factor;
  for (size_t r = 0; r < repeats; r++) {
    const NAME(f64) *bv = (const NAME(f64) *)b, *cv = (const NAME(f64) *)c;
    NAME(f64) *restrict av = (NAME(f64) *)a;
    for (size_t i = 0; i < n / PER_VECTOR; i += PARTS)
      for (size_t k = 0; k < PARTS; k++) av[i + k] = bv[i + k] + f * cv[i + k];
    BARRIER;
  }
}
