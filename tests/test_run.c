/* test_run.c - tests/run must not let a failure, a crash or an empty program
 * pass. Made-up programs print what cmocka would. Run from the source's root.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "tests/process.h"

/* The total and exit status of tests/run over one or two programs. */
static void totals(const char *script, const char *other, const char *last_line, int exit_status) {
  const char *const scripts[] = {script, other};
  const char *const paths[] = {temporary_path("program0"), temporary_path("program1")};
  const char *argv[] = {"tests/run", paths[0], other ? paths[1] : NULL, NULL};
  for (size_t i = 0; i < 2 && scripts[i]; i++) {
    FILE *file = fopen(paths[i], "w");
    assert_non_null(file);
    fprintf(file, "#!/bin/sh\n%s\n", scripts[i]);
    assert_int_equal(fclose(file), 0);
    assert_int_equal(chmod(paths[i], 0700), 0);
  }
  struct process p = process_run(argv, environ, NULL);
  size_t length = strlen(p.out), wanted = strlen(last_line);
  assert_true(length > wanted);
  assert_string_equal(p.out + length - wanted, last_line);
  assert_int_equal(p.exit_status, exit_status);
  process_free(&p);
  for (size_t i = 0; i < 2 && scripts[i]; i++) unlink(paths[i]);
}

static void test_passes(void **state) {
  (void)state;
  totals("printf '1..2\nok 1 - a\nok 2 - b\n'", NULL, "\n2 passed, 0 failed\n", 0);
  totals("printf '1..1\nok 1 - a\n'", "printf '1..1\nok 1 - b\n'", "\n2 passed, 0 failed\n", 0);
}

static void test_failure(void **state) {
  (void)state;
  totals("printf '1..2\nok 1 - a\nnot ok 2 - b\n'; exit 1", NULL, "\n1 passed, 1 failed\n", 1);
  totals("printf '1..1\nok 1 - a\n'", "printf '1..1\nnot ok 1 - b\n'; exit 1",
         "\n1 passed, 1 failed\n", 1);
}

static void test_crash(void **state) {
  (void)state;
  totals("printf '1..3\nok 1 - a\n'; kill -ABRT $$", NULL, "\n1 passed, 2 failed\n", 1);
  totals("kill -SEGV $$", NULL, "\n0 passed, 1 failed\n", 1);
  totals("printf '1..1\nok 1 - a\n'; kill -SEGV $$", NULL, "\n1 passed, 1 failed\n", 1);
}

/* A program may stop early with exit status 0, or test nothing. */
static void test_silence(void **state) {
  (void)state;
  totals("exit 0", NULL, "\n0 passed, 1 failed\n", 1);
  totals("printf '1..3\nok 1 - a\n'", NULL, "\n1 passed, 2 failed\n", 1);
}

static void test_skipped(void **state) {
  (void)state;
  totals("printf '1..2\nok 1 - a\nnot ok 2 # SKIP b\n'", NULL, "\n1 passed, 0 failed\n", 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_passes),  cmocka_unit_test(test_failure), cmocka_unit_test(test_crash),
      cmocka_unit_test(test_silence), cmocka_unit_test(test_skipped),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
