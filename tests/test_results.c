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
  r.rows[1].threads = 2;
  assert_int_equal(cb_results_write(&r), CB_OK);
  root = json_load_file(temporary_path("bench.json"), 0, NULL);
  sample = json_array_get(json_object_get(root, "benchmarks"), ROUNDS + 1);
  assert_string_equal(json_string_value(json_object_get(sample, "name")),
                      "figure4/m/csr/f64/3430/5/threads:2");
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

/* 3430 tetrahedra of 100 flops and 50 bytes in 10 us: 34.3 Gflop/s and 17.15 GB/s. */
static void test_roofline(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, false);
  struct cb_roofline p = {.work = "product",
                          .mesh = "grid",
                          .level = "L2",
                          .variant = "a/ebe/f32x16",
                          .tetrahedra = 3430,
                          .threads = 2,
                          .flops = 100,
                          .bytes = 50,
                          .visits = 0.75,
                          .time = {1e-5, 1e-5, 2e-5},
                          .peak = 68.6e9,
                          .bandwidth = 20e9,
                          .attainable = 40e9};
  assert_int_equal(cb_results_add_roofline(&r, &p), CB_OK);
  p.work = "step", p.level = "", p.bytes = p.bandwidth = p.attainable = NAN;
  assert_int_equal(cb_results_add_roofline(&r, &p), CB_OK);
  assert_int_equal(cb_results_write(&r), CB_OK);
  double v[9];
  read_line("roofline.csv", 0, line);
  assert_string_equal(line,
                      "work,variant,mesh,tetrahedra,threads,flops_per_tetrahedron,"
                      "bytes_per_tetrahedron,time_s_median,time_s_low,time_s_high,flops_per_byte,"
                      "gflops,gb_per_s,level,peak_gflops,level_gb_per_s,attainable_gflops,"
                      "percent_of_peak,percent_of_attainable,node_visits_per_tetrahedron,quick");
  read_line("roofline.csv", 1, line);
  assert_int_equal(
      sscanf(line,
             "product,a/ebe/f32x16,grid,3430,2,100,50,%*[^,],%*[^,],%*[^,],%lf,%lf,%lf,"
             "L2,%lf,%lf,%lf,%lf,%lf,0.75,0",
             v, v + 1, v + 2, v + 3, v + 4, v + 5, v + 6, v + 7),
      8);
  const double expected[8] = {2, 34.3, 17.15, 68.6, 20, 40, 50, 85.75};
  for (int i = 0; i < 8; i++) assert_true(fabs(v[i] / expected[i] - 1) < 1e-12);
  read_line("roofline.csv", 2, line);
  assert_int_equal(strncmp(line, "step,a/ebe/f32x16,grid,3430,2,100,,", 35), 0);
  assert_int_equal(sscanf(strstr(line, ",,,68."), ",,,%lf,,,%lf,,0.75,0", v, v + 1), 2);
  assert_true(fabs(v[1] - 50) < 1e-12);
  cb_results_free(&r);
}

/* Rows of the figure only, each with the speedup of its own size and threads. */
static void test_scaling(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, false);
  struct cb_row row = make_row("m/ebe/f64");
  row.figure = "scaling";
  row.step = (struct cb_interval){343e-6, 343e-6, 343e-6};
  snprintf(row.status, sizeof row.status, "ok");
  assert_int_equal(cb_results_add_row(&r, &row), CB_OK);
  row.threads = 2;
  assert_int_equal(cb_results_add_row(&r, &row), CB_OK);
  const struct cb_ratio ratios[] = {
      {"speed", "m/ebe/f64", "m/ebe/f64", 3430, 5, 1, 2, {9, 9, 9}, NAN},
      {"scaling", "m/ebe/f64", "m/ebe/f64", 10000, 5, 1, 2, {8, 8, 8}, NAN},
      {"scaling", "m/ebe/f64", "m/ebe/f64", 3430, 50, 1, 2, {7, 7, 7}, NAN},
      {"scaling", "m/ebe/f64", "m/ebe/f64", 3430, 5, 1, 4, {6, 6, 6}, NAN},
      {"scaling", "m/ebe/f64", "m/ebe/f64", 3430, 5, 1, 2, {1.75, 1.5, 2}, NAN}};
  for (size_t i = 0; i < sizeof ratios / sizeof *ratios; i++)
    assert_int_equal(cb_results_add_ratio(&r, &ratios[i]), CB_OK);
  assert_int_equal(cb_results_write(&r), CB_OK);
  double ns;
  read_line("scaling.csv", 1, line);
  assert_int_equal(strncmp(line, "m/ebe/f64,3430,5,1,", 19), 0);
  assert_non_null(strstr(line, ",,,,123.5,0.25,ok,0"));
  read_line("scaling.csv", 2, line);
  assert_int_equal(
      sscanf(line, "m/ebe/f64,3430,5,2,%*[^,],%*[^,],%*[^,],%lf,1.75,1.5,2,123.5,0.25,ok,0", &ns),
      1);
  assert_true(fabs(ns - 100) < 1e-9);
  cb_results_free(&r);
}

static void test_speed_and_frames(void **state) {
  (void)state;
  struct cb_results r;
  char line[1024];
  make_run(&r, true);
  const struct cb_speed speed = {"grid",     "m/ebe/f32", 3430,  2,  {0.5, 0.25, 1},
                                 {8, 4, 16}, 52,          0.125, NAN};
  const struct cb_frame frame = {.mesh = "irregular",
                                 .variant = "m/ebe/f32",
                                 .threads = 2,
                                 .iterations = 5,
                                 .measurements = 3,
                                 .limit_s = 0.5,
                                 .fits = {58, 1000, {0.25, 0.125, 0.375}, 2048}};
  assert_int_equal(cb_results_add_speed(&r, &speed), CB_OK);
  assert_int_equal(cb_results_add_frame(&r, &frame), CB_OK);
  assert_int_equal(cb_results_write(&r), CB_OK);
  read_line("speed.csv", 0, line);
  assert_string_equal(line, "variant,mesh,tetrahedra,threads,step_s_median,step_s_low,step_s_high,"
                            "times_faster,times_faster_low,times_faster_high,"
                            "bytes_per_tetrahedron,force_error,position_error,quick");
  read_line("speed.csv", 1, line);
  assert_string_equal(line, "m/ebe/f32,grid,3430,2,0.5,0.25,1,8,4,16,52,0.125,,1");
  read_line("frame33.csv", 1, line);
  assert_string_equal(line, "m/ebe/f32,irregular,2,5,0.5,58,1000,0.25,0.125,0.375,2048,,,,,,,3,1");
  cb_results_free(&r);
}

static void test_every_file_is_there_and_whole(void **state) {
  (void)state;
  static const char *const files[] = {
      "roofline.csv", "speed.csv",        "scaling.csv", "frame33.csv",   "bench.csv",
      "samples.csv",  "ratios.csv",       "fits.csv",    "crossings.csv", "convergence.csv",
      "bench.json",   "environment.json", "footer.txt"};
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
      cmocka_unit_test(test_roofline),
      cmocka_unit_test(test_scaling),
      cmocka_unit_test(test_speed_and_frames),
      cmocka_unit_test(test_every_file_is_there_and_whole),
      cmocka_unit_test(test_arrays_grow),
      cmocka_unit_test(test_earlier_run_stays_until_the_first_write),
      cmocka_unit_test(test_place_that_cannot_be_written),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
