/* sweep_values.c - deformation gradients of any singular values, of both orientations, flat
 * and collapsed; turns; and what is nearly the identity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/verify/patches.h"

/* A row is the worst of six: three along the axes, three anyhow; the values in the six
 * orders. The mild ones come first. */
enum { SAME = 6, DECADES = 6, RIGHT_ANGLES = 4 };

/* ---- singular values -------------------------------------------------------------- */

/* Of n, e = 1e-2, 1e2, 1e-4 ... 1e12. */
static double spread(size_t n) {
  const double power = 2.0 * (double)(1 + n / 2);
  return pow(10, n % 2 ? power : -power);
}

/* values e^power, or 0 */
struct kind {
  int power[3];
  bool zero[3];
};
static const struct kind regular[] = {
    {{0, 0, 1}, {0}}, {{0, 1, 1}, {0}}, {{1, 1, 1}, {0}}, {{-1, 0, 1}, {0}}};
static const struct kind flat[] = {{{0, 1, 0}, {false, false, true}},
                                   {{1, 1, 0}, {false, false, true}}};
static const struct kind collapsed[] = {{{1, 0, 0}, {false, true, true}}};
enum { REGULAR = 4, FLAT = 2, SPREADS = 2 * DECADES };

static double values(const struct kind *kinds, size_t count, size_t n, double s[3]) {
  const double e = spread(n / count);
  for (int i = 0; i < 3; i++)
    s[i] = kinds[n % count].zero[i] ? 0 : pow(e, kinds[n % count].power[i]);
  return e;
}

static double regular_values(size_t n, double s[3]) {
  if (n) return values(regular, REGULAR, n - 1, s);
  return s[0] = s[1] = s[2] = 1;
}

static double inverted_values(size_t n, double s[3]) {
  const double e = regular_values(n, s);
  s[2] = -s[2];
  return e;
}

static double flat_values(size_t n, double s[3]) {
  if (n) return values(flat, FLAT, n - 1, s);
  s[0] = s[1] = 1, s[2] = 0;
  return 1;
}

static double collapsed_values(size_t n, double s[3]) {
  if (n > 1) return values(collapsed, 1, n - 2, s);
  s[0] = n == 0, s[1] = s[2] = 0;
  return s[0];
}

static void any_rotation(gsl_rng *rng, double angle, double *Q) {
  double u[3];
  for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(rng);
  cb_random_rotation(u, angle, Q);
}

/* F := U diag(s) V^T */
static void of_values(gsl_rng *rng, const double *s, size_t variation, double *F) {
  static const int order[SAME][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                     {2, 1, 0}, {1, 0, 2}, {0, 2, 1}};
  double U[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, V[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  if (variation >= 3) any_rotation(rng, -1, U), any_rotation(rng, -1, V);
  for (int i = 0; i < 9; i++) {
    F[i] = 0;
    for (int k = 0; k < 3; k++)
      F[i] += U[i / 3 * 3 + k] * s[order[variation][k]] * V[i % 3 * 3 + k];
  }
}

#define OF_VALUES(NAME)                                                                            \
  static void NAME##_fill(gsl_rng *rng, size_t n, size_t variation, double *F) {                   \
    double s[3];                                                                                   \
    NAME##_values(n, s);                                                                           \
    of_values(rng, s, variation, F);                                                               \
  }                                                                                                \
  static void NAME##_name(const void *context, size_t n, struct cb_extreme *row) {                 \
    double s[3];                                                                                   \
    (void)context;                                                                                 \
    row->value = NAME##_values(n, s);                                                              \
    snprintf(row->parameter, sizeof row->parameter, "values %g %g %g", s[0], s[1], s[2]);          \
  }
OF_VALUES(regular)
OF_VALUES(inverted)
OF_VALUES(flat)
OF_VALUES(collapsed)

/* ---- turns ------------------------------------------------------------------------ */

static double degrees(size_t n) {
  static const double exact[RIGHT_ANGLES] = {0, 90, 120, 180};
  return n < RIGHT_ANGLES ? exact[n] : 180 - pow(10, (double)RIGHT_ANGLES - 1 - (double)n);
}

/* About an axis for the first three: exact at right angles, about (1, 1, 1) at 120. */
static void turned_fill(gsl_rng *rng, size_t n, size_t variation, double *F) {
  const double angle = degrees(n) * M_PI / 180;
  const double c = n == 1 ? 0 : cos(angle), s = n == 0 || n == 3 ? 0 : sin(angle);
  const size_t x = variation, y = (x + 1) % 3, z = (x + 2) % 3;
  if (variation >= 3) {
    any_rotation(rng, angle, F);
    return;
  }
  for (size_t i = 0; i < 9; i++) F[i] = 0;
  if (n == 2) {
    F[2] = F[3] = F[7] = 1;
    return;
  }
  F[4 * x] = 1, F[4 * y] = F[4 * z] = c, F[3 * y + z] = -s, F[3 * z + y] = s;
}

static void turned_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = degrees(n);
  if (n < RIGHT_ANGLES)
    snprintf(row->parameter, sizeof row->parameter, "turned by %g degrees", row->value);
  else
    snprintf(row->parameter, sizeof row->parameter, "turned by 180 - 1e-%zu degrees",
             n + 1 - RIGHT_ANGLES);
}

/* ---- near rest -------------------------------------------------------------------- */

static double nearness(size_t n) { return pow(10, -2 * (double)(n + 1)); }

static void near_fill(gsl_rng *rng, size_t n, size_t variation, double *F) {
  const double e = nearness(n);
  for (int i = 0; i < 9; i++) {
    F[i] = i % 4 == 0;
    if (variation == 0) F[i] *= 1 + e;
    if (variation == 1 && i == 4) F[i] += e;
    if (variation > 1) F[i] += gsl_ran_gaussian(rng, e);
  }
}

static void near_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = nearness(n);
  snprintf(row->parameter, sizeof row->parameter, "identity + %g", row->value);
}

/* ------------------------------------------------------------------------------------ */

static enum cb_status run(const char *sweep, size_t rows,
                          void (*fill)(gsl_rng *rng, size_t n, size_t variation, double *F),
                          cb_row_name_fn *name, struct cb_extremes *all) {
  struct cb_cases c;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status =
      rng ? cb_cases_create(rows * SAME, true, &c) : cb_fail_memory("the sweep of values");
  if (!status) {
    gsl_rng_set(rng, all->seed);
    for (size_t n = 0; n < c.count; n++) {
      double F[9];
      fill(rng, n / SAME, n % SAME, F);
      for (int i = 0; i < 9; i++) c.x[12 * n + 3 + (size_t)(i % 3 * 3 + i / 3)] = F[i];
    }
    status = cb_cases_sweep(sweep, &c, SAME, name, NULL, all);
    cb_cases_free(&c);
  }
  if (rng) gsl_rng_free(rng);
  return status;
}

#define SWEEP(ID, NAME, ROWS, SUMMARY)                                                             \
  static enum cb_status ID##_run(struct cb_extremes *all) {                                        \
    return run(NAME, ROWS, ID##_fill, ID##_name, all);                                             \
  }                                                                                                \
  const struct cb_sweep cb_sweep_##ID = {NAME, SUMMARY, ID##_run};
SWEEP(regular, "values", 1 + SPREADS * REGULAR, "singular values of 1e-12 to 1e12")
SWEEP(inverted, "inverted", 1 + SPREADS * REGULAR, "the same, turned inside out")
SWEEP(flat, "flat", 1 + SPREADS * FLAT, "of no volume")
SWEEP(collapsed, "collapsed", 2 + SPREADS, "to a line or to a point")
SWEEP(turned, "turned", RIGHT_ANGLES + 12, "turned, to 180 - 1e-12 degrees")
SWEEP(near, "near", 8, "near the identity, to 1e-16")
