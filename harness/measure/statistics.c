/* Order statistics and the bootstrap; GSL sorts, fits and knows the
 * distributions.
 * Source: intervals of the median: David & Nagaraja, Order Statistics, 7.1;
 *         percentile bootstrap: Efron & Tibshirani 1993, chapter 13.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/statistics.h"

#include <gsl/gsl_cdf.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"

size_t cb_median_rank(size_t n) {
  const double tail = (1 - CB_CONFIDENCE) / 2;
  size_t k = 0;
  while (k < n / 2 && gsl_cdf_binomial_P((unsigned)k, 0.5, (unsigned)n) <= tail) k++;
  return k;
}

static bool all_finite(size_t n, const double *samples) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(samples[i])) return false;
  return true;
}

enum cb_status cb_median_interval(size_t n, const double *samples, struct cb_interval *median,
                                  double *scatter) {
  struct cb_interval result = {NAN, NAN, NAN};
  double spread = NAN;
  if (n > 0 && all_finite(n, samples)) {
    double *sorted = malloc(2 * n * sizeof *sorted);
    if (!sorted) return cb_fail_memory("the statistics");
    memcpy(sorted, samples, n * sizeof *sorted);
    gsl_sort(sorted, 1, n);
    result.value = gsl_stats_median_from_sorted_data(sorted, 1, n);
    spread = gsl_stats_mad(sorted, 1, n, sorted + n) / fabs(result.value);
    const size_t rank = cb_median_rank(n);
    if (rank > 0) {
      result.low = sorted[rank - 1];
      result.high = sorted[n - rank];
    }
    free(sorted);
  }
  *median = result;
  if (scatter) *scatter = spread;
  return CB_OK;
}

bool cb_scatter_stable(double scatter) { return scatter <= CB_SCATTER_LIMIT; }

enum cb_status cb_ratio_interval(size_t n, const double *numerator, const double *denominator,
                                 struct cb_interval *ratio) {
  double *ratios = malloc((n ? n : 1) * sizeof *ratios);
  if (!ratios) return cb_fail_memory("the statistics");
  for (size_t i = 0; i < n; i++) ratios[i] = numerator[i] / denominator[i];
  const enum cb_status status = cb_median_interval(n, ratios, ratio, NULL);
  free(ratios);
  return status;
}

/* Line through the medians of the picked rounds (rounds numbers). work holds
 * one column of samples, then the weights and medians. */
static struct cb_line fit(const struct cb_series *s, const size_t *picked, double *work) {
  double *weight = work + s->rounds, *median = weight + s->counts;
  for (size_t c = 0; c < s->counts; c++) {
    for (size_t r = 0; r < s->rounds; r++) work[r] = s->seconds[c][picked[r]];
    median[c] = all_finite(s->rounds, work) ? gsl_stats_median(work, 1, s->rounds) : NAN;
    weight[c] = 1 / (median[c] * median[c]);
  }
  struct cb_line line;
  double cov00, cov01, cov11, chi_squared;
  gsl_fit_wlinear(s->iterations, 1, weight, 1, median, 1, s->counts, &line.intercept, &line.slope,
                  &cov00, &cov01, &cov11, &chi_squared);
  return line;
}

/* A workspace for fit: *work and *picked, both to be freed. */
static enum cb_status fit_begin(const struct cb_series *s, double **work, size_t **picked) {
  if (s->counts < 2 || s->rounds < 1)
    return cb_fail(CB_INPUT, "a line needs two iteration counts and one round; got %zu and %zu",
                   s->counts, s->rounds);
  *work = malloc((s->rounds + 2 * s->counts) * sizeof **work);
  *picked = malloc(s->rounds * sizeof **picked);
  if (*work && *picked) return CB_OK;
  free(*work);
  free(*picked);
  return cb_fail_memory("the statistics");
}

enum cb_status cb_line_fit(const struct cb_series *series, struct cb_line *line) {
  double *work = NULL;
  size_t *picked = NULL;
  const enum cb_status status = fit_begin(series, &work, &picked);
  if (status) return status;
  for (size_t r = 0; r < series->rounds; r++) picked[r] = r;
  *line = fit(series, picked, work);
  free(work);
  free(picked);
  return CB_OK;
}

enum cb_status cb_line_bootstrap(const struct cb_series *series, unsigned long seed,
                                 struct cb_line *lines) {
  double *work = NULL;
  size_t *picked = NULL;
  const enum cb_status status = fit_begin(series, &work, &picked);
  if (status) return status;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (rng) {
    gsl_rng_set(rng, seed);
    for (size_t i = 0; i < CB_REPLICATES; i++) {
      for (size_t r = 0; r < series->rounds; r++)
        picked[r] = gsl_rng_uniform_int(rng, series->rounds);
      lines[i] = fit(series, picked, work);
    }
    gsl_rng_free(rng);
  }
  free(work);
  free(picked);
  return rng ? CB_OK : cb_fail_memory("the statistics");
}

double cb_line_crossing(struct cb_line first, struct cb_line second) {
  const double saved = second.slope - first.slope, spent = first.intercept - second.intercept;
  if (isnan(saved) || isnan(spent)) return NAN;
  if (!(saved > 0)) return INFINITY;
  return fmax(0, spent / saved);
}

void cb_percentile_interval(size_t n, double *values, struct cb_interval *interval) {
  interval->low = interval->high = NAN;
  if (n == 0) return;
  for (size_t i = 0; i < n; i++)
    if (isnan(values[i])) return;
  gsl_sort(values, 1, n);
  const size_t cut = (size_t)((1 - CB_CONFIDENCE) / 2 * (double)n);
  interval->low = values[cut];
  interval->high = values[n - 1 - cut];
}
