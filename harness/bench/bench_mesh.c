/* --mesh: every variant on the user's own mesh.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"

static const size_t ITERATIONS[1] = {5};

/* All of f64, and the widest lanes in clusters. */
static bool wanted(const struct cb_variant *v) {
  return v->arithmetic == cb_arithmetics[0] ||
         (v->arithmetic == cb_bench_lanes(sizeof(float)) && v->storage == CB_EBE_CLUSTER);
}

/* Share of the machine's memory that a block of variants may take. */
static const double MEMORY_SHARE = 0.25;

/* A generous estimate of a variant's bytes on a mesh, in advance. */
static double bytes_of(const struct cb_variant *v, const struct cb_mesh *mesh) {
  const double numbers = v->model->form[v->storage][0].state_numbers + 64.0;
  return (double)mesh->tets * numbers * (double)v->arithmetic->scalar_bytes;
}

/* How many of the variants from `first` on fit into memory together. */
static size_t fitting(const struct cb_bench *b, const struct cb_mesh *mesh, size_t first,
                      size_t count, const struct cb_entry *entries) {
  double bytes = bytes_of(entries[first].variant, mesh);
  size_t last = first + 1;
  while (last < count) {
    bytes += bytes_of(entries[last].variant, mesh);
    if (bytes > MEMORY_SHARE * b->results.environment.memory) break;
    last++;
  }
  return last - first;
}

static int by_storage(const void *first, const void *second) {
  const struct cb_entry *e = first, *f = second;
  const struct cb_variant *v = e->variant, *w = f->variant;
  if (v->storage != w->storage) return v->storage < w->storage ? -1 : 1;
  if (v != w) return v > w ? 1 : -1;
  return (e->threads > f->threads) - (e->threads < f->threads);
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_entry *entries = NULL;
  size_t count = 0;
  struct cb_bench_scene scene = {0};
  enum cb_status status = cb_bench_scene_mesh(b->options->mesh_path, b->options->seed, &scene);
  if (!status) status = cb_bench_select(b, wanted, &entries, &count);
  if (!status) qsort(entries, count, sizeof *entries, by_storage);
  for (size_t i = 0, n; !status && i < count; i += n) {
    n = fitting(b, &scene.mesh, i, count, entries);
    const struct cb_block_plan plan = {.figure = "mesh",
                                       .scene = &scene,
                                       .entry_count = n,
                                       .entries = entries + i,
                                       .count_count = 1,
                                       .iterations = ITERATIONS,
                                       .parts = true,
                                       .budget_s = budget_s * (double)n / (double)count,
                                       .after = cb_block_ratios};
    status = cb_bench_block(b, &plan);
  }
  cb_bench_scene_free(&scene);
  free(entries);
  return status;
}

/* Fastest first; what has no time comes last. */
static int by_time(const void *first, const void *second) {
  const struct cb_row *const *v = first, *const *w = second;
  const double a = isnan((*v)->step.value) ? INFINITY : (*v)->step.value;
  const double c = isnan((*w)->step.value) ? INFINITY : (*w)->step.value;
  return (a > c) - (a < c);
}

static void print(const struct cb_results *r, FILE *stream) {
  const struct cb_row **rows = malloc((r->row_count + 1) * sizeof *rows);
  struct cb_table *t = cb_table_create("variant,threads,step_ms,ns_per_tetrahedron,update_ms,one_"
                                       "product_ms,bytes_per_tetrahedron,status");
  size_t count = 0;
  for (size_t i = 0; rows && i < r->row_count; i++)
    if (strcmp(r->rows[i].figure, "mesh") == 0) rows[count++] = &r->rows[i];
  if (rows) qsort(rows, count, sizeof *rows, by_time);
  char title[160] = "";
  if (count > 0)
    snprintf(title, sizeof title,
             "Your mesh: %zu tetrahedra, %zu nodes, %zu iterations, fastest first",
             rows[0]->tetrahedra, rows[0]->nodes, rows[0]->iterations);
  for (size_t i = 0; t && i < count; i++) {
    cb_table_text(t, rows[i]->variant);
    cb_table_integer(t, (long long)rows[i]->threads);
    cb_bench_step_cell(t, rows[i], 1e3);
    cb_bench_step_cell(t, rows[i], 1e9 / (double)rows[i]->tetrahedra);
    cb_bench_number_cell(t, 1e3 * rows[i]->update_s);
    cb_bench_number_cell(t, 1e3 * rows[i]->product_s);
    cb_bench_number_cell(t, rows[i]->bytes_per_tetrahedron);
    cb_table_text(t, rows[i]->status);
  }
  cb_bench_print(stream, title, t);
  free(rows);
}

const struct cb_bench_figure cb_bench_mesh = {"mesh", 1, false, run, print};
