/* sweep_shapes.c - slivers, needles and plates, and elements far from the origin: shapes at
 * rest that are hardly shapes, moderately deformed. Frames are functions of F, which is
 * ordinary here; what is held against quad precision is the force and the product.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/verify/patches.h"

enum { TRIALS = 3 };

static const double regular[12] = {0, 0, 0, 0, 1, 1, 1, 0, 1, 1, 1, 0};

/* x := X moved by a deformation gradient of about a fifth of strain, any rotation and X. */
static void deform(gsl_rng *rng, const double *X, double *x) {
  double Q[9], u[3], F[9];
  for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(rng);
  cb_random_rotation(u, -1, Q);
  for (int i = 0; i < 9; i++) F[i] = Q[i] + gsl_ran_gaussian(rng, 0.1);
  for (int i = 0; i < 12; i++) {
    const double *p = X + i / 3 * 3, *row = F + i % 3 * 3;
    x[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
  }
}

static void turn(gsl_rng *rng, double *X) {
  double Q[9], u[3], turned[12];
  for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(rng);
  cb_random_rotation(u, -1, Q);
  for (int i = 0; i < 12; i++) {
    const double *p = X + i / 3 * 3, *row = Q + i % 3 * 3;
    turned[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2];
  }
  memcpy(X, turned, sizeof turned);
}

/* ---- slivers ------------------------------------------------------------------------ */

enum { ANGLES = 9, SLIVERS = 3 };
static const double angle[ANGLES] = {60, 30, 10, 3, 1, 0.3, 0.1, 0.03, 0.01};

/* Smallest dihedral angle: a cap, its top above the middle of its base; four points about a
 * square, edges of a tent of that slope; two faces nearly on each other. */
static void sliver(double degrees, size_t kind, double *X) {
  const double a = degrees * M_PI / 180, h = tan(a) / sqrt(12), z = tan(a / 2) / 2;
  const double shape[SLIVERS][12] = {
      {0, 0, 0, 1, 0, 0, 0.5, sqrt(0.75), 0, 0.5, sqrt(1. / 12), h},
      {-0.5, 0, -z / 2, 0.5, 0, -z / 2, 0, -0.5, z / 2, 0, 0.5, z / 2},
      {0, 0, 0, 1, 0, 0, 0.5, cos(a / 2), -sin(a / 2), 0.5, cos(a / 2), sin(a / 2)}};
  memcpy(X, shape[kind], sizeof shape[kind]);
}

static void sliver_fill(size_t n, size_t variation, double *X) {
  sliver(angle[n], variation / TRIALS, X);
}

static void sliver_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = angle[n];
  snprintf(row->parameter, sizeof row->parameter, "dihedral angle %g degrees", angle[n]);
}

/* ---- aspect ------------------------------------------------------------------------- */

enum { RATIOS = 7, FORMS = 2 };

static void aspect_fill(size_t n, size_t variation, double *X) {
  const double ratio = pow(10, (double)n);
  const bool needle = variation / TRIALS;
  for (int i = 0; i < 12; i++)
    X[i] = regular[i] / (i % 3 == 2 || (needle && i % 3 == 1) ? ratio : 1);
}

static void aspect_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = pow(10, (double)n);
  snprintf(row->parameter, sizeof row->parameter, "aspect ratio %g", row->value);
}

/* ------------------------------------------------------------------------------------ */

/* far: how far from the origin, m. */
static enum cb_status run(const char *sweep, size_t rows, size_t same, double far,
                          void (*fill)(size_t n, size_t variation, double *X), cb_row_name_fn *name,
                          struct cb_extremes *all) {
  struct cb_cases c;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status =
      rng ? cb_cases_create(rows * same, false, &c) : cb_fail_memory("the sweep of shapes");
  if (!status) {
    gsl_rng_set(rng, all->seed);
    for (size_t n = 0; n < c.count; n++) {
      double *X = c.X + 12 * n, *x = c.x + 12 * n;
      fill(n / same, n % same, X);
      turn(rng, X);
      deform(rng, X, x);
      for (int i = 0; i < 12; i++) X[i] += far / (1 + i % 3), x[i] += far / (1 + i % 3);
    }
    status = cb_cases_sweep(sweep, &c, same, name, &far, all);
    cb_cases_free(&c);
  }
  if (rng) gsl_rng_free(rng);
  return status;
}

/* ---- offset ------------------------------------------------------------------------- */

enum { FROM = 3, TO = 9 };

static void offset_fill(size_t n, size_t variation, double *X) {
  (void)n, (void)variation;
  memcpy(X, regular, sizeof regular);
}

static void offset_name(const void *context, size_t n, struct cb_extreme *row) {
  (void)n;
  row->value = *(const double *)context;
  snprintf(row->parameter, sizeof row->parameter, "offset by %g of the size", row->value);
  if (!row->note[0])
    snprintf(row->note, sizeof row->note, "positions themselves are rounded by %.1g of the size",
             row->value * row->variant->arithmetic->roundoff);
}

/* Each by itself: kernels may take the middle of the mesh for the origin. */
static enum cb_status offset_run(struct cb_extremes *all) {
  enum cb_status status = CB_OK;
  for (int power = FROM; !status && power <= TO; power++)
    status = run("offset", 1, TRIALS, pow(10, power), offset_fill, offset_name, all);
  return status;
}
const struct cb_sweep cb_sweep_offset = {"offset", "1e3 to 1e9 of its size away from the origin",
                                         offset_run};

/* ------------------------------------------------------------------------------------ */

#define SWEEP(ID, ROWS, SAME, SUMMARY)                                                             \
  static enum cb_status ID##_run(struct cb_extremes *all) {                                        \
    return run(#ID, ROWS, SAME, 0, ID##_fill, ID##_name, all);                                     \
  }                                                                                                \
  const struct cb_sweep cb_sweep_##ID = {#ID, SUMMARY, ID##_run};
SWEEP(sliver, ANGLES, SLIVERS *TRIALS, "dihedral angles down to 0.01 degrees")
SWEEP(aspect, RATIOS, FORMS *TRIALS, "needles and plates of up to 1e6 : 1")
