/* test_frames_summary.c - a routine in one row of `corobench frames`: the worst of its groups.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/files/table.h"
#include "harness/frames/frames.h"
#include "tests/process.h"

static const struct cb_frame_set double_set = {
    .kind = CB_FRAME_POLAR, .scalar_bytes = sizeof(double), .roundoff = 0x1p-53};
static const struct cb_frame_group groups[] = {
    {"a", "", 0, 10}, {"b", "", 10, 10}, {"c", "", 20, 10}, {"d", "", 30, 10}};

/* Of ten finite answers. */
static struct cb_frame_result result(double error, double orthogonality, double ns) {
  return (struct cb_frame_result){.inputs = 10,
                                  .unique = isnan(error) ? 0 : 10,
                                  .error = error,
                                  .degrees = error,
                                  .orthogonality = orthogonality,
                                  .determinant = 0,
                                  .excess = 0,
                                  .ns = ns};
}

static struct cb_frame_summary summary_of(size_t count, const struct cb_frame_result *results) {
  struct cb_frame_summary s = {.groups = 0};
  for (size_t g = 0; g < count; g++) cb_frame_summary_add(&s, &results[g], &double_set, &groups[g]);
  return s;
}

/* The worst of each, whichever group it is of; NaN, of groups without a unique answer, hides
 * nothing, be it first or last. */
static void each_worst_is_found(void **state) {
  (void)state;
  const struct cb_frame_result results[] = {result(NAN, 7, 40), result(5, 1, 90), result(9, 2, 30),
                                            result(NAN, 3, 50)};
  const struct cb_frame_summary s = summary_of(4, results);
  assert_true(s.worst.error == 9 && s.worst.orthogonality == 7);
  assert_true(s.fastest_ns == 30 && s.worst.ns == 90);
  assert_string_equal(s.group, "c");
  assert_true(s.groups == 4 && s.right == 4 && s.worst.inputs == 40 && s.worst.unique == 20);
  assert_true(isnan(summary_of(1, results).worst.error));
}

/* What is wrong is worse than what is far off but right, and the verdicts have an order. */
static void a_worse_verdict_is_the_worst_group(void **state) {
  (void)state;
  struct cb_frame_result results[] = {result(900, 1, 1), result(1e9, 1, 1), result(2, 1, 1),
                                      result(1, 1, 1)};
  results[1].degrees = 0.1;
  assert_string_equal(summary_of(4, results).group, "b"); /* inaccurate */
  results[0].error = 1e15, results[0].degrees = 80;
  assert_string_equal(summary_of(4, results).group, "a"); /* wrong */
  results[2].determinant = 0x1p54, results[2].flipped = 3;
  assert_string_equal(summary_of(4, results).group, "c"); /* a reflection */
  results[3].not_finite = 2;
  const struct cb_frame_summary s = summary_of(4, results);
  assert_string_equal(s.group, "d");
  assert_true(s.right == 0 && s.worst.flipped == 3 && s.worst.not_finite == 2);
  assert_int_equal(summary_of(3, results).worst.not_finite, 0);
}

static double worst_of_csv(const char *csv, const char *frame, int column, bool sum) {
  double worst = 0;
  size_t found = 0;
  for (const char *line = csv; *line; line += strcspn(line, "\n") + 1) {
    if (strncmp(line, frame, strlen(frame)) != 0) continue;
    const char *cell = line;
    for (int i = 0; i < column; i++) cell = strchr(cell, ',') + 1;
    const double value = strtod(cell, NULL); /* empty: 0 */
    worst = sum ? worst + value : fmax(worst, value);
    found++;
  }
  assert_int_equal(found, CB_FRAME_GROUPS);
  return worst;
}

#define FRAMES(...)                                                                                \
  run_words(NULL,                                                                                  \
            (const char *const[]){"frames", "--variant", "svd-precomputed/ebe/f64", "--variant",   \
                                  "polar-reflected-precomputed/ebe/f32", __VA_ARGS__, NULL})

/* One row each, of at most 100 columns, and as bad as the worst row of the long table: the
 * inputs and the answers are the same in both runs, the times are not. */
static void the_row_is_the_worst_of_the_long_table(void **state) {
  (void)state;
  static const struct {
    const char *row, *long_row;
  } frames[] = {{"\nsvd/f64 ", "svd,f64,"}, {"\npolar-reflected/f32 ", "polar-reflected,f32,"}};
  struct process p = FRAMES("--format", "table"), csv = FRAMES("--format", "csv");
  assert_done(&p);
  assert_done(&csv);
  for (const char *line = p.out; *line; line += strcspn(line, "\n") + 1)
    assert_true(strcspn(line, "\n") <= 100);
  for (size_t i = 0; i < 2; i++) {
    size_t right, all, flipped, not_finite;
    double error, orthogonality;
    const char *row = strstr(p.out, frames[i].row), *key = frames[i].long_row;
    assert_non_null(row);
    assert_int_equal(sscanf(row, " %*s %zu/%zu %*s %lf %lf %zu %zu", &right, &all, &error,
                            &orthogonality, &flipped, &not_finite),
                     6);
    /* four digits are printed */
    const double errors[] = {error / worst_of_csv(csv.out, key, 4, false),
                             orthogonality / worst_of_csv(csv.out, key, 6, false)};
    for (int k = 0; k < 2; k++) assert_true(fabs(errors[k] - 1) <= 1e-3);
    assert_true((double)not_finite == worst_of_csv(csv.out, key, 9, true));
    assert_true((double)flipped == worst_of_csv(csv.out, key, 12, true));
    assert_true(all == CB_FRAME_GROUPS);
    assert_true(i == 0 ? right == all && flipped == 0 : right < all && flipped > 0);
  }
  process_free(&p);
  process_free(&csv);
}

static void groups_are_shown_when_asked_for(void **state) {
  (void)state;
  struct process p = FRAMES("--groups");
  assert_done(&p);
  assert_int_equal(lines(p.out), 2 + 2 * CB_FRAME_GROUPS);
  assert_null(strstr(p.out, "--groups"));
  process_free(&p);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_worst_is_found),
      cmocka_unit_test(a_worse_verdict_is_the_worst_group),
      cmocka_unit_test(the_row_is_the_worst_of_the_long_table),
      cmocka_unit_test(groups_are_shown_when_asked_for),
  };
  (void)argc;
  find_program(argv[0]);
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
