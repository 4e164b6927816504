/* test_table.c - the three formats of a table.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/table.h"

/* To be freed. */
static char *printed(const struct cb_table *t, enum cb_format format) {
  char *text;
  size_t size;
  FILE *stream = open_memstream(&text, &size);
  assert_non_null(stream);
  assert_int_equal(cb_table_print(t, format, stream), CB_OK);
  fclose(stream);
  return text;
}

static struct cb_table *sample(void) {
  struct cb_table *t = cb_table_create("variant,tetrahedra,step_s,note");
  assert_non_null(t);
  cb_table_text(t, "qr/ebe/f64");
  cb_table_integer(t, 3430);
  cb_table_number(t, 1.0 / 3);
  cb_table_text(t, "");
  cb_table_text(t, "a \"b\", c\nd");
  cb_table_integer(t, -7);
  cb_table_number(t, NAN);
  cb_table_missing(t);
  cb_table_text(t, "M\xC3\xBCller");
  cb_table_missing(t);
  cb_table_number(t, -INFINITY);
  cb_table_text(t, "x");
  assert_int_equal(cb_table_rows(t), 3);
  return t;
}

static void csv_is_quoted(void **state) {
  (void)state;
  struct cb_table *t = sample();
  char *text = printed(t, CB_CSV);
  assert_string_equal(text, "variant,tetrahedra,step_s,note\n"
                            "qr/ebe/f64,3430,0.33333333333333331,\n"
                            "\"a \"\"b\"\", c\nd\",-7,nan,\n"
                            "M\xC3\xBCller,,-inf,x\n");
  free(text);
  cb_table_free(t);
}

static void json_parses(void **state) {
  (void)state;
  struct cb_table *t = sample();
  char *text = printed(t, CB_JSON);
  json_t *root = json_loads(text, 0, NULL);
  assert_true(json_is_array(root) && json_array_size(root) == 3);
  json_t *row = json_array_get(root, 0);
  assert_int_equal(json_integer_value(json_object_get(row, "tetrahedra")), 3430);
  assert_true(json_real_value(json_object_get(row, "step_s")) == 1.0 / 3);
  assert_string_equal(json_string_value(json_object_get(row, "note")), "");
  row = json_array_get(root, 1);
  assert_string_equal(json_string_value(json_object_get(row, "variant")), "a \"b\", c\nd");
  assert_true(json_is_null(json_object_get(row, "step_s")));
  assert_true(json_is_null(json_object_get(row, "note")));
  row = json_array_get(root, 2);
  assert_true(json_is_null(json_object_get(row, "step_s")));
  json_decref(root);
  free(text);
  cb_table_free(t);
}

static void numbers_survive(void **state) {
  (void)state;
  const double values[] = {0.1, -1e-300, 5e-324, 1.7976931348623157e308, 123456789.125, -0.0};
  struct cb_table *t = cb_table_create("value");
  for (size_t i = 0; i < 6; i++) cb_table_number(t, values[i]);
  char *csv = printed(t, CB_CSV), *json = printed(t, CB_JSON), *rest = csv;
  json_t *root = json_loads(json, 0, NULL);
  strsep(&rest, "\n");
  for (size_t i = 0; i < 6; i++) {
    assert_true(strtod(strsep(&rest, "\n"), NULL) == values[i]);
    assert_true(json_real_value(json_object_get(json_array_get(root, i), "value")) == values[i]);
  }
  json_decref(root);
  free(json);
  free(csv);
  cb_table_free(t);
}

static void text_is_aligned(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("name,mul,step_s");
  cb_table_text(t, "polar");
  cb_table_integer(t, 12);
  cb_table_number(t, 0.000123456);
  cb_table_text(t, "\xC3\xBC");
  cb_table_missing(t);
  cb_table_number(t, -NAN);
  char *text = printed(t, CB_TABLE);
  assert_string_equal(text, "name   mul     step_s\n"
                            "-----  ---  ---------\n"
                            "polar   12  0.0001235\n"
                            "\xC3\xBC        -        nan\n");
  free(text);
  cb_table_free(t);
}

static void last_text_has_no_padding(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("n,why");
  cb_table_integer(t, 1);
  cb_table_text(t, "a long reason");
  cb_table_integer(t, 2);
  cb_table_text(t, "short");
  char *text = printed(t, CB_TABLE);
  assert_string_equal(text, "n  why\n-  -------------\n1  a long reason\n2  short\n");
  free(text);
  cb_table_free(t);
}

static void empty_table(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("a,b");
  const char *const expected[] = {"a  b\n-  -\n", "a,b\n", "[\n]\n"};
  for (int format = CB_TABLE; format <= CB_JSON; format++) {
    char *text = printed(t, (enum cb_format)format);
    assert_string_equal(text, expected[format]);
    free(text);
  }
  assert_int_equal(cb_table_rows(t), 0);
  cb_table_free(t);
  cb_table_free(NULL);
}

static void full_disk_is_noticed(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("number");
  for (int rows = 1; rows <= 10000; rows *= 100) { /* within the buffer and far above */
    while (cb_table_rows(t) < (size_t)rows) cb_table_integer(t, rows);
    for (int format = CB_TABLE; format <= CB_JSON; format++) {
      FILE *full = fopen("/dev/full", "w");
      assert_non_null(full);
      assert_int_equal(cb_table_print(t, (enum cb_format)format, full), CB_IO);
      assert_non_null(strstr(cb_error_message(), "No space left"));
      fclose(full);
    }
  }
  cb_table_free(t);
}

static void json_of_bytes_is_refused(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("path");
  cb_table_text(t, "caf\xE9.msh");
  FILE *stream = fopen("/dev/null", "w");
  assert_non_null(stream);
  assert_int_equal(cb_table_print(t, CB_JSON, stream), CB_INPUT);
  assert_non_null(strstr(cb_error_message(), "UTF-8"));
  assert_int_equal(cb_table_print(t, CB_CSV, stream), CB_OK);
  fclose(stream);
  cb_table_free(t);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(csv_is_quoted),
      cmocka_unit_test(json_parses),
      cmocka_unit_test(numbers_survive),
      cmocka_unit_test(text_is_aligned),
      cmocka_unit_test(last_text_has_no_padding),
      cmocka_unit_test(empty_table),
      cmocka_unit_test(full_disk_is_noticed),
      cmocka_unit_test(json_of_bytes_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
