/* A variant on the scene, ready to step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"

/* Whole cache lines, so that lanes may be loaded aligned. */
static const size_t ALIGNMENT = 64;

static enum cb_status allocate_vectors(size_t nodes, struct cb_job *job) {
  const struct cb_arithmetic *a = job->variant->arithmetic;
  const size_t bytes = nodes * a->stride * a->scalar_bytes;
  job->vector_bytes = (bytes + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
  job->start_x = aligned_alloc(ALIGNMENT, job->vector_bytes);
  job->start_v = aligned_alloc(ALIGNMENT, job->vector_bytes);
  job->x = aligned_alloc(ALIGNMENT, job->vector_bytes);
  job->v = aligned_alloc(ALIGNMENT, job->vector_bytes);
  if (job->start_x && job->start_v && job->x && job->v) return CB_OK;
  return cb_fail_memory("the node vectors");
}

enum cb_status cb_bench_explain(enum cb_status status, const char *what) {
  switch (status) {
  case CB_OK: return CB_OK;
  case CB_MEMORY: return cb_fail_memory(what);
  case CB_NUMERIC:
    return cb_fail(status, "%s: the matrix is not positive definite; is the mesh held?", what);
  default: return cb_fail(status, "%s does not take this mesh or material", what);
  }
}

enum cb_status cb_job_create(const struct cb_variant *v, size_t threads,
                             const struct cb_bench_scene *scene,
                             const struct cb_step_parameters *step, struct cb_job *job) {
  struct cb_job made = {.variant = v, .threads = threads};
  cb_variant_name(v, made.name);
  const double begin = cb_timer_now();
  enum cb_status status =
      cb_operator_create(v, &scene->mesh, &scene->material, cb_step_scale(step), threads, &made.op);
  if (!status) status = cb_stepper_create(made.op, step, scene->mass, scene->fixed, &made.stepper);
  made.setup_s = cb_timer_now() - begin;
  status = cb_bench_explain(status, made.name);
  if (!status) status = allocate_vectors(scene->mesh.nodes, &made);
  if (status) {
    cb_job_free(&made);
    return status;
  }
  v->arithmetic->from_double(scene->mesh.nodes, scene->x, made.start_x);
  v->arithmetic->from_double(scene->mesh.nodes, scene->v, made.start_v);
  v->arithmetic->from_double(scene->mesh.nodes, scene->x, made.x);
  v->arithmetic->from_double(scene->mesh.nodes, scene->v, made.v);
  *job = made;
  return CB_OK;
}

void cb_job_free(struct cb_job *job) {
  cb_stepper_free(job->stepper);
  cb_operator_free(job->op);
  free(job->start_x);
  free(job->start_v);
  free(job->x);
  free(job->v);
  *job = (struct cb_job){0};
}

void cb_job_restore(void *job) {
  struct cb_job *j = job;
  memcpy(j->x, j->start_x, j->vector_bytes);
  memcpy(j->v, j->start_v, j->vector_bytes);
}

void cb_job_steps(void *job, size_t repeats) {
  struct cb_job *j = job;
  for (size_t i = 0; i < repeats; i++) {
    cb_stepper_step(j->stepper, j->x, j->v, NULL);
    const enum cb_ending why = cb_stepper_ended(j->stepper).why;
    j->lost |= why == CB_ENDED_INDEFINITE || why == CB_ENDED_OVERFLOW;
  }
}

bool cb_job_finite(const struct cb_job *job, const void *vector, double *work) {
  const size_t nodes = cb_operator_nodes(job->op);
  job->variant->arithmetic->to_double(nodes, vector, work);
  for (size_t i = 0; i < 3 * nodes; i++)
    if (!isfinite(work[i])) return false;
  return true;
}
