/* case_spin.c - a free body that spins and flies, 10 000 steps: momentum stays, whatever the
 * step; angular momentum and energy are what the implicit step takes, and a ghost torque adds.
 * The columns are 100, 1000 and 10 000 steps.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/progress.h"
#include "harness/truth/truth.h"
#include "reference/energy.h"

enum { LOOKS = 3 };
static const size_t AT[LOOKS] = {100, 1000, 10000};
static const double SPIN[3] = {1, 2, 10};      /* rad/s */
static const double VELOCITY[3] = {0.3, 0, 0}; /* m/s */

struct flight {
  double momentum[LOOKS], angular[LOOKS], energy[LOOKS]; /* of those at the start; momentum: what
                                                            is gone */
};

struct state {
  struct cb_mesh mesh;
  struct cb_material material;
  double *mass, *x, *v;
};

static void totals(const struct state *s, double *momentum, double *angular, double *energy) {
  double c[3] = {0}, all = 0;
  memset(momentum, 0, 3 * sizeof *momentum);
  memset(angular, 0, 3 * sizeof *angular);
  for (size_t i = 0; i < s->mesh.nodes; i++) {
    all += s->mass[i];
    for (int k = 0; k < 3; k++) {
      momentum[k] += s->mass[i] * s->v[3 * i + k];
      c[k] += s->mass[i] * s->x[3 * i + k];
    }
  }
  *energy = cb_elastic_energy(&s->mesh, &s->material, s->x, NULL);
  for (size_t i = 0; i < s->mesh.nodes; i++) {
    const double *v = s->v + 3 * i;
    double r[3];
    for (int k = 0; k < 3; k++) r[k] = s->x[3 * i + k] - c[k] / all;
    for (int k = 0; k < 3; k++) {
      angular[k] +=
          s->mass[i] * (r[(k + 1) % 3] * v[(k + 2) % 3] - r[(k + 2) % 3] * v[(k + 1) % 3]);
      *energy += s->mass[i] / 2 * v[k] * v[k];
    }
  }
}

static double norm(const double *a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

static enum cb_status launch(struct state *s) {
  enum cb_status status = cb_mesh_grid(2, 2, 3, 0.05, &s->mesh);
  if (!status) status = cb_material_isotropic(1e5, 0.3, 1000, &s->material);
  if (status) return status;
  s->mass = malloc(s->mesh.nodes * sizeof *s->mass);
  s->x = malloc(3 * s->mesh.nodes * sizeof *s->x);
  s->v = malloc(3 * s->mesh.nodes * sizeof *s->v);
  if (!s->mass || !s->x || !s->v) return cb_fail_memory("the flight");
  cb_mesh_mass(&s->mesh, s->material.density, s->mass);
  for (size_t i = 0; i < s->mesh.nodes; i++)
    for (int k = 0; k < 3; k++) {
      const double *X = s->mesh.X + 3 * i;
      const double r[3] = {X[0] - 0.05, X[1] - 0.05, X[2] - 0.075};
      s->x[3 * i + k] = X[k];
      s->v[3 * i + k] =
          VELOCITY[k] + SPIN[(k + 1) % 3] * r[(k + 2) % 3] - SPIN[(k + 2) % 3] * r[(k + 1) % 3];
    }
  return CB_OK;
}

static enum cb_status fly(const char *model, struct flight *f) {
  const struct cb_step_parameters step = {.h = 1e-3, .iterations = 30};
  struct state s = {0};
  struct cb_operator *op = NULL;
  struct cb_stepper *stepper = NULL;
  double p0[3], l0[3], e0, p[3], l[3], e;
  char name[96];
  snprintf(name, sizeof name, "%s/ebe/f64", model);
  enum cb_status status = launch(&s);
  if (!status)
    status = cb_operator_create(cb_variant_find(name), &s.mesh, &s.material, cb_step_scale(&step),
                                1, &op);
  if (!status) status = cb_stepper_create(op, &step, s.mass, NULL, &stepper);
  if (status == CB_MEMORY) cb_fail_memory("the flight"); /* kernels say nothing */
  if (!status) totals(&s, p0, l0, &e0);
  for (size_t n = 1, look = 0; !status && look < LOOKS; n++) {
    cb_stepper_step(stepper, s.x, s.v, NULL);
    /* kept out of the body, which would fly on with every momentum it had */
    if (cb_stepper_ended(stepper).why == CB_ENDED_OVERFLOW) s.v[0] = NAN;
    if (n == AT[look]) {
      totals(&s, p, l, &e);
      const double lost[3] = {p[0] - p0[0], p[1] - p0[1], p[2] - p0[2]};
      f->momentum[look] = norm(lost) / norm(p0);
      f->angular[look] = norm(l) / norm(l0);
      f->energy[look++] = e / e0;
    }
    if (n % 1000 == 0 && cb_interrupted())
      status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  cb_stepper_free(stepper);
  cb_operator_free(op);
  cb_mesh_free(&s.mesh);
  free(s.mass);
  free(s.x);
  free(s.v);
  return status;
}

static enum cb_status add(struct cb_truth *t, const char *what, const char *model, double exact,
                          const double *values, double low, double high) {
  struct cb_truth_row row = cb_truth_row(what, model, "conservation");
  row.exact = exact;
  row.coarse = values[0], row.medium = values[1], row.fine = row.judged = values[2];
  row.low = low, row.high = high;
  return cb_truth_add(t, &row);
}

enum cb_status cb_truth_spin(struct cb_truth *t) {
  static const char *const models[] = {"linear",
                                       "green",
                                       "node-warp",
                                       "qr-precomputed",
                                       "qr-updated",
                                       "qr-exact",
                                       "polar-closed-updated",
                                       "polar-exact",
                                       "polar-quaternion-precomputed",
                                       "svd-updated"};
  enum cb_status status = CB_OK;
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++) {
    struct flight f;
    if (!cb_truth_asked(t, models[m])) continue;
    status = fly(models[m], &f);
    if (status) break;
    char name[96];
    snprintf(name, sizeof name, "%s/ebe/f64", models[m]);
    const unsigned laws = cb_variant_find(name)->model->laws[0];
    const bool newton = laws & CB_KEEPS(CB_LAW_NEWTON);
    status = add(t, "flight, momentum gone", models[m], 0, f.momentum, newton ? 0 : NAN, 1e-9);
    /* shown: what backward Euler and a ghost torque take or add */
    if (!status)
      status = add(t, "flight, angular momentum left", models[m], 1, f.angular, NAN, NAN);
    if (!status) status = add(t, "flight, energy left", models[m], 1, f.energy, NAN, NAN);
  }
  return status;
}
