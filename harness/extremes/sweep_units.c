/* sweep_units.c - the same scene in other units of length, stiffness and mass: forces and
 * products, and one implicit step, in which all three meet.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/extremes/report.h"
#include "harness/progress.h"

enum { SCALES = 12, ELEMENTS = 4, ITERATIONS = 5, TRIALS = 2 };
enum unit { LENGTH, STIFFNESS, MASS, UNITS };
static const char *const unit_name[UNITS] = {"length", "stiffness", "mass"};

/* 0.1, 10, 0.01 ... 1e6 */
static double scale_of(size_t n) {
  const double power = (double)(1 + n / 2);
  return pow(10, n % 2 ? power : -power);
}

struct scaled {
  enum unit unit;
  double scale;
};

static void name(const void *context, size_t n, struct cb_extreme *row) {
  const struct scaled *s = context;
  (void)n;
  row->value = s->scale;
  snprintf(row->parameter, sizeof row->parameter, "%s times %g", unit_name[s->unit], s->scale);
}

static enum cb_status shapes(unsigned long seed, const struct scaled *s, struct cb_cases *c) {
  static const double X[12] = {0, 0, 0, 1, 0.1, 0, 0.2, 0.9, 0.1, 0.1, 0.2, 1.1};
  const double length = s->unit == LENGTH ? s->scale : 1;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status =
      rng ? cb_cases_create(ELEMENTS, false, c) : cb_fail_memory("the sweep of units");
  if (!status) {
    gsl_rng_set(rng, seed);
    for (size_t i = 0; i < 12 * ELEMENTS; i++) {
      c->X[i] = length * X[i % 12];
      c->x[i] = length * (X[i % 12] + gsl_ran_gaussian(rng, 0.15));
    }
    if (s->unit == STIFFNESS) c->young *= s->scale;
  }
  if (rng) gsl_rng_free(rng);
  return status;
}

/* ---- one step ----------------------------------------------------------------------- */

/* dv[12 * ELEMENTS] of the first step from rest at x. As long as waves need through the
 * element: then mass and stiffness weigh the same in any unit. */
static enum cb_status step(const struct cb_variant *v, const struct cb_cases *c,
                           const struct scaled *s, double *dv) {
  const struct cb_arithmetic *a = v->arithmetic;
  const double density = 1000 * (s->unit == MASS ? s->scale : 1);
  const double length = s->unit == LENGTH ? s->scale : 1;
  const struct cb_step_parameters p = {.h = length * sqrt(density / c->young),
                                       .iterations = ITERATIONS};
  const size_t bytes = (4 * ELEMENTS * a->stride * a->scalar_bytes / 64 + 2) * 64;
  uint32_t tet[4 * ELEMENTS];
  uint8_t fixed[4 * ELEMENTS] = {0};
  double mass[4 * ELEMENTS], none[12 * ELEMENTS] = {0};
  struct cb_mesh mesh = {4 * ELEMENTS, ELEMENTS, c->X, tet, 1};
  struct cb_material m;
  struct cb_operator *op = NULL;
  struct cb_stepper *stepper = NULL;
  void *x = aligned_alloc(64, bytes), *velocity = aligned_alloc(64, bytes);
  for (uint32_t i = 0; i < 4 * ELEMENTS; i++) tet[i] = i;
  cb_mesh_mass(&mesh, density, mass);
  enum cb_status status = x && velocity ? CB_OK : CB_MEMORY;
  if (!status) status = cb_material_isotropic(c->young, 0.3, density, &m);
  if (!status) status = cb_operator_create(v, &mesh, &m, cb_step_scale(&p), 1, &op);
  if (!status) status = cb_stepper_create(op, &p, mass, fixed, &stepper);
  if (status) {
    cb_fail(status, "%s/%s/%s cannot take a step of the sweep of units", v->model->name,
            cb_storage_name[v->storage], a->name);
  } else {
    a->from_double(mesh.nodes, c->x, x);
    a->from_double(mesh.nodes, none, velocity);
    cb_stepper_step(stepper, x, velocity, NULL);
    a->to_double(mesh.nodes, cb_stepper_dv(stepper), dv);
    if (cb_stepper_ended(stepper).why == CB_ENDED_OVERFLOW) dv[0] = NAN; /* was kept out of dv */
  }
  cb_stepper_free(stepper);
  cb_operator_free(op);
  free(x), free(velocity);
  return status;
}

static double norm(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < 12 * ELEMENTS; i++) sum = hypot(sum, a[i] - (b ? b[i] : 0));
  return sum;
}

static void round_to(const struct cb_arithmetic *a, double moved, gsl_rng *rng, double length,
                     const struct cb_cases *from, struct cb_cases *to) {
  for (size_t i = 0; i < 12 * ELEMENTS; i++) {
    to->X[i] = a->scalar_bytes == sizeof(float) ? (float)from->X[i] : from->X[i];
    to->x[i] = a->scalar_bytes == sizeof(float) ? (float)from->x[i] : from->x[i];
    to->X[i] += length * gsl_ran_gaussian(rng, moved * a->roundoff);
    to->x[i] += length * gsl_ran_gaussian(rng, moved * a->roundoff);
  }
}

/* dv in quad, and what the arithmetic's rounding explains of an error: see cases.h. */
static enum cb_status exact_step(const struct cb_variant *v, const struct cb_cases *c,
                                 const struct scaled *s, unsigned long seed, double *dv,
                                 double *unit) {
  char counted_name[96];
  snprintf(counted_name, sizeof counted_name, "%s/ebe/counted", v->model->name);
  const struct cb_variant *counted = cb_variant_find(counted_name);
  struct cb_cases moved = {0};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status = CB_OK;
  *unit = NAN;
  if (!rng) return cb_fail_memory("the sweep of units");
  gsl_rng_set(rng, seed);
  if (counted) status = cb_cases_create(ELEMENTS, false, &moved);
  moved.young = c->young;
  for (int t = 0; counted && !status && t <= TRIALS; t++) {
    double other[12 * ELEMENTS];
    round_to(v->arithmetic, t ? 8 : 0, rng, s->unit == LENGTH ? s->scale : 1, c, &moved);
    status = step(counted, &moved, s, t ? other : dv);
    if (status) break;
    if (t) *unit = fmax(*unit, norm(other, dv) / 8 + v->arithmetic->roundoff * norm(dv, NULL));
  }
  gsl_rng_free(rng);
  cb_cases_free(&moved);
  return status;
}

static enum cb_status add_step(struct cb_extremes *all, const struct cb_variant *v,
                               const struct cb_cases *c, const struct scaled *s) {
  double dv[12 * ELEMENTS], exact[12 * ELEMENTS], unit;
  struct cb_extreme row = cb_extreme_blank("units", v);
  enum cb_status status = exact_step(v, c, s, all->seed, exact, &unit);
  if (!status) status = step(v, c, s, dv);
  if (status) return status;
  name(s, 0, &row);
  strncat(row.parameter, " in a step", sizeof row.parameter - strlen(row.parameter) - 1);
  row.finite = isfinite(norm(dv, NULL));
  if (row.finite) row.force_error = norm(dv, exact) / unit;
  return cb_extremes_add(all, &row);
}

static enum cb_status run_scale(struct cb_extremes *all, const void *context) {
  const struct scaled *s = context;
  struct cb_cases c;
  enum cb_status status = shapes(all->seed, s, &c);
  if (status) return status;
  if (s->unit != MASS) status = cb_cases_sweep("units", &c, ELEMENTS, name, s, all);
  for (size_t v = 0; !status && all->variants[v]; v++)
    status = add_step(all, all->variants[v], &c, s);
  cb_cases_free(&c);
  return status;
}

static enum cb_status run(struct cb_extremes *all) {
  enum cb_status status = CB_OK;
  for (size_t n = 0; !status && n < UNITS * SCALES; n++) {
    const struct scaled s = {(enum unit)(n % UNITS), scale_of(n / UNITS)};
    char key[64];
    snprintf(key, sizeof key, "units: %s times %g", unit_name[s.unit], s.scale);
    status = cb_extremes_part(all, key, run_scale, &s);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  return status;
}

const struct cb_sweep cb_sweep_units = {"units", "length, stiffness and mass times 1e-6 to 1e6",
                                        run};
