/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/gate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/verify/laws.h"
#include "harness/verify/probe.h"

/* The same model in quad, by its plainest storage. */
static const struct cb_variant *oracle(const struct cb_variant *v) {
  for (const struct cb_variant *q = cb_variants(NULL); q->model; q++)
    if (q->storage == CB_EBE && strcmp(q->arithmetic->name, "counted") == 0 &&
        strcmp(q->model->name, v->model->name) == 0)
      return q;
  return NULL;
}

static enum cb_status open_and_run(const struct cb_variant *v, const struct cb_patches *p,
                                   const struct cb_material *m, double *f, double *Ku) {
  struct cb_probe probe;
  enum cb_status status = cb_probe_open(v, &p->mesh, m, &probe);
  if (status) return status;
  cb_probe_force(&probe, p->before, f);
  cb_probe_force(&probe, p->x, f);
  cb_probe_product(&probe, p->before, Ku);
  cb_probe_close(&probe);
  return CB_OK;
}

static double worst_difference(const struct cb_patches *p, const double *a, const double *b) {
  double worst = 0;
  for (size_t n = 0; n < p->count; n++) {
    double d = 0, s = 0;
    for (size_t i = 3 * n * p->nodes; i < 3 * (n + 1) * p->nodes; i++)
      d += (a[i] - b[i]) * (a[i] - b[i]), s += b[i] * b[i];
    worst = cb_worst(worst, sqrt(d / s));
  }
  return worst;
}

static enum cb_status check_accuracy(const struct cb_variant *v, const struct cb_patches *p,
                                     const struct cb_material *m, double limit, char reason[160]) {
  size_t length = 3 * p->mesh.nodes;
  double *f = calloc(4 * length, sizeof *f);
  if (!f) return cb_fail_memory("the verification");
  enum cb_status status = open_and_run(v, p, m, f, f + length);
  if (!status) status = open_and_run(oracle(v), p, m, f + 2 * length, f + 3 * length);
  if (!status) {
    double force = worst_difference(p, f, f + 2 * length);
    double product = worst_difference(p, f + length, f + 3 * length);
    if (!(force <= limit) || !(product <= limit)) {
      snprintf(reason, 160, "differs from quad precision: force by %.2g, product by %.2g", force,
               product);
      status = CB_BROKEN;
    }
  }
  free(f);
  return status;
}

enum cb_status cb_gate(const struct cb_variant *variant, char reason[160]) {
  struct cb_patches p;
  struct cb_material m;
  struct cb_law_value values[CB_LAWS];
  double limit = cb_law_limit(variant->arithmetic);
  unsigned claimed = variant->model->laws[0];
  enum cb_status status = cb_material_isotropic(1e5, 0.4, 1000, &m);
  if (!status) status = cb_patches_random(20, variant->model->node_frames ? 2 : 1, 0.3, 7, &p);
  if (status) return status;
  status = cb_laws_measure(variant, &m, &p, claimed, values);
  for (int law = 0; law < CB_LAWS && !status; law++)
    if ((claimed & CB_KEEPS(law)) && !cb_law_kept(values[law].worst, limit)) {
      snprintf(reason, 160, "breaks a law that it claims: %s by %.2g", cb_law_name[law],
               values[law].worst);
      status = CB_BROKEN;
    }
  if (!status) status = check_accuracy(variant, &p, &m, limit, reason);
  cb_patches_free(&p);
  return status;
}
