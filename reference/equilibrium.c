/* equilibrium.c - see equilibrium.h.
 * Source: Nocedal & Wright 2006, section 3.4 (matrix made positive definite by a multiple
 *         of the identity); Crisfield 1991, section 9.2 (line search on the residual's part
 *         along the step).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/equilibrium.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reference/direct.h"
#include "reference/tangent.h"

struct solver {
  const struct cb_mesh *mesh;
  const uint8_t *fixed;
  const double *external;
  struct cb_operator *op; /* bcsr, f64: its node vectors are plain */
  struct cb_tangent *tangent;
  struct cb_direct *direct;
  const uint32_t *row_start, *column;
  double *blocks, *shift, *r, *dx, *trial;
  double reaction;
};

static void close_solver(struct solver *s) {
  cb_operator_free(s->op);
  cb_tangent_free(s->tangent);
  cb_direct_free(s->direct);
  free(s->blocks);
  free(s->shift);
  free(s->r);
  free(s->dx);
  free(s->trial);
}

static const struct cb_variant *variant(const char *model, const char *storage) {
  char name[96];
  snprintf(name, sizeof name, "%s/%s/f64", model, storage);
  return cb_variant_find(name);
}

static enum cb_status open_solver(const char *model, enum cb_newton_matrix matrix,
                                  const struct cb_mesh *mesh, const struct cb_material *material,
                                  struct solver *s) {
  const struct cb_variant *assembled = variant(model, "bcsr"), *single = variant(model, "ebe");
  if (!assembled || !single) return CB_INPUT;
  enum cb_status status = cb_operator_create(assembled, mesh, material, 1, 1, &s->op);
  if (!status && matrix == CB_NEWTON_TRUE)
    status = cb_tangent_create(single, mesh, material, &s->tangent);
  if (status) return status;
  cb_operator_pattern(s->op, &s->row_start, &s->column);
  s->blocks = malloc(9 * sizeof *s->blocks * s->row_start[mesh->nodes]);
  s->shift = malloc(mesh->nodes * sizeof *s->shift);
  s->r = malloc(3 * mesh->nodes * sizeof *s->r);
  s->dx = malloc(3 * mesh->nodes * sizeof *s->dx);
  s->trial = malloc(3 * mesh->nodes * sizeof *s->trial);
  if (!s->blocks || !s->shift || !s->r || !s->dx || !s->trial) return CB_MEMORY;
  return cb_direct_create(mesh->nodes, s->row_start, s->column, s->fixed, &s->direct);
}

/* r := f(x) + external, zero on fixed nodes; returns its length, NaN or infinity for a shape
 * that the model does not bear. Leaves the operator at x. s->reaction: on fixed nodes. */
static double residual(struct solver *s, const double *x) {
  double square = 0, held = 0;
  cb_operator_update(s->op, x, NULL, 1, s->r);
  for (size_t i = 0; i < 3 * s->mesh->nodes; i++) {
    if (s->external) s->r[i] += s->external[i];
    if (s->fixed[i / 3]) {
      held += s->r[i] * s->r[i];
      s->r[i] = 0;
    }
    square += s->r[i] * s->r[i];
  }
  s->reaction = sqrt(held);
  return sqrt(square);
}

static double largest_diagonal(const struct solver *s) {
  double most = 0;
  for (uint32_t i = 0; i < s->mesh->nodes; i++)
    for (size_t b = s->row_start[i]; b < s->row_start[i + 1]; b++)
      if (s->column[b] == i)
        for (size_t k = 0; k < 9; k += 4) most = fmax(most, s->blocks[9 * b + k]);
  return most;
}

/* dx := K^-1 r, K shifted until it has a factor. */
static enum cb_status direction(struct solver *s, const double *x, struct cb_newton *newton) {
  if (s->tangent)
    cb_tangent_blocks(s->tangent, x, s->row_start, s->column, s->blocks);
  else
    cb_operator_blocks(s->op, s->blocks);
  enum cb_status status = cb_direct_factor(s->direct, s->blocks, NULL);
  for (double part = 1e-4; status == CB_NUMERIC && part < 10; part *= 4) {
    const double shift = part * largest_diagonal(s);
    for (size_t i = 0; i < s->mesh->nodes; i++) s->shift[i] = shift;
    status = cb_direct_factor(s->direct, s->blocks, s->shift);
    newton->shifts++;
  }
  return status ? status : cb_direct_solve(s->direct, s->r, s->dx);
}

static double dot(size_t numbers, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < numbers; i++) sum += a[i] * b[i];
  return sum;
}

/* x := x + dx, or as much of it as brings the residual's part along dx down: of forces with
 * an energy, its slope. (The residual itself may grow: whoever bends a beam stretches it
 * first.) Returns the new residual's length, or NaN: none does. */
static double advance(struct solver *s, double *x, struct cb_newton *newton) {
  const size_t numbers = 3 * s->mesh->nodes;
  const double slope = fabs(dot(numbers, s->dx, s->r));
  for (double part = 1; part > 1e-3; part /= 2) {
    for (size_t i = 0; i < numbers; i++) s->trial[i] = x[i] + part * s->dx[i];
    const double after = residual(s, s->trial);
    if (fabs(dot(numbers, s->dx, s->r)) <= 0.8 * slope) {
      memcpy(x, s->trial, numbers * sizeof *x);
      return after;
    }
    newton->halved++;
  }
  return NAN;
}

static double length(size_t numbers, const double *v) {
  double square = 0;
  for (size_t i = 0; v && i < numbers; i++) square += v[i] * v[i];
  return sqrt(square);
}

static enum cb_status iterate(struct solver *s, double tolerance, double *x,
                              struct cb_newton *newton) {
  double r = residual(s, x), unit = length(3 * s->mesh->nodes, s->external);
  if (!(unit > 0)) unit = s->reaction > r ? s->reaction : r > 0 ? r : 1;
  for (newton->iterations = 0;; newton->iterations++) {
    newton->residual[newton->iterations] = r / unit;
    if (r / unit <= tolerance) return CB_OK;
    if (newton->iterations == CB_NEWTON_MOST) return CB_NUMERIC;
    enum cb_status status = direction(s, x, newton);
    if (status) return status;
    r = advance(s, x, newton);
    if (isnan(r)) return CB_NUMERIC;
  }
}

enum cb_status cb_equilibrium_solve(const char *model, enum cb_newton_matrix matrix,
                                    const struct cb_mesh *mesh, const struct cb_material *material,
                                    const uint8_t *fixed, const double *external, double tolerance,
                                    double *x, struct cb_newton *newton) {
  struct solver s = {.mesh = mesh, .fixed = fixed, .external = external};
  *newton = (struct cb_newton){0};
  enum cb_status status = open_solver(model, matrix, mesh, material, &s);
  if (!status) status = iterate(&s, tolerance, x, newton);
  close_solver(&s);
  return status;
}
