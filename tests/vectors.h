/* vectors.h - what the tests of reference/ share: random vectors, norms, and an
 * assertion that tells the measured value beside its limit.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_VECTORS_H
#define CB_TESTS_VECTORS_H

/* cmocka wants these before it. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_rng.h>
#include <math.h>

/* NaN fails too. */
static inline void assert_within(const char *what, double measured, double limit) {
  if (!(measured <= limit)) fail_msg("%s: measured %.3g, limit %.3g", what, measured, limit);
}

static inline double distance(size_t n, const double *x, const double *y) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return sqrt(sum);
}

static inline double norm(size_t n, const double *x) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += x[i] * x[i];
  return sqrt(sum);
}

/* Between -1 and 1. */
static inline void random_vector(gsl_rng *rng, size_t n, double *x) {
  for (size_t i = 0; i < n; i++) x[i] = 2 * gsl_rng_uniform(rng) - 1;
}

#endif
