/* sweep_materials.c - Poisson's ratio up to incompressible and down to -1, and a Young's
 * modulus of zero, on strongly deformed elements of any shape.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"

enum { SAME = 6 };
static const double DEFORMED = 0.15; /* of the edge, in each coordinate */

struct material {
  double young, poisson;
};
static const struct material materials[] = {{1000, 0},        {1000, 0.4},       {1000, 0.49},
                                            {1000, 0.499},    {1000, 0.4999},    {1000, 0.49999},
                                            {1000, 0.499999}, {1000, 0.4999999}, {1000, -0.5},
                                            {1000, -0.9},     {1000, -0.99},     {0, 0.3}};
enum { MATERIALS = sizeof materials / sizeof *materials };

static void name(const void *context, size_t n, struct cb_extreme *row) {
  const struct material *m = context;
  (void)n;
  row->value = m->young > 0 ? m->poisson : m->young;
  if (m->young > 0)
    snprintf(row->parameter, sizeof row->parameter, "Poisson's ratio %.7g", m->poisson);
  else
    snprintf(row->parameter, sizeof row->parameter, "Young's modulus 0");
}

static enum cb_status run(struct cb_extremes *all) {
  static const double X[12] = {0, 0, 0, 1, 0.1, 0, 0.2, 0.9, 0.1, 0.1, 0.2, 1.1};
  struct cb_cases c;
  enum cb_status status = cb_cases_create(SAME, false, &c);
  if (status) return status;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng) status = cb_fail_memory("the sweep of materials");
  if (rng) gsl_rng_set(rng, all->seed);
  for (size_t i = 0; rng && i < 12 * SAME; i++) {
    c.X[i] = X[i % 12];
    c.x[i] = X[i % 12] + gsl_ran_gaussian(rng, DEFORMED);
  }
  for (size_t n = 0; !status && n < MATERIALS; n++) {
    c.young = materials[n].young, c.poisson = materials[n].poisson;
    status = cb_cases_sweep("materials", &c, SAME, name, &materials[n], all);
  }
  if (rng) gsl_rng_free(rng);
  cb_cases_free(&c);
  return status;
}

const struct cb_sweep cb_sweep_materials = {
    "materials", "Poisson's ratio to 0.4999999 and -0.99, no stiffness", run};
