/* Figure 4 of the paper: time of one step against the number of conjugate
 * gradient iterations, assembled and not, and where assembling starts to pay.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"

enum { COUNTS = 8 };
static const size_t ITERATIONS[COUNTS] = {1, 2, 5, 10, 20, 50, 100, 200};
static const double PAPER_CROSSING = 50; /* section 3.2 */

/* In f64 as in the paper, and in the widest lanes. */
static bool wanted(const struct cb_variant *v) {
  const bool clustered = v->storage == CB_EBE_CLUSTER || v->storage == CB_EBE_RECOMPUTE;
  const bool plain = v->storage == CB_EBE || v->storage == CB_BCSR;
  if (strcmp(v->model->name, "qr-updated") != 0) return false;
  if (v->arithmetic == cb_arithmetics[0]) return !clustered;
  return v->arithmetic == cb_bench_lanes(sizeof(float)) && (clustered || plain);
}

static bool assembled(const struct cb_variant *v) { return v->storage >= CB_CSR; }

/* The line of a job's times, and as many as the bootstrap draws. */
struct job_line {
  struct cb_line line, drawn[CB_REPLICATES];
};

static enum cb_status fit_job(const struct cb_block *block, size_t j, unsigned long seed,
                              struct job_line *out) {
  double iterations[COUNTS];
  const double *seconds[COUNTS];
  for (size_t c = 0; c < COUNTS; c++) {
    iterations[c] = (double)ITERATIONS[c];
    seconds[c] = cb_block_step_s(block, j, c);
  }
  const struct cb_series series = {COUNTS, block->samples.rounds, iterations, seconds};
  enum cb_status status = cb_line_fit(&series, &out->line);
  if (!status) status = cb_line_bootstrap(&series, seed, out->drawn);
  return status;
}

static enum cb_status add_fit(struct cb_bench *b, const struct cb_block *block, size_t j,
                              const struct job_line *line, double *work) {
  struct cb_fit fit = {.tetrahedra = block->plan->scene->mesh.tets,
                       .threads = block->jobs[j].threads};
  snprintf(fit.variant, CB_NAME, "%s", block->jobs[j].name);
  fit.fixed.value = line->line.intercept;
  for (size_t i = 0; i < CB_REPLICATES; i++) work[i] = line->drawn[i].intercept;
  cb_percentile_interval(CB_REPLICATES, work, &fit.fixed);
  fit.iteration.value = line->line.slope;
  for (size_t i = 0; i < CB_REPLICATES; i++) work[i] = line->drawn[i].slope;
  cb_percentile_interval(CB_REPLICATES, work, &fit.iteration);
  return cb_results_add_fit(&b->results, &fit);
}

static enum cb_status add_crossing(struct cb_bench *b, const struct cb_block *block, size_t first,
                                   size_t second, const struct job_line *lines, double *work) {
  struct cb_crossing crossing = {.tetrahedra = block->plan->scene->mesh.tets,
                                 .threads = block->jobs[first].threads,
                                 .paper = PAPER_CROSSING};
  snprintf(crossing.assembled, CB_NAME, "%s", block->jobs[first].name);
  snprintf(crossing.unassembled, CB_NAME, "%s", block->jobs[second].name);
  crossing.iterations.value = cb_line_crossing(lines[first].line, lines[second].line);
  for (size_t i = 0; i < CB_REPLICATES; i++)
    work[i] = cb_line_crossing(lines[first].drawn[i], lines[second].drawn[i]);
  cb_percentile_interval(CB_REPLICATES, work, &crossing.iterations);
  return cb_results_add_crossing(&b->results, &crossing);
}

static bool is_pair(const struct cb_job *first, const struct cb_job *second) {
  const struct cb_variant *v = first->variant, *w = second->variant;
  return assembled(v) && !assembled(w) && v->model == w->model && v->arithmetic == w->arithmetic &&
         first->threads == second->threads && !first->lost && !second->lost;
}

static enum cb_status add_lines(struct cb_bench *b, const struct cb_block *block) {
  struct job_line *lines = malloc((block->job_count + 1) * sizeof *lines);
  double *work = malloc(CB_REPLICATES * sizeof *work);
  enum cb_status status = lines && work ? CB_OK : cb_fail_memory("the lines of figure 4");
  for (size_t j = 0; !status && j < block->job_count; j++) {
    if (block->jobs[j].lost) continue;
    status = fit_job(block, j, b->options->seed, &lines[j]);
    if (!status) status = add_fit(b, block, j, &lines[j], work);
  }
  for (size_t i = 0; i < block->job_count; i++)
    for (size_t j = 0; !status && j < block->job_count; j++)
      if (is_pair(&block->jobs[i], &block->jobs[j]))
        status = add_crossing(b, block, i, j, lines, work);
  free(lines);
  free(work);
  return status;
}

static bool same_threads(const struct cb_entry *e, const struct cb_entry *f) {
  return e->threads == f->threads;
}

/* A block for each number of threads: one thread is not kept on a processor for two. */
static enum cb_status run_blocks(struct cb_bench *b, const struct cb_bench_scene *scene,
                                 size_t count, const struct cb_entry *entries, double budget_s) {
  struct cb_entry *list = malloc((count + 1) * sizeof *list);
  enum cb_status status = list ? CB_OK : cb_fail_memory("the list of variants");
  for (size_t i = 0; !status && i < count; i++) {
    const size_t chosen = cb_bench_group(i, count, entries, same_threads, list);
    const struct cb_block_plan plan = {.figure = "4",
                                       .scene = scene,
                                       .entry_count = chosen,
                                       .entries = list,
                                       .count_count = COUNTS,
                                       .iterations = ITERATIONS,
                                       .budget_s = budget_s * (double)chosen / (double)count,
                                       .after = add_lines};
    if (chosen > 0) status = cb_bench_block(b, &plan);
  }
  free(list);
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_entry *entries = NULL;
  size_t count = 0;
  struct cb_bench_scene scene = {0};
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (!status) status = cb_bench_scene_grid(cb_bench_paper_cells, b->options->seed, &scene);
  if (!status) status = run_blocks(b, &scene, count, entries, budget_s);
  cb_bench_scene_free(&scene);
  free(entries);
  return status;
}

static void print_steps(const struct cb_results *r, FILE *stream) {
  struct cb_table *t =
      cb_table_create("variant,threads,1,2,5,10,20,50,100,200,fixed_us,iteration_us");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *first = &r->rows[i];
    if (strcmp(first->figure, "4") != 0 || first->iterations != ITERATIONS[0]) continue;
    cb_table_text(t, first->variant);
    cb_table_integer(t, (long long)first->threads);
    for (size_t c = 0; c < COUNTS; c++)
      cb_bench_step_cell(t, cb_bench_row(r, first, first->tetrahedra, ITERATIONS[c]), 1e6);
    const struct cb_fit *fit = NULL;
    for (size_t k = 0; k < r->fit_count; k++)
      if (strcmp(r->fits[k].variant, first->variant) == 0 && r->fits[k].threads == first->threads)
        fit = &r->fits[k];
    if (fit) {
      cb_table_number(t, 1e6 * fit->fixed.value);
      cb_table_number(t, 1e6 * fit->iteration.value);
    } else {
      cb_table_missing(t);
      cb_table_missing(t);
    }
  }
  cb_bench_print(stream,
                 "Figure 4: time of one step (us) at 1 to 200 conjugate gradient iterations, 3430 "
                 "tetrahedra; the line through them",
                 t);
}

static void print_crossings(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("assembled,unassembled,threads,from_iterations,paper");
  for (size_t i = 0; t && i < r->crossing_count; i++) {
    cb_table_text(t, r->crossings[i].assembled);
    cb_table_text(t, r->crossings[i].unassembled);
    cb_table_integer(t, (long long)r->crossings[i].threads);
    cb_bench_interval_cell(t, r->crossings[i].iterations);
    cb_table_number(t, r->crossings[i].paper);
  }
  cb_bench_print(stream, "Assembling is the cheaper from so many iterations on [95 % interval]", t);
}

static void print(const struct cb_results *r, FILE *stream) {
  print_steps(r, stream);
  print_crossings(r, stream);
}

const struct cb_bench_figure cb_bench_figure4 = {"4", 0.1, false, run, print};
