/* steps.c - see steps.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/steps.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/progress.h"
#include "reference/direct.h"
#include "reference/energy.h"

const char *const cb_integrator_name[CB_INTEGRATORS] = {"implicit, 5 iterations",
                                                        "implicit, direct", "symplectic Euler"};

/* ---- bodies ----------------------------------------------------------------------------- */

enum cb_status cb_swing_body(unsigned long seed, struct cb_bench_scene *s) {
  static const size_t one[3] = {1, 1, 1};
  enum cb_status status = cb_bench_scene_grid(one, seed, s);
  if (status) return status;
  memset(s->fixed, 0, s->mesh.nodes);
  for (size_t i = 0; i < 3 * s->mesh.nodes; i++) {
    s->x[i] *= i % 3 == 2 ? 1.1 : 1;
    s->v[i] = 0;
  }
  return CB_OK;
}

/* The first of the cell's, about its middle, stretched by a tenth and turning twice a
 * second. */
enum cb_status cb_swing_tetrahedron(unsigned long seed, struct cb_bench_scene *s) {
  enum cb_status status = cb_swing_body(seed, s);
  if (status) return status;
  double X[12], c[3] = {0};
  for (size_t i = 0; i < 12; i++) X[i] = s->mesh.X[3 * s->mesh.tet[i / 3] + i % 3];
  for (size_t i = 0; i < 12; i++) c[i % 3] += X[i] / 4;
  s->mesh.nodes = 4, s->mesh.tets = 1;
  for (uint32_t i = 0; i < 4; i++) s->mesh.tet[i] = i;
  for (size_t i = 0; i < 12; i++) {
    s->mesh.X[i] = X[i] - c[i % 3];
    s->x[i] = s->mesh.X[i] * (i % 3 == 2 ? 1.1 : 1);
  }
  static const double spin[3] = {6, 3, 12};
  for (size_t i = 0; i < 12; i += 3)
    for (size_t k = 0; k < 3; k++)
      s->v[i + k] =
          spin[(k + 1) % 3] * s->x[i + (k + 2) % 3] - spin[(k + 2) % 3] * s->x[i + (k + 1) % 3];
  cb_mesh_mass(&s->mesh, s->material.density, s->mass);
  return CB_OK;
}

/* ---- a body on its way -------------------------------------------------------------------- */

struct way {
  const struct cb_bench_scene *s;
  enum cb_integrator integrator;
  double h;
  size_t length; /* 3*nodes */
  struct cb_job job;
  struct cb_direct *direct;
  double *x, *v, *f; /* [length]; f: of its work too */
  double *blocks;
};

static void close_way(struct way *w) {
  cb_job_free(&w->job);
  cb_direct_free(w->direct);
  free(w->x);
  free(w->blocks);
}

static enum cb_status open_direct(struct way *w) {
  const uint32_t *row_start, *column;
  const size_t nodes = w->s->mesh.nodes;
  cb_operator_pattern(w->job.op, &row_start, &column);
  w->blocks = malloc(9 * sizeof *w->blocks * row_start[nodes]);
  if (!w->blocks) return cb_fail_memory("the direct solver");
  return cb_bench_explain(cb_direct_create(nodes, row_start, column, w->s->fixed, &w->direct),
                          "the direct solver");
}

static enum cb_status open_way(const struct cb_variant *v, const struct cb_bench_scene *s,
                               enum cb_integrator integrator, double h, struct way *w) {
  const struct cb_step_parameters step = {.h = h, .iterations = 5};
  *w = (struct way){.s = s, .integrator = integrator, .h = h, .length = 3 * s->mesh.nodes};
  w->x = malloc(3 * w->length * sizeof *w->x);
  if (!w->x) return cb_fail_memory("a swing");
  w->v = w->x + w->length, w->f = w->v + w->length;
  memcpy(w->x, s->x, w->length * sizeof *w->x);
  memcpy(w->v, s->v, w->length * sizeof *w->v);
  if (integrator == CB_IMPLICIT_DIRECT &&
      (v->storage != CB_BCSR || v->arithmetic != cb_arithmetics[0]))
    return cb_fail(CB_INPUT, "the direct solver takes bcsr/f64 only");
  enum cb_status status = cb_job_create(v, 1, s, &step, &w->job);
  return status || integrator != CB_IMPLICIT_DIRECT ? status : open_direct(w);
}

/* A matrix that is not positive definite is no failure of the program: the velocities then
 * are not finite, as they are where a number overflows. */
static enum cb_status step_directly(struct way *w) {
  double *x = w->job.x, *v = w->job.v;
  cb_stepper_right_side(w->job.stepper, x, v, NULL);
  cb_operator_blocks(w->job.op, w->blocks);
  enum cb_status status = cb_direct_factor(w->direct, w->blocks, w->s->mass);
  if (!status) status = cb_direct_solve(w->direct, cb_stepper_b(w->job.stepper), w->f);
  for (size_t i = 0; i < w->length; i++) {
    v[i] += status ? NAN : w->f[i];
    x[i] += w->h * v[i];
  }
  return status == CB_MEMORY ? cb_fail_memory("the direct solver") : CB_OK;
}

/* In double, whatever the force is computed in. */
static void step_explicitly(struct way *w) {
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  a->from_double(w->s->mesh.nodes, w->x, w->job.x);
  cb_operator_update(w->job.op, w->job.x, NULL, 1, w->job.v);
  a->to_double(w->s->mesh.nodes, w->job.v, w->f);
  for (size_t i = 0; i < w->length; i++) {
    w->v[i] += w->h * w->f[i] / w->s->mass[i / 3];
    w->x[i] += w->h * w->v[i];
  }
}

static enum cb_status step(struct way *w) {
  if (w->integrator == CB_IMPLICIT_DIRECT) return step_directly(w);
  if (w->integrator == CB_EXPLICIT)
    step_explicitly(w);
  else
    cb_stepper_step(w->job.stepper, w->job.x, w->job.v, NULL);
  return CB_OK;
}

/* ---- looks ---------------------------------------------------------------------------------- */

struct state {
  double energy, momentum[3], angular[3];
  double speed, lever; /* sum m |v|, sum m |r| |v| */
};

static bool observe(struct way *w, struct state *s) {
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  const size_t nodes = w->s->mesh.nodes;
  if (w->integrator != CB_EXPLICIT) {
    a->to_double(nodes, w->job.x, w->x);
    a->to_double(nodes, w->job.v, w->v);
  }
  *s = (struct state){0};
  for (size_t i = 0; i < w->length; i++)
    if (!(fabs(w->x[i]) < 1e100 && fabs(w->v[i]) < 1e100)) return false; /* their squares are */
  for (size_t n = 0; n < nodes; n++) {
    const double *x = w->x + 3 * n, *v = w->v + 3 * n, m = w->s->mass[n];
    const double speed = hypot(hypot(v[0], v[1]), v[2]);
    for (int k = 0; k < 3; k++) {
      const int p = (k + 1) % 3, q = (k + 2) % 3;
      s->momentum[k] += m * v[k];
      s->angular[k] += m * (x[p] * v[q] - x[q] * v[p]);
    }
    s->energy += m / 2 * speed * speed;
    s->speed += m * speed;
    s->lever += m * speed * hypot(hypot(x[0], x[1]), x[2]);
  }
  s->energy += cb_elastic_energy(&w->s->mesh, &w->s->material, w->x, NULL);
  return isfinite(s->energy);
}

static double change(const double *a, const double *b) {
  return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]);
}

enum cb_status cb_swing(const struct cb_variant *v, const struct cb_bench_scene *scene,
                        enum cb_integrator integrator, double h, size_t steps, size_t looks,
                        struct cb_swing *swing) {
  struct way w;
  struct state start, now = {0};
  struct cb_swing s = {true, 1, 1, 0, 0};
  enum cb_status status = open_way(v, scene, integrator, h, &w);
  if (!status) s.finite = observe(&w, &start);
  for (size_t n = 1; !status && s.finite && n <= steps; n++) {
    status = step(&w);
    if (integrator == CB_IMPLICIT_ITERATED &&
        cb_stepper_ended(w.job.stepper).why == CB_ENDED_OVERFLOW)
      s.finite = false; /* kept out of the body, which would only seem to be at rest */
    if (!s.finite) break;
    if (n * looks % steps >= looks && n != steps) continue;
    s.finite = observe(&w, &now);
    s.most = fmax(s.most, now.energy / start.energy);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  if (!status && s.finite) {
    s.energy = now.energy / start.energy;
    s.momentum = start.speed > 0 ? change(now.momentum, start.momentum) / start.speed : NAN;
    s.angular = start.lever > 0 ? change(now.angular, start.angular) / start.lever : NAN;
  }
  if (!s.finite) s.most = s.energy = s.momentum = s.angular = NAN;
  close_way(&w);
  if (!status) *swing = s;
  return status;
}
