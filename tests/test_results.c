/* The files of a run: the columns that programs rely on, numbers that come back
 * as they went in, nothing where nothing was measured, JSON that parses.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <jansson.h>

#include "harness/error.h"
#include "harness/measure/results.h"
#include "tests/temporary.h"

enum { ROUNDS = 7 };
/* Line `number` (from 0) of a file of the run. */
static void read_line(const char *name, int number, char line[1024]) {
  FILE *f = fopen(temporary_path(name), "r");
  assert_non_null(f);
  for (int i = 0; i <= number; i++) assert_non_null(fgets(line, 1024, f));
  line[strcspn(line, "\n")] = 0;
  fclose(f);
}

static double step_s[2 * ROUNDS], cpu_s[2 * ROUNDS];
static size_t repeats[2 * ROUNDS];

/* Subject 0: 1/3 s in every round; subject 1: from 1 s to 7 s. */
static struct cb_samples make_samples(void) {
  for (int r = 0; r < ROUNDS; r++) {
    step_s[r] = cpu_s[r] = 1.0 / 3;
    step_s[ROUNDS + r] = cpu_s[ROUNDS + r] = 1 + (r * 3) % ROUNDS;
    repeats[r] = repeats[ROUNDS + r] = 10;
  }
  return (struct cb_samples){2, ROUNDS, ROUNDS, step_s, cpu_s, repeats};
}

static struct cb_row make_row(const char *variant) {
  const struct cb_mesh mesh = {.nodes = 512, .tets = 3430};
  struct cb_row row = cb_row_unmeasured("4", variant, &mesh);
  row.iterations = 5;
  row.bytes_per_tetrahedron = 123.5;
  row.setup_s = 0.25;
  return row;
}

static void make_run(struct cb_results *r, bool quick) {
  const struct cb_samples samples = make_samples();
  assert_int_equal(cb_results_create(temporary, quick, r), CB_OK);
  struct cb_row row = make_row("m/ebe/f64");
  assert_int_equal(cb_results_add_measured(r, &row, &samples, 0), CB_OK);
  row = make_row("m/csr/f64");
  assert_int_equal(cb_results_add_measured(r, &row, &samples, 1), CB_OK);
  row = make_row("bad/ebe/f64");
  snprintf(row.status, sizeof row.status, "failed: net force, \"3e-2\"");
  assert_int_equal(cb_results_add_row(r, &row), CB_OK);
}

static void test_bench_csv(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, false);
  assert_int_equal(cb_results_write(&r), CB_OK);
  read_line("bench.csv", 0, line);
  const char *columns = "figure,variant,tetrahedra,nodes,iterations,threads,step_s_median,"
                        "step_s_low,step_s_high,bytes_per_tetrahedron,status,";
  assert_memory_equal(line, columns, strlen(columns));
  double median, low, high, bytes;
  read_line("bench.csv", 1, line);
  assert_int_equal(
      sscanf(line, "4,m/ebe/f64,3430,512,5,1,%lf,%lf,%lf,%lf,ok,", &median, &low, &high, &bytes),
      4);
  assert_true(median == 1.0 / 3 && low == 1.0 / 3 && high == 1.0 / 3 && bytes == 123.5);
  read_line("bench.csv", 2, line);
  assert_int_equal(sscanf(line, "4,m/csr/f64,3430,512,5,1,%lf,%lf,%lf", &median, &low, &high), 3);
  assert_true(median == 4 && low == 1 && high == 7);
  assert_non_null(strstr(line, ",unstable,"));
  read_line("bench.csv", 3, line);
  assert_non_null(strstr(line, "bad/ebe/f64,3430,512,5,1,,,,123.5,\"failed: net force, "));
  cb_results_free(&r);
}

static void test_samples_csv(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, true);
  assert_int_equal(cb_results_write(&r), CB_OK);
  read_line("samples.csv", 0, line);
  assert_string_equal(
      line, "figure,variant,tetrahedra,iterations,threads,round,steps,step_s,cpu_s,quick");
  read_line("samples.csv", 1 + ROUNDS + 2, line);
  assert_memory_equal(line, "4,m/csr/f64,3430,5,1,2,10,7", 26);
  assert_string_equal(line + strlen(line) - 2, ",1"); /* quick */
  cb_results_free(&r);
}

static void test_bench_json(void **state) {
  (void)state;
  struct cb_results r;
  make_run(&r, true);
  assert_int_equal(cb_results_write(&r), CB_OK);
  json_t *root = json_load_file(temporary_path("bench.json"), 0, NULL);
  assert_non_null(root);
  const json_t *context = json_object_get(root, "context");
  assert_true(json_is_true(json_object_get(context, "quick")));
  assert_true(json_is_integer(json_object_get(context, "num_cpus")));
  assert_null(json_object_get(context, "host_name"));
  const json_t *list = json_object_get(root, "benchmarks");
  assert_int_equal(json_array_size(list), 2 * (ROUNDS + 1)); /* a failure has no samples */
  const json_t *sample = json_array_get(list, ROUNDS + 1), *median = json_array_get(list, ROUNDS);
  assert_string_equal(json_string_value(json_object_get(sample, "name")),
                      "figure4/m/csr/f64/3430/5");
  assert_string_equal(json_string_value(json_object_get(sample, "run_type")), "iteration");
  assert_true(json_real_value(json_object_get(sample, "real_time")) == 1e9);
  assert_string_equal(json_string_value(json_object_get(median, "aggregate_name")), "median");
  assert_true(fabs(json_real_value(json_object_get(median, "cpu_time")) / 1e9 - 1.0 / 3) < 1e-7);
  json_decref(root);
  cb_results_free(&r);
}

static void test_other_tables(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, false);
  const struct cb_ratio ratio = {"7", "a/ebe/f64", "b/ebe/f64", 500, 5, 2, 1, {1.5, 1.25, 2}, NAN};
  const struct cb_fit fit = {"a/ebe/f64", 500, 2, {1, 0.5, 2}, {0.25, 0.125, 0.5}};
  const struct cb_crossing never = {"a/csr/f64", "a/ebe/f64", 500, 2, {INFINITY, 64, INFINITY}, 50};
  const struct cb_convergence point = {"a/ebe/f64", 500, 20, 4e-4, NAN};
  assert_int_equal(cb_results_add_ratio(&r, &ratio), CB_OK);
  assert_int_equal(cb_results_add_fit(&r, &fit), CB_OK);
  assert_int_equal(cb_results_add_crossing(&r, &never), CB_OK);
  assert_int_equal(cb_results_add_convergence(&r, &point), CB_OK);
  assert_int_equal(cb_results_write(&r), CB_OK);
  read_line("ratios.csv", 1, line);
  assert_string_equal(line, "7,a/ebe/f64,b/ebe/f64,500,5,2,1,1.5,1.25,2,,0");
  read_line("fits.csv", 1, line);
  assert_string_equal(line, "a/ebe/f64,500,2,1,0.5,2,0.25,0.125,0.5,0");
  read_line("crossings.csv", 1, line);
  assert_string_equal(line, "a/csr/f64,a/ebe/f64,500,2,,64,,50,never,0");
  read_line("convergence.csv", 1, line);
  assert_memory_equal(line, "a/ebe/f64,500,", 14);
  assert_string_equal(line + strlen(line) - 6, ",20,,0");
  read_line("footer.txt", 0, line);
  assert_null(strstr(line, "QUICK"));
  cb_results_free(&r);
}

static void test_every_file_is_there_and_whole(void **state) {
  (void)state;
  static const char *const files[] = {"bench.csv",  "samples.csv",      "ratios.csv",
                                      "fits.csv",   "crossings.csv",    "convergence.csv",
                                      "bench.json", "environment.json", "footer.txt"};
  struct cb_results r;
  char part[32];
  make_run(&r, false);
  assert_int_equal(cb_results_write(&r), CB_OK);
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    assert_int_equal(access(temporary_path(files[i]), R_OK), 0);
    snprintf(part, sizeof part, "%s.part", files[i]);
    assert_int_not_equal(access(temporary_path(part), F_OK), 0);
  }
  cb_results_free(&r);
}

/* More rows than the array's first sizes, each still itself. */
static void test_arrays_grow(void **state) {
  (void)state;
  struct cb_results r;
  assert_int_equal(cb_results_create(temporary, false, &r), CB_OK);
  for (size_t i = 0; i < 1000; i++) {
    const struct cb_ratio ratio = {.figure = "7", .tetrahedra = i};
    assert_int_equal(cb_results_add_ratio(&r, &ratio), CB_OK);
  }
  for (size_t i = 0; i < 1000; i++) assert_int_equal(r.ratios[i].tetrahedra, i);
  cb_results_free(&r);
}

static void test_earlier_run_stays_until_the_first_write(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, true);
  assert_int_equal(cb_results_write(&r), CB_OK);
  cb_results_free(&r);
  assert_int_equal(cb_results_create(temporary, false, &r), CB_OK);
  read_line("bench.csv", 3, line);
  assert_int_equal(cb_results_write(&r), CB_OK);
  read_line("footer.txt", 0, line);
  assert_null(strstr(line, "QUICK"));
  cb_results_free(&r);
}

static void test_place_that_cannot_be_written(void **state) {
  (void)state;
  struct cb_results r = {.row_count = 77};
  FILE *f = fopen(temporary_path("file"), "w");
  assert_non_null(f);
  fclose(f);
  assert_int_equal(cb_results_create(temporary_path("file"), false, &r), CB_IO);
  assert_int_equal(r.row_count, 77);
  assert_true(strlen(cb_error_message()) > 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bench_csv),
      cmocka_unit_test(test_samples_csv),
      cmocka_unit_test(test_bench_json),
      cmocka_unit_test(test_other_tables),
      cmocka_unit_test(test_every_file_is_there_and_whole),
      cmocka_unit_test(test_arrays_grow),
      cmocka_unit_test(test_earlier_run_stays_until_the_first_write),
      cmocka_unit_test(test_place_that_cannot_be_written),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
