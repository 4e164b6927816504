/* way.c - see way.h: opening and closing.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/way.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"

void cb_way_close(struct cb_way *w) {
  cb_job_free(&w->job);
  cb_direct_free(w->direct);
  free(w->blocks);
  free(w->diagonal);
  free(w->held);
  free(w->touching);
  free(w->external);
  free(w->force);
  free(w->x);
  free(w->v);
  free(w->f);
  free(w->time);
}

static enum cb_status open_direct(struct cb_way *w) {
  const struct cb_bench_scene *at = &w->body->at;
  const uint32_t *row_start, *column;
  cb_operator_pattern(w->job.op, &row_start, &column);
  w->blocks = malloc(9 * sizeof *w->blocks * row_start[at->mesh.nodes]);
  w->diagonal = malloc(at->mesh.nodes * sizeof *w->diagonal);
  if (!w->blocks || !w->diagonal) return cb_fail_memory("the direct solver");
  for (size_t i = 0; i < at->mesh.nodes; i++)
    w->diagonal[i] = at->mass[i] * (1 + w->step.h * w->step.beta);
  return cb_bench_explain(cb_direct_create(at->mesh.nodes, row_start, column, w->held, &w->direct),
                          "the direct solver");
}

static enum cb_status allocate(struct cb_way *w) {
  const size_t nodes = w->body->at.mesh.nodes;
  w->force = aligned_alloc(64, w->job.vector_bytes);
  w->x = malloc(3 * nodes * sizeof *w->x);
  w->v = malloc(3 * nodes * sizeof *w->v);
  w->f = malloc(3 * nodes * sizeof *w->f);
  w->time = malloc(w->steps * sizeof *w->time);
  w->held = malloc(nodes);
  if (!w->force || !w->x || !w->v || !w->f || !w->time || !w->held)
    return cb_fail_memory("the simulation");
  memcpy(w->held, w->body->at.fixed, nodes);
  if (!w->body->scene->grounded) return CB_OK;
  w->touching = calloc(nodes, 1);
  return w->touching ? CB_OK : cb_fail_memory("the ground");
}

enum cb_status cb_way_open(const struct cb_body *body, const struct cb_trial *trial,
                           struct cb_way *w) {
  const struct cb_scene *scene = body->scene;
  const double look = scene->duration / CB_SAMPLES;
  const size_t between = (size_t)ceil(look / trial->step * (1 - 1e-9));
  *w = (struct cb_way){
      .body = body, .trial = trial, .steps = CB_SAMPLES * between, .material = body->at.material};
  w->step = (struct cb_step_parameters){look / (double)between, scene->alpha, scene->beta,
                                        trial->iterations};
  enum cb_status status =
      cb_job_create(trial->variant, trial->threads, &body->at, &w->step, &w->job);
  if (status) return status;
  if (cb_operator_tune(w->job.op, &trial->tuning) != CB_OK)
    return cb_fail(CB_INPUT, "%s has not what is to be tuned", w->job.name);
  status = allocate(w);
  if (!status && body->external) {
    w->external = aligned_alloc(64, w->job.vector_bytes);
    if (!w->external) return cb_fail_memory("the loads");
    trial->variant->arithmetic->from_double(body->at.mesh.nodes, body->external, w->external);
  }
  return status || trial->iterations ? status : open_direct(w);
}
