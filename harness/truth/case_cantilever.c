/* case_cantilever.c - a slender beam bent far by a force at its end, against the elastica.
 * Linear tetrahedra are too stiff in bending, by an error that falls with h^2; so what is
 * judged is how it falls, and where it would end (Richardson's extrapolation).
 * Source: Mattiasson 1981 (numbers), Bisshopp & Drucker 1945 (formulas).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/truth/beam.h"
#include "harness/truth/truth.h"
#include "reference/elastica.h"
#include "reference/equilibrium.h"

static const double WIDTH = 0.1, YOUNG = 1e6;
enum { WIDTHS = 10, LOADS = 3, MESHES = 3 };
static const size_t ACROSS[MESHES] = {2, 4, 6};
static const double RATIO = 1.5; /* of the cells of the last two */
static const double ALPHA[LOADS] = {0.2, 1, 5};

/* down[LOADS]: deflections of the tip, one load after the other; NaN from where no
 * equilibrium is found. */
static enum cb_status bend(const char *model, size_t across, double *down) {
  struct cb_beam beam = {0};
  struct cb_newton newton;
  const double inertia = pow(WIDTH, 4) / 12;
  enum cb_status status = cb_beam_create(WIDTH, WIDTHS, across, YOUNG, &beam);
  for (int n = 0; n < LOADS; n++) down[n] = NAN;
  for (int n = 0; !status && n < LOADS; n++) {
    double along;
    cb_beam_push(&beam, ALPHA[n] * YOUNG * inertia / (beam.length * beam.length));
    status = cb_equilibrium_solve(model, CB_NEWTON_USUAL, &beam.mesh, &beam.material, beam.fixed,
                                  beam.external, 1e-4, beam.x, &newton);
    if (status == CB_NUMERIC) { /* says the row */
      status = CB_OK;
      break;
    }
    if (status == CB_MEMORY) cb_fail_memory("the cantilever"); /* the solver says nothing */
    if (!status) cb_beam_tip(&beam, &along, &down[n]);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  cb_beam_free(&beam);
  return status;
}

enum cb_status cb_truth_cantilever(struct cb_truth *t) {
  static const char *const models[] = {"linear",     "green",    "qr-precomputed",
                                       "qr-updated", "qr-exact", "polar-closed-updated",
                                       "polar-exact"};
  enum cb_status status = CB_OK;
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++) {
    double down[MESHES][LOADS];
    if (!cb_truth_asked(t, models[m])) continue;
    for (int n = 0; !status && n < MESHES; n++) status = bend(models[m], ACROSS[n], down[n]);
    for (int n = 0; !status && n < LOADS; n++) {
      char name[CB_TRUTH_NAME];
      double shortening;
      snprintf(name, sizeof name, "cantilever, alpha %g, deflection / L", ALPHA[n]);
      struct cb_truth_row row = cb_truth_row(name, models[m], "Mattiasson 1981, elastica");
      status = cb_elastica_tip(ALPHA[n], &shortening, &row.exact);
      row.coarse = down[0][n], row.medium = down[1][n], row.fine = down[2][n];
      row.order = cb_truth_order(row.exact, row.medium, row.fine, RATIO);
      /* where an error of second order ends */
      row.judged = (row.fine + (row.fine - row.medium) / (RATIO * RATIO - 1)) / row.exact;
      /* within 2 %: the elastica does not shear (0.6 %: 0.6 (a / L)^2), and the coarse meshes are
       * not yet of second order */
      if (strcmp(models[m], "linear") != 0 && strcmp(models[m], "qr-precomputed") != 0)
        row.low = 0.98, row.high = 1.02;
      if (!status) status = cb_truth_add(t, &row);
    }
  }
  return status;
}
