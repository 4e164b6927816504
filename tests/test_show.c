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

/* What plots/film.gp draws: every picture has all faces of a closed surface, one caption, and
 * what holds the body as long as it does; and a strip has its eight. */
static void the_data_of_a_strip_are_complete(void **state) {
  (void)state;
  const char *const words[] = {"run",
                               "scenes/liver-yank.json",
                               "--resolution",
                               "0.5",
                               "--variant",
                               "polar-exact/ebe/f64",
                               "--output",
                               temporary,
                               "--pictures",
                               "20",
                               NULL};
  struct process p = run_words(NULL, words);
  assert_done(&p);
  assert_non_null(strstr(p.out, "It recovers."));
  process_free(&p);
  char *table = whole("liver-yank-film.csv"), *faces = whole("liver-yank-faces.txt");
  char *grips = whole("liver-yank-grips.txt");
  assert_int_equal(lines(table), 1 + 21);
  assert_int_equal(occurrences(table, ",1\n"), 8); /* of column strip */
  assert_non_null(strstr(table, "\n20,1.6"));      /* the end */
  const size_t patches = occurrences(faces, "nan nan nan 0 0\nnan"), each = patches / 21;
  assert_int_equal(patches, 21 * each);
  assert_int_equal(occurrences(faces, "\n\n\n"), 21); /* pictures */
  assert_int_equal(lines(faces), patches * 9 + 21);
  assert_true(each > 100 && each % 2 == 0);    /* closed: three edges of two faces each */
  assert_true(occurrences(faces, " 1\n") > 0); /* inverted ones */
  assert_int_equal(occurrences(grips, " 0\n"), 21 * 4);
  assert_int_equal(occurrences(grips, " 1\n"), 6); /* pictures up to 0.4 s, every 0.08 s */
  free(table);
  free(faces);
  free(grips);
}

static void several_variants_are_a_table(void **state) {
  (void)state;
  const char *const words[] = {"run",
                               "scenes/rabbit-crush.json",
                               "--resolution",
                               "0.5",
                               "--variant",
                               "polar-exact/ebe/f64",
                               "--variant",
                               "polar-reflected-*/ebe/f64",
                               "--variant",
                               "polar-exact/ebe/*",
                               "--format",
                               "csv",
                               "--output",
                               temporary,
                               "--pictures",
                               "3",
                               NULL};
  struct process p = run_words(NULL, words);
  assert_done(&p);
  const char *second = strchr(p.out, '\n') + 1; /* the first glob's first, and only once */
  assert_memory_equal(second, "polar-exact/ebe/f64,", 20);
  assert_int_equal(occurrences(p.out, "polar-exact/ebe/f64,"), 1);
  assert_true(lines(p.out) > 5);
  char *table = whole("rabbit-crush-run.csv");
  assert_string_equal(table, p.out);
  free(table);
  process_free(&p);
}

static void a_resolution_must_be_one(void **state) {
  (void)state;
  const char *const words[] = {"run", "scenes/block.json", "--resolution", "0", NULL};
  struct process p = run_words(NULL, words);
  assert_one_sentence(&p, "--resolution");
  process_free(&p);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_film_begins_and_ends_with_the_scene),
      cmocka_unit_test(the_data_of_a_strip_are_complete),
      cmocka_unit_test(several_variants_are_a_table),
      cmocka_unit_test(a_resolution_must_be_one),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
