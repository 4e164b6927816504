/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <string.h>

#include "harness/bench/cost.h"
#include "harness/error.h"
#include "harness/verify/counter.h"

static const struct cb_variant *counted(const struct cb_variant *v) {
  for (const struct cb_variant *q = cb_variants(NULL); q->model; q++)
    if (q->storage == v->storage && strcmp(q->arithmetic->name, "counted") == 0 &&
        strcmp(q->model->name, v->model->name) == 0)
      return q;
  return NULL;
}

bool cb_cost_assembled(const struct cb_variant *v) {
  return strstr(cb_storage_name[v->storage], "csr") != NULL; /* csr, bcsr and what follows */
}

static double executed(void) {
  struct cb_counts counts[STAGES];
  double sum = 0;
  cb_counter_read(counts);
  for (int s = 0; s < STAGES; s++)
    sum += (double)(counts[s].mul + counts[s].add + counts[s].div + counts[s].sqrt);
  return sum;
}

static enum cb_status counted_job(const struct cb_variant *v, const struct cb_bench_scene *scene,
                                  struct cb_job *job) {
  const struct cb_variant *q = counted(v);
  if (!q || !cb_counter_works())
    return cb_fail(CB_BROKEN, "operations are not counted: link with the Makefile's COUNT flags");
  return cb_job_create(q, 1, scene, &cb_bench_step, job);
}

/* The numbers do not matter: no update is needed before. */
enum cb_status cb_cost_product(const struct cb_variant *v, const struct cb_bench_scene *scene,
                               double *flops) {
  struct cb_job job = {0};
  const enum cb_status status = counted_job(v, scene, &job);
  if (status) return status;
  cb_counter_reset();
  cb_operator_product(job.op, job.start_v, job.v);
  *flops = executed() / (double)scene->mesh.tets;
  cb_job_free(&job);
  return CB_OK;
}

enum cb_status cb_cost_step(const struct cb_variant *v, const struct cb_bench_scene *scene,
                            double *flops) {
  struct cb_job job = {0};
  const enum cb_status status = counted_job(v, scene, &job);
  if (status) return status;
  if (v->model->memory_numbers > 0) cb_stepper_step(job.stepper, job.x, job.v, NULL); /* warm */
  cb_counter_reset();
  cb_stepper_step(job.stepper, job.x, job.v, NULL);
  *flops = executed() / (double)scene->mesh.tets;
  cb_job_free(&job);
  return CB_OK;
}

/* Rows, columns and numbers of the matrix. */
static double matrix_bytes(const struct cb_operator *op) {
  const uint32_t *row_start, *column;
  const struct cb_variant *v = cb_operator_variant(op);
  const double nodes = (double)cb_operator_nodes(op), index = sizeof(uint32_t);
  cb_operator_pattern(op, &row_start, &column);
  const double blocks = row_start[cb_operator_nodes(op)];
  const double numbers = 9 * blocks * (double)v->arithmetic->scalar_bytes;
  if (v->storage == CB_CSR) return numbers + index * (9 * blocks + 3 * nodes + 1);
  return numbers + index * (blocks + nodes + 1);
}

/* Node indices and the state that the update leaves to the product. */
static double element_bytes(const struct cb_operator *op, const struct cb_mesh *mesh) {
  enum { REST_NUMBERS = 11 }; /* REST_ISOTROPIC of kernels/elements.h */
  const struct cb_variant *v = cb_operator_variant(op);
  const double scalar = (double)v->arithmetic->scalar_bytes * (double)mesh->tets;
  const double state = scalar * v->model->form[v->storage][0].state_numbers;
  double bytes = (double)cb_operator_bytes(op) - scalar * v->model->memory_numbers;
  /* Lanes make the rest shape again in each update. */
  if (v->arithmetic->lanes == 1 && !v->model->keeps_rest) bytes -= scalar * REST_NUMBERS;
  return fmax(bytes, state);
}

double cb_cost_bytes(const struct cb_operator *op, const struct cb_mesh *mesh) {
  const struct cb_variant *v = cb_operator_variant(op);
  const double vectors = v->storage == CB_EBE_RECOMPUTE ? 3 : 2;
  const double vector = (double)(mesh->nodes * v->arithmetic->stride * v->arithmetic->scalar_bytes);
  const double own = cb_cost_assembled(v) ? matrix_bytes(op) : element_bytes(op, mesh);
  return (own + vectors * vector) / (double)mesh->tets;
}
