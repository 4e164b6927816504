/* test_journal.c - finished rows are there again, whole and once, after any end; rows of other
 * work are not joined.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/journal.h"
#include "harness/measure/results_slices.h"
#include "tests/process.h"

static const char *journal_path(void) { return temporary_path("work.unfinished"); }

static struct cb_journal *opened(bool resume) {
  struct cb_journal *j = NULL;
  const enum cb_status status = cb_journal_open(temporary, "work", "all of it", resume, &j);
  if (status) fail_msg("status %d: %s", status, cb_error_message());
  return j;
}

/* A journal of rows "0" to "n-1", as a killed run leaves it. */
static void leave_rows(int n) {
  struct cb_journal *j = opened(false);
  for (int i = 0; i < n; i++) {
    char key[16];
    snprintf(key, sizeof key, "%d", i);
    assert_int_equal(cb_journal_add(j, key, json_pack("[i, f]", i, 0.1 * i)), CB_OK);
  }
  assert_int_equal(cb_journal_close(j, CB_INTERRUPTED), CB_INTERRUPTED);
}

static void append(const char *text) {
  FILE *file = fopen(journal_path(), "a");
  assert_non_null(file);
  fputs(text, file);
  fclose(file);
}

static bool is_there(void) {
  struct stat found;
  return stat(journal_path(), &found) == 0;
}

static void rows_are_found_again(void **state) {
  (void)state;
  size_t session = 0;
  leave_rows(5);
  struct cb_journal *j = opened(true);
  assert_int_equal(cb_journal_session(j), 2);
  const json_t *row = cb_journal_row(j, "3", &session);
  assert_int_equal(session, 1);
  assert_true(json_real_value(json_array_get(row, 1)) == 0.1 * 3);
  assert_null(cb_journal_row(j, "5", NULL));
  assert_int_equal(cb_journal_add(j, "5", json_true()), CB_OK);
  assert_null(cb_journal_row(j, "5", NULL)); /* of this session */
  assert_int_equal(cb_journal_add(j, "5", json_true()), CB_BROKEN);
  assert_int_equal(cb_journal_add(j, "3", json_true()), CB_BROKEN);
  cb_fail(CB_INTERRUPTED, "interrupted");
  cb_journal_close(j, CB_INTERRUPTED);
  assert_non_null(strstr(cb_error_message(), "interrupted; 6 finished parts are kept in"));
  assert_non_null(strstr(cb_error_message(), "--resume"));
  j = opened(true);
  assert_int_equal(cb_journal_session(j), 3);
  assert_non_null(cb_journal_row(j, "5", &session));
  assert_int_equal(session, 2);
  cb_journal_done(j);
  assert_false(is_there());
  assert_int_equal(cb_journal_close(j, CB_OK), CB_OK);
}

/* Killed at any byte: the whole lines count, and the next one is whole again. */
static void half_lines_are_no_rows(void **state) {
  (void)state;
  leave_rows(3);
  char *text = read_text(journal_path());
  const size_t length = strlen(text);
  for (size_t cut = 0; cut <= length; cut++) {
    FILE *file = fopen(journal_path(), "w");
    fwrite(text, 1, cut, file);
    fclose(file);
    size_t rows = 0, found = 0;
    for (size_t i = 0; i < cut; i++) rows += text[i] == '\n';
    rows -= rows > 0; /* the header */
    struct cb_journal *j = opened(true);
    for (int i = 0; i < 3; i++)
      found += cb_journal_row(j, (char[2]){(char)('0' + i)}, NULL) != NULL;
    assert_int_equal(found, rows);
    assert_int_equal(cb_journal_add(j, "next", json_true()), CB_OK);
    cb_journal_close(j, CB_INTERRUPTED);
    j = opened(true);
    assert_non_null(cb_journal_row(j, "next", NULL));
    cb_journal_close(j, CB_INTERRUPTED);
  }
  free(text);
}

static void nothing_finished_leaves_nothing(void **state) {
  (void)state;
  unlink(journal_path());
  struct cb_journal *j = opened(true);
  assert_int_equal(cb_journal_session(j), 1);
  assert_true(is_there());
  cb_fail(CB_MEMORY, "no memory");
  assert_int_equal(cb_journal_close(j, CB_MEMORY), CB_MEMORY);
  assert_string_equal(cb_error_message(), "no memory");
  assert_false(is_there());
  leave_rows(2);
  j = opened(false);
  assert_null(cb_journal_row(j, "1", NULL));
  cb_journal_close(j, CB_MEMORY);
  assert_false(is_there());
}

static void assert_refused_journal(const char *options, const char *said) {
  struct cb_journal *j = NULL;
  char *before = read_text(journal_path());
  assert_int_equal(cb_journal_open(temporary, "work", options, true, &j), CB_INPUT);
  assert_null(j);
  if (!strstr(cb_error_message(), said)) fail_msg("'%s' is not in: %s", said, cb_error_message());
  assert_non_null(strstr(cb_error_message(), "work.unfinished"));
  char *after = read_text(journal_path());
  assert_string_equal(before, after);
  free(before);
  free(after);
}

/* The header with another value of that member. */
static void falsify(const char *member) {
  char *text = read_text(journal_path());
  const size_t first = strcspn(text, "\n");
  json_t *header = json_loadb(text, first, 0, NULL);
  assert_non_null(header);
  json_object_set_new(header, member, json_string("another"));
  FILE *file = fopen(journal_path(), "w");
  json_dumpf(header, file, JSON_COMPACT);
  fputs(text + first, file);
  fclose(file);
  json_decref(header);
  free(text);
}

static void other_rows_are_not_joined(void **state) {
  (void)state;
  static const char *const members[] = {"commit", "compiler", "machine", "options", "journal"};
  leave_rows(2);
  assert_refused_journal("half of it", "another options, 'all of it' and not 'half of it'");
  for (size_t i = 0; i < sizeof members / sizeof *members; i++) {
    char said[64];
    leave_rows(2);
    falsify(members[i]);
    snprintf(said, sizeof said, "another %s, 'another' and not '", members[i]);
    assert_refused_journal("all of it", said);
  }
}

static void other_lines_are_refused(void **state) {
  (void)state;
  static const char *const lines[] = {
      "\n",
      "{}\n",
      "[1]\n",
      "x\n",
      "{\"key\":\"7\",\"session\":1}\n",
      "{\"key\":7,\"session\":1,\"row\":0}\n",
      "{\"key\":\"7\",\"session\":0,\"row\":0}\n",
      "{\"key\":\"7\",\"session\":1,\"row\":0,\"row\":1}\n",
      "{\"key\":\"1\",\"session\":1,\"row\":0}\n" /* there is one */};
  for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
    leave_rows(2);
    append(lines[i]);
    assert_refused_journal("all of it", "line 4");
  }
}

static void one_run_at_a_time(void **state) {
  (void)state;
  struct cb_journal *j = opened(false), *second = NULL;
  assert_int_equal(cb_journal_open(temporary, "work", "all of it", false, &second), CB_INPUT);
  assert_non_null(strstr(cb_error_message(), "another run is writing"));
  cb_journal_close(j, CB_OK);
}

/* With no room for the next row, what was finished before it is kept. */
static void full_disk_keeps_what_is_finished(void **state) {
  (void)state;
  leave_rows(2);
  struct stat file;
  struct rlimit limit;
  assert_int_equal(stat(journal_path(), &file), 0);
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
  struct cb_journal *j = opened(true);
  const struct rlimit tight = {(rlim_t)file.st_size + 20, limit.rlim_max};
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &tight), 0);
  const enum cb_status status = cb_journal_add(j, "next", json_string("longer than the room"));
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
  assert_int_equal(status, CB_IO);
  assert_non_null(strstr(cb_error_message(), "work.unfinished"));
  cb_journal_close(j, status);
  j = opened(true);
  assert_non_null(cb_journal_row(j, "1", NULL));
  assert_null(cb_journal_row(j, "next", NULL));
  cb_journal_close(j, CB_OK);
}

static void numbers_come_back(void **state) {
  (void)state;
  const double numbers[] = {0,       -0.0,     0.1,       1.0 / 3, DBL_MIN, DBL_TRUE_MIN,
                            DBL_MAX, INFINITY, -INFINITY, NAN};
  struct cb_journal *j = opened(false);
  json_t *row = json_array();
  for (size_t i = 0; i < 10; i++) json_array_append_new(row, cb_journal_number(numbers[i]));
  assert_int_equal(cb_journal_add(j, "numbers", row), CB_OK);
  cb_journal_close(j, CB_INTERRUPTED);
  j = opened(true);
  for (size_t i = 0; i < 10; i++) {
    double back = 7;
    const json_t *found = cb_journal_row(j, "numbers", NULL);
    assert_true(cb_journal_to_number(json_array_get(found, i), &back));
    assert_true(isnan(numbers[i]) ? isnan(back) : memcmp(&back, &numbers[i], sizeof back) == 0);
  }
  assert_false(cb_journal_to_number(json_true(), &(double){0}));
  assert_false(cb_journal_to_number(NULL, &(double){0}));
  cb_journal_close(j, CB_OK);
}

static void contents_have_digests(void **state) {
  (void)state;
  leave_rows(1);
  const uint64_t before = cb_journal_digest(journal_path());
  assert_true(before != 0 && before == cb_journal_digest(journal_path()));
  append("x");
  assert_true(cb_journal_digest(journal_path()) != before);
  assert_true(cb_journal_digest(temporary_path("nowhere")) == 0);
}

/* ---- slices of results ---------------------------------------------------------------------- */

/* An item of every list; x tells them apart. A member that is new is missing here, which the
 * compiler says, and in results_slices.c. */
static void add_all(struct cb_results *r, double x) {
  const struct cb_mesh mesh = {.nodes = 5, .tets = 2};
  struct cb_row row = cb_row_unmeasured("7", "a/b/c", &mesh);
  const double step[2] = {x, 2 * x}, cpu[2] = {x, NAN};
  const size_t repeats[2] = {3, 4};
  struct cb_samples samples = {.stride = 2, .rounds = 2};
  samples.step_s = (double *)step, samples.cpu_s = (double *)cpu;
  samples.repeats = (size_t *)repeats;
  const struct cb_interval i = {x, -INFINITY, x + 1};
  row.setup_s = x;
  assert_int_equal(cb_results_add_row(r, &row), CB_OK);
  assert_int_equal(cb_results_add_measured(r, &row, &samples, 0), CB_OK);
  cb_results_add_ratio(r, &(struct cb_ratio){"4", "n", "d", 1, 2, 3, 4, i, NAN});
  cb_results_add_fit(r, &(struct cb_fit){"v", 1, 2, i, i});
  cb_results_add_crossing(r, &(struct cb_crossing){"a", "u", 1, 2, i, x});
  cb_results_add_convergence(r, &(struct cb_convergence){"v", 1, 2, x, NAN});
  cb_results_add_roofline(
      r, &(struct cb_roofline){"step", "grid", "L1", "v", 1, 2, x, NAN, 3 * x, i, x, x, x});
  cb_results_add_speed(r, &(struct cb_speed){"grid", "v", 1, 2, i, i, x, x, x});
  cb_results_add_frame(r, &(struct cb_frame){"grid", "v", 1, 2, 3, x, {4, 5, i, x}, {6, 7, i, x}});
}

static char *tables_of(struct cb_results *r) {
  static const char *const names[] = {"bench.csv",    "samples.csv",   "ratios.csv",
                                      "fits.csv",     "crossings.csv", "convergence.csv",
                                      "roofline.csv", "speed.csv",     "frame33.csv"};
  char *all = strdup("");
  assert_int_equal(cb_results_write_tables(r), CB_OK);
  for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
    char *text = read_text(temporary_path(names[i])), *more = NULL;
    assert_true(lines(text) >= 2);
    assert_true(asprintf(&more, "%s%s", all, text) > 0);
    free(all);
    free(text);
    all = more;
  }
  return all;
}

static void slices_of_results_come_back(void **state) {
  (void)state;
  struct cb_results r = {.directory = temporary, .session = 1};
  struct cb_results s = {.directory = temporary, .session = 1};
  add_all(&r, 0.1);
  add_all(&s, 0.1);
  const struct cb_mark mark = cb_results_mark(&r);
  add_all(&r, 1.0 / 3);
  add_all(&r, 1e-300);
  json_t *slice = cb_results_since(&r, &mark);
  assert_non_null(slice);
  assert_int_equal(cb_results_restore(&s, slice, 1), CB_OK);
  char *before = tables_of(&r), *after = tables_of(&s);
  assert_string_equal(before, after);
  free(before);
  free(after);
  json_array_remove(json_array_get(json_object_get(slice, "samples"), 0), 0);
  assert_int_equal(cb_results_restore(&s, slice, 1), CB_INPUT);
  json_object_clear(slice);
  json_object_set_new(slice, "samples", json_pack("[[i, i, i, f, f]]", 7, 0, 1, 1.0, 1.0));
  assert_int_equal(cb_results_restore(&s, slice, 1), CB_INPUT); /* of a row that is not there */
  json_decref(slice);
  cb_results_free(&r);
  cb_results_free(&s);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rows_are_found_again),
      cmocka_unit_test(half_lines_are_no_rows),
      cmocka_unit_test(nothing_finished_leaves_nothing),
      cmocka_unit_test(other_rows_are_not_joined),
      cmocka_unit_test(other_lines_are_refused),
      cmocka_unit_test(one_run_at_a_time),
      cmocka_unit_test(full_disk_keeps_what_is_finished),
      cmocka_unit_test(numbers_come_back),
      cmocka_unit_test(contents_have_digests),
      cmocka_unit_test(slices_of_results_come_back),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
