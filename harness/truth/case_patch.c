/* case_patch.c - the patch test (Irons): under an affine displacement every element of
 * whatever mesh has the same F, so the forces on inner nodes must cancel. An element
 * whose frame depends on the order of its vertices gives each element a stress of its own,
 * unless the displacement is a rotation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/truth/truth.h"
#include "harness/verify/probe.h"

enum { CELLS = 4 };
static const double EDGE = 0.1;
static const double ROUNDING = 1e-11; /* of the largest force: a few hundred roundings, and the
                                         condition of the worst elements */

static const double STRETCH[9] = {1.3, 0.2, -0.1, 0.05, 0.8, 0.15, -0.2, 0.1, 1.1};
static const double TURN[9] = {0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6};

static bool inside(const double *X) {
  for (int k = 0; k < 3; k++)
    if (!(X[k] > 1e-9 && X[k] < CELLS * EDGE - 1e-9)) return false;
  return true;
}

/* Largest force on an inner node by the largest on any node, or (a rotation: all vanish) by
 * E A. */
static enum cb_status imbalance(const char *model, const struct cb_mesh *mesh, const double *F,
                                bool rotation, double *relative) {
  char name[96];
  struct cb_probe probe;
  struct cb_material m;
  snprintf(name, sizeof name, "%s/ebe/f64", model);
  double *x = malloc(6 * mesh->nodes * sizeof *x);
  if (!x) return cb_fail_memory("the patch");
  double *f = x + 3 * mesh->nodes;
  enum cb_status status = cb_material_isotropic(1000, 0.3, 1000, &m);
  if (!status) status = cb_probe_open(cb_variant_find(name), mesh, &m, &probe);
  if (!status) {
    double most = rotation ? 1000 * EDGE * EDGE : 0, inner = 0;
    for (size_t i = 0; i < 3 * mesh->nodes; i++) {
      const double *X = mesh->X + i / 3 * 3, *row = F + 3 * (i % 3);
      x[i] = row[0] * X[0] + row[1] * X[1] + row[2] * X[2];
    }
    cb_probe_force(&probe, x, f);
    for (size_t i = 0; i < mesh->nodes; i++) {
      const double size =
          sqrt(f[3 * i] * f[3 * i] + f[3 * i + 1] * f[3 * i + 1] + f[3 * i + 2] * f[3 * i + 2]);
      if (!rotation && !(size <= most)) most = size; /* NaN stays */
      if (inside(mesh->X + 3 * i) && !(size <= inner)) inner = size;
    }
    *relative = inner / most;
    cb_probe_close(&probe);
  }
  free(x);
  return status;
}

static bool has_order(const struct cb_model *m) { return m->laws[0] & CB_KEEPS(CB_LAW_ORDER); }

enum cb_status cb_truth_patch(struct cb_truth *t) {
  struct cb_mesh mesh = {0};
  enum cb_status status = cb_mesh_irregular(CELLS, CELLS, CELLS, EDGE, 2005, &mesh);
  for (const struct cb_model *const *m = cb_arithmetics[0]->models; !status && *m; m++)
    for (int turn = 0; !status && turn < 2; turn++) {
      if (!cb_truth_asked(t, (*m)->name)) continue;
      struct cb_truth_row row =
          cb_truth_row(turn ? "patch, rotation" : "patch, stretch", (*m)->name, "Irons 1966");
      status = imbalance((*m)->name, &mesh, turn ? TURN : STRETCH, turn, &row.fine);
      row.exact = 0, row.judged = row.fine;
      /* Who does not depend on the order of vertices must pass; of a rotation, who claims to be
       * rotated. The others are shown. */
      if (turn ? (*m)->laws[0] & CB_KEEPS(CB_LAW_ROTATION) : has_order(*m))
        row.low = 0, row.high = ROUNDING;
      if (!status) status = cb_truth_add(t, &row);
    }
  cb_mesh_free(&mesh);
  return status;
}
