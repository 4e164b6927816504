/* cases_reference.c - what quad precision makes of the elements, and how much of it
 * rounding their vertices moves.
 * Trade:  the condition is measured, not derived: the same for every model, force and
 *         operator, at twice the price of one run in quad precision.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/extremes/exact.h"

enum { TRIALS = 2 };
/* Positions in double have to tell the moved ones apart from the others. */
static const double moved_by = 8;
const double cb_well_conditioned = 1e-3;

static double norm(size_t n, const double *a) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum = hypot(sum, a[i]); /* squares would overflow */
  return sum;
}

static double longest(const double *x) {
  double size = 0;
  for (int i = 3; i < 12; i += 3) {
    const double e[3] = {x[i] - x[0], x[i + 1] - x[1], x[i + 2] - x[2]};
    size = fmax(size, norm(3, e));
  }
  return size;
}

typedef __float128 quad;

static quad magnitude(quad a) { return a < 0 ? -a : a; }

/* |edges| |cofactors| / |volume|, in quad: what a rounding of the edges is for the volume;
 * *triple: what one of each product in it is (cases.h). Infinite where the volume is 0. */
static double volume_condition(const double *x, double *triple) {
  quad e[9], volume = 0, products = 0;
  double edges[9], cofactors[9];
  for (int i = 0; i < 9; i++) edges[i] = (double)(e[i] = (quad)x[3 + i] - x[i % 3]);
  for (int i = 0; i < 9; i++) {
    const int a = (i / 3 + 1) % 3 * 3, b = (i / 3 + 2) % 3 * 3, c = (i + 1) % 3, d = (i + 2) % 3;
    const quad one = e[a + c] * e[b + d], other = e[a + d] * e[b + c];
    cofactors[i] = (double)(one - other);
    if (i >= 3) continue;
    volume += e[i] * (one - other);
    products += magnitude(e[i]) * (magnitude(one) + magnitude(other));
  }
  volume = magnitude(volume);
  *triple = volume == 0 ? HUGE_VAL : (double)(products / volume);
  return volume == 0 ? HUGE_VAL : norm(9, edges) * norm(9, cofactors) / (double)volume;
}

static void know_shape(const struct cb_variant *v, struct cb_reference *r, size_t n) {
  struct cb_known *k = &r->known[n];
  const double *x = r->cases.x + 12 * n;
  const enum cb_definition definition = cb_frame_definition(v->model);
  double at_rest;
  k->flat = !(volume_condition(x, &k->triple) * r->roundoff < cb_well_conditioned);
  k->lost = isinf(volume_condition(r->cases.X + 12 * n, &at_rest));
  if (!r->cases.unit || definition == CB_UNDEFINED) return;
  double F[9];
  for (int i = 0; i < 9; i++) F[i] = x[3 + i % 3 * 3 + i / 3];
  cb_frame_exact(definition, F, k->R, &k->condition);
  k->framed = k->condition * r->roundoff < cb_well_conditioned;
  k->jumps = !k->framed;
}

/* unit := a rounding of the answer, the least number, and what the moved answers moved by. */
static double unit(const struct cb_reference *r, const double *a, const double *moved,
                   size_t stride) {
  double most = 0;
  for (int t = 0; t < TRIALS; t++) {
    double d[12];
    for (int i = 0; i < 12; i++) d[i] = moved[(size_t)t * stride + (size_t)i] - a[i];
    const double far = norm(12, d) / moved_by;
    if (!(far <= most)) most = far;
  }
  return most + r->roundoff * norm(12, a) + r->least;
}

/* With a for the origin: far from it, double could not tell the moved positions apart. No
 * force changes by that. */
static void move(gsl_rng *rng, double roundoff, const struct cb_cases *from, struct cb_cases *to) {
  for (size_t n = 0; n < from->count; n++) {
    const double *x = from->x + 12 * n, *X = from->X + 12 * n;
    const double now = moved_by * roundoff * longest(x);
    const double rest = from->unit ? 0 : moved_by * roundoff * longest(X);
    for (size_t i = 0; i < 12; i++) {
      to->x[12 * n + i] = x[i] - x[i % 3] + gsl_ran_gaussian(rng, now);
      to->X[12 * n + i] = X[i] - X[i % 3] + gsl_ran_gaussian(rng, rest);
    }
  }
}

static enum cb_status run(const struct cb_variant *counted, const struct cb_cases *c,
                          const double *u, double *f, double *y) {
  struct cb_probe probe;
  enum cb_status status = cb_cases_open(counted, c, &probe);
  if (status) return status;
  cb_probe_force(&probe, c->x, f);
  cb_probe_product(&probe, u, y);
  cb_probe_close(&probe);
  return CB_OK;
}

static enum cb_status know_forces(const struct cb_variant *v, gsl_rng *rng,
                                  struct cb_reference *r) {
  const size_t count = r->cases.count, length = 12 * count;
  struct cb_cases moved = {0};
  char name[96];
  snprintf(name, sizeof name, "%s/ebe/counted", v->model->name);
  const struct cb_variant *counted = cb_variant_find(name);
  for (size_t n = 0; n < count; n++) r->known[n].f_unit = r->known[n].y_unit = NAN;
  if (!counted) return CB_OK;
  double *f = malloc(2 * (TRIALS + 1) * length * sizeof *f), *y = f + (TRIALS + 1) * length;
  enum cb_status status = f ? CB_OK : cb_fail_memory("the forces in quad precision");
  if (!status) status = cb_cases_create(count, r->cases.unit, &moved);
  moved.young = r->cases.young, moved.poisson = r->cases.poisson;
  if (!status) status = run(counted, &r->cases, r->u, f, y);
  for (size_t t = 1; !status && t <= TRIALS; t++) {
    move(rng, r->roundoff, &r->cases, &moved);
    status = run(counted, &moved, r->u, f + t * length, y + t * length);
  }
  for (size_t n = 0; !status && n < count; n++) {
    struct cb_known *k = &r->known[n];
    memcpy(k->f, f + 12 * n, sizeof k->f);
    memcpy(k->y, y + 12 * n, sizeof k->y);
    k->f_unit = unit(r, k->f, f + length + 12 * n, length);
    k->y_unit = unit(r, k->y, y + length + 12 * n, length);
  }
  cb_cases_free(&moved);
  free(f);
  return status;
}

enum cb_status cb_reference_create(const struct cb_variant *v, const struct cb_cases *cases,
                                   unsigned long seed, struct cb_reference *r) {
  const bool single = v->arithmetic->scalar_bytes == sizeof(float);
  struct cb_reference made = {.roundoff = v->arithmetic->roundoff,
                              .least = single ? FLT_MIN : DBL_MIN,
                              .most = single ? FLT_MAX : DBL_MAX,
                              .u = malloc(12 * cases->count * sizeof *made.u),
                              .known = calloc(cases->count, sizeof *made.known)};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  enum cb_status status = cb_cases_create(cases->count, cases->unit, &made.cases);
  if (!status && !(rng && made.u && made.known)) status = cb_fail_memory("the exact answers");
  if (status) goto done;
  gsl_rng_set(rng, seed);
  made.cases.young = cases->young, made.cases.poisson = cases->poisson;
  for (size_t i = 0; i < 12 * cases->count; i++) {
    made.cases.X[i] = single ? (float)cases->X[i] : cases->X[i];
    made.cases.x[i] = single ? (float)cases->x[i] : cases->x[i];
    made.u[i] = (float)gsl_ran_gaussian(rng, 1);
  }
  for (size_t n = 0; n < cases->count; n++) know_shape(v, &made, n);
  status = know_forces(v, rng, &made);
done:
  if (rng) gsl_rng_free(rng);
  if (status)
    cb_reference_free(&made);
  else
    *r = made;
  return status;
}

void cb_reference_free(struct cb_reference *r) {
  cb_cases_free(&r->cases);
  free(r->u);
  free(r->known);
  *r = (struct cb_reference){0};
}
