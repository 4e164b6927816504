/* test_positions.c - the reader of positions: what it accepts, and the sentence for what it
 * refuses.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/mesh_files.h"

static enum cb_status read_positions(const char *text, const long long *numbers, double *x) {
  const struct cb_mesh mesh = {.nodes = 6};
  write_text("x.csv", text);
  cb_fail(CB_BROKEN, "%s", "");
  return cb_positions_read(temporary_path("x.csv"), &mesh, numbers, x);
}

static void positions_are_read(void **state) {
  (void)state;
  const double expected[] = {0.1, 0.2, 0.3, 1, 1, 1, 3, -3, 30, 4, 4, 4, 5, 5, 5, 6, 6.5, 6.25};
  double x[18];
  char *crlf = with_crlf(csv_text);
  const char *const texts[] = {csv_text, crlf};
  for (size_t i = 0; i < 2; i++) {
    memset(x, 0, sizeof x);
    assert_int_equal(read_positions(texts[i], msh_numbers, x), CB_OK);
    assert_memory_equal(x, expected, sizeof x);
  }
  free(crlf);
  /* As a spreadsheet writes it, for a mesh that numbers from 0. */
  assert_int_equal(read_positions("\xEF\xBB\xBFnode,x,y,z\n5, 5, 0, 0\n0,1,2,3\n1,0,0,0\n2,0,0,0\n"
                                  "3,0,0,0\n4,0,0,0\n",
                                  NULL, x),
                   CB_OK);
  assert_true(x[2] == 3 && x[15] == 5);
}

static void positions_refuse(void **state) {
  (void)state;
  const char *const cases[][4] = {
      {"node,x,y,z\n", "", "line 1", "header"},
      {"node,x,y,z\n", "node,x,y,z,w\n", "line 1", "header"},
      {"node,x,y,z\n", "node;x;y;z\n", "line 1", "header"},
      {"4,4,4,4\n", "", "x.csv", "node 4 has no position"},
      {"4,4,4,4\n", "4,4,4,4\n4,4,4,4\n", "line 6", "position already"},
      {"4,4,4,4\n", "5,4,4,4\n", "line 5", "no node 5"},
      {"4,4,4,4\n", "4,4,4,nan\n", "line 5", "finite"},
      {"4,4,4,4\n", "4,4,inf,4\n", "line 5", "finite"},
      {"4,4,4,4\n", "4,4,4\n", "line 5", "finite"},
      {"4,4,4,4\n", "4,4,4,4,4\n", "line 5", "nothing after"},
      {"4,4,4,4\n", "4 4 4 4\n", "line 5", "node,x,y,z"},
      {"4,4,4,4\n", "four,4,4,4\n", "line 5", "node,x,y,z"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double x[18] = {42};
    char *text = replaced(csv_text, cases[i][0], cases[i][1]);
    assert_int_equal(read_positions(text, msh_numbers, x), CB_INPUT);
    assert_contains(cb_error_message(), cases[i][2]);
    assert_contains(cb_error_message(), cases[i][3]);
    assert_true(x[0] == 42);
    free(text);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(positions_are_read),
      cmocka_unit_test(positions_refuse),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
