/* case_uniaxial.c - a bar stretched along x, free on its sides: the nominal stress of each
 * material law in closed form.
 *   linear strain of a frame (R = I here), rest B: P = E (s - 1)
 *   ... current B over the rest volume:            P = E (s - 1) t^2
 *   ... current B over the current volume:         P = E (s - 1) / s
 *   Green strain, St. Venant-Kirchhoff:            P = E s (s^2 - 1) / 2
 * with the lateral stretch t = 1 - nu (s - 1), or sqrt(1 - nu (s^2 - 1)).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/truth/truth.h"
#include "harness/verify/probe.h"

enum { CELLS = 2 };
static const double EDGE = 0.1, YOUNG = 1000, POISSON = 0.3;
static const double STRETCHES[3] = {0.7, 1.2, 1.6};
static const double ROUNDING = 1e-11;

static double lateral(const struct cb_model *m, double s) {
  return strcmp(m->name, "green") == 0 ? sqrt(1 - POISSON * (s * s - 1)) : 1 - POISSON * (s - 1);
}

static double nominal(const struct cb_model *m, double s) {
  const double t = lateral(m, s);
  if (strcmp(m->name, "green") == 0) return YOUNG * s * (s * s - 1) / 2;
  if (strstr(m->name, "-updated-volume")) return YOUNG * (s - 1) / s;
  if (strstr(m->name, "-updated") || strstr(m->name, "-lazy")) return YOUNG * (s - 1) * t * t;
  return YOUNG * (s - 1);
}

/* Nominal stress on the x+ face, and the largest force sideways by that on the face. */
static enum cb_status pull(const struct cb_model *m, const struct cb_mesh *mesh, double s,
                           double *stress, double *sideways) {
  char name[96];
  struct cb_probe probe;
  struct cb_material material;
  snprintf(name, sizeof name, "%s/ebe/f64", m->name);
  double *x = malloc(6 * mesh->nodes * sizeof *x);
  if (!x) return cb_fail_memory("the bar");
  double *f = x + 3 * mesh->nodes;
  enum cb_status status = cb_material_isotropic(YOUNG, POISSON, 1000, &material);
  if (!status) status = cb_probe_open(cb_variant_find(name), mesh, &material, &probe);
  if (!status) {
    double force = 0, most = 0;
    for (size_t i = 0; i < 3 * mesh->nodes; i++)
      x[i] = mesh->X[i] * (i % 3 == 0 ? s : lateral(m, s));
    cb_probe_force(&probe, x, f);
    for (size_t i = 0; i < mesh->nodes; i++) {
      if (mesh->X[3 * i] > (CELLS - 0.5) * EDGE) force -= f[3 * i];
      most = fmax(most, fmax(fabs(f[3 * i + 1]), fabs(f[3 * i + 2])));
    }
    *stress = force / (CELLS * EDGE * CELLS * EDGE);
    *sideways = most / fabs(force);
    cb_probe_close(&probe);
  }
  free(x);
  return status;
}

enum cb_status cb_truth_uniaxial(struct cb_truth *t) {
  struct cb_mesh mesh = {0};
  enum cb_status status = cb_mesh_grid(CELLS, CELLS, CELLS, EDGE, &mesh);
  for (const struct cb_model *const *m = cb_arithmetics[0]->models; !status && *m; m++)
    for (size_t n = 0; !status && n < 3; n++) {
      char what[CB_TRUTH_NAME];
      double sideways = NAN;
      if (!cb_truth_asked(t, (*m)->name)) continue;
      snprintf(what, sizeof what, "uniaxial stretch %.1f, Pa", STRETCHES[n]);
      struct cb_truth_row row = cb_truth_row(what, (*m)->name, "closed form of the law");
      status = pull(*m, &mesh, STRETCHES[n], &row.fine, &sideways);
      row.exact = nominal(*m, STRETCHES[n]);
      row.judged = fmax(fabs(row.fine / row.exact - 1), sideways);
      if (isnan(row.fine) || isnan(sideways)) row.judged = NAN;
      /* a frame that depends on the order of vertices is not I here: shown */
      if ((*m)->laws[0] & CB_KEEPS(CB_LAW_ORDER)) row.low = 0, row.high = ROUNDING;
      if (!status) status = cb_truth_add(t, &row);
    }
  cb_mesh_free(&mesh);
  return status;
}
