/* test_figures.c - the figures of speed as a user runs them, on one and two threads.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/process.h"

#define RUN(...) run_words(NULL, (const char *const[]){__VA_ARGS__, NULL})

static char *read_result(const char *directory, const char *name) {
  char path[256];
  snprintf(path, sizeof path, "%s/%s", temporary_path(directory), name);
  return read_text(path);
}

/* A quick run of one figure, of two storages on one and two threads. */
static void run_figure(const char *figure) {
  char results[256];
  snprintf(results, sizeof results, "%s", temporary_path(figure));
  struct process p = RUN("bench", "--quick", "--seconds", "1", "--figure", figure, "--variant",
                         "qr-updated/ebe/f64", "--variant", "qr-updated/bcsr/f64", "--threads",
                         "1,2", "--output", results);
  assert_done(&p);
  assert_non_null(strstr(p.out, "qr-updated/bcsr/f64"));
  assert_non_null(strstr(p.out, "QUICK RUN"));
  process_free(&p);
}

static void test_speed_figure(void **state) {
  (void)state;
  run_figure("speed");
  char *csv = read_result("speed", "speed.csv");
  assert_int_equal(lines(csv), 1 + 2 * (1 + 2 * 2)); /* the base, two variants, twice */
  assert_non_null(strstr(csv, "\nqr-updated/ebe-paper/f64,grid,3430,1,"));
  const char *row = strstr(csv, "\nqr-updated/ebe/f64,irregular,");
  assert_non_null(row);
  double faster, force, position;
  assert_int_equal(sscanf(row,
                          "\nqr-updated/ebe/f64,irregular,%*[^,],1,%*[^,],%*[^,],%*[^,],%lf,%*[^,],"
                          "%*[^,],%*[^,],%lf,%lf,1",
                          &faster, &force, &position),
                   3);
  assert_true(faster > 0);
  assert_true(force == 0 && position == 0); /* it is what errors are measured against */
  free(csv);
}

static void test_roofline_figure(void **state) {
  (void)state;
  run_figure("roofline");
  char *csv = read_result("roofline", "roofline.csv");
  assert_int_equal(lines(csv), 1 + 2 * 2 * 2 * 2); /* works, meshes, variants, threads */
  assert_non_null(strstr(csv, "\nproduct,qr-updated/ebe/f64,grid,3430,2,129,"));
  free(csv);
  csv = read_result("roofline", "machine.csv");
  assert_non_null(strstr(csv, "\nfma-f64,"));
  free(csv);
}

static void test_scaling_figure(void **state) {
  (void)state;
  run_figure("scaling");
  char *csv = read_result("scaling", "scaling.csv");
  assert_int_equal(lines(csv), 1 + 2 * 2 * (4 + 6)); /* sizes, counts of 3430 tetrahedra */
  assert_non_null(strstr(csv, "\nqr-updated/bcsr/f64,3430,50,2,"));
  free(csv);
  csv = read_result("scaling", "frame33.csv");
  double cells, exceeding, fits_s, exceeds_s;
  assert_int_equal(lines(csv), 1 + 2); /* grid and irregular, what is ready at once */
  assert_int_equal(
      sscanf(
          strchr(csv, '\n'),
          "\nqr-updated/ebe/f64,grid,2,5,%*[^,],%lf,%*[^,],%lf,%*[^,],%*[^,],%*[^,],%lf,%*[^,],%lf",
          &cells, &fits_s, &exceeding, &exceeds_s),
      4);
  assert_true(cells < exceeding && fits_s <= 33e-3 && exceeds_s > 33e-3);
  free(csv);
}

static void test_force_threads(void **state) {
  (void)state;
  char positions[256], mesh[256];
  snprintf(mesh, sizeof mesh, "%s", small_mesh());
  snprintf(positions, sizeof positions, "%s", temporary_path("x.csv"));
  FILE *f = fopen(positions, "w");
  fputs("node,x,y,z\n1,0,0,0\n2,1.2,0,0\n3,0.1,1,0\n4,0.2,0.1,1\n5,1,1,1\n", f);
  fclose(f);
#define FORCE(...)                                                                                 \
  RUN("force", "--mesh", mesh, "--positions", positions, "--variant", "qr-exact/ebe/f64",          \
      "--young", "1e5", "--poisson", "0.4", "--threads", __VA_ARGS__)
  struct process one = FORCE("1"), two = FORCE("2"), again = FORCE("2");
  assert_done(&one);
  assert_done(&two);
  assert_string_equal(two.out, again.out);
  assert_int_equal(lines(one.out), lines(two.out));
  process_free(&one);
  process_free(&two);
  process_free(&again);
  assert_refused(FORCE("1,2"), "give --threads one number");
  assert_refused(FORCE("0"), "--threads needs a whole number from 1 to 64");
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_speed_figure),
      cmocka_unit_test(test_roofline_figure),
      cmocka_unit_test(test_scaling_figure),
      cmocka_unit_test(test_force_threads),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
