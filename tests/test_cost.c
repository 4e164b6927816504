/* What a product works and moves, and what bench chooses to time.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/bench/cost.h"
#include "tests/temporary.h"

static struct cb_bench_scene scene; /* the paper's block */

static int make_scene(void **state) {
  const int failed = temporary_make(state);
  return failed ? failed : cb_bench_scene_grid(cb_bench_paper_cells, 1, &scene) != CB_OK;
}

static int free_scene(void **state) {
  cb_bench_scene_free(&scene);
  return temporary_remove(state);
}

/* 117 of the product and 12 of the scatter; of a matrix: 9 multiplications and as many
 * additions a block, and one addition a row. Other arithmetics count the same. */
static void test_flops_of_products(void **state) {
  (void)state;
  const char *const names[] = {"qr-updated/ebe/f64", "svd-updated/ebe/f32"};
  double flops;
  for (size_t i = 0; i < 2; i++) {
    assert_int_equal(cb_cost_product(cb_variant_find(names[i]), &scene, &flops), CB_OK);
    assert_true(flops == 129);
  }
  const struct cb_variant *v = cb_variant_find("qr-updated/bcsr/f64");
  struct cb_job job;
  const uint32_t *row, *column;
  assert_int_equal(cb_job_create(v, 1, &scene, &cb_bench_step, &job), CB_OK);
  cb_operator_pattern(job.op, &row, &column);
  const double blocks = row[scene.mesh.nodes], nodes = (double)scene.mesh.nodes;
  assert_int_equal(cb_cost_product(v, &scene, &flops), CB_OK);
  assert_true(fabs(flops * (double)scene.mesh.tets - (18 * blocks + 3 * nodes)) < 1e-6);
  /* Its bytes: numbers, columns, rows, two vectors. */
  const double bytes = blocks * (72 + 4) + 4 * (nodes + 1) + 2 * 24 * nodes;
  assert_true(job.variant->arithmetic->stride == 3);
  assert_true(fabs(cb_cost_bytes(job.op, &scene.mesh) * (double)scene.mesh.tets - bytes) < 1e-6);
  cb_job_free(&job);
}

/* A step is an update, products and vectors: more than five products, and the more the
 * dearer the frame. */
static void test_flops_of_steps(void **state) {
  (void)state;
  double qr, svd;
  assert_int_equal(cb_cost_step(cb_variant_find("qr-updated/ebe/f64"), &scene, &qr), CB_OK);
  assert_int_equal(cb_cost_step(cb_variant_find("svd-updated/ebe/f64"), &scene, &svd), CB_OK);
  assert_true(qr > 5 * 129 + 200 && qr < 5 * 129 + 600);
  assert_true(svd > qr + 500);
}

/* Node indices and nine numbers; what only the update reads does not count. */
static void test_bytes_of_elements(void **state) {
  (void)state;
  const char *const names[] = {"qr-updated/ebe/f64", "polar-quaternion-updated/ebe/f64",
                               "qr-updated/ebe/f32"};
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    struct cb_job job;
    const struct cb_variant *v = cb_variant_find(names[i]);
    assert_int_equal(cb_job_create(v, 1, &scene, &cb_bench_step, &job), CB_OK);
    const double scalar = (double)v->arithmetic->scalar_bytes, tets = (double)scene.mesh.tets;
    const double vectors = 2 * scalar * (double)(v->arithmetic->stride * scene.mesh.nodes) / tets;
    const double own = cb_cost_bytes(job.op, &scene.mesh) - vectors;
    assert_true(own >= 9 * scalar);
    assert_true(own < 16 + 9 * scalar + 0.5);
    cb_job_free(&job);
  }
}

/* ---- what is timed ---------------------------------------------------------- */

static bool ebe_of_two(const struct cb_variant *v) {
  return strcmp(v->model->name, "qr-updated") == 0 && v->storage == CB_EBE &&
         (v->arithmetic == cb_arithmetics[0] || v->arithmetic == cb_bench_lanes(sizeof(float)));
}

static bool same_threads(const struct cb_entry *e, const struct cb_entry *f) {
  return e->threads == f->threads;
}

static void test_entries(void **state) {
  (void)state;
  struct cb_options options = {.output = temporary_path("run"), .threads = {3, {4, 1, 2}}};
  struct cb_bench b;
  struct cb_entry *entries, list[8];
  size_t count, seen = 0;
  assert_int_equal(cb_bench_create(&options, true, 1, &b), CB_OK);
  assert_int_equal(cb_bench_select(&b, ebe_of_two, &entries, &count), CB_OK);
  assert_int_equal(count, 6);
  assert_int_equal(cb_bench_group(0, count, entries, same_threads, list), 2);
  for (size_t i = 0; i < count; i++) {
    assert_int_equal(entries[i].threads, options.threads.of[i % 3]);
    seen += cb_bench_group(i, count, entries, same_threads, list);
  }
  assert_int_equal(seen, count); /* each in one group */
  free(entries);
  cb_bench_free(&b);
  /* By default the paper's own arithmetic has one thread. */
  options.threads.count = 0;
  assert_int_equal(cb_bench_create(&options, true, 1, &b), CB_OK);
  assert_int_equal(cb_bench_select(&b, ebe_of_two, &entries, &count), CB_OK);
  assert_int_equal(count, 1 + b.threads.count);
  assert_int_equal(entries[0].threads, 1);
  assert_int_equal(entries[count - 1].threads, b.threads.of[b.threads.count - 1]);
  free(entries);
  cb_bench_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_flops_of_products),
      cmocka_unit_test(test_flops_of_steps),
      cmocka_unit_test(test_bytes_of_elements),
      cmocka_unit_test(test_entries),
  };
  return cmocka_run_group_tests(tests, make_scene, free_scene);
}
