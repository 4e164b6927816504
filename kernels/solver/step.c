/* step.c - one implicit step: right-hand side, filtered conjugate gradients with
 * a fixed number of iterations, new velocities and positions.
 * Source: Baraff & Witkin 1998, section 5 (filtering: a fixed node's residual
 *         and search direction are zero, so it never moves); no preconditioner,
 *         as in the paper.
 * Trade:  stopped early, a free body with unequal masses drifts: the residual
 *         that is left has a sum. Masses as preconditioner would prevent it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "kernels/arithmetic.h"
#include "kernels/arithmetics.h"
#include "kernels/solver/stepper.h"

#define LENGTH(s) (STRIDE * (s)->nodes)

static void free_stepper(struct cb_stepper *s) {
  for (int i = 0; i < STEPPER_VECTORS; i++) free(s->vector[i]);
  free(s->mass);
  free(s->fixed);
  free(s);
}

static enum cb_status create(struct cb_operator *op, const struct cb_step_parameters *p,
                             const double *mass, const uint8_t *fixed, size_t nodes,
                             struct cb_stepper **out) {
  struct cb_stepper *s = calloc(1, sizeof *s);
  if (!s) return CB_MEMORY;
  s->op = op, s->parameters = *p, s->nodes = nodes;
  size_t bytes = (LENGTH(s) * sizeof(S) + 63) / 64 * 64 + 64;
  bool there = true;
  for (int i = 0; i < STEPPER_VECTORS; i++) {
    s->vector[i] = aligned_alloc(64, bytes);
    if (s->vector[i]) memset(s->vector[i], 0, bytes);
    there = there && s->vector[i];
  }
  s->mass = malloc(nodes * sizeof(S) + 1);
  s->fixed = calloc(nodes + 1, 1);
  if (!there || !s->mass || !s->fixed) {
    free_stepper(s);
    return CB_MEMORY;
  }
  s->bytes = STEPPER_VECTORS * bytes + nodes * (sizeof(S) + 1);
  for (size_t n = 0; n < nodes; n++) ((S *)s->mass)[n] = (S)mass[n];
  if (fixed) memcpy(s->fixed, fixed, nodes);
  *out = s;
  return CB_OK;
}

static void filter(const struct cb_stepper *s, S *v) {
  for (size_t n = 0; n < s->nodes; n++)
    if (s->fixed[n])
      for (size_t i = 0; i < STRIDE; i++) v[STRIDE * n + i] = 0;
}

/* b := h (f + f_ext) - c K v - h beta M v, zero on fixed nodes. */
static void right_side(struct cb_stepper *s, const void *x, const void *velocity,
                       const void *external) {
  S *b = s->vector[STEPPER_B];
  const S *v = velocity, *f = external, *m = s->mass;
  const S h = (S)s->parameters.h, drag = (S)(s->parameters.h * s->parameters.beta);
  cb_operator_update(s->op, x, v, s->parameters.h, b);
  if (f)
    for (size_t i = 0; i < LENGTH(s); i++) b[i] += h * f[i];
  if (drag != 0)
    for (size_t n = 0; n < s->nodes; n++)
      for (size_t i = 0; i < 3; i++) b[STRIDE * n + i] -= drag * m[n] * v[STRIDE * n + i];
  filter(s, b);
}

/* Sums are kept apart by coordinate, so that they do not wait for each other and
 * nodes are added as vectors; in double, for float too. */
struct sum {
  ACC part[STRIDE];
};

static inline ACC total(const struct sum *s) {
  ACC sum = s->part[0];
  for (int i = 1; i < STRIDE; i++) sum += s->part[i];
  return sum;
}

static ACC norm2(const struct cb_stepper *s, const S *restrict a) {
  struct sum sum = {{0}};
  for (size_t n = 0; n < LENGTH(s); n += STRIDE)
    for (size_t i = 0; i < STRIDE; i++) sum.part[i] += (ACC)a[n + i] * (ACC)a[n + i];
  return total(&sum);
}

/* y := filtered A p; returns p . y. */
static ACC apply(const struct cb_stepper *s, const S *restrict p, S *restrict y) {
  const S *restrict m = s->mass;
  const S factor = (S)(1 + s->parameters.h * s->parameters.beta);
  struct sum sum = {{0}};
  cb_operator_product(s->op, p, y);
  for (size_t n = 0; n < s->nodes; n++) {
    const S mass = factor * m[n], keep = s->fixed[n] ? (S)0 : (S)1;
    const S *restrict pn = p + STRIDE * n;
    S *restrict yn = y + STRIDE * n;
    for (size_t i = 0; i < STRIDE; i++) {
      yn[i] = keep * (yn[i] + mass * pn[i]);
      sum.part[i] += (ACC)pn[i] * (ACC)yn[i];
    }
  }
  return total(&sum);
}

/* dv += alpha p, r -= alpha y; returns r . r. */
static ACC descend(const struct cb_stepper *s, S alpha, const S *restrict p, const S *restrict y,
                   S *restrict dv, S *restrict r) {
  struct sum sum = {{0}};
  for (size_t n = 0; n < LENGTH(s); n += STRIDE)
    for (size_t i = n; i < n + STRIDE; i++) {
      dv[i] += alpha * p[i];
      r[i] -= alpha * y[i];
      sum.part[i - n] += (ACC)r[i] * (ACC)r[i];
    }
  return total(&sum);
}

/* Once the residual is gone to rounding, or p . A p underflows (float), the work
 * goes on with zero steps: every iteration costs the same, and no 0/0 arises. */
static void solve(struct cb_stepper *s) {
  S *restrict dv = s->vector[STEPPER_DV], *restrict r = s->vector[STEPPER_R];
  S *restrict p = s->vector[STEPPER_P], *restrict y = s->vector[STEPPER_Y];
  const S *restrict b = s->vector[STEPPER_B];
  for (size_t i = 0; i < LENGTH(s); i++) dv[i] = 0, r[i] = p[i] = b[i];
  const double roundoff = cb_operator_variant(s->op)->arithmetic->roundoff;
  ACC rr = norm2(s, r), enough = rr * (ACC)(roundoff * roundoff);
  for (size_t k = 0; k < s->parameters.iterations; k++) {
    const ACC py = apply(s, p, y);
    const int finished = !(rr > enough) || py == 0;
    const ACC next = descend(s, finished ? (S)0 : (S)(rr / py), p, y, dv, r);
    const S beta = finished ? (S)0 : (S)(next / rr);
    for (size_t i = 0; i < LENGTH(s); i++) p[i] = r[i] + beta * p[i];
    rr = next;
  }
}

static void advance(struct cb_stepper *s, void *positions, void *velocities) {
  S *restrict x = positions, *restrict v = velocities;
  const S *restrict dv = s->vector[STEPPER_DV];
  const S h = (S)s->parameters.h;
  for (size_t i = 0; i < LENGTH(s); i++) v[i] += dv[i];
  filter(s, v);
  for (size_t i = 0; i < LENGTH(s); i++) x[i] += h * v[i];
}

const struct cb_step_functions CB_NAME(cb_step) = {create, free_stepper, right_side, solve,
                                                   advance};
