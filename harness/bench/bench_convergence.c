/* Error of the conjugate gradient against the direct solution of the same step,
 * after each number of iterations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/progress.h"
#include "reference/direct.h"

/* The paper's step, and longer ones, which are worse conditioned. */
static const double STEPS[] = {4e-4, 2e-3, 1e-2}; /* s */
enum { STEP_COUNT = sizeof STEPS / sizeof *STEPS };
static const size_t ITERATIONS[] = {1, 2, 3, 4, 5, 7, 10, 14, 20, 30, 50, 70, 100, 140, 200};
enum { COUNTS = sizeof ITERATIONS / sizeof *ITERATIONS };

static bool wanted(const struct cb_variant *v) {
  return v->arithmetic == cb_arithmetics[0] && strcmp(v->model->name, "qr-updated") == 0 &&
         v->storage == CB_EBE;
}

/* dv[3*nodes] := direct solution of A dv = b with the assembled matrix of that
 * job, whose state is up to date. */
static enum cb_status solve_directly(const struct cb_job *assembled,
                                     const struct cb_bench_scene *scene, const double *b,
                                     double *dv) {
  const uint32_t *row_start, *column;
  cb_operator_pattern(assembled->op, &row_start, &column);
  struct cb_direct *direct = NULL;
  double *blocks = malloc(9 * sizeof *blocks * row_start[scene->mesh.nodes]);
  enum cb_status status = blocks ? CB_OK : cb_fail_memory("the assembled matrix");
  if (!status)
    status = cb_direct_create(scene->mesh.nodes, row_start, column, scene->fixed, &direct);
  if (!status) {
    cb_operator_blocks(assembled->op, blocks);
    status = cb_direct_factor(direct, blocks, scene->mass); /* undamped: 1 + h beta = 1 */
  }
  if (!status) status = cb_direct_solve(direct, b, dv);
  cb_direct_free(direct);
  free(blocks);
  return cb_bench_explain(status, "the direct solution");
}

static double relative_error(size_t numbers, const double *dv, const double *exact) {
  double error = 0, norm = 0;
  for (size_t i = 0; i < numbers; i++) {
    error += (dv[i] - exact[i]) * (dv[i] - exact[i]);
    norm += exact[i] * exact[i];
  }
  return sqrt(error / norm);
}

/* One curve; work[6*nodes]. */
static enum cb_status add_curve(struct cb_bench *b, const struct cb_bench_scene *scene,
                                const struct cb_job *job, const struct cb_job *assembled, double h,
                                double *work) {
  const size_t nodes = scene->mesh.nodes;
  const struct cb_arithmetic *a = job->variant->arithmetic;
  double *exact = work, *dv = work + 3 * nodes;
  cb_stepper_right_side(assembled->stepper, assembled->x, assembled->v, NULL);
  cb_stepper_right_side(job->stepper, job->x, job->v, NULL);
  a->to_double(nodes, cb_stepper_b(job->stepper), dv);
  enum cb_status status = solve_directly(assembled, scene, dv, exact);
  for (size_t c = 0; !status && c < COUNTS; c++) {
    cb_stepper_set_iterations(job->stepper, ITERATIONS[c]);
    cb_stepper_right_side(job->stepper, job->x, job->v, NULL);
    cb_stepper_solve(job->stepper);
    a->to_double(nodes, cb_stepper_dv(job->stepper), dv);
    if (cb_stepper_ended(job->stepper).why == CB_ENDED_OVERFLOW) dv[0] = NAN;
    struct cb_convergence point = {.tetrahedra = scene->mesh.tets,
                                   .iterations = ITERATIONS[c],
                                   .h = h,
                                   .error = relative_error(3 * nodes, dv, exact)};
    snprintf(point.variant, CB_NAME, "%s", job->name);
    status = cb_results_add_convergence(&b->results, &point);
  }
  return status;
}

/* The curves of one variant; those of a model that cannot be assembled are left
 * out. */
static enum cb_status add_variant(struct cb_bench *b, const struct cb_bench_scene *scene,
                                  const struct cb_variant *v, double *work) {
  char name[CB_NAME];
  struct cb_variant same_assembled = {v->model, CB_BCSR, cb_arithmetics[0]};
  cb_variant_name(&same_assembled, name);
  const struct cb_variant *reference = cb_variant_find(name);
  const char *reason = "";
  enum cb_status status = cb_bench_gate(b, v, &reason);
  for (size_t i = 0; !status && reference && !reason[0] && i < STEP_COUNT; i++) {
    struct cb_step_parameters step = cb_bench_step;
    struct cb_job job = {0}, assembled = {0};
    step.h = STEPS[i];
    status = cb_job_create(v, 1, scene, &step, &job);
    if (!status) status = cb_job_create(reference, 1, scene, &step, &assembled);
    if (!status) status = add_curve(b, scene, &job, &assembled, step.h, work);
    cb_job_free(&job);
    cb_job_free(&assembled);
  }
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  (void)budget_s; /* nothing is timed */
  struct cb_entry *entries = NULL;
  size_t count = 0;
  struct cb_bench_scene scene = {0};
  double *work = NULL;
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (!status) status = cb_bench_scene_grid(cb_bench_paper_cells, b->options->seed, &scene);
  if (!status && !(work = malloc(6 * scene.mesh.nodes * sizeof *work)))
    status = cb_fail_memory("the solutions");
  for (size_t i = 0; !status && i < count; i++) {
    if (i > 0 && entries[i].variant == entries[i - 1].variant) continue; /* more threads */
    if (cb_interrupted())
      status = cb_fail(CB_INTERRUPTED, "interrupted while solving");
    else
      status = add_variant(b, &scene, entries[i].variant, work);
  }
  free(work);
  cb_bench_scene_free(&scene);
  free(entries);
  return status;
}

static double error_at(const struct cb_results *r, const char *variant, double h,
                       size_t iterations) {
  for (size_t i = 0; i < r->convergence_count; i++) {
    const struct cb_convergence *c = &r->convergences[i];
    if (strcmp(c->variant, variant) == 0 && c->h == h && c->iterations == iterations)
      return c->error;
  }
  return NAN;
}

static void print(const struct cb_results *r, FILE *stream) {
  static const size_t shown[] = {1, 5, 10, 20, 50, 100, 200};
  struct cb_table *t = cb_table_create("variant,h_ms,1,5,10,20,50,100,200");
  for (size_t i = 0; t && i < r->convergence_count; i++) {
    const struct cb_convergence *c = &r->convergences[i];
    if (c->iterations != ITERATIONS[0]) continue;
    cb_table_text(t, c->variant);
    cb_table_number(t, 1e3 * c->h);
    for (size_t k = 0; k < sizeof shown / sizeof *shown; k++)
      cb_bench_number_cell(t, error_at(r, c->variant, c->h, shown[k]));
  }
  cb_bench_print(stream,
                 "Convergence: relative error of dv against the direct solution, after 1 to 200 "
                 "iterations, 3430 tetrahedra",
                 t);
}

const struct cb_bench_figure cb_bench_convergence = {"convergence", 0.005, true, run, print};
