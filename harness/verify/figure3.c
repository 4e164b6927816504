/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/figure3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "reference/oracles.h"

/* Edge 0.1 m, E = 10 kPa, nu = 0.3, 1000 kg/m^3. The pull grows to 3 N in the
 * first quarter and stays. Symplectic Euler: no implicit operator and no damping
 * has a hand in the torque. */
static const double EDGE = 0.1, YOUNG = 1e4, POISSON = 0.3, DENSITY = 1000, PULL = 3;
static const double STEP = 1e-5;
enum { STEPS = 20000, STEPS_PER_ROW = 100 };

static const char *const models[] = {"qr-precomputed", "qr-updated", "qr-exact",
                                     "polar-higham-precomputed"};

struct body {
  double X[12], x[12], v[12], f[12], mass[4];
  struct cb_operator *op;
};

static enum cb_status body_make(const char *model, struct body *b) {
  static const double corner[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
  uint32_t tet[4] = {0, 2, 1, 3};
  char name[96];
  struct cb_material m;
  *b = (struct body){0};
  for (int i = 0; i < 12; i++) b->X[i] = b->x[i] = corner[i] * EDGE / sqrt(8);
  struct cb_mesh mesh = {4, 1, b->X, tet, 1};
  snprintf(name, sizeof name, "%s/ebe/f64", model);
  const struct cb_variant *v = cb_variant_find(name);
  if (!v) return cb_fail(CB_BROKEN, "the model %s of figure 3 is not in this program", model);
  cb_mesh_mass(&mesh, DENSITY, b->mass);
  enum cb_status status = cb_material_isotropic(YOUNG, POISSON, DENSITY, &m);
  if (!status) status = cb_operator_create(v, &mesh, &m, 1, 1, &b->op);
  return status == CB_MEMORY ? cb_fail_memory("figure 3") : status;
}

/* One step: elastic force, and a pair of forces along b-c, outwards: no net
 * force, no net torque. */
static void advance(struct body *b, double pull) {
  double d[3], length = 0;
  cb_operator_update(b->op, b->x, NULL, 1, b->f);
  for (int i = 0; i < 3; i++) d[i] = b->x[9 + i] - b->x[3 + i], length += d[i] * d[i];
  for (int i = 0; i < 3; i++) {
    b->f[9 + i] += pull * d[i] / sqrt(length);
    b->f[3 + i] -= pull * d[i] / sqrt(length);
  }
  for (int i = 0; i < 12; i++) {
    b->v[i] += STEP * b->f[i] / b->mass[i / 3];
    b->x[i] += STEP * b->v[i];
  }
}

static void add_cross(const double *r, const double *f, double *sum) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    sum[i] += r[j] * f[k] - r[k] * f[j];
  }
}

static double norm3(const double *a) { return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

struct state {
  double angle, torque, spin;
};

static enum cb_status observe(struct body *b, struct state *s) {
  double F[9] = {0}, R[9], c[3] = {0}, torque[3] = {0}, momentum[3] = {0}, size = 0, inertia = 0;
  for (int i = 0; i < 12; i++) c[i % 3] += b->x[i] / 4;
  cb_operator_update(b->op, b->x, NULL, 1, b->f);
  for (int n = 0; n < 12; n += 3) {
    double r[3], p[3];
    for (int i = 0; i < 3; i++) r[i] = b->x[n + i] - c[i], p[i] = b->mass[n / 3] * b->v[n + i];
    for (int i = 0; i < 3; i++) /* best fit of a regular rest shape: sum x X^T */
      for (int j = 0; j < 3; j++) F[3 * i + j] += r[i] * b->X[n + j];
    add_cross(r, b->f + n, torque);
    add_cross(r, p, momentum);
    size += norm3(r) * norm3(b->f + n);
    inertia += b->mass[n / 3] * norm3(r) * norm3(r) * 2 / 3;
  }
  enum cb_status status = cb_oracle_polar(F, R);
  if (status) return cb_fail(status, "figure 3 left the finite numbers");
  s->angle = cb_rotation_angle(R);
  s->torque = size > 0 ? norm3(torque) / size : 0;
  s->spin = norm3(momentum) / inertia;
  return CB_OK;
}

/* Rows of one model into table (NULL: none), the last state into *last. */
static enum cb_status run_model(const char *model, struct cb_table *table, struct state *last) {
  struct body b;
  enum cb_status status = body_make(model, &b);
  for (int n = 0; n <= STEPS && !status; n++) {
    if (n % STEPS_PER_ROW == 0) {
      status = observe(&b, last);
      if (!status && table) {
        cb_table_text(table, model);
        cb_table_number(table, n * STEP);
        cb_table_number(table, last->angle);
        cb_table_number(table, last->torque);
        cb_table_number(table, last->spin);
      }
      if (cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted in figure 3");
    }
    if (status) break;
    advance(&b, PULL * fmin(1, 4.0 * n / STEPS));
  }
  cb_operator_free(b.op);
  return status;
}

enum cb_status cb_figure3_run(struct cb_table **table) {
  struct state last;
  struct cb_table *t = cb_table_create("model,time_s,angle_rad,torque,spin_rad_s");
  enum cb_status status = t ? CB_OK : cb_fail_memory("figure 3");
  for (size_t i = 0; i < sizeof models / sizeof *models && !status; i++)
    status = run_model(models[i], t, &last);
  if (status)
    cb_table_free(t);
  else
    *table = t;
  return status;
}

enum cb_status cb_figure3_angle(const char *model, double *angle_rad) {
  struct state last;
  enum cb_status status = run_model(model, NULL, &last);
  if (!status) *angle_rad = last.angle;
  return status;
}
