/* The largest mesh whose step fits into a frame of 33 ms: found by measuring meshes
 * of different sizes, never by extrapolation.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/scaling.h"
#include "harness/bench/search.h"
#include "harness/error.h"
#include "harness/progress.h"

static const double LIMIT = 33e-3;      /* s */
static const double MEMORY_SHARE = 0.5; /* of the machine's, at most */
static const double STEPS_S = 0.4;      /* s of timing for each mesh */
static const double RESOLUTION = 0.02;  /* of the cells along an edge, 6 % of all */
static const double QUICK_RESOLUTION = 0.1;
enum { ROUNDS = 15, MIN_ROUNDS = 6, TRIALS = 3, LEAST = 2, MESHES = 2 };

static const struct kind {
  const char *name;
  enum cb_status (*make)(const size_t cells[3], unsigned long seed, struct cb_bench_scene *scene);
  double tets_per_cell;
  double guess; /* of the tetrahedra of a grid as fast: where to begin */
} KINDS[MESHES] = {{"grid", cb_bench_scene_grid, 10, 1},
                   {"irregular", cb_bench_scene_irregular, 6, 0.72}};

struct session {
  struct cb_bench *b;
  const struct kind *kind;
  struct cb_entry entry;
  struct cb_frame_size fits, exceeds; /* the nearest so far */
  double first_s, budget_s;           /* of the planned time */
  size_t measured;
};

/* *step := median of a job's time, *fastest := the least, s. */
static enum cb_status time_once(const struct cb_bench *b, struct cb_job *job,
                                struct cb_interval *step, double *fastest) {
  const struct cb_subject subject = {job->name, cb_job_restore, cb_job_steps, job};
  const struct cb_timing timing = {.budget_s = STEPS_S,
                                   .min_rounds = MIN_ROUNDS,
                                   .max_rounds = ROUNDS,
                                   .seed = b->options->seed};
  struct cb_samples samples = {0};
  enum cb_status status = cb_timer_run(1, &subject, &timing, &samples);
  if (!status) status = cb_median_interval(samples.rounds, samples.step_s, step, NULL);
  *fastest = INFINITY;
  for (size_t i = 0; !status && i < samples.rounds; i++)
    *fastest = fmin(*fastest, samples.step_s[i]);
  cb_samples_free(&samples);
  return status;
}

/* A median beyond the limit of which some samples are within it may be the work of
 * another program, and would end the search far from its goal: it is taken again. */
static enum cb_status time_job(const struct cb_bench *b, struct cb_job *job,
                               struct cb_interval *step) {
  double fastest = 0;
  enum cb_status status = CB_OK;
  *step = (struct cb_interval){INFINITY, INFINITY, INFINITY};
  for (int i = 0; !status && i < TRIALS && step->value > LIMIT && fastest <= LIMIT; i++)
    status = time_once(b, job, step, &fastest);
  return status;
}

static void show(const struct session *s, size_t tets, const char *name) {
  char what[CB_NAME + 96];
  snprintf(what, sizeof what, "largest mesh in 33 ms: %s, %s, %zu tetrahedra", name, s->kind->name,
           tets);
  const double share = 1 - 1 / (1 + 0.4 * (double)s->measured); /* it is not known how many */
  cb_progress(s->b->done_s + s->first_s + share * s->budget_s, what);
}

static enum cb_status measure(void *context, size_t cells, double *cost) {
  struct session *s = context;
  struct cb_bench_scene scene = {0};
  struct cb_job job = {0};
  struct cb_frame_size size = {.cells = cells};
  char name[CB_NAME];
  cb_variant_name(s->entry.variant, name);
  if (cb_interrupted()) return cb_fail(CB_INTERRUPTED, "interrupted while searching");
  show(s, (size_t)(s->kind->tets_per_cell * pow((double)cells, 3)), name);
  enum cb_status status =
      s->kind->make((const size_t[3]){cells, cells, cells}, s->b->options->seed, &scene);
  if (!status)
    status = cb_job_create(s->entry.variant, s->entry.threads, &scene, &cb_bench_step, &job);
  if (!status) status = time_job(s->b, &job, &size.step);
  if (!status) {
    size.tetrahedra = scene.mesh.tets;
    size.bytes =
        (double)(cb_operator_bytes(job.op) + cb_stepper_bytes(job.stepper) + 2 * job.vector_bytes);
    *cost = size.step.value;
    if (*cost <= LIMIT)
      s->fits = size;
    else
      s->exceeds = size;
    s->measured++;
  }
  cb_job_free(&job);
  cb_bench_scene_free(&scene);
  return status;
}

/* Cells along an edge of a mesh of so many tetrahedra, in [LEAST, most]. */
static size_t edge_of(const struct kind *kind, double tets, size_t most) {
  const double edge = cbrt(tets / kind->tets_per_cell);
  return edge > (double)most ? most : edge > LEAST ? (size_t)edge : LEAST;
}

static enum cb_status add_frame(struct session *s, size_t measurements) {
  struct cb_frame frame = {.mesh = s->kind->name,
                           .threads = s->entry.threads,
                           .iterations = CB_SCALING_ITERATIONS,
                           .measurements = measurements,
                           .limit_s = LIMIT,
                           .fits = s->fits,
                           .exceeds = s->exceeds};
  cb_variant_name(s->entry.variant, frame.variant);
  return cb_results_add_frame(&s->b->results, &frame);
}

/* One search, from what a smaller or larger mesh took. */
static enum cb_status search(struct cb_bench *b, void *context) {
  struct session *s = context;
  const struct cb_row *row = cb_scaling_last(&b->results, s->entry);
  const double memory = b->results.environment.memory, tets = (double)row->tetrahedra;
  const double room = memory > 0 ? MEMORY_SHARE * memory / cb_scaling_bytes(row, 1) : 1e8;
  struct cb_search search = {.low = LEAST,
                             .high = edge_of(s->kind, room, 1000),
                             .resolution = b->results.quick ? QUICK_RESOLUTION : RESOLUTION,
                             .limit = LIMIT,
                             .measure = measure,
                             .context = s};
  search.first = edge_of(s->kind, s->kind->guess * LIMIT * tets / row->step.value, search.high);
  s->measured = 0;
  const enum cb_status status = cb_search_run(&search);
  return status ? status : add_frame(s, search.measurements);
}

static double seconds_of(const struct cb_results *r, struct cb_entry entry) {
  const struct cb_row *row = cb_scaling_last(r, entry);
  return row ? row->step.value / (double)row->tetrahedra : INFINITY;
}

/* The fastest first: what there is no time for is what matters least. */
static void sort(const struct cb_results *r, size_t count, struct cb_entry *entries) {
  for (size_t i = 1; i < count; i++)
    for (size_t k = i; k > 0 && seconds_of(r, entries[k]) < seconds_of(r, entries[k - 1]); k--) {
      const struct cb_entry entry = entries[k];
      entries[k] = entries[k - 1];
      entries[k - 1] = entry;
    }
}

enum cb_status cb_frame_search(struct cb_bench *b, size_t count, struct cb_entry *entries,
                               double budget_s) {
  struct session s = {.b = b, .budget_s = budget_s / (double)(MESHES * count + !count)};
  enum cb_status status = CB_OK;
  const double begin = cb_timer_now();
  sort(&b->results, count, entries);
  for (size_t i = 0; !status && i < count; i++) {
    const bool in_time = i == 0 || cb_timer_now() - begin < budget_s;
    for (size_t k = 0; !status && k < MESHES; k++, s.first_s += s.budget_s) {
      char key[2 * CB_NAME + 64], name[CB_NAME];
      if (!cb_scaling_last(&b->results, entries[i])) continue;
      s.entry = entries[i];
      s.kind = &KINDS[k];
      s.fits = s.exceeds = (struct cb_frame_size){0};
      cb_variant_name(entries[i].variant, name);
      snprintf(key, sizeof key, "frame: %s, %s on %zu threads", KINDS[k].name, name,
               entries[i].threads);
      status = in_time ? cb_bench_part(b, key, search, &s) : add_frame(&s, 0);
    }
  }
  return status;
}

static void size_cells(struct cb_table *t, const struct cb_frame_size *size) {
  if (size->cells == 0) {
    for (int i = 0; i < 4; i++) cb_table_missing(t);
    return;
  }
  cb_table_integer(t, (long long)size->tetrahedra);
  cb_table_integer(t, (long long)size->cells);
  cb_table_number(t, 1e3 * size->step.value);
  cb_table_number(t, 1e-6 * size->bytes);
}

void cb_frame_print(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create(
      "variant,mesh,threads,tetrahedra,cells,step_ms,MB,does_not_fit,cells,step_ms,MB,measured");
  size_t left_out = 0;
  for (size_t i = 0; t && i < r->frame_count; i++) {
    const struct cb_frame *f = &r->frames[i];
    left_out += f->measurements == 0;
    if (f->measurements == 0) continue;
    cb_table_text(t, f->variant);
    cb_table_text(t, f->mesh);
    cb_table_integer(t, (long long)f->threads);
    size_cells(t, &f->fits);
    size_cells(t, &f->exceeds);
    cb_table_integer(t, (long long)f->measurements);
  }
  cb_bench_print(stream,
                 "The largest mesh whose step of 5 iterations fits into 33 ms, and the next one "
                 "measured that does not;\ncells: along each edge of the block; MB: operator, "
                 "solver and node vectors; measured: meshes tried",
                 t);
  if (left_out > 0)
    fprintf(stream, "%zu more were not searched: there was no time; give more with --seconds\n",
            left_out);
}
