/* changes.c - see way.h: what changes while a scene runs. None of it is in the time of a step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "harness/error.h"
#include "harness/scene/way.h"

void cb_way_put(const struct cb_way *w, void *vector, size_t node, size_t axis, double value) {
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  const size_t i = a->stride * node + axis;
  switch (a->scalar_bytes) {
  case sizeof(float): ((float *)vector)[i] = (float)value; break;
  case sizeof(double): ((double *)vector)[i] = value; break;
  default: ((__float128 *)vector)[i] = value;
  }
}

/* ---- made anew ---------------------------------------------------------------------- */

/* An operator is made for its material, a stepper and a direct solver for what is held. */
static enum cb_status make_anew(struct cb_way *w, bool stiffness) {
  const struct cb_bench_scene *at = &w->body->at;
  enum cb_status status = CB_OK;
  cb_stepper_free(w->job.stepper);
  w->job.stepper = NULL;
  if (stiffness) {
    cb_operator_free(w->job.op);
    w->job.op = NULL;
    status = cb_operator_create(w->job.variant, &at->mesh, &w->material, cb_step_scale(&w->step),
                                w->job.threads, &w->job.op);
    if (!status) status = cb_operator_tune(w->job.op, &w->trial->tuning);
  }
  if (!status) status = cb_stepper_create(w->job.op, &w->step, at->mass, w->held, &w->job.stepper);
  if (!status && w->direct) {
    const uint32_t *row_start, *column;
    cb_direct_free(w->direct);
    w->direct = NULL;
    cb_operator_pattern(w->job.op, &row_start, &column);
    status = cb_direct_create(at->mesh.nodes, row_start, column, w->held, &w->direct);
  }
  return cb_bench_explain(status, w->job.name);
}

/* ---- what changes --------------------------------------------------------------------- */

/* Returns whether another stage begins at time t. */
static bool begin_stage(struct cb_way *w, double t, enum cb_status *status) {
  const struct cb_scene *s = w->body->scene;
  size_t stage = w->stage;
  while (stage < s->stage_count && s->stage[stage].from * (1 - 1e-9) <= t) stage++;
  if (stage == w->stage) return false;
  w->stage = stage;
  *status = cb_material_isotropic(s->stage[stage - 1].young, s->material.poisson,
                                  s->material.density, &w->material);
  return true;
}

/* Does a handle let go at time t, that is, hold until there and not for another step? */
static bool let_go(const struct cb_way *w, double t) {
  bool some = false;
  for (size_t n = 0; n < w->body->scene->handle_count; n++) {
    const struct cb_handle *handle = &w->body->scene->handle[n];
    some |= cb_handle_holds(handle, t) && !cb_handle_holds(handle, t + w->step.h);
  }
  return some;
}

/* Nodes that touch the ground and are pulled up do so no more; returns whether there were
 * any. */
static bool lift(struct cb_way *w) {
  const size_t nodes = w->body->at.mesh.nodes;
  bool lifted = false;
  if (!memchr(w->touching, 1, nodes)) return false;
  cb_operator_update(w->job.op, w->job.x, NULL, 1, w->force);
  w->job.variant->arithmetic->to_double(nodes, w->force, w->f);
  for (size_t i = 0; i < nodes; i++) {
    const double load = w->body->external ? w->body->external[3 * i + 2] : 0;
    if (!w->touching[i] || !(w->f[3 * i + 2] + load > 0)) continue;
    w->touching[i] = 0;
    lifted = true;
  }
  return lifted;
}

/* held := what is anchored, what handles hold for a step from time t on, what touches the
 * ground. */
static void hold(struct cb_way *w, double t) {
  const size_t nodes = w->body->at.mesh.nodes;
  memcpy(w->held, w->body->anchored, nodes);
  for (size_t n = 0; n < w->body->scene->handle_count; n++) {
    const struct cb_grip *g = &w->body->grip[n];
    if (!cb_handle_holds(g->handle, t + w->step.h)) continue;
    for (size_t i = 0; i < g->count; i++) w->held[g->node[i]] = 1;
  }
  for (size_t i = 0; w->touching && i < nodes; i++) w->held[i] |= w->touching[i];
}

enum cb_status cb_way_change(struct cb_way *w, size_t n) {
  const double t = (double)n * w->step.h;
  enum cb_status status = CB_OK;
  const bool stiffness = begin_stage(w, t, &status);
  bool other_nodes = w->landed;
  other_nodes |= let_go(w, t);
  if (w->touching) other_nodes |= lift(w);
  w->landed = false;
  if (status || !(stiffness || other_nodes)) return status;
  hold(w, t);
  return make_anew(w, stiffness);
}

void cb_way_land(struct cb_way *w) {
  const double ground = w->body->scene->ground;
  w->job.variant->arithmetic->to_double(w->body->at.mesh.nodes, w->job.x, w->x);
  for (size_t i = 0; i < w->body->at.mesh.nodes; i++) {
    if (w->held[i] || !(w->x[3 * i + 2] < ground)) continue;
    cb_way_put(w, w->job.x, i, 2, ground);
    for (size_t k = 0; k < 3; k++) cb_way_put(w, w->job.v, i, k, 0);
    w->touching[i] = 1;
    w->landed = true;
  }
}
