/* step.c - one implicit step: right-hand side, filtered conjugate gradients with
 * a fixed number of iterations, new velocities and positions.
 * Source: Baraff & Witkin 1998, section 5 (filtering: a fixed node's residual
 *         and search direction are zero, so it never moves); no preconditioner,
 *         as in the paper. Nocedal & Wright 2006, section 7.1 (negative curvature).
 * Trade:  stopped early, a free body with unequal masses drifts: the residual
 *         that is left has a sum. Masses as preconditioner would prevent it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/arithmetics.h"
#include "kernels/memory.h"
#include "kernels/solver/stepper.h"
#include "kernels/solver/vectors.h"

/* Vectors begin at different places of their pages: a pass reads and writes up to six, which
 * would all want the same eight lines of the first cache. */
enum { PAGE = 4096, LINES = 9 * 64 };

static void free_stepper(struct cb_stepper *s) {
  free(s->vector[0]);
  free(s->fixed);
  free(s);
}

static void fill_mass(const struct cb_stepper *s, const double *mass) {
  const double factor = 1 + s->parameters.h * s->parameters.beta;
  S *m = s->vector[STEPPER_MASS];
  for (size_t i = 0; i < STRIDE * s->nodes; i++) m[i] = (S)(factor * mass[i / STRIDE]);
}

static enum cb_status create(struct cb_operator *op, const struct cb_step_parameters *p,
                             const double *mass, const uint8_t *fixed, size_t nodes,
                             struct cb_stepper **out) {
  struct cb_stepper *s = calloc(1, sizeof *s);
  if (!s) return CB_MEMORY;
  s->op = op, s->parameters = *p, s->nodes = nodes;
  s->threads = cb_team_threads(cb_operator_team(op));
  const size_t bytes = (blocks_of(nodes) * BLOCK_SCALARS * sizeof(S) / PAGE + 1) * PAGE + LINES;
  char *vectors = cb_memory(STEPPER_VECTORS, bytes);
  for (size_t i = 0; vectors && i < STEPPER_VECTORS; i++) s->vector[i] = vectors + i * bytes;
  for (size_t n = 0; fixed && n < nodes; n++) s->fixed_count += fixed[n] != 0;
  s->fixed = malloc(s->fixed_count * sizeof *s->fixed + 1);
  if (!vectors || !s->fixed) {
    free_stepper(s);
    return CB_MEMORY;
  }
  s->bytes = STEPPER_VECTORS * bytes + s->fixed_count * sizeof *s->fixed;
  for (size_t n = 0, i = 0; i < s->fixed_count; n++)
    if (fixed[n]) s->fixed[i++] = (uint32_t)n;
  fill_mass(s, mass);
  *out = s;
  return CB_OK;
}

/* v := 0 on the fixed nodes among those scalars, which are whole nodes. */
static void filter(const struct cb_stepper *s, struct share scalars, S *v) {
  const size_t first = scalars.first / STRIDE, last = scalars.last / STRIDE;
  size_t low = 0, high = s->fixed_count; /* the first fixed node from `first` on */
  while (low < high) {
    const size_t middle = (low + high) / 2;
    if (s->fixed[middle] < first)
      low = middle + 1;
    else
      high = middle;
  }
  for (; low < s->fixed_count && s->fixed[low] < last; low++) {
    S *node = v + STRIDE * (size_t)s->fixed[low];
#pragma GCC unroll 4
    for (size_t i = 0; i < STRIDE; i++) node[i] = 0;
  }
}

/* The sum over all threads, the same on each. */
static ACC reduce(const struct cb_stepper *s, size_t thread, const struct sum *own) {
  struct cb_team *team = cb_operator_team(s->op);
  ACC part = sum_total(own), total = 0;
  cb_team_tell(team, thread, &part, sizeof part);
  for (size_t t = 0; t < s->threads; t++) {
    memcpy(&part, cb_team_told(team, thread, t), sizeof part);
    total += part;
  }
  return total;
}

/* b := h (f + f_ext) - c K v - h beta M v, zero on fixed nodes. */
static void right_side(struct cb_stepper *s, size_t thread, const void *x, const void *velocity,
                       const void *external) {
  S *restrict b = s->vector[STEPPER_B];
  const S *restrict v = velocity, *restrict f = external, *restrict m = s->vector[STEPPER_MASS];
  const double damping = s->parameters.h * s->parameters.beta;
  const S h = (S)s->parameters.h, drag = (S)(damping / (1 + damping));
  const struct share own = scalars_of(s->nodes, share_of(s->nodes, s->threads, thread));
  for (size_t i = own.first; i < own.last; i++) b[i] = 0;
  if (f)
    for (size_t i = own.first; i < own.last; i++) b[i] = h * f[i];
  if (drag != 0)
    for (size_t i = own.first; i < own.last; i++) b[i] -= drag * m[i] * v[i];
  cb_team_barrier(cb_operator_team(s->op), thread);
  cb_operator_update_part(s->op, thread, x, velocity, s->parameters.h, b);
  cb_team_barrier(cb_operator_team(s->op), thread);
  filter(s, own, b);
}

/* Residual and direction are b itself until the first step: no vector is copied, as beyond
 * the caches it is their traffic that takes the time. */

/* y := M b; returns b . b. */
static ACC start(const struct cb_stepper *s, size_t thread, struct share own, const T *b) {
  const T *restrict m = s->vector[STEPPER_MASS];
  T *restrict y = s->vector[STEPPER_Y];
  struct sum sum = {0};
  for (size_t i = own.first; i < own.last; i += BLOCK_TS)
    for (size_t n = 0; n < BLOCK_TS; n++) {
      const T value = b[i + n];
      y[i + n] = m[i + n] * value;
      sum_product(&sum, n, value, value);
    }
  return reduce(s, thread, &sum);
}

/* Returns p . y. */
static ACC curvature(const struct cb_stepper *s, size_t thread, struct share own, const T *p) {
  const T *y = s->vector[STEPPER_Y];
  struct sum sum = {0};
  for (size_t i = own.first; i < own.last; i += BLOCK_TS)
    for (size_t n = 0; n < BLOCK_TS; n++) sum_product(&sum, n, p[i + n], y[i + n]);
  return reduce(s, thread, &sum);
}

/* r := last - alpha y; returns r . r. */
static ACC descend(const struct cb_stepper *s, size_t thread, struct share own, const T *last,
                   T alpha) {
  const T *restrict y = s->vector[STEPPER_Y];
  T *r = s->vector[STEPPER_R];
  struct sum sum = {0};
  for (size_t i = own.first; i < own.last; i += BLOCK_TS)
    for (size_t n = 0; n < BLOCK_TS; n++) {
      const T left = last[i + n] - alpha * y[i + n];
      r[i + n] = left;
      sum_product(&sum, n, left, left);
    }
  return reduce(s, thread, &sum);
}

/* dv := alpha p, if that is the first step, or dv + alpha p. */
static void move(const struct cb_stepper *s, struct share own, const T *p, T alpha, bool first) {
  T *restrict dv = s->vector[STEPPER_DV];
  for (size_t i = own.first; i < own.last; i++) dv[i] = first ? alpha * p[i] : dv[i] + alpha * p[i];
}

/* dv as above; p := r + beta last, y := M p. */
static void turn(const struct cb_stepper *s, struct share own, const T *last, T alpha, T beta,
                 bool first) {
  const T *restrict r = s->vector[STEPPER_R], *restrict m = s->vector[STEPPER_MASS];
  T *restrict dv = s->vector[STEPPER_DV], *restrict y = s->vector[STEPPER_Y];
  T *p = s->vector[STEPPER_P];
  for (size_t i = own.first; i < own.last; i++) {
    const T before = last[i], next = r[i] + beta * before;
    dv[i] = first ? alpha * before : dv[i] + alpha * before;
    p[i] = next;
    y[i] = m[i] * next;
  }
}

/* p . M p, where M is all that is left of the operator. */
static ACC inertia(const struct cb_stepper *s, size_t thread, struct share own, const T *p) {
  const T *m = s->vector[STEPPER_MASS];
  struct sum sum = {0};
  for (size_t i = own.first; i < own.last; i += BLOCK_TS)
    for (size_t n = 0; n < BLOCK_TS; n++) sum_product(&sum, n, p[i + n], m[i + n] * p[i + n]);
  return reduce(s, thread, &sum);
}

/* Bounds of |p| and |dv| by the triangle inequality, kept beside the vectors: what would
 * overflow is known before it is written. In double, which `counted` does not count. */
struct bounds {
  double p, dv;
  double scale;    /* of the system that is solved; dv is in its units */
  double steepest; /* the largest p . A p / |p|^2 met */
};

/* A power of two that takes a right-hand side of that size to about 1 where A p or the
 * squares might be beyond the arithmetic or denormal otherwise; 1 nearly always. */
static double scale_of(double size) {
  const double large = sizeof(S) == sizeof(float) ? 0x1p40 : 0x1p300;
  const bool usual = !(size > large) && !(size < 1 / large);
  return usual || size == 0 || !isfinite(size) ? 1 : exp2(-ilogb(size));
}

/* r, p := scale b, y := M p */
static void begin_scaled(const struct cb_stepper *s, struct share own, double scale) {
  const S *restrict b = s->vector[STEPPER_B], *restrict m = s->vector[STEPPER_MASS];
  S *restrict r = s->vector[STEPPER_R], *restrict p = s->vector[STEPPER_P];
  S *restrict y = s->vector[STEPPER_Y];
  const struct share scalars = scalars_of(s->nodes, own);
  for (size_t i = scalars.first; i < scalars.last; i++) {
    r[i] = p[i] = (S)(scale * b[i]);
    y[i] = m[i] * p[i];
  }
}

/* Lost in rounding beside the steepest direction, twice over: on a positive definite A whose
 * condition is anything like what the arithmetic can solve this is never so. */
static bool lacks_curvature(struct bounds *b, double roundoff, double py) {
  const double slope = py / b->p / b->p;
  b->steepest = fmax(b->steepest, slope);
  return py <= 0 || slope <= 256 * roundoff * roundoff * b->steepest;
}

static bool within(const struct bounds *b, double step) {
  const double most = (sizeof(S) == sizeof(float) ? FLT_MAX : DBL_MAX) / 2;
  const double dv = b->dv + fabs(step) * b->p;
  return b->p <= most && fabs(step) <= most && dv <= most && dv <= most * b->scale; /* NaN: no */
}

/* A step from dv = 0 along p where p . A p <= 0: downhill, and no farther than the size of the
 * curvature or the mass alone would allow. */
static bool descend_without_curvature(const struct cb_stepper *s, size_t thread, struct share own,
                                      const T *p, const struct bounds *b, ACC rr, ACC py) {
  const double mass = (double)inertia(s, thread, own, p);
  const double step = (double)rr / fmax(mass, -(double)py);
  if (!within(b, step)) return false;
  move(s, own, p, splat((S)step), true);
  return true;
}

/* All threads decide alike: by sums that are the same on each. What ends the work is
 * looked at before dv is touched, so that dv is finite whatever comes; *moved: whether it was.
 * Once the residual is gone to rounding the work goes on with zero steps: every iteration
 * costs the same, and no 0/0 arises. */
static struct cb_ended iterate(const struct cb_stepper *s, size_t thread, struct share own,
                               double *scale, bool *moved) {
  struct cb_team *team = cb_operator_team(s->op);
  const double roundoff = cb_operator_variant(s->op)->arithmetic->roundoff;
  const T *p = s->vector[STEPPER_B], *r = p;
  ACC rr = start(s, thread, own, p);
  *scale = scale_of(sqrt((double)rr));
  if (*scale != 1) {
    r = s->vector[STEPPER_R], p = s->vector[STEPPER_P];
    begin_scaled(s, own, *scale);
    rr = rr * (ACC)*scale * (ACC)*scale;
    cb_team_barrier(team, thread);
  }
  const ACC enough = rr * (ACC)(roundoff * roundoff);
  struct bounds bound = {.p = sqrt((double)rr), .scale = *scale};
  struct cb_ended ended = {CB_ENDED_ITERATIONS, 0};
  for (size_t k = 0; k < s->parameters.iterations; k++) {
    if (!isfinite((double)rr)) return (struct cb_ended){CB_ENDED_OVERFLOW, k};
    cb_operator_product_part(s->op, thread, p, s->vector[STEPPER_Y]);
    cb_team_barrier(team, thread);
    filter(s, scalars_of(s->nodes, own), s->vector[STEPPER_Y]);
    const ACC py = curvature(s, thread, own, p);
    if (!(rr > enough)) ended.why = CB_ENDED_SOLVED;
    const bool solved = ended.why == CB_ENDED_SOLVED;
    if (!isfinite((double)py)) return (struct cb_ended){CB_ENDED_OVERFLOW, k};
    if (!solved && lacks_curvature(&bound, roundoff, (double)py)) {
      if (k == 0) *moved = descend_without_curvature(s, thread, own, p, &bound, rr, py);
      return (struct cb_ended){CB_ENDED_INDEFINITE, k == 0 ? *moved : k};
    }
    const ACC alpha = solved ? 0 : rr / py;
    if (!within(&bound, (double)alpha)) return (struct cb_ended){CB_ENDED_OVERFLOW, k};
    bound.dv += (double)alpha * bound.p;
    *moved = true;
    ended.iterations += !solved;
    if (k + 1 == s->parameters.iterations) {
      move(s, own, p, splat((S)alpha), k == 0);
      break;
    }
    const ACC next = descend(s, thread, own, r, splat((S)alpha)), beta = solved ? 0 : next / rr;
    r = s->vector[STEPPER_R];
    turn(s, own, p, splat((S)alpha), splat((S)beta), k == 0);
    p = s->vector[STEPPER_P];
    bound.p = sqrt((double)next) + (double)beta * bound.p;
    rr = next;
    cb_team_barrier(team, thread);
  }
  return ended;
}

static void solve(struct cb_stepper *s, size_t thread) {
  const struct share own = share_of(s->nodes, s->threads, thread);
  const struct share scalars = scalars_of(s->nodes, own);
  S *dv = s->vector[STEPPER_DV];
  double scale;
  bool moved = false;
  const struct cb_ended ended = iterate(s, thread, own, &scale, &moved);
  if (thread == 0) s->ended = ended;
  if (!moved)
    for (size_t i = scalars.first; i < scalars.last; i++) dv[i] = 0;
  else if (scale != 1)
    for (size_t i = scalars.first; i < scalars.last; i++) dv[i] = (S)(dv[i] / scale);
}

static void advance(struct cb_stepper *s, size_t thread, void *positions, void *velocities) {
  S *restrict x = positions, *restrict v = velocities;
  const S *restrict dv = s->vector[STEPPER_DV];
  const S h = (S)s->parameters.h;
  const struct share own = scalars_of(s->nodes, share_of(s->nodes, s->threads, thread));
  filter(s, own, v); /* and dv is zero there */
  for (size_t i = own.first; i < own.last; i++) {
    v[i] += dv[i];
    x[i] += h * v[i];
  }
}

const struct cb_step_functions CB_NAME(cb_step) = {create, free_stepper, right_side, solve,
                                                   advance};
