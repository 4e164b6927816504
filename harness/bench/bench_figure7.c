/* Figure 7 of the paper: time of one step against the number of tetrahedra, for
 * the ways to find the element frame; and whether their ratios last with more
 * iterations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"

enum { FEW = 5, MANY = 50 };
static const size_t FIVE[1] = {FEW}, FIFTY[1] = {MANY};

/* 500 to 106480 tetrahedra. The large ones need the time: a round of them takes
 * as long as a hundred of the small. */
static const struct size {
  size_t cells[3];
  const size_t *iterations;
  double share;
} SIZES[] = {{{5, 5, 2}, FIVE, 0.05},    {{7, 7, 7}, FIVE, 0.08},    {{7, 7, 7}, FIFTY, 0.10},
             {{10, 10, 10}, FIVE, 0.10}, {{15, 15, 15}, FIVE, 0.20}, {{22, 22, 22}, FIVE, 0.47}};

enum { SIZE_COUNT = sizeof SIZES / sizeof *SIZES, PAPER = 1 };

static bool ends_with(const char *text, const char *end) {
  const size_t length = strlen(text), tail = strlen(end);
  return length >= tail && strcmp(text + length - tail, end) == 0;
}

static bool is_one_of(const char *name, const char *const *list) {
  while (*list && strcmp(name, *list) != 0) list++;
  return *list != NULL;
}

/* Models with a frame per element, in the paper's storage and in the one whose
 * product needs no frame; in the latter also those without such a frame, as a
 * measure. Left out: two polar ones that are there to be wrong and are as dear
 * as their right counterparts, and the current volume, which blows up. */
static bool wanted_of_paper(const struct cb_variant *v) {
  const char *name = v->model->name;
  if (v->storage != CB_EBE_PAPER && v->storage != CB_EBE) return false;
  return strncmp(name, "polar-edges", 11) != 0 && strncmp(name, "polar-reflected", 15) != 0 &&
         !ends_with(name, "-updated-volume");
}

/* The same question asked of the fastest kernels: fewer frames, in clusters. */
static bool wanted(const struct cb_variant *v) {
  static const char *const frames[] = {
      "qr-precomputed",       "qr-updated",           "qr-exact",
      "polar-higham-updated", "polar-closed-updated", "polar-closed-precomputed",
      "polar-exact",          "svd-updated",          NULL};
  if (v->arithmetic == cb_arithmetics[0]) return wanted_of_paper(v);
  return v->arithmetic == cb_bench_lanes(sizeof(float)) && v->storage == CB_EBE_CLUSTER &&
         is_one_of(v->model->name, frames);
}

static bool same_group(const struct cb_entry *e, const struct cb_entry *f) {
  return e->variant->storage == f->variant->storage &&
         e->variant->arithmetic == f->variant->arithmetic && e->threads == f->threads;
}

/* One block per storage, arithmetic and number of threads, so that no more than its
 * share is in memory, and one thread is not kept on a processor for two. */
static enum cb_status run_size(struct cb_bench *b, const struct size *size, size_t count,
                               const struct cb_entry *entries, struct cb_entry *list,
                               double budget_s) {
  struct cb_bench_scene scene;
  enum cb_status status = cb_bench_scene_grid(size->cells, b->options->seed, &scene);
  if (status) return status;
  for (size_t i = 0; !status && i < count; i++) {
    const size_t chosen = cb_bench_group(i, count, entries, same_group, list);
    const struct cb_block_plan plan = {.figure = "7",
                                       .scene = &scene,
                                       .entry_count = chosen,
                                       .entries = list,
                                       .count_count = 1,
                                       .iterations = size->iterations,
                                       .parts = size == &SIZES[PAPER],
                                       .budget_s = budget_s * (double)chosen / (double)count,
                                       .after = cb_block_ratios};
    if (chosen > 0) status = cb_bench_block(b, &plan);
  }
  cb_bench_scene_free(&scene);
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_entry *entries = NULL, *list = NULL;
  size_t count = 0;
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (!status && !(list = malloc((count + 1) * sizeof *list)))
    status = cb_fail_memory("the list of variants");
  /* A round of the largest size alone takes seconds. */
  const size_t sizes = b->results.quick ? SIZE_COUNT - 1 : SIZE_COUNT;
  for (size_t i = 0; !status && i < sizes; i++)
    status = run_size(b, &SIZES[i], count, entries, list, SIZES[i].share * budget_s);
  free(list);
  free(entries);
  return status;
}

static size_t tetrahedra(const struct size *size) {
  return 10 * size->cells[0] * size->cells[1] * size->cells[2];
}

static void model_cell(struct cb_table *t, const char *variant) {
  char model[CB_NAME];
  snprintf(model, sizeof model, "%.*s", (int)strcspn(variant, "/"), variant);
  cb_table_text(t, model);
}

/* Everything behind the model: "/ebe-paper/f64". */
static const char *storage_of(const char *variant) { return variant + strcspn(variant, "/"); }

/* Rows and ratios of one table: the same storage, arithmetic and threads. */
static bool in_table(const struct cb_row *row, const struct cb_row *first) {
  return strcmp(row->figure, "7") == 0 && row->threads == first->threads &&
         strcmp(storage_of(row->variant), storage_of(first->variant)) == 0;
}

static void table_print(FILE *stream, const char *what, const struct cb_row *first,
                        struct cb_table *t) {
  char title[256];
  snprintf(title, sizeof title, "%s, %s, %zu thread%s", what, storage_of(first->variant) + 1,
           first->threads, first->threads > 1 ? "s" : "");
  cb_bench_print(stream, title, t);
}

static void print_steps(const struct cb_results *r, const struct cb_row *first, FILE *stream) {
  struct cb_table *t = cb_table_create("model,500,3430,10000,33750,106480");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (!in_table(row, first) || row->iterations != FEW || row->tetrahedra != tetrahedra(&SIZES[0]))
      continue;
    model_cell(t, row->variant);
    for (size_t s = 0; s < SIZE_COUNT; s++)
      if (SIZES[s].iterations == FIVE)
        cb_bench_step_cell(t, cb_bench_row(r, row, tetrahedra(&SIZES[s]), FEW), 1e3);
  }
  table_print(stream,
              "Figure 7: time of one step (ms) against the number of tetrahedra, 5 iterations",
              first, t);
}

static void print_parts(const struct cb_results *r, const struct cb_row *first, FILE *stream) {
  struct cb_table *t = cb_table_create("model,update_us,solve_us,one_product_us,setup_us");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (!in_table(row, first) || row->iterations != FEW ||
        row->tetrahedra != tetrahedra(&SIZES[PAPER]))
      continue;
    model_cell(t, row->variant);
    const double parts[] = {row->update_s, row->solve_s, row->product_s, row->setup_s};
    for (size_t k = 0; k < 4; k++) cb_bench_number_cell(t, 1e6 * parts[k]);
  }
  table_print(stream, "The parts of a step, 3430 tetrahedra, 5 iterations", first, t);
}

static struct cb_interval find_ratio(const struct cb_results *r, const struct cb_ratio *like,
                                     size_t tets, size_t iterations) {
  for (size_t i = 0; i < r->ratio_count; i++) {
    const struct cb_ratio *c = &r->ratios[i];
    if (strcmp(c->figure, "7") == 0 && c->tetrahedra == tets && c->iterations == iterations &&
        c->threads == like->threads && strcmp(c->numerator, like->numerator) == 0 &&
        strcmp(c->denominator, like->denominator) == 0)
      return c->ratio;
  }
  return (struct cb_interval){NAN, NAN, NAN};
}

static void print_ratios(const struct cb_results *r, const struct cb_row *first, FILE *stream) {
  struct cb_table *t =
      cb_table_create("time_of,by_that_of,3430_tets,106480_tets,3430_tets_50_iterations,paper");
  const size_t paper = tetrahedra(&SIZES[PAPER]), large = tetrahedra(&SIZES[SIZE_COUNT - 1]);
  for (size_t i = 0; t && i < r->ratio_count; i++) {
    const struct cb_ratio *ratio = &r->ratios[i];
    if (strcmp(ratio->figure, "7") != 0 || ratio->threads != first->threads ||
        strcmp(storage_of(ratio->numerator), storage_of(first->variant)) != 0 ||
        ratio->tetrahedra != paper || ratio->iterations != FEW)
      continue;
    model_cell(t, ratio->numerator);
    model_cell(t, ratio->denominator);
    cb_bench_interval_cell(t, ratio->ratio);
    cb_bench_interval_cell(t, find_ratio(r, ratio, large, FEW));
    cb_bench_interval_cell(t, find_ratio(r, ratio, paper, MANY));
    cb_bench_number_cell(t, ratio->paper);
  }
  table_print(stream, "Ratios of the times of a step [95 % interval]", first, t);
}

static bool seen_before(const struct cb_results *r, size_t i) {
  for (size_t k = 0; k < i; k++)
    if (in_table(&r->rows[k], &r->rows[i])) return true;
  return false;
}

static void print(const struct cb_results *r, FILE *stream) {
  for (size_t i = 0; i < r->row_count; i++) {
    const struct cb_row *first = &r->rows[i];
    if (strcmp(first->figure, "7") != 0 || seen_before(r, i)) continue;
    print_steps(r, first, stream);
    print_parts(r, first, stream);
    print_ratios(r, first, stream);
  }
}

const struct cb_bench_figure cb_bench_figure7 = {"7", 0.22, false, run, print};
