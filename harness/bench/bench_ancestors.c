/* The linear methods that the paper descends from, timed: everything is paid in
 * the set-up. What a force on the surface does to the surface.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/progress.h"
#include "reference/ancestors.h"
#include "reference/direct.h"

enum { METHODS = 3, ROUNDS = 21, MIN_ROUNDS = 6 };
static const char *const NAMES[METHODS] = {"linear/inverse", "linear/condensed", "linear/factored"};

/* The stiffness matrix, and the methods made of it. */
struct ancestors {
  const uint32_t *row_start, *column;
  double *blocks;
  size_t surface_count;
  uint32_t *surface;
  struct cb_inverse *inverse;
  struct cb_condensation *condensation;
  struct cb_direct *direct; /* sparse factors, all nodes loaded and seen */
  double *f, *u;            /* [3*nodes] */
  double setup_s[METHODS];
};

static void run_inverse(void *context, size_t repeats) {
  struct ancestors *a = context;
  for (size_t i = 0; i < repeats; i++) cb_inverse_apply(a->inverse, a->f, a->u);
}

static void run_condensation(void *context, size_t repeats) {
  struct ancestors *a = context;
  for (size_t i = 0; i < repeats; i++) cb_condensation_apply(a->condensation, a->f, a->u);
}

static void run_direct(void *context, size_t repeats) {
  struct ancestors *a = context;
  /* It cannot fail: there is a factor, and the first solve was done in make. */
  for (size_t i = 0; i < repeats; i++) cb_direct_solve(a->direct, a->f, a->u);
}

static void free_ancestors(struct ancestors *a) {
  free(a->blocks);
  free(a->surface);
  free(a->f);
  free(a->u);
  cb_inverse_free(a->inverse);
  cb_condensation_free(a->condensation);
  cb_direct_free(a->direct);
}

static enum cb_status make_methods(const struct cb_bench_scene *scene, struct ancestors *a) {
  const size_t nodes = scene->mesh.nodes;
  double begin = cb_timer_now(), end;
  enum cb_status status = cb_inverse_create(nodes, a->row_start, a->column, a->blocks, scene->fixed,
                                            a->surface_count, a->surface, &a->inverse);
  end = cb_timer_now();
  a->setup_s[0] = end - begin;
  if (status) return status;
  status = cb_condensation_create(nodes, a->row_start, a->column, a->blocks, scene->fixed,
                                  a->surface_count, a->surface, &a->condensation);
  begin = cb_timer_now();
  a->setup_s[1] = begin - end;
  if (!status) status = cb_direct_create(nodes, a->row_start, a->column, scene->fixed, &a->direct);
  if (!status) status = cb_direct_factor(a->direct, a->blocks, NULL);
  if (!status) status = cb_direct_solve(a->direct, a->f, a->u);
  a->setup_s[2] = cb_timer_now() - begin;
  return status;
}

/* linear: assembled, c = 1; *a keeps pointers into it. */
static enum cb_status make(const struct cb_bench_scene *scene, const struct cb_job *linear,
                           struct ancestors *a) {
  const size_t nodes = scene->mesh.nodes;
  cb_stepper_right_side(linear->stepper, linear->x, linear->v, NULL); /* fills the matrix */
  cb_operator_pattern(linear->op, &a->row_start, &a->column);
  a->blocks = malloc(9 * sizeof *a->blocks * a->row_start[nodes]);
  a->surface = malloc(nodes * sizeof *a->surface);
  a->f = malloc(3 * nodes * sizeof *a->f);
  a->u = malloc(3 * nodes * sizeof *a->u);
  if (!a->blocks || !a->surface || !a->f || !a->u) return cb_fail_memory("the linear ancestors");
  cb_operator_blocks(linear->op, a->blocks);
  for (size_t i = 0; i < 3 * nodes; i++) a->f[i] = 1e-3 * sin((double)i); /* N */
  const enum cb_status status = cb_surface_nodes(&scene->mesh, a->surface, &a->surface_count);
  return cb_bench_explain(status ? status : make_methods(scene, a), "a linear ancestor");
}

static void show(void *context, double share, const char *subject) {
  const struct cb_bench *b = context;
  cb_progress(b->done_s + share * cb_bench_ancestors.share * b->seconds, subject);
}

static enum cb_status measure(struct cb_bench *b, const struct cb_bench_scene *scene,
                              struct ancestors *a, double budget_s) {
  const struct cb_subject subjects[METHODS] = {{NAMES[0], NULL, run_inverse, a},
                                               {NAMES[1], NULL, run_condensation, a},
                                               {NAMES[2], NULL, run_direct, a}};
  const size_t bytes[METHODS] = {cb_inverse_bytes(a->inverse),
                                 cb_condensation_bytes(a->condensation),
                                 cb_direct_bytes(a->direct)};
  const struct cb_timing timing = {.epoch_s = fmax(0.8 * budget_s / (METHODS * ROUNDS), 2e-3),
                                   .budget_s = budget_s,
                                   .min_rounds = MIN_ROUNDS,
                                   .max_rounds = ROUNDS,
                                   .seed = b->options->seed,
                                   .progress = show,
                                   .progress_context = b};
  struct cb_samples samples = {0};
  enum cb_status status = cb_timer_run(METHODS, subjects, &timing, &samples);
  for (size_t i = 0; !status && i < METHODS; i++) {
    struct cb_row row = cb_row_unmeasured("ancestors", NAMES[i], &scene->mesh);
    row.setup_s = a->setup_s[i];
    row.bytes_per_tetrahedron = (double)bytes[i] / (double)scene->mesh.tets;
    status = cb_results_add_measured(&b->results, &row, &samples, i);
  }
  cb_samples_free(&samples);
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  const struct cb_variant *linear = cb_variant_find("linear/bcsr/f64");
  struct cb_bench_scene scene = {0};
  struct cb_job job = {0};
  const struct cb_step_parameters unit = {.h = 1}; /* c = 1: K itself */
  struct ancestors a = {0};
  if (!linear) return cb_fail(CB_BROKEN, "linear/bcsr/f64 is not there to be factored");
  enum cb_status status = cb_bench_scene_grid(cb_bench_paper_cells, b->options->seed, &scene);
  if (!status) status = cb_job_create(linear, 1, &scene, &unit, &job);
  if (!status) status = make(&scene, &job, &a);
  if (!status) status = measure(b, &scene, &a, budget_s);
  free_ancestors(&a);
  cb_job_free(&job);
  cb_bench_scene_free(&scene);
  return status;
}

static void print(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("method,setup_ms,apply_us,bytes_per_tetrahedron");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (strcmp(row->figure, "ancestors") != 0) continue;
    cb_table_text(t, row->variant);
    cb_table_number(t, 1e3 * row->setup_s);
    cb_bench_step_cell(t, row, 1e6);
    cb_table_number(t, row->bytes_per_tetrahedron);
  }
  cb_bench_print(stream,
                 "Linear ancestors: surface displacement under surface forces, 3430 tetrahedra", t);
}

const struct cb_bench_figure cb_bench_ancestors = {"ancestors", 0.02, true, run, print};
