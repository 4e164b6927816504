/* How many times faster than the paper's method in scalar f64, and how far from f64:
 * speed and error side by side.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"

static const size_t ITERATIONS[1] = {5};
static const char BASE[] = "qr-updated/ebe-paper/f64";
static const char *const MODELS[] = {"qr-updated", "qr-exact", "polar-closed-updated",
                                     "polar-closed-precomputed", "svd-updated"};
enum { MODEL_COUNT = sizeof MODELS / sizeof *MODELS, MESHES = 2, STEPS = 10 };

static const struct place {
  const char *name;
  enum cb_status (*make)(const size_t cells[3], unsigned long seed, struct cb_bench_scene *scene);
  size_t cells[3], quick_cells[3];
  double share;
} PLACES[MESHES] = {{"grid", cb_bench_scene_grid, {7, 7, 7}, {7, 7, 7}, 0.4},
                    {"irregular", cb_bench_scene_irregular, {18, 18, 18}, {12, 12, 12}, 0.6}};

static bool wanted(const struct cb_variant *v) {
  const bool unassembled =
      v->storage == CB_EBE || v->storage == CB_EBE_CLUSTER || v->storage == CB_EBE_RECOMPUTE;
  const struct cb_arithmetic *a = v->arithmetic;
  if (!unassembled || (a != cb_bench_lanes(sizeof(float)) && a != cb_bench_lanes(sizeof(double))))
    return false;
  for (size_t i = 0; i < MODEL_COUNT; i++)
    if (strcmp(v->model->name, MODELS[i]) == 0) return true;
  return false;
}

/* ---- error ------------------------------------------------------------------ */

/* Of one model in ebe/f64: forces at the start, N, positions after STEPS steps, m. */
struct truth {
  const char *model;
  double *force, *x; /* [3*nodes]; in one allocation */
};

/* Forces at the start and positions after STEPS steps of a job, which then is at
 * its start again. */
static void evaluate(struct cb_job *job, size_t nodes, double *force, double *x) {
  const struct cb_arithmetic *a = job->variant->arithmetic;
  cb_operator_reset(job->op);
  cb_operator_update(job->op, job->start_x, NULL, 1, job->v);
  a->to_double(nodes, job->v, force);
  memcpy(job->x, job->start_x, job->vector_bytes);
  memcpy(job->v, job->start_v, job->vector_bytes);
  cb_stepper_set_iterations(job->stepper, ITERATIONS[0]);
  bool finite = true;
  for (int i = 0; i < STEPS; i++) {
    cb_stepper_step(job->stepper, job->x, job->v, NULL);
    finite = finite && cb_stepper_ended(job->stepper).why != CB_ENDED_OVERFLOW;
  }
  a->to_double(nodes, job->x, x);
  if (!finite) x[0] = NAN; /* was kept out of the positions */
  memcpy(job->x, job->start_x, job->vector_bytes);
  memcpy(job->v, job->start_v, job->vector_bytes);
}

static enum cb_status find_truth(const struct cb_variant *v, const struct cb_bench_scene *scene,
                                 struct truth *truth) {
  char name[CB_NAME];
  const struct cb_variant same = {v->model, CB_EBE, cb_arithmetics[0]};
  cb_variant_name(&same, name);
  const struct cb_variant *exact = cb_variant_find(name);
  struct cb_job job = {0};
  double *numbers = malloc(6 * scene->mesh.nodes * sizeof *numbers);
  enum cb_status status = numbers ? CB_OK : cb_fail_memory("the forces in f64");
  if (!status && !exact) status = cb_fail(CB_BROKEN, "%s is not in this program", name);
  if (!status) status = cb_job_create(exact, 1, scene, &cb_bench_step, &job);
  if (status) {
    free(numbers);
    return status;
  }
  *truth = (struct truth){v->model->name, numbers, numbers + 3 * scene->mesh.nodes};
  evaluate(&job, scene->mesh.nodes, truth->force, truth->x);
  cb_job_free(&job);
  return CB_OK;
}

/* Largest difference by the largest of `exact - start`; start NULL: zero. */
static double error_of(size_t n, const double *found, const double *exact, const double *start) {
  double error = 0, scale = 0;
  for (size_t i = 0; i < n; i++) {
    const double difference = fabs(found[i] - exact[i]);
    if (!isnan(error) && !(difference <= error)) error = difference; /* a NaN stays */
    scale = fmax(scale, fabs(exact[i] - (start ? start[i] : 0)));
  }
  return error / scale;
}

/* ---- rows ------------------------------------------------------------------- */

struct session {
  const struct place *place;
  struct truth truths[64];
  size_t truth_count;
};

static enum cb_status truth_of(struct session *s, const struct cb_variant *v,
                               const struct cb_bench_scene *scene, const struct truth **found) {
  for (size_t i = 0; i < s->truth_count; i++)
    if (strcmp(s->truths[i].model, v->model->name) == 0) {
      *found = &s->truths[i];
      return CB_OK;
    }
  if (s->truth_count == sizeof s->truths / sizeof *s->truths)
    return cb_fail(CB_INPUT, "--variant selects too many models for this figure; use fewer");
  const enum cb_status status = find_truth(v, scene, &s->truths[s->truth_count]);
  if (!status) *found = &s->truths[s->truth_count++];
  return status;
}

static bool is_base(const struct cb_job *job) {
  return strcmp(job->name, BASE) == 0 && job->threads == 1;
}

static enum cb_status add_speed(struct cb_bench *b, const struct cb_block *block, size_t j,
                                const struct cb_ratio *ratio) {
  const struct cb_bench_scene *scene = block->plan->scene;
  struct session *s = block->plan->context;
  struct cb_job *job = &block->jobs[j];
  const size_t n = 3 * scene->mesh.nodes;
  const struct truth *truth = NULL;
  struct cb_speed speed = {.mesh = s->place->name,
                           .tetrahedra = scene->mesh.tets,
                           .threads = job->threads,
                           .faster = ratio ? ratio->ratio : (struct cb_interval){NAN, NAN, NAN},
                           .bytes_per_tetrahedron =
                               (double)cb_operator_bytes(job->op) / (double)scene->mesh.tets};
  snprintf(speed.variant, sizeof speed.variant, "%s", job->name);
  double *found = malloc(2 * n * sizeof *found);
  enum cb_status status = found ? CB_OK : cb_fail_memory("the forces");
  if (!status) status = truth_of(s, job->variant, scene, &truth);
  if (!status)
    status =
        cb_median_interval(block->samples.rounds, cb_block_step_s(block, j, 0), &speed.step, NULL);
  if (!status) {
    evaluate(job, scene->mesh.nodes, found, found + n);
    speed.force_error = error_of(n, found, truth->force, NULL);
    speed.position_error = error_of(n, found + n, truth->x, scene->x);
    status = cb_results_add_speed(&b->results, &speed);
  }
  free(found);
  return status;
}

/* The base is in every block, and once among the speeds. */
static bool has_base(const struct cb_results *r, const struct place *place) {
  for (size_t i = 0; i < r->speed_count; i++)
    if (strcmp(r->speeds[i].mesh, place->name) == 0 && r->speeds[i].threads == 1 &&
        strcmp(r->speeds[i].variant, BASE) == 0)
      return true;
  return false;
}

static enum cb_status add_speeds(struct cb_bench *b, const struct cb_block *block) {
  const struct cb_results *r = &b->results;
  struct session *s = block->plan->context;
  size_t base = 0;
  enum cb_status status = CB_OK;
  while (base < block->job_count && !is_base(&block->jobs[base])) base++;
  const bool compared = base < block->job_count && !block->jobs[base].lost;
  for (size_t j = 0; !status && j < block->job_count; j++) {
    if (block->jobs[j].lost || (j == base && has_base(r, s->place))) continue;
    if (compared) status = cb_block_ratio(b, block, base, j, 0, NAN);
    if (!status) status = add_speed(b, block, j, compared ? &r->ratios[r->ratio_count - 1] : NULL);
  }
  return status;
}

/* ---- run -------------------------------------------------------------------- */

static bool same_threads(const struct cb_entry *e, const struct cb_entry *f) {
  return e->threads == f->threads;
}

/* The base, on one thread, in each block: one for each number of threads. */
static enum cb_status run_place(struct cb_bench *b, struct session *s, size_t count,
                                const struct cb_entry *entries, double budget_s) {
  struct cb_bench_scene scene = {0};
  const struct cb_entry base = {cb_variant_find(BASE), 1};
  struct cb_entry *list = malloc((count + 2) * sizeof *list);
  enum cb_status status = list ? CB_OK : cb_fail_memory("the list of variants");
  const size_t *cells = b->results.quick ? s->place->quick_cells : s->place->cells;
  if (!status) status = s->place->make(cells, b->options->seed, &scene);
  for (size_t i = 0; !status && i < count; i++) {
    const size_t chosen = cb_bench_group(i, count, entries, same_threads, list + 1);
    bool there = false;
    for (size_t k = 1; k <= chosen; k++)
      there = there || (list[k].variant == base.variant && list[k].threads == base.threads);
    list[0] = base;
    const struct cb_block_plan plan = {.figure = "speed",
                                       .scene = &scene,
                                       .entry_count = chosen + !there,
                                       .entries = list + there,
                                       .count_count = 1,
                                       .iterations = ITERATIONS,
                                       .budget_s = budget_s * (double)chosen / (double)count,
                                       .after = add_speeds,
                                       .context = s};
    if (chosen > 0) status = cb_bench_block(b, &plan);
  }
  cb_bench_scene_free(&scene);
  free(list);
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_entry *entries = NULL;
  size_t count = 0;
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  for (size_t i = 0; !status && i < MESHES; i++) {
    struct session s = {.place = &PLACES[i]};
    status = run_place(b, &s, count, entries, PLACES[i].share * budget_s);
    for (size_t k = 0; k < s.truth_count; k++) free(s.truths[k].force);
  }
  free(entries);
  return status;
}

static void print_place(const struct cb_results *r, const struct place *place, FILE *stream) {
  struct cb_table *t = cb_table_create("variant,threads,step_us,ns_per_tetrahedron,times_faster,"
                                       "bytes_per_tetrahedron,force_error,position_error");
  size_t tets = 0;
  for (size_t i = 0; t && i < r->speed_count; i++) {
    const struct cb_speed *s = &r->speeds[i];
    if (strcmp(s->mesh, place->name) != 0) continue;
    tets = s->tetrahedra;
    cb_table_text(t, s->variant);
    cb_table_integer(t, (long long)s->threads);
    cb_bench_number_cell(t, 1e6 * s->step.value);
    cb_bench_number_cell(t, 1e9 * s->step.value / (double)s->tetrahedra);
    cb_bench_interval_cell(t, s->faster);
    cb_bench_number_cell(t, s->bytes_per_tetrahedron);
    cb_bench_number_cell(t, s->force_error);
    cb_bench_number_cell(t, s->position_error);
  }
  char title[400];
  snprintf(title, sizeof title,
           "Speed against %s on one thread, %s mesh of %zu tetrahedra, 5 iterations [95 %% "
           "interval]; errors\nagainst the same model in ebe/f64: largest difference of a force by "
           "the largest force at the start;\nof a position after %d steps by the largest "
           "displacement since the start",
           BASE, place->name, tets, STEPS);
  cb_bench_print(stream, title, t);
}

static void print(const struct cb_results *r, FILE *stream) {
  for (size_t i = 0; i < MESHES; i++) print_place(r, &PLACES[i], stream);
}

const struct cb_bench_figure cb_bench_speed = {"speed", 0.1, false, run, print};
