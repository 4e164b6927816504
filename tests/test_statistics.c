/* The statistics on samples whose answer is known: by hand, by construction, or
 * by counting how often an interval holds the truth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>

#include "harness/measure/statistics.h"

#define assert_near(value, expected, tolerance)                                                    \
  assert_true(fabs((value) - (expected)) <= (tolerance))

enum { ROUNDS = 25, COUNTS = 5 };
static const double iterations[COUNTS] = {1, 5, 20, 50, 100};

static gsl_rng *random_numbers(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  assert_non_null(rng);
  return rng;
}

static void test_median_and_scatter(void **state) {
  (void)state;
  const double samples[] = {9, 1, 2, 8, 3, 7, 4, 6, 5};
  struct cb_interval median;
  double scatter;
  assert_int_equal(cb_median_interval(9, samples, &median, &scatter), CB_OK);
  assert_near(median.value, 5, 0);
  /* ranks 2 and 8: 1 - 2 (1 + 9) / 512 = 0.961 */
  assert_near(median.low, 2, 0);
  assert_near(median.high, 8, 0);
  assert_near(scatter, 1.4826 * 2 / 5, 1e-4);
  assert_near(samples[0], 9, 0); /* not sorted in place */
}

/* Values of printed tables of the sign test at 5 %, two-sided. */
static void test_median_rank(void **state) {
  (void)state;
  assert_int_equal(cb_median_rank(5), 0);
  assert_int_equal(cb_median_rank(6), 1);
  assert_int_equal(cb_median_rank(9), 2);
  assert_int_equal(cb_median_rank(25), 8);
  assert_int_equal(cb_median_rank(100), 40);
}

static void test_few_samples_have_no_interval(void **state) {
  (void)state;
  const double samples[] = {1, 2, 3, 4, 5};
  struct cb_interval median;
  assert_int_equal(cb_median_interval(5, samples, &median, NULL), CB_OK);
  assert_near(median.value, 3, 0);
  assert_true(isnan(median.low) && isnan(median.high));
  assert_int_equal(cb_median_interval(0, samples, &median, NULL), CB_OK);
  assert_true(isnan(median.value));
}

static void test_nan_fails_every_gate(void **state) {
  (void)state;
  const double bad[] = {1, 1, NAN, 1, 1, 1, 1}, good[] = {1, 1, 1, 1, 1, 1, 1};
  struct cb_interval interval;
  double scatter = 0;
  assert_int_equal(cb_median_interval(7, bad, &interval, &scatter), CB_OK);
  assert_true(isnan(interval.value) && isnan(interval.low) && isnan(interval.high));
  assert_false(cb_scatter_stable(scatter));
  assert_int_equal(cb_ratio_interval(7, good, bad, &interval), CB_OK);
  assert_true(isnan(interval.value));
  const double zero[] = {0, 0, 0, 0, 0, 0, 0};
  assert_int_equal(cb_ratio_interval(7, good, zero, &interval), CB_OK);
  assert_true(isnan(interval.value));
  double values[] = {1, NAN, 2};
  cb_percentile_interval(3, values, &interval);
  assert_true(isnan(interval.low) && isnan(interval.high));
  assert_true(isnan(cb_line_crossing((struct cb_line){NAN, 1}, (struct cb_line){1, 2})));
  assert_true(cb_scatter_stable(0.049));
  assert_false(cb_scatter_stable(0.051));
}

/* Skewed noise, as timings have: the interval must hold the true median in at
 * least 95 % of the trials, less four standard deviations of the count. */
static void test_median_coverage(void **state) {
  (void)state;
  enum { TRIALS = 4000 };
  gsl_rng *rng = random_numbers();
  size_t held = 0;
  for (int t = 0; t < TRIALS; t++) {
    double samples[ROUNDS];
    for (int r = 0; r < ROUNDS; r++) samples[r] = gsl_ran_lognormal(rng, 0, 0.3);
    struct cb_interval median;
    assert_int_equal(cb_median_interval(ROUNDS, samples, &median, NULL), CB_OK);
    held += median.low <= 1 && 1 <= median.high;
  }
  gsl_rng_free(rng);
  const double share = (double)held / TRIALS, deviation = sqrt(0.95 * 0.05 / TRIALS);
  print_message("median: %.3f of the intervals hold it, at least %.3f expected\n", share,
                0.95 - 4 * deviation);
  assert_true(share >= 0.95 - 4 * deviation);
  assert_true(share < 0.995); /* an interval that is always right says nothing */
}

/* Two variants, 30 % apart, on a machine that slows both by up to a factor of
 * two from round to round: only the paired ratio can see it. */
static void test_planted_ratio(void **state) {
  (void)state;
  enum { TRIALS = 400 };
  gsl_rng *rng = random_numbers();
  size_t held = 0;
  for (int t = 0; t < TRIALS; t++) {
    double slow[ROUNDS], fast[ROUNDS];
    for (int r = 0; r < ROUNDS; r++) {
      const double machine = gsl_ran_flat(rng, 1, 2);
      slow[r] = 1.3e-3 * machine * gsl_ran_lognormal(rng, 0, 0.02);
      fast[r] = 1.0e-3 * machine * gsl_ran_lognormal(rng, 0, 0.02);
    }
    struct cb_interval ratio;
    assert_int_equal(cb_ratio_interval(ROUNDS, slow, fast, &ratio), CB_OK);
    held += ratio.low <= 1.3 && 1.3 <= ratio.high;
    assert_true(ratio.low > 1.2 && ratio.high < 1.4);
  }
  gsl_rng_free(rng);
  print_message("ratio: %zu of %d intervals hold 1.3\n", held, TRIALS);
  assert_true((double)held >= TRIALS * 0.95 - 4 * sqrt(TRIALS * 0.95 * 0.05));
}

struct rounds {
  double numbers[COUNTS][ROUNDS];
  const double *seconds[COUNTS];
  struct cb_series series;
};

/* Times on that line, each with that relative noise; rng NULL: none. */
static void make_rounds(struct rounds *s, gsl_rng *rng, struct cb_line line, double noise) {
  for (int c = 0; c < COUNTS; c++) {
    s->seconds[c] = s->numbers[c];
    for (int r = 0; r < ROUNDS; r++) {
      const double factor = rng ? gsl_ran_lognormal(rng, 0, noise) : 1;
      s->numbers[c][r] = (line.intercept + line.slope * iterations[c]) * factor;
    }
  }
  s->series = (struct cb_series){COUNTS, ROUNDS, iterations, s->seconds};
}

static void test_exact_line(void **state) {
  (void)state;
  struct rounds rounds;
  struct cb_line line;
  make_rounds(&rounds, NULL, (struct cb_line){3e-4, 2e-5}, 0);
  rounds.numbers[2][0] = 1; /* one interrupted epoch must not move the line */
  assert_int_equal(cb_line_fit(&rounds.series, &line), CB_OK);
  assert_near(line.intercept, 3e-4, 1e-15);
  assert_near(line.slope, 2e-5, 1e-16);
}

/* Medians off a line, so that the weights matter: with weights 1/y^2 the normal
 * equations say that the weighted residuals are orthogonal to 1 and to n. */
static void test_weights_are_relative(void **state) {
  (void)state;
  const double one[] = {1}, two[] = {2}, four[] = {4};
  const double *const seconds[] = {one, two, four};
  const struct cb_series series = {3, 1, iterations, seconds};
  struct cb_line line;
  assert_int_equal(cb_line_fit(&series, &line), CB_OK);
  double sum[2] = {0, 0};
  for (int c = 0; c < 3; c++) {
    const double y = seconds[c][0], r = (y - line.intercept - line.slope * iterations[c]) / (y * y);
    sum[0] += r;
    sum[1] += r * iterations[c];
  }
  assert_near(sum[0], 0, 1e-14);
  assert_near(sum[1], 0, 1e-14);
}

static void test_line_needs_two_counts(void **state) {
  (void)state;
  struct rounds rounds;
  struct cb_line line = {7, 7};
  make_rounds(&rounds, NULL, (struct cb_line){1, 1}, 0);
  rounds.series.counts = 1;
  assert_int_equal(cb_line_fit(&rounds.series, &line), CB_INPUT);
  assert_near(line.slope, 7, 0);
}

static void test_crossing(void **state) {
  (void)state;
  const struct cb_line assembled = {10, 1}, unassembled = {1, 2};
  assert_near(cb_line_crossing(assembled, unassembled), 9, 1e-15);
  /* dearer from the start and in each iteration; as dear in each iteration */
  assert_true(isinf(cb_line_crossing((struct cb_line){10, 3}, unassembled)));
  assert_true(isinf(cb_line_crossing((struct cb_line){10, 2}, unassembled)));
  /* cheaper from the start */
  assert_near(cb_line_crossing((struct cb_line){0.5, 1}, unassembled), 0, 0);
}

/* Lines that cross at 50 iterations, 2 % noise: the bootstrap interval must hold
 * 50 about 95 times in 100. */
static void test_crossing_coverage(void **state) {
  (void)state;
  enum { TRIALS = 100 };
  static struct cb_line first[CB_REPLICATES], second[CB_REPLICATES];
  static double crossings[CB_REPLICATES];
  gsl_rng *rng = random_numbers();
  size_t held = 0;
  for (unsigned t = 0; t < TRIALS; t++) {
    struct rounds a, b;
    make_rounds(&a, rng, (struct cb_line){2.0e-3, 2e-5}, 0.02);
    make_rounds(&b, rng, (struct cb_line){0.5e-3, 5e-5}, 0.02);
    assert_int_equal(cb_line_bootstrap(&a.series, t, first), CB_OK);
    assert_int_equal(cb_line_bootstrap(&b.series, t, second), CB_OK);
    for (int i = 0; i < CB_REPLICATES; i++) crossings[i] = cb_line_crossing(first[i], second[i]);
    struct cb_interval crossing = {50, 0, 0};
    cb_percentile_interval(CB_REPLICATES, crossings, &crossing);
    held += crossing.low <= 50 && 50 <= crossing.high;
    assert_true(crossing.low > 45 && crossing.high < 55);
  }
  gsl_rng_free(rng);
  print_message("crossing: %zu of %d intervals hold 50\n", held, TRIALS);
  assert_true(held >= 86); /* 95 less four standard deviations */
}

static void test_bootstrap_pairs_rounds(void **state) {
  (void)state;
  static struct cb_line first[CB_REPLICATES], second[CB_REPLICATES];
  gsl_rng *rng = random_numbers();
  struct rounds rounds;
  make_rounds(&rounds, rng, (struct cb_line){1e-3, 1e-5}, 0.1);
  gsl_rng_free(rng);
  assert_int_equal(cb_line_bootstrap(&rounds.series, 7, first), CB_OK);
  assert_int_equal(cb_line_bootstrap(&rounds.series, 7, second), CB_OK);
  assert_memory_equal(first, second, sizeof first);
  assert_int_equal(cb_line_bootstrap(&rounds.series, 8, second), CB_OK);
  assert_memory_not_equal(first, second, sizeof first);
}

static void test_percentiles(void **state) {
  (void)state;
  double values[200];
  for (int i = 0; i < 200; i++) values[i] = 199 - i;
  values[3] = INFINITY; /* was 196 */
  struct cb_interval interval = {100, 0, 0};
  cb_percentile_interval(200, values, &interval);
  assert_near(interval.value, 100, 0);
  assert_near(interval.low, 5, 0);
  assert_near(interval.high, 194, 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_median_and_scatter),
      cmocka_unit_test(test_median_rank),
      cmocka_unit_test(test_few_samples_have_no_interval),
      cmocka_unit_test(test_nan_fails_every_gate),
      cmocka_unit_test(test_median_coverage),
      cmocka_unit_test(test_planted_ratio),
      cmocka_unit_test(test_exact_line),
      cmocka_unit_test(test_weights_are_relative),
      cmocka_unit_test(test_line_needs_two_counts),
      cmocka_unit_test(test_crossing),
      cmocka_unit_test(test_crossing_coverage),
      cmocka_unit_test(test_bootstrap_pairs_rounds),
      cmocka_unit_test(test_percentiles),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
