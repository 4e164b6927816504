/* Blocks of variants, timed in the same rounds, and the rows they become.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/progress.h"

/* 21 rounds give the median an interval from the 6th to the 16th sample. */
enum { ROUNDS = 21, MIN_ROUNDS = 6, PART_ROUNDS = 7, PARTS = 3 };
static const double MIN_EPOCH = 2e-3; /* s: the clock's resolution is then 1e-4 of it or better */
/* Share of the budget for whole steps; the parts get what is left. */
static const double STEP_SHARE = 0.8;

static struct cb_row row_of(const struct cb_block *block, struct cb_entry entry, size_t count) {
  char name[CB_NAME];
  cb_variant_name(entry.variant, name);
  struct cb_row row = cb_row_unmeasured(block->plan->figure, name, &block->plan->scene->mesh);
  row.iterations = block->plan->iterations[count];
  row.threads = entry.threads;
  return row;
}

/* Rows without a time, and why. */
static enum cb_status refuse(struct cb_bench *b, const struct cb_block *block,
                             struct cb_entry entry, const char *reason) {
  enum cb_status status = CB_OK;
  for (size_t c = 0; !status && c < block->plan->count_count; c++) {
    struct cb_row row = row_of(block, entry, c);
    snprintf(row.status, sizeof row.status, "failed: %s", reason);
    status = cb_results_add_row(&b->results, &row);
  }
  return status;
}

static void free_block(struct cb_block *block) {
  for (size_t i = 0; i < block->job_count; i++) cb_job_free(&block->jobs[i]);
  free(block->jobs);
  cb_samples_free(&block->samples);
}

/* A job, or a row that says why not. */
static enum cb_status admit(struct cb_bench *b, struct cb_block *block, struct cb_entry entry) {
  const char *reason;
  enum cb_status status = cb_bench_gate(b, entry.variant, &reason);
  if (status) return status;
  if (cb_interrupted()) return cb_fail(CB_INTERRUPTED, "interrupted before a measurement");
  if (reason[0]) return refuse(b, block, entry, reason);
  status = cb_job_create(entry.variant, entry.threads, block->plan->scene, &cb_bench_step,
                         &block->jobs[block->job_count]);
  if (!status) block->job_count++;
  return status;
}

/* ---- what is timed ----------------------------------------------------------- */

struct work {
  struct cb_job *job;
  size_t iterations;
};

/* Every epoch begins in the same state; warm-started frames keep their memory. */
static void restore(void *context) {
  const struct work *work = context;
  struct cb_job *job = work->job;
  memcpy(job->x, job->start_x, job->vector_bytes);
  memcpy(job->v, job->start_v, job->vector_bytes);
  cb_stepper_set_iterations(job->stepper, work->iterations);
}

static void restore_right_side(void *context) {
  const struct work *work = context;
  restore(context);
  cb_stepper_right_side(work->job->stepper, work->job->x, work->job->v, NULL);
}

static void run_steps(void *context, size_t repeats) {
  const struct work *work = context;
  cb_job_steps(work->job, repeats);
}

static void run_update(void *context, size_t repeats) {
  const struct work *work = context;
  for (size_t i = 0; i < repeats; i++)
    cb_stepper_right_side(work->job->stepper, work->job->x, work->job->v, NULL);
}

static void run_solve(void *context, size_t repeats) {
  const struct work *work = context;
  for (size_t i = 0; i < repeats; i++) cb_stepper_solve(work->job->stepper);
}

static void run_product(void *context, size_t repeats) {
  const struct work *work = context;
  for (size_t i = 0; i < repeats; i++)
    cb_operator_product(work->job->op, work->job->start_v, work->job->v);
}

/* ---- timing -------------------------------------------------------------------- */

struct watch {
  const struct cb_bench *b;
  const struct cb_block *block;
  double first_s, budget_s; /* of the planned time */
};

static void show(void *context, double share, const char *subject) {
  const struct watch *watch = context;
  char what[CB_NAME + 64];
  snprintf(what, sizeof what, "%s, %zu tetrahedra: %s", watch->block->plan->figure,
           watch->block->plan->scene->mesh.tets, subject);
  cb_progress(watch->b->done_s + watch->first_s + share * watch->budget_s, what);
}

/* Epochs as long as the budget allows for that many rounds: more time makes
 * every sample steadier. */
static enum cb_status time_works(const struct cb_bench *b, struct watch *watch, size_t count,
                                 const struct cb_subject *subjects, size_t rounds,
                                 struct cb_samples *samples) {
  const double epoch = 0.8 * watch->budget_s / (double)(count * rounds);
  const struct cb_timing timing = {.epoch_s = fmax(epoch, MIN_EPOCH),
                                   .budget_s = watch->budget_s,
                                   .min_rounds = MIN_ROUNDS,
                                   .max_rounds = rounds,
                                   .seed = b->options->seed,
                                   .progress = show,
                                   .progress_context = watch};
  return cb_timer_run(count, subjects, &timing, samples);
}

static enum cb_status time_steps(const struct cb_bench *b, struct cb_block *block,
                                 struct watch *watch) {
  const size_t count = block->job_count * block->plan->count_count;
  struct work *works = malloc(count * sizeof *works);
  struct cb_subject *subjects = malloc(count * sizeof *subjects);
  enum cb_status status = works && subjects ? CB_OK : cb_fail_memory("the measurement");
  for (size_t i = 0; !status && i < count; i++) {
    struct cb_job *job = &block->jobs[i / block->plan->count_count];
    works[i] = (struct work){job, block->plan->iterations[i % block->plan->count_count]};
    subjects[i] = (struct cb_subject){job->name, restore, run_steps, &works[i]};
  }
  if (!status) status = time_works(b, watch, count, subjects, ROUNDS, &block->samples);
  free(works);
  free(subjects);
  return status;
}

static enum cb_status time_parts(const struct cb_bench *b, const struct cb_block *block,
                                 struct watch *watch, struct cb_samples *samples) {
  const size_t count = PARTS * block->job_count;
  struct work *works = malloc(block->job_count * sizeof *works);
  struct cb_subject *subjects = malloc(count * sizeof *subjects);
  enum cb_status status = works && subjects ? CB_OK : cb_fail_memory("the measurement");
  for (size_t i = 0; !status && i < block->job_count; i++) {
    const char *name = block->jobs[i].name;
    works[i] = (struct work){&block->jobs[i], block->plan->iterations[0]};
    subjects[PARTS * i] = (struct cb_subject){name, restore, run_update, &works[i]};
    subjects[PARTS * i + 1] = (struct cb_subject){name, restore_right_side, run_solve, &works[i]};
    subjects[PARTS * i + 2] = (struct cb_subject){name, restore_right_side, run_product, &works[i]};
  }
  if (!status) status = time_works(b, watch, count, subjects, PART_ROUNDS, samples);
  free(works);
  free(subjects);
  return status;
}

/* ---- rows ------------------------------------------------------------------------ */

static enum cb_status median_of(const struct cb_samples *samples, size_t subject, double *median) {
  struct cb_interval interval;
  const double *step_s = samples->step_s + subject * samples->stride;
  const enum cb_status status = cb_median_interval(samples->rounds, step_s, &interval, NULL);
  if (!status) *median = interval.value;
  return status;
}

/* After its steps a job must still be somewhere. */
static enum cb_status find_lost(struct cb_block *block) {
  const size_t nodes = block->plan->scene->mesh.nodes;
  double *x = malloc(3 * nodes * sizeof *x);
  if (!x) return cb_fail_memory("the check of the state");
  for (size_t j = 0; j < block->job_count; j++) {
    struct cb_job *job = &block->jobs[j];
    job->lost = job->lost || !cb_job_finite(job, job->x, x);
  }
  free(x);
  return CB_OK;
}

/* Row of subject i; parts may be NULL. */
static enum cb_status add_row(struct cb_bench *b, const struct cb_block *block, size_t i,
                              const struct cb_samples *parts) {
  const size_t j = i / block->plan->count_count;
  const struct cb_job *job = &block->jobs[j];
  struct cb_row row =
      row_of(block, (struct cb_entry){job->variant, job->threads}, i % block->plan->count_count);
  row.bytes_per_tetrahedron = (double)cb_operator_bytes(job->op) / (double)row.tetrahedra;
  row.setup_s = job->setup_s;
  if (job->lost) {
    snprintf(row.status, sizeof row.status,
             "failed: the steps end early or leave the finite numbers");
    return cb_results_add_row(&b->results, &row);
  }
  enum cb_status status = CB_OK;
  if (parts) status = median_of(parts, PARTS * j, &row.update_s);
  if (parts && !status) status = median_of(parts, PARTS * j + 1, &row.solve_s);
  if (parts && !status) status = median_of(parts, PARTS * j + 2, &row.product_s);
  if (!status) status = cb_results_add_measured(&b->results, &row, &block->samples, i);
  return status;
}

static enum cb_status measure(struct cb_bench *b, struct cb_block *block) {
  const double budget_s = block->plan->budget_s;
  const double step_s = block->plan->parts ? STEP_SHARE * budget_s : budget_s;
  struct watch steps = {b, block, 0, step_s}, rest = {b, block, step_s, budget_s - step_s};
  struct cb_samples parts = {0};
  enum cb_status status = time_steps(b, block, &steps);
  if (!status) status = find_lost(block);
  if (!status && block->plan->parts) status = time_parts(b, block, &rest, &parts);
  for (size_t i = 0; !status && i < block->job_count * block->plan->count_count; i++)
    status = add_row(b, block, i, block->plan->parts ? &parts : NULL);
  cb_samples_free(&parts);
  return status;
}

const double *cb_block_step_s(const struct cb_block *block, size_t job, size_t count) {
  const size_t subject = job * block->plan->count_count + count;
  return block->samples.step_s + subject * block->samples.stride;
}

static enum cb_status run_block(struct cb_bench *b, void *context) {
  const struct cb_block_plan *plan = context;
  struct cb_block block = {.plan = plan};
  block.jobs = calloc(plan->entry_count + 1, sizeof *block.jobs);
  enum cb_status status = block.jobs ? CB_OK : cb_fail_memory("the list of variants");
  for (size_t i = 0; !status && i < plan->entry_count; i++)
    status = admit(b, &block, plan->entries[i]);
  if (!status && block.job_count > 0) status = measure(b, &block);
  if (!status && block.job_count > 0 && plan->after) status = plan->after(b, &block);
  free_block(&block);
  return status;
}

enum cb_status cb_bench_block(struct cb_bench *b, const struct cb_block_plan *plan) {
  char key[2 * CB_NAME + 256], first[CB_NAME], last[CB_NAME];
  const struct cb_entry *begin = plan->entries, *end = begin + plan->entry_count - 1;
  cb_variant_name(begin->variant, first);
  cb_variant_name(end->variant, last);
  snprintf(key, sizeof key,
           "figure %s: %zu tetrahedra, %zu nodes, %zu counts of iterations from %zu, %zu entries "
           "from %s on %zu to %s on %zu threads",
           plan->figure, plan->scene->mesh.tets, plan->scene->mesh.nodes, plan->count_count,
           plan->iterations[0], plan->entry_count, first, begin->threads, last, end->threads);
  const enum cb_status status = cb_bench_part(b, key, run_block, (void *)plan);
  b->done_s += plan->budget_s;
  return status;
}
