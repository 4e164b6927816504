/* test_output.c - outputs are whole or absent: after success, failure, exit and
 * interrupt.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/progress.h"
#include "tests/temporary.h"

static bool exists(const char *name) {
  struct stat found;
  return lstat(temporary_path(name), &found) == 0;
}

static void assert_holds(const char *name, const char *expected) {
  char text[64] = "";
  FILE *stream = fopen(temporary_path(name), "r");
  assert_non_null(stream);
  text[fread(text, 1, sizeof text - 1, stream)] = '\0';
  fclose(stream);
  assert_string_equal(text, expected);
}

static void write_file(const char *name, const char *text) {
  FILE *stream = fopen(temporary_path(name), "w");
  assert_non_null(stream);
  assert_true(fputs(text, stream) >= 0);
  assert_int_equal(fclose(stream), 0);
}

static void commit_replaces(void **state) {
  (void)state;
  write_file("replaced", "old");
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary, "replaced"), CB_OK);
  fputs("new", o.stream);
  fflush(o.stream);
  assert_holds("replaced", "old");
  assert_holds("replaced.part", "new");
  assert_int_equal(cb_output_commit(&o), CB_OK);
  assert_null(o.stream);
  assert_holds("replaced", "new");
  assert_false(exists("replaced.part"));
  cb_output_abandon(&o);
  assert_holds("replaced", "new");
}

static void abandon_leaves_nothing(void **state) {
  (void)state;
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, NULL, temporary_path("abandoned")), CB_OK);
  fputs("half", o.stream);
  assert_true(exists("abandoned.part"));
  cb_output_abandon(&o);
  assert_false(exists("abandoned.part"));
  assert_false(exists("abandoned"));
}

static void full_disk_leaves_the_old(void **state) {
  (void)state;
  write_file("full", "old");
  assert_int_equal(symlink("/dev/full", temporary_path("full.part")), 0);
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary, "full"), CB_OK);
  fputs("new", o.stream);
  assert_int_equal(cb_output_commit(&o), CB_IO);
  assert_non_null(strstr(cb_error_message(), temporary_path("full")));
  assert_non_null(strstr(cb_error_message(), "No space left"));
  assert_non_null(strstr(cb_error_message(), "--output"));
  assert_holds("full", "old");
  assert_false(exists("full.part"));
}

/* The disk is full for a while, before the commit, and then has room again. */
static void full_disk_in_between(void **state) {
  (void)state;
  assert_int_equal(symlink("/dev/full", temporary_path("long.part")), 0);
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary, "long"), CB_OK);
  fputs("lost", o.stream);
  assert_int_equal(fflush(o.stream), EOF);
  int room = open("/dev/null", O_WRONLY);
  assert_true(room >= 0 && dup2(room, fileno(o.stream)) >= 0);
  close(room);
  assert_int_equal(cb_output_commit(&o), CB_IO);
  assert_non_null(strstr(cb_error_message(), "an earlier write failed"));
  assert_false(exists("long"));
  assert_false(exists("long.part"));
}

static void tables_are_whole_or_absent(void **state) {
  (void)state;
  struct cb_table *t = cb_table_create("a,b");
  cb_table_integer(t, 1);
  cb_table_missing(t);
  assert_int_equal(cb_output_table(temporary, "table.csv", t, CB_CSV), CB_OK);
  assert_holds("table.csv", "a,b\n1,\n");

  assert_int_equal(symlink("/dev/full", temporary_path("table.json.part")), 0);
  assert_int_equal(cb_output_table(temporary, "table.json", t, CB_JSON), CB_IO);
  assert_non_null(strstr(cb_error_message(), temporary_path("table.json")));
  assert_false(exists("table.json"));
  assert_false(exists("table.json.part"));
  cb_table_free(t);
}

static void no_such_directory(void **state) {
  (void)state;
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary_path("nowhere"), "x"), CB_IO);
  assert_non_null(strstr(cb_error_message(), "nowhere/x"));
  assert_non_null(strstr(cb_error_message(), "No such file"));
  assert_false(exists("nowhere"));
}

static void name_is_a_directory(void **state) {
  (void)state;
  assert_int_equal(mkdir(temporary_path("taken"), 0777), 0);
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary, "taken"), CB_OK);
  assert_int_equal(cb_output_commit(&o), CB_IO);
  assert_true(exists("taken"));
  assert_false(exists("taken.part"));
}

static void directories_are_made(void **state) {
  (void)state;
  assert_int_equal(cb_output_directory(temporary_path("deep/er//still/")), CB_OK);
  assert_int_equal(cb_output_directory(temporary_path("deep/er/still")), CB_OK);
  struct stat found;
  assert_int_equal(stat(temporary_path("deep/er/still"), &found), 0);
  assert_true(S_ISDIR(found.st_mode));
  assert_int_equal(cb_output_directory("."), CB_OK);
  assert_int_equal(cb_output_directory("/"), CB_OK);
}

static void directories_that_cannot_be(void **state) {
  (void)state;
  write_file("file", "");
  assert_int_equal(cb_output_directory(temporary_path("file")), CB_IO);
  assert_non_null(strstr(cb_error_message(), "Not a directory"));
  assert_int_equal(cb_output_directory(temporary_path("file/below/it")), CB_IO);
  assert_non_null(strstr(cb_error_message(), "Not a directory"));
  assert_int_equal(cb_output_directory(""), CB_IO);

  if (geteuid() == 0) return; /* root may write anywhere */
  assert_int_equal(mkdir(temporary_path("locked"), 0500), 0);
  assert_int_equal(cb_output_directory(temporary_path("locked/a/b")), CB_IO);
  assert_non_null(strstr(cb_error_message(), "Permission denied"));
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary_path("locked"), "x"), CB_IO);
  assert_non_null(strstr(cb_error_message(), "Permission denied"));
}

static void name_too_long(void **state) {
  (void)state;
  static char name[5000];
  memset(name, 'x', sizeof name - 1);
  struct cb_output o;
  assert_int_equal(cb_output_open(&o, temporary, name), CB_IO);
  assert_int_equal(cb_output_directory(name), CB_IO);
}

static void open_at_once(void **state) {
  (void)state;
  struct cb_output o[17];
  char name[32];
  for (size_t i = 0; i < 16; i++) {
    snprintf(name, sizeof name, "many%zu", i);
    assert_int_equal(cb_output_open(o + i, temporary, name), CB_OK);
  }
  assert_int_equal(cb_output_open(o + 16, temporary, "many16"), CB_IO);
  assert_false(exists("many16.part"));
  cb_output_abandon(o + 3);
  assert_int_equal(cb_output_open(o + 3, temporary, "many3"), CB_OK);
  for (size_t i = 0; i < 16; i++) cb_output_abandon(o + i);
}

/* The wait status of a child that opens an output and ends as told. */
static int status_of_child(void (*end)(void)) {
  fflush(NULL);
  pid_t child = fork();
  assert_true(child >= 0);
  if (child == 0) {
    struct cb_output o;
    if (!freopen("/dev/null", "w", stderr) || cb_output_open(&o, temporary, "child") != CB_OK)
      _exit(99);
    fputs("half", o.stream);
    fflush(o.stream);
    end();
    _exit(98);
  }
  int status;
  assert_int_equal(waitpid(child, &status, 0), child);
  return status;
}

static void end_by_exit(void) {
  if (!exists("child.part")) _exit(97);
  exit(7);
}

static void end_by_second_interrupt(void) {
  cb_interrupt_install();
  raise(SIGINT);
  if (!cb_interrupted() || !exists("child.part")) _exit(97);
  raise(SIGINT);
}

static void end_by_second_terminate(void) {
  cb_interrupt_install();
  if (cb_interrupted()) _exit(97);
  raise(SIGTERM);
  if (!cb_interrupted() || !exists("child.part")) _exit(97);
  raise(SIGTERM);
}

static void every_end_removes_parts(void **state) {
  (void)state;
  const struct {
    void (*end)(void);
    int status;
  } ends[] = {{end_by_exit, 7}, {end_by_second_interrupt, 130}, {end_by_second_terminate, 130}};
  for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
    int status = status_of_child(ends[i].end);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), ends[i].status);
    assert_false(exists("child.part"));
    assert_false(exists("child"));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(commit_replaces),
      cmocka_unit_test(abandon_leaves_nothing),
      cmocka_unit_test(full_disk_leaves_the_old),
      cmocka_unit_test(full_disk_in_between),
      cmocka_unit_test(tables_are_whole_or_absent),
      cmocka_unit_test(no_such_directory),
      cmocka_unit_test(name_is_a_directory),
      cmocka_unit_test(directories_are_made),
      cmocka_unit_test(directories_that_cannot_be),
      cmocka_unit_test(name_too_long),
      cmocka_unit_test(open_at_once),
      cmocka_unit_test(every_end_removes_parts),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
