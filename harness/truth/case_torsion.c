/* case_torsion.c - twisted bars of square section, and Saint-Venant's torsion constant
 *   J = a^4 (1/3 - (64/pi^5) sum over odd n of tanh(n pi/2) / n^5) = 0.1406 a^4.
 * Both ends are clamped, which stiffens them by the same amount whatever the length: the
 * difference of the compliances of two lengths is that of the part between.
 * Source: Timoshenko & Goodier 1970, section 109.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/truth/truth.h"
#include "harness/verify/probe.h"
#include "reference/equilibrium.h"

static const double WIDTH = 0.1, YOUNG = 1e5, POISSON = 0.3;
static const double ANGLE = 1e-3; /* rad: small, so that every law is the linear one */
enum { SHORT = 2, LONG = 4 };     /* lengths in widths */
static const size_t ACROSS[3] = {2, 3, 5};

static double torsion_constant(void) {
  double sum = 0;
  for (int n = 1; n < 200; n += 2) sum += tanh(n * M_PI / 2) / pow(n, 5);
  return pow(WIDTH, 4) * (1.0 / 3 - 64 / pow(M_PI, 5) * sum);
}

/* The torque that holds the end x+ at ANGLE about x. */
static enum cb_status hold(const char *model, size_t across, size_t widths, double *torque) {
  struct cb_mesh mesh = {0};
  struct cb_material m;
  struct cb_newton newton;
  struct cb_probe probe = {0};
  char name[96];
  double *x = NULL, *f;
  uint8_t *fixed = NULL;
  const double cell = WIDTH / (double)across, length = WIDTH * (double)widths;
  enum cb_status status = cb_mesh_grid(across * widths, across, across, cell, &mesh);
  if (!status) status = cb_material_isotropic(YOUNG, POISSON, 1, &m);
  if (status) goto done;
  x = malloc(6 * mesh.nodes * sizeof *x);
  fixed = calloc(mesh.nodes, 1);
  status = x && fixed ? CB_OK : cb_fail_memory("the bar");
  if (status) goto done;
  f = x + 3 * mesh.nodes;
  for (size_t i = 0; i < mesh.nodes; i++) { /* twisted evenly to begin with */
    const double *X = mesh.X + 3 * i, angle = ANGLE * X[0] / length;
    const double y = X[1] - WIDTH / 2, z = X[2] - WIDTH / 2;
    x[3 * i] = X[0];
    x[3 * i + 1] = WIDTH / 2 + cos(angle) * y - sin(angle) * z;
    x[3 * i + 2] = WIDTH / 2 + sin(angle) * y + cos(angle) * z;
    fixed[i] = X[0] < 1e-9 || X[0] > length - 1e-9;
  }
  status = cb_equilibrium_solve(model, CB_NEWTON_USUAL, &mesh, &m, fixed, NULL, 1e-7, x, &newton);
  if (status == CB_MEMORY) cb_fail_memory("the twisted bar"); /* the solver says nothing */
  if (status == CB_NUMERIC)
    status =
        cb_fail(status, "the twisted bar of %s has no equilibrium: %zu iterations, residual %.2g",
                model, newton.iterations, newton.residual[newton.iterations]);
  if (status) goto done;
  snprintf(name, sizeof name, "%s/ebe/f64", model);
  status = cb_probe_open(cb_variant_find(name), &mesh, &m, &probe);
  if (status) goto done;
  cb_probe_force(&probe, x, f);
  *torque = 0;
  for (size_t i = 0; i < mesh.nodes; i++)
    if (mesh.X[3 * i] > length - 1e-9)
      *torque -=
          (x[3 * i + 1] - WIDTH / 2) * f[3 * i + 2] - (x[3 * i + 2] - WIDTH / 2) * f[3 * i + 1];
done:
  cb_probe_close(&probe);
  free(x);
  free(fixed);
  cb_mesh_free(&mesh);
  return status;
}

enum cb_status cb_truth_torsion(struct cb_truth *t) {
  static const char *const models[] = {"linear",   "green",       "qr-updated",
                                       "qr-exact", "polar-exact", "svd-updated"};
  const double shear = YOUNG / (2 * (1 + POISSON)), J = torsion_constant();
  enum cb_status status = CB_OK;
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++) {
    if (!cb_truth_asked(t, models[m])) continue;
    struct cb_truth_row row =
        cb_truth_row("torsion constant J / a^4", models[m], "Timoshenko & Goodier 1970");
    double *values[3] = {&row.coarse, &row.medium, &row.fine};
    for (size_t n = 0; !status && n < 3; n++) {
      double shorter = NAN, longer = NAN;
      status = hold(models[m], ACROSS[n], SHORT, &shorter);
      if (!status) status = hold(models[m], ACROSS[n], LONG, &longer);
      *values[n] =
          (LONG - SHORT) * WIDTH / (shear * ANGLE) / (1 / longer - 1 / shorter) / pow(WIDTH, 4);
    }
    row.exact = J / pow(WIDTH, 4);
    row.order = cb_truth_order(row.exact, row.medium, row.fine, 5.0 / 3);
    row.judged = row.order, row.low = 1.7, row.high = 2.3;
    if (!status) status = cb_truth_add(t, &row);
  }
  return status;
}
