/* statistics.h - what a handful of noisy timings allow one to say: medians and
 * ratios with intervals, lines through them, where two lines cross.
 *
 * Every interval is meant to hold the true value in 95 of 100 runs. Numbers
 * that are not finite make every result NaN, so that gates fail.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STATISTICS_H
#define CB_STATISTICS_H

#include "kernels/kernel.h"

#define CB_CONFIDENCE 0.95
/* A row that scatters more than this is unstable; what the user can do. */
#define CB_SCATTER_LIMIT 0.05
#define CB_SCATTER_REMEDY                                                                          \
  "close other programs, fix the CPU frequency, or give more time: --seconds"

struct cb_interval {
  double value, low, high;
};

/* Rank k, counted from 1, such that the k-th smallest and the k-th largest of n
 * independent samples enclose their median with at least CB_CONFIDENCE
 * (binomial distribution, nothing assumed about the samples); 0 when n < 6, too
 * few for any such k. */
size_t cb_median_rank(size_t n);

/* *median := median of samples[n] and its interval by cb_median_rank; low and
 * high are NaN when n < 6. *scatter (may be NULL) := 1.4826 MAD / |median|, an
 * estimate of the relative standard deviation. CB_MEMORY; n = 0 gives NaN. */
enum cb_status cb_median_interval(size_t n, const double *samples, struct cb_interval *median,
                                  double *scatter);
/* Not more than CB_SCATTER_LIMIT; false for NaN. */
bool cb_scatter_stable(double scatter);

/* *ratio := median of numerator[i] / denominator[i] and its interval, which is
 * the inverted sign test. Sample i of both was taken in the same round, so what
 * slows the machine for a while cancels. CB_MEMORY. */
enum cb_status cb_ratio_interval(size_t n, const double *numerator, const double *denominator,
                                 struct cb_interval *ratio);

/* Times of one variant at several iteration counts, all measured in the same
 * rounds: seconds[c][r] at iterations[c] in round r. Nothing is owned. */
struct cb_series {
  size_t counts, rounds;
  const double *iterations;
  const double *const *seconds;
};
struct cb_line {
  double intercept, slope; /* time = intercept + slope * iterations; s */
};

/* *line := weighted least squares line through the medians; weights 1/median^2,
 * as timing errors are proportional to the time. CB_MEMORY, CB_INPUT for fewer
 * than two counts. */
enum cb_status cb_line_fit(const struct cb_series *series, struct cb_line *line);

/* lines[CB_REPLICATES] := the line refitted to rounds drawn with replacement.
 * One seed draws the same rounds for every series of as many rounds, so
 * lines[i] of two series may be compared. CB_MEMORY, CB_INPUT. */
#define CB_REPLICATES 1000
enum cb_status cb_line_bootstrap(const struct cb_series *series, unsigned long seed,
                                 struct cb_line *lines);

/* Iteration count from which on `first` is the cheaper: 0 if it always is,
 * INFINITY if it is not even for very many iterations. */
double cb_line_crossing(struct cb_line first, struct cb_line second);

/* interval->low, high := percentiles of values[n], which are reordered;
 * infinite values are allowed, NaN makes both NaN. The value is kept. */
void cb_percentile_interval(size_t n, double *values, struct cb_interval *interval);

#endif
