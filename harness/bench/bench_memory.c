/* Bytes per tetrahedron of every variant, from what is really allocated.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"

/* All of f64, and of the widest lanes of both scalars. */
static bool wanted(const struct cb_variant *v) {
  const struct cb_arithmetic *a = v->arithmetic;
  return a == cb_arithmetics[0] || a == cb_bench_lanes(sizeof(double)) ||
         a == cb_bench_lanes(sizeof(float));
}

static enum cb_status add_row(struct cb_bench *b, const struct cb_bench_scene *scene,
                              struct cb_entry entry) {
  struct cb_operator *op;
  enum cb_status status = cb_operator_create(entry.variant, &scene->mesh, &scene->material,
                                             cb_step_scale(&cb_bench_step), entry.threads, &op);
  char name[CB_NAME];
  cb_variant_name(entry.variant, name);
  if (status) return cb_bench_explain(status, name);
  struct cb_row row = cb_row_unmeasured("memory", name, &scene->mesh);
  row.threads = entry.threads;
  row.bytes_per_tetrahedron = (double)cb_operator_bytes(op) / (double)scene->mesh.tets;
  snprintf(row.status, sizeof row.status, "ok");
  cb_operator_free(op);
  return cb_results_add_row(&b->results, &row);
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  (void)budget_s; /* nothing is timed */
  struct cb_entry *entries = NULL;
  size_t count = 0;
  struct cb_bench_scene scene = {0};
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (!status) status = cb_bench_scene_grid(cb_bench_paper_cells, b->options->seed, &scene);
  for (size_t i = 0; !status && i < count; i++) status = add_row(b, &scene, entries[i]);
  cb_bench_scene_free(&scene);
  free(entries);
  return status;
}

/* Bytes of that model in that storage, of the arithmetic of `first`; NaN: not
 * there. */
static double bytes_of(const struct cb_results *r, const struct cb_variant *first, int storage) {
  char name[CB_NAME];
  const struct cb_variant wanted = {first->model, (enum cb_storage)storage, first->arithmetic};
  cb_variant_name(&wanted, name);
  for (size_t i = 0; i < r->row_count; i++)
    if (strcmp(r->rows[i].figure, "memory") == 0 && strcmp(r->rows[i].variant, name) == 0)
      return r->rows[i].bytes_per_tetrahedron;
  return NAN;
}

/* One row a model and arithmetic, one column a storage. */
static void print(const struct cb_results *r, FILE *stream) {
  char columns[160] = "model,arithmetic";
  for (int s = 0; s < CB_STORAGES; s++) {
    strcat(columns, ",");
    strcat(columns, cb_storage_name[s]);
  }
  struct cb_table *t = cb_table_create(columns);
  const struct cb_variant *before = NULL;
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    const struct cb_variant *v = cb_variant_find(row->variant);
    if (strcmp(row->figure, "memory") != 0 || !v) continue;
    if (before && before->model == v->model && before->arithmetic == v->arithmetic) continue;
    before = v;
    cb_table_text(t, v->model->name);
    cb_table_text(t, v->arithmetic->name);
    for (int s = 0; s < CB_STORAGES; s++) cb_bench_number_cell(t, bytes_of(r, v, s));
  }
  cb_bench_print(stream, "Bytes per tetrahedron, 3430 tetrahedra", t);
}

const struct cb_bench_figure cb_bench_memory = {"memory", 0.005, true, run, print};
