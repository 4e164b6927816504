/* corobench run, as a user runs it: what it writes is what the body did.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/process.h"

/* Not inlined: gcc 12 takes what getdelim returns for the address of a local. */
static __attribute__((noinline)) char *whole(const char *name) {
  return read_text(temporary_path(name));
}

static size_t occurrences(const char *text, const char *of) {
  const size_t length = strlen(of);
  size_t n = 0;
  for (size_t i = 0; text[i]; i++) n += strncmp(text + i, of, length) == 0;
  return n;
}

static void a_film_begins_and_ends_with_the_scene(void **state) {
  (void)state;
  const char *const words[] = {
      "run", "scenes/twisted-bar.json", "--output", temporary, "--pictures", "8", NULL};
  struct process p = run_words(NULL, words);
  assert_done(&p);
  assert_non_null(strstr(p.out, "80 steps"));
  assert_non_null(strstr(p.out, "In the end 0 of 1350 elements are inverted"));
  process_free(&p);
  char *series = whole("twisted-bar.pvd");
  assert_int_equal(occurrences(series, "<DataSet"), 9);
  assert_non_null(strstr(series, "timestep=\"0\" file=\"twisted-bar-0000.vtu\""));
  assert_non_null(strstr(series, "timestep=\"0.4\" file=\"twisted-bar-0008.vtu\""));
  free(series);
  char *first = whole("twisted-bar-0000.vtu");
  char *last = whole("twisted-bar-0008.vtu");
  assert_non_null(strstr(first, "NumberOfPoints=\"256\" NumberOfCells=\"1350\""));
  assert_int_equal(lines(first), lines(last));
  /* at the start no volume has changed, in the end most have */
  const size_t kept = occurrences(strstr(first, "Name=\"volume\""), "\n1");
  assert_true(kept > 1200 && occurrences(strstr(last, "Name=\"volume\""), "\n1\n") < kept / 2);
  free(first);
  free(last);
}

static void one_variant_is_run(void **state) {
  (void)state;
  const char *const words[] = {"run", "scenes/block.json", "--variant", "qr-*", NULL};
  struct process p = run_words(NULL, words);
  assert_one_sentence(&p, "run needs exactly one variant, and --variant selects ");
  process_free(&p);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_film_begins_and_ends_with_the_scene),
      cmocka_unit_test(one_variant_is_run),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
