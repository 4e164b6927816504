/* tangent_sweep.c - how far each model's operator is from the derivative of its force, from
 * strains of a millionth to strains of one: a test at one tiny strain says little.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/truth/truth.h"
#include "harness/verify/patches.h"
#include "harness/verify/probe.h"

enum { ELEMENTS = 200, DECADES = 6, PER_DECADE = 2 };

struct work {
  struct cb_patches patches;
  double *direction, *strain; /* [3*nodes] random: u, and displacements of strain one */
  double *x, *up, *down, *Ku;
};

static enum cb_status prepare(struct work *w, unsigned long seed) {
  const size_t numbers = 3 * w->patches.mesh.nodes;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  w->direction = malloc(6 * numbers * sizeof *w->direction);
  if (!rng || !w->direction) {
    gsl_rng_free(rng);
    return CB_MEMORY;
  }
  w->strain = w->direction + numbers, w->x = w->strain + numbers, w->up = w->x + numbers;
  w->down = w->up + numbers, w->Ku = w->down + numbers;
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < numbers; i++) {
    w->direction[i] = gsl_ran_gaussian(rng, w->patches.size);
    w->strain[i] = gsl_ran_gaussian(rng, w->patches.size / 3);
  }
  gsl_rng_free(rng);
  return CB_OK;
}

/* Largest |K u + (f(x + e u) - f(x - e u)) / 2 e| / |df| over the elements, in quad. */
static double worst_error(struct work *w, struct cb_probe *probe, double strain) {
  const struct cb_patches *p = &w->patches;
  const size_t numbers = 3 * p->mesh.nodes;
  const double e =
      0x1p-20; /* errors: e^2 of truncation, and rounding of the forces to double by e */
  double worst = 0;
  for (size_t i = 0; i < numbers; i++)
    w->x[i] = p->mesh.X[i] + strain * w->strain[i] + e * w->direction[i];
  cb_probe_force(probe, w->x, w->up);
  for (size_t i = 0; i < numbers; i++) w->x[i] -= 2 * e * w->direction[i];
  cb_probe_force(probe, w->x, w->down);
  for (size_t i = 0; i < numbers; i++) w->x[i] += e * w->direction[i];
  cb_probe_reset(probe);
  cb_probe_force(probe, w->x, w->Ku); /* the operator at x */
  cb_probe_product(probe, w->direction, w->Ku);
  for (size_t n = 0; n < p->count; n++) {
    double error = 0, size = 0;
    for (size_t i = 3 * n * p->nodes; i < 3 * (n + 1) * p->nodes; i++) {
      const double df = (w->up[i] - w->down[i]) / (2 * e);
      error += (w->Ku[i] + df) * (w->Ku[i] + df), size += df * df;
    }
    const double relative = sqrt(error / size);
    if (!(relative <= worst)) worst = relative;
  }
  return worst;
}

static enum cb_status sweep_model(struct work *w, const char *model, struct cb_table *t) {
  char name[96];
  struct cb_probe probe;
  struct cb_material m;
  snprintf(name, sizeof name, "%s/ebe/counted", model);
  enum cb_status status = cb_material_isotropic(1000, 0.3, 1000, &m);
  if (!status) status = cb_probe_open(cb_variant_find(name), &w->patches.mesh, &m, &probe);
  if (status) return status;
  for (int n = 0; n <= DECADES * PER_DECADE; n++) {
    const double strain = pow(10, (double)n / PER_DECADE - DECADES);
    cb_table_text(t, model);
    cb_table_number(t, strain);
    cb_table_number(t, worst_error(w, &probe, strain));
  }
  cb_probe_close(&probe);
  return CB_OK;
}

enum cb_status cb_tangent_sweep(const struct cb_options *options, struct cb_table **table) {
  static const char *const models[] = {"linear",      "green",         "qr-precomputed",
                                       "qr-updated",  "qr-exact",      "polar-closed-updated",
                                       "polar-exact", "polar-tangent", "polar-tangent-clamped"};
  const struct cb_truth asked = {.options = options};
  struct work w = {0};
  struct cb_table *t = cb_table_create("model,strain,error");
  enum cb_status status =
      t ? cb_patches_random(ELEMENTS, 1, 0, options->seed, &w.patches) : CB_MEMORY;
  if (!status) status = prepare(&w, options->seed);
  if (status == CB_MEMORY) cb_fail_memory("the sweep of tangents");
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++)
    if (cb_truth_asked(&asked, models[m])) status = sweep_model(&w, models[m], t);
  free(w.direction);
  cb_patches_free(&w.patches);
  if (status)
    cb_table_free(t);
  else
    *table = t;
  return status;
}
