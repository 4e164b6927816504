/* sweep_values.c - deformation gradients of any singular values, turns, and what is nearly
 * the identity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/verify/patches.h"

enum {
  SAME = 6, /* of each row: three along the axes, three anyhow; the six orders */
  PATTERNS = 4,
  DECADES = 6, /* 1e-12 to 1e12 by two, the mild ones first */
  SPREAD = PATTERNS * DECADES * 4,
  FIXED = 5,
  TURNS = 4 + 12,
  NEAR = 8,
  ROWS = FIXED + SPREAD + TURNS + NEAR
};

/* Powers of e of the three. */
static const int pattern[PATTERNS][3] = {{0, 0, 1}, {0, 1, 1}, {1, 1, 1}, {-1, 0, 1}};
static const double fixed_values[FIXED][3] = {
    {1, 1, 1}, {1, 1, 0}, {1, 0, 0}, {0, 0, 0}, {1, 1, -1}};

/* s[3] of row n < FIXED + SPREAD; returns what its axis says. */
static double values(size_t n, double s[3]) {
  if (n < FIXED) {
    for (int i = 0; i < 3; i++) s[i] = fixed_values[n][i];
    return fixed_values[n][2];
  }
  n -= FIXED;
  const size_t kind = n % PATTERNS, sign = n / PATTERNS % 2, small = n / PATTERNS / 2 % 2;
  const int power = 2 * (1 + (int)(n / PATTERNS / 4));
  for (int i = 0; i < 3; i++) s[i] = pow(10, (small ? -power : power) * pattern[kind][i]);
  if (sign) s[2] = -s[2];
  return pow(10, small ? -power : power);
}

/* Degrees of turn n. */
static double degrees(size_t n) {
  static const double exact[4] = {0, 90, 120, 180};
  return n < 4 ? exact[n] : 180 - pow(10, 4 - (double)n);
}

static void name(size_t n, struct cb_extreme *row) {
  double s[3];
  if (n < FIXED + SPREAD) {
    row->value = values(n, s);
    snprintf(row->parameter, sizeof row->parameter, "values %g %g %g", s[0], s[1], s[2]);
  } else if (n < FIXED + SPREAD + TURNS) {
    n -= FIXED + SPREAD;
    row->value = degrees(n);
    if (n < 4)
      snprintf(row->parameter, sizeof row->parameter, "turned by %g degrees", row->value);
    else
      snprintf(row->parameter, sizeof row->parameter, "turned by 180 - 1e-%zu degrees", n - 3);
  } else {
    n -= FIXED + SPREAD + TURNS;
    row->value = pow(10, -2 * (double)(n + 1));
    snprintf(row->parameter, sizeof row->parameter, "identity + %g", row->value);
  }
}

static void any_rotation(gsl_rng *rng, double angle, double *Q) {
  double u[3];
  for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(rng);
  cb_random_rotation(u, angle, Q);
}

/* F := U diag(s) V^T; along the axes for the first three, in other orders for each. */
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

/* About an axis for the first three: exact at right angles; about (1, 1, 1) at 120. */
static void turn(gsl_rng *rng, size_t n, size_t variation, double *F) {
  const double angle = degrees(n) * M_PI / 180;
  const double c = n == 1 ? 0 : cos(angle), s = n == 0 || n == 3 ? 0 : sin(angle);
  const size_t x = variation, y = (x + 1) % 3, z = (x + 2) % 3;
  if (variation >= 3) {
    any_rotation(rng, angle, F);
    return;
  }
  for (size_t i = 0; i < 9; i++) F[i] = i % 4 == 0 ? c : 0;
  if (n == 2) {
    F[0] = F[4] = F[8] = 0, F[2] = F[3] = F[7] = 1;
    return;
  }
  F[4 * x] = 1, F[3 * y + z] = -s, F[3 * z + y] = s;
}

static void fill(gsl_rng *rng, size_t row, size_t variation, double *F) {
  double s[3];
  if (row < FIXED + SPREAD) {
    values(row, s);
    of_values(rng, s, variation, F);
  } else if (row < FIXED + SPREAD + TURNS) {
    turn(rng, row - FIXED - SPREAD, variation, F);
  } else {
    const double e = pow(10, -2 * (double)(row - FIXED - SPREAD - TURNS + 1));
    for (int i = 0; i < 9; i++)
      F[i] = (i % 4 == 0) + (variation == 0   ? (i % 4 == 0) * e
                             : variation == 1 ? (i == 4) * e
                                              : gsl_ran_gaussian(rng, e));
  }
}

static enum cb_status run(struct cb_extremes *all) {
  struct cb_cases c;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status =
      rng ? cb_cases_create(ROWS * SAME, true, &c) : cb_fail_memory("the sweep of values");
  if (!status) {
    gsl_rng_set(rng, all->seed);
    for (size_t n = 0; n < c.count; n++) {
      double F[9];
      fill(rng, n / SAME, n % SAME, F);
      for (int i = 0; i < 9; i++) c.x[12 * n + 3 + (size_t)(i % 3 * 3 + i / 3)] = F[i];
    }
    status = cb_cases_sweep("values", &c, SAME, name, all);
    cb_cases_free(&c);
  }
  if (rng) gsl_rng_free(rng);
  return status;
}

const struct cb_sweep cb_sweep_values = {
    "values", "singular values 1e-12 to 1e12, turns, near the identity", run};
