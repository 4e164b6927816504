/* Time of a step against the number of tetrahedra, of threads and of iterations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/scaling.h"
#include "harness/error.h"
#include "harness/measure/crew.h"
#include "harness/progress.h"

enum { COUNTS = 6 };
static const size_t ONE_COUNT[1] = {CB_SCALING_ITERATIONS},
                    ALL_COUNTS[COUNTS] = {1, 2, 5, 10, 20, 50};

/* 500 to 2 million tetrahedra; each cache ends somewhere between. */
static const struct size {
  size_t edge[3];
  bool large;       /* one variant at a time, and not in quick runs */
  bool all_threads; /* as many as there are, besides those of the others */
  bool all_counts;
} SIZES[] = {{{5, 5, 2}, false, false, false},    {{7, 7, 7}, false, false, true},
             {{10, 10, 10}, false, false, false}, {{15, 15, 15}, false, true, false},
             {{22, 22, 22}, false, false, false}, {{27, 27, 27}, true, false, false},
             {{37, 37, 37}, true, false, false},  {{46, 46, 46}, true, true, false},
             {{58, 58, 58}, true, false, false}};
enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES };

/* Shares of the budget: of a size's block, of a variant's block of a large size; the
 * rest is for the frames. */
static const double SMALL_SHARE = 0.03, LARGE_SHARE = 0.006;
static const double MEMORY_SHARE = 0.4; /* of the machine's */

static bool wanted(const struct cb_variant *v) {
  if (strcmp(v->model->name, "qr-updated") != 0) return false;
  if (v->arithmetic == cb_arithmetics[0]) return v->storage == CB_EBE_PAPER;
  return v->arithmetic == cb_bench_lanes(sizeof(float)) &&
         (v->storage == CB_EBE || v->storage == CB_EBE_CLUSTER || v->storage == CB_EBE_RECOMPUTE ||
          v->storage == CB_BCSR);
}

static size_t tetrahedra(const struct size *size) {
  return 10 * size->edge[0] * size->edge[1] * size->edge[2];
}

static bool has(const struct cb_threads *threads, size_t n) {
  for (size_t i = 0; i < threads->count; i++)
    if (threads->of[i] == n) return true;
  return false;
}

/* Those asked for; else, where the figure is about them, 1, 2, 4 ... and all. */
static struct cb_threads threads_of(const struct cb_bench *b, const struct size *size) {
  struct cb_threads threads = b->threads;
  if (b->options->threads.count > 0 || !size->all_threads) return threads;
  const size_t limit = cb_crew_limit(), most = sizeof threads.of / sizeof *threads.of;
  for (size_t n = 4; n < limit && n < most; n *= 2) threads.of[threads.count++] = n;
  if (limit <= most && !has(&threads, limit)) threads.of[threads.count++] = limit;
  return threads;
}

/* Time on one thread by time on several. */
static enum cb_status add_speedups(struct cb_bench *b, const struct cb_block *block) {
  enum cb_status status = CB_OK;
  for (size_t i = 0; i < block->job_count; i++)
    for (size_t k = 0; k < block->job_count; k++) {
      const struct cb_job *one = &block->jobs[i], *more = &block->jobs[k];
      if (one->variant != more->variant || one->threads != 1 || more->threads == 1) continue;
      if (one->lost || more->lost) continue;
      for (size_t c = 0; !status && c < block->plan->count_count; c++)
        status = cb_block_ratio(b, block, i, k, c, NAN);
    }
  return status;
}

/* The entries of one block: so many variants, each with all threads. */
static size_t list_entries(size_t variants, const struct cb_variant *const *variant,
                           const struct cb_threads *threads, struct cb_entry *list) {
  size_t count = 0;
  for (size_t i = 0; i < variants; i++)
    for (size_t k = 0; k < threads->count; k++)
      list[count++] = (struct cb_entry){variant[i], threads->of[k]};
  return count;
}

/* Enough memory for all of a block's jobs, as far as smaller ones tell? */
static bool fits(const struct cb_bench *b, size_t tets, size_t count, const struct cb_entry *list) {
  double bytes = 0;
  for (size_t i = 0; i < count; i++) {
    const struct cb_row *row = cb_scaling_last(&b->results, list[i]);
    if (row) bytes += cb_scaling_bytes(row, (double)tets);
  }
  return !(b->results.environment.memory > 0) ||
         bytes <= MEMORY_SHARE * b->results.environment.memory;
}

/* Small sizes: all in one block. Large ones: a variant at a time, and where memory is
 * short, one number of threads at a time. */
static enum cb_status run_size(struct cb_bench *b, const struct size *size, size_t variants,
                               const struct cb_variant *const *variant, double budget_s) {
  struct cb_bench_scene scene = {0};
  const struct cb_threads threads = threads_of(b, size);
  const size_t together = size->large ? 1 : variants;
  struct cb_entry *list = malloc((variants * threads.count + 1) * sizeof *list);
  enum cb_status status = list ? CB_OK : cb_fail_memory("the list of variants");
  if (!status) status = cb_bench_scene_grid(size->edge, b->options->seed, &scene);
  for (size_t i = 0; !status && i < variants; i += together) {
    const size_t count = list_entries(together, variant + i, &threads, list);
    const size_t step = fits(b, scene.mesh.tets, count, list) ? count : 1;
    for (size_t k = 0; !status && k < count; k += step) {
      if (step == 1 && !fits(b, scene.mesh.tets, 1, list + k)) continue;
      const struct cb_block_plan plan = {.figure = "scaling",
                                         .scene = &scene,
                                         .entry_count = step,
                                         .entries = list + k,
                                         .count_count = size->all_counts ? COUNTS : 1,
                                         .iterations = size->all_counts ? ALL_COUNTS : ONE_COUNT,
                                         .budget_s = (size->large ? LARGE_SHARE : SMALL_SHARE) *
                                                     budget_s * (double)step / (double)count,
                                         .after = add_speedups};
      status = cb_bench_block(b, &plan);
    }
  }
  cb_bench_scene_free(&scene);
  free(list);
  return status;
}

/* The variants among the entries, each once; returns how many. */
static size_t distinct(size_t count, const struct cb_entry *entries,
                       const struct cb_variant **variant) {
  size_t variants = 0;
  for (size_t i = 0; i < count; i++)
    if (i == 0 || entries[i].variant != entries[i - 1].variant)
      variant[variants++] = entries[i].variant;
  return variants;
}

/* In quick runs only what is ready at once, which clusters of millions are not, and on
 * as many threads as are asked for. */
static size_t list_frames(const struct cb_bench *b, size_t variants,
                          const struct cb_variant *const *variant, struct cb_entry *list) {
  size_t kept = 0;
  const size_t count = list_entries(variants, variant, &b->threads, list);
  for (size_t i = 0; i < count; i++) {
    const enum cb_storage storage = list[i].variant->storage;
    const bool ready = (storage == CB_EBE_PAPER || storage == CB_EBE) &&
                       list[i].threads == b->threads.of[b->threads.count - 1];
    if (!b->results.quick || ready) list[kept++] = list[i];
  }
  return kept;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_entry *entries = NULL, *list = NULL;
  const struct cb_variant **variant = NULL;
  size_t count = 0, variants = 0;
  double used = 0;
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (status) return status;
  variant = malloc((count + 1) * sizeof *variant);
  list = malloc((count + 1) * b->threads.count * sizeof *list);
  if (!variant || !list) status = cb_fail_memory("the list of variants");
  if (!status) variants = distinct(count, entries, variant);
  for (size_t i = 0; !status && i < SIZE_COUNT; i++) {
    if (SIZES[i].large && b->results.quick) continue;
    used += SIZES[i].large ? LARGE_SHARE * (double)variants : SMALL_SHARE;
    status = run_size(b, &SIZES[i], variants, variant, budget_s);
  }
  if (!status) {
    const size_t frames = list_frames(b, variants, variant, list);
    status = cb_frame_search(b, frames, list, fmax(1 - used, 0) * budget_s);
  }
  free(list);
  free(variant);
  free(entries);
  return status;
}

/* ---- tables ------------------------------------------------------------------ */

static bool begins_curve(const struct cb_row *row) {
  return strcmp(row->figure, "scaling") == 0 && row->tetrahedra == tetrahedra(&SIZES[0]);
}

static void print_sizes(const struct cb_results *r, FILE *stream) {
  char columns[256] = "variant,threads";
  for (size_t s = 0; s < SIZE_COUNT; s++)
    snprintf(columns + strlen(columns), sizeof columns - strlen(columns), ",%zu",
             tetrahedra(&SIZES[s]));
  struct cb_table *t = cb_table_create(columns);
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (!begins_curve(row)) continue;
    cb_table_text(t, row->variant);
    cb_table_integer(t, (long long)row->threads);
    for (size_t s = 0; s < SIZE_COUNT; s++) {
      const size_t tets = tetrahedra(&SIZES[s]);
      cb_bench_step_cell(t, cb_bench_row(r, row, tets, CB_SCALING_ITERATIONS), 1e9 / (double)tets);
    }
  }
  cb_bench_print(stream,
                 "Scaling: ns per tetrahedron and step against the number of tetrahedra, grid, 5 "
                 "iterations",
                 t);
}

static void print_counts(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("variant,threads,1,2,5,10,20,50");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (!begins_curve(row)) continue;
    cb_table_text(t, row->variant);
    cb_table_integer(t, (long long)row->threads);
    for (size_t c = 0; c < COUNTS; c++)
      cb_bench_step_cell(t, cb_bench_row(r, row, 3430, ALL_COUNTS[c]), 1e6);
  }
  cb_bench_print(stream, "Scaling: time of one step (us) at 1 to 50 iterations, 3430 tetrahedra",
                 t);
}

static struct cb_interval speedup_at(const struct cb_results *r, const struct cb_ratio *like,
                                     size_t tets) {
  for (size_t i = 0; i < r->ratio_count; i++) {
    const struct cb_ratio *c = &r->ratios[i];
    if (strcmp(c->figure, "scaling") == 0 && c->tetrahedra == tets &&
        c->iterations == CB_SCALING_ITERATIONS &&
        c->denominator_threads == like->denominator_threads &&
        strcmp(c->numerator, like->numerator) == 0)
      return c->ratio;
  }
  return (struct cb_interval){NAN, NAN, NAN};
}

static void print_speedups(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("variant,threads,3430,33750,106480,973360");
  static const size_t shown[] = {3430, 33750, 106480, 973360};
  for (size_t i = 0; t && i < r->ratio_count; i++) {
    const struct cb_ratio *ratio = &r->ratios[i];
    if (strcmp(ratio->figure, "scaling") != 0 || ratio->tetrahedra != 33750) continue;
    cb_table_text(t, ratio->numerator);
    cb_table_integer(t, (long long)ratio->denominator_threads);
    for (size_t s = 0; s < sizeof shown / sizeof *shown; s++)
      cb_bench_interval_cell(t, speedup_at(r, ratio, shown[s]));
  }
  cb_bench_print(stream,
                 "Scaling: times faster than on one thread, grid, 5 iterations [95 % interval]", t);
}

static void print(const struct cb_results *r, FILE *stream) {
  print_sizes(r, stream);
  print_speedups(r, stream);
  print_counts(r, stream);
  cb_frame_print(r, stream);
}

const struct cb_bench_figure cb_bench_scaling = {"scaling", 0.42, false, run, print};
