/* test_extremes_parts.c - finished parts of `extremes`, to the journal and back.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/extremes/report.h"
#include "harness/files/journal.h"
#include "tests/temporary.h"

static struct cb_journal *journal(bool resume) {
  struct cb_journal *j;
  const enum cb_status status = cb_journal_open(temporary_path("."), "extremes", "any", resume, &j);
  if (status) fail_msg("%s", cb_error_message());
  return j;
}

/* Numbers that JSON has not, or not to the last digit, in every column. */
static const double odd_number[] = {NAN, INFINITY, -INFINITY, -0.0, 0x1p-1074, 1. / 3, 1e300};
enum { ODD = sizeof odd_number / sizeof *odd_number };

static enum cb_status add_odd_rows(struct cb_extremes *all, const void *context) {
  size_t *calls = *(size_t *const *)context;
  ++*calls;
  for (int i = 0; i < ODD; i++) {
    struct cb_extreme row = cb_extreme_blank("values", all->variants[i % 2]);
    double *const to[] = {&row.value,         &row.frame_error,   &row.force_error,
                          &row.product_error, &row.orthogonality, &row.determinant,
                          &row.torque};
    for (int n = 0; n < 7; n++) *to[n] = odd_number[(i + n) % ODD];
    snprintf(row.parameter, sizeof row.parameter, "row %d, \"quoted\"", i);
    snprintf(row.note, sizeof row.note, "note %d", i);
    row.finite = i % 2, row.law = i % 3 ? "euler" : "", row.why = (enum cb_why)(i % 3);
    const struct cb_extreme_step step = {
        all->variants[0], "Euler", "drift", 1e-3, (size_t)i, i % 2, 1, odd_number[i], 2, NAN};
    assert_int_equal(cb_extremes_add(all, &row), CB_OK);
    assert_int_equal(cb_extremes_add_step(all, &step), CB_OK);
  }
  return CB_OK;
}

static char *printed(struct cb_table *t) {
  char *text = NULL;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  assert_int_equal(cb_table_print(t, CB_CSV, stream), CB_OK);
  fclose(stream);
  cb_table_free(t);
  return text;
}

static void a_part_comes_back_as_it_was(void **state) {
  (void)state;
  const struct cb_variant *list[] = {cb_variant_find("linear/ebe/f64"),
                                     cb_variant_find("qr-exact/ebe/f32"), NULL};
  size_t calls = 0, *context = &calls;
  char *rows[2], *steps[2];
  for (int session = 0; session < 2; session++) {
    struct cb_extremes all = {.variants = list, .journal = journal(session == 1)};
    assert_int_equal(cb_extremes_part(&all, "odd", add_odd_rows, &context), CB_OK);
    for (int i = 0; i < ODD; i++) assert_int_equal(all.row[i].why, i % 3);
    rows[session] = printed(cb_extremes_rows(&all));
    steps[session] = printed(cb_extremes_steps(&all));
    cb_extremes_free(&all);
    cb_journal_close(all.journal, CB_INTERRUPTED);
  }
  assert_int_equal(calls, 1);
  assert_string_equal(rows[0], rows[1]);
  assert_string_equal(steps[0], steps[1]);
  for (int i = 0; i < 2; i++) free(rows[i]), free(steps[i]);
}

/* A journal of the right kind, in which somebody has written. */
static void a_part_that_is_none_is_refused(void **state) {
  (void)state;
  static const char *const parts[] = {
      "7",
      "[[], 1]",
      "[[[]], []]",
      "[[], [[]]]",
      "[[[\"near\",\"p\",\"no/such/variant\",\"\",\"\",1,1,1,1,1,1,1,true,0]],[]]",
      "[[[\"near\",\"p\",\"linear/ebe/f64\",\"\",\"\",1,1,1,1,1,1,1,true,3]],[]]",
      "[[[\"near\",\"p\",\"linear/ebe/f64\",\"\",\"\",1,1,1,1,1,1,true,true,0]],[]]"};
  const struct cb_variant *list[] = {cb_variant_find("linear/ebe/f64"), NULL};
  for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
    struct cb_journal *j = journal(false);
    assert_int_equal(cb_journal_add(j, "near", json_loads(parts[i], JSON_DECODE_ANY, NULL)), CB_OK);
    cb_journal_close(j, CB_INTERRUPTED);
    struct cb_extremes all = {.variants = list, .journal = journal(true)};
    if (cb_extremes_run("near", &all) != CB_INPUT) fail_msg("taken: %s", parts[i]);
    assert_non_null(strstr(cb_error_message(), "without --resume"));
    assert_int_equal(all.count, 0);
    cb_journal_close(all.journal, CB_INPUT);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_part_comes_back_as_it_was),
                                     cmocka_unit_test(a_part_that_is_none_is_refused)};
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
