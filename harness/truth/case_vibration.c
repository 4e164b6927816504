/* case_vibration.c - a bar that vibrates lengthwise, held at one end, nu = 0:
 *   omega = pi/(2 L) sqrt(E / density),
 * and a period of 2 pi h / atan(omega h) where backward Euler takes steps h, as each turns
 * the phase of 1 / (1 - i omega h). The eigenvalue of mass and stiffness comes from inverse
 * iteration, the period from the implicit step itself.
 * Source: Rayleigh, The theory of sound; Golub & Van Loan, section 8.2.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/truth/truth.h"
#include "reference/direct.h"

static const double LENGTH = 0.4, WIDTH = 0.1, YOUNG = 1e5, DENSITY = 1000;
static const double AMPLITUDE = 1e-4; /* m: a strain of 4e-4 at the held end */
static const size_t ALONG[3] = {4, 8, 16};
enum { STEPS = 400 }; /* in a period */
enum {
  ITERATIONS = 4
}; /* of which each makes rounding 38 times more of a bending mode, and a
      ninth of the next mode lengthwise */

struct bar {
  struct cb_mesh mesh;
  struct cb_material material;
  struct cb_operator *op;
  struct cb_direct *direct;
  const uint32_t *row_start, *column;
  double *mass, *blocks, *x, *v, *dv;
  uint8_t *fixed;
};

static void close_bar(struct bar *b) {
  cb_operator_free(b->op);
  cb_direct_free(b->direct);
  cb_mesh_free(&b->mesh);
  free(b->mass);
  free(b->blocks);
  free(b->x);
  free(b->v);
  free(b->dv);
  free(b->fixed);
}

static double mode(const double *X) { return AMPLITUDE * sin(M_PI / 2 * X[0] / LENGTH); }

/* c: of the operator; the bar is in its mode, at rest. */
static enum cb_status open_bar(const char *model, size_t along, double c, struct bar *b) {
  char name[96];
  const double cell = LENGTH / (double)along;
  const size_t across = (size_t)round(WIDTH / cell);
  snprintf(name, sizeof name, "%s/bcsr/f64", model);
  *b = (struct bar){0};
  enum cb_status status = cb_mesh_grid(along, across, across, cell, &b->mesh);
  if (!status) status = cb_material_isotropic(YOUNG, 0, DENSITY, &b->material);
  if (status) return status;
  const size_t nodes = b->mesh.nodes;
  status = cb_operator_create(cb_variant_find(name), &b->mesh, &b->material, c, 1, &b->op);
  if (status) return status;
  cb_operator_pattern(b->op, &b->row_start, &b->column);
  b->mass = malloc(nodes * sizeof *b->mass);
  b->blocks = malloc(9 * sizeof *b->blocks * b->row_start[nodes]);
  b->x = malloc(3 * nodes * sizeof *b->x);
  b->v = calloc(nodes, 3 * sizeof *b->v);
  b->dv = malloc(3 * nodes * sizeof *b->dv);
  b->fixed = malloc(nodes);
  if (!b->mass || !b->blocks || !b->x || !b->v || !b->dv || !b->fixed)
    return cb_fail_memory("the bar");
  cb_mesh_mass(&b->mesh, DENSITY, b->mass);
  for (size_t i = 0; i < nodes; i++) {
    memcpy(b->x + 3 * i, b->mesh.X + 3 * i, 3 * sizeof *b->x);
    b->x[3 * i] += mode(b->mesh.X + 3 * i);
    b->fixed[i] = b->mesh.X[3 * i] < 1e-9;
  }
  status = cb_direct_create(nodes, b->row_start, b->column, b->fixed, &b->direct);
  return status;
}

/* Kernels and solver say nothing. */
static enum cb_status explained(enum cb_status status, const char *model) {
  if (status == CB_MEMORY) return cb_fail_memory("the vibrating bar");
  return status ? cb_fail(status, "%s cannot vibrate", model) : CB_OK;
}

/* omega by inverse iteration from the mode, K at the rest shape. */
static enum cb_status eigenvalue(size_t along, double *omega) {
  struct bar b;
  enum cb_status status = open_bar("linear", along, 1, &b);
  if (!status) {
    cb_operator_update(b.op, b.mesh.X, NULL, 1, b.dv);
    cb_operator_blocks(b.op, b.blocks);
    status = cb_direct_factor(b.direct, b.blocks, NULL);
  }
  double *u = b.v, *Mu = b.dv;
  for (size_t i = 0; !status && i < b.mesh.nodes; i++) u[3 * i] = mode(b.mesh.X + 3 * i);
  for (int n = 0; !status && n < ITERATIONS; n++) {
    double uMu = 0, uKu = 0;
    for (size_t i = 0; i < 3 * b.mesh.nodes; i++) Mu[i] = b.mass[i / 3] * u[i];
    status = cb_direct_solve(b.direct, Mu, u); /* u := K^-1 M u: u K u = u M u of before */
    for (size_t i = 0; i < 3 * b.mesh.nodes; i++)
      uKu += u[i] * Mu[i], uMu += b.mass[i / 3] * u[i] * u[i];
    *omega = sqrt(uKu / uMu);
    for (size_t i = 0; i < 3 * b.mesh.nodes; i++) u[i] /= sqrt(uMu);
  }
  close_bar(&b);
  return explained(status, "linear");
}

/* Mean displacement of the free end, along the bar. */
static double end(const struct bar *b) {
  double sum = 0, count = 0;
  for (size_t i = 0; i < b->mesh.nodes; i++)
    if (b->mesh.X[3 * i] > LENGTH - 1e-9) sum += b->x[3 * i] - b->mesh.X[3 * i], count++;
  return sum / count;
}

/* Twice the time from one passage through rest to the next, by the implicit step solved
 * directly, so that nothing but the step is in it. */
static enum cb_status period(const char *model, size_t along, double h, double *seconds) {
  struct bar b;
  double passage[2] = {NAN, NAN};
  int passed = 0;
  enum cb_status status = open_bar(model, along, h * h, &b);
  for (int n = 0; !status && passed < 2 && n < 2 * STEPS; n++) {
    const double before = end(&b);
    cb_operator_update(b.op, b.x, b.v, h, b.dv); /* h f - c K v */
    cb_operator_blocks(b.op, b.blocks);
    status = cb_direct_factor(b.direct, b.blocks, b.mass);
    if (!status) status = cb_direct_solve(b.direct, b.dv, b.dv);
    if (status) break;
    for (size_t i = 0; i < 3 * b.mesh.nodes; i++) b.v[i] += b.dv[i], b.x[i] += h * b.v[i];
    const double after = end(&b);
    if (before * after < 0) passage[passed++] = h * (n + before / (before - after));
  }
  *seconds = 2 * (passage[1] - passage[0]);
  close_bar(&b);
  return explained(status, model);
}

enum cb_status cb_truth_vibration(struct cb_truth *t) {
  static const char *const models[] = {"linear",      "green",       "qr-precomputed",
                                       "qr-updated",  "qr-exact",    "polar-closed-updated",
                                       "polar-exact", "svd-updated", "polar-tangent"};
  const double omega = M_PI / (2 * LENGTH) * sqrt(YOUNG / DENSITY);
  const double h = 2 * M_PI / omega / STEPS;
  enum cb_status status = CB_OK;
  if (cb_truth_asked(t, "linear")) {
    struct cb_truth_row row =
        cb_truth_row("vibration lengthwise, eigenvalue, rad/s", "linear", "Rayleigh 1877");
    double *values[3] = {&row.coarse, &row.medium, &row.fine};
    for (size_t n = 0; !status && n < 3; n++) status = eigenvalue(ALONG[n], values[n]);
    row.exact = omega;
    row.judged = row.order = cb_truth_order(omega, row.medium, row.fine, 2);
    row.low = 1.85, row.high = 2.15;
    if (!status) status = cb_truth_add(t, &row);
  }
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++) {
    if (!cb_truth_asked(t, models[m])) continue;
    struct cb_truth_row row =
        cb_truth_row("vibration lengthwise, period, s", models[m], "Rayleigh 1877, backward Euler");
    status = period(models[m], ALONG[0], h, &row.coarse);
    if (!status) status = period(models[m], ALONG[1], h, &row.medium);
    row.exact = 2 * M_PI * h / atan(omega * h);
    row.judged = row.order = cb_truth_order(row.exact, row.coarse, row.medium, 2);
    row.low = 1.85, row.high = 2.15;
    if (!status) status = cb_truth_add(t, &row);
  }
  return status;
}
