/* test_mesh_damage.c - files of meshes and positions, cut short at each byte, without each line,
 * with each byte changed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/mesh_files.h"

/* Whatever is wrong with a file, it is read or refused with a sentence. */
static void assert_survives(const char *name, const char *bytes, size_t size) {
  write_bytes(name, bytes, size);
  struct cb_mesh mesh = {0};
  long long *numbers = NULL;
  double x[18];
  cb_fail(CB_BROKEN, "%s", "");
  enum cb_status status;
  if (strstr(name, ".csv"))
    status = cb_positions_read(temporary_path(name), &(struct cb_mesh){.nodes = 6}, msh_numbers, x);
  else
    status = cb_mesh_read(temporary_path(name), &mesh, &numbers);
  assert_true(status == CB_OK || status == CB_INPUT);
  if (status == CB_INPUT) assert_contains(cb_error_message(), temporary);
  for (size_t i = 0; i < 4 * mesh.tets; i++) assert_true(mesh.tet[i] < mesh.nodes);
  for (size_t i = 0; i < 3 * mesh.nodes; i++) assert_true(isfinite(mesh.X[i]));
  free(numbers);
  cb_mesh_free(&mesh);
}

static void damage(const char *name, const char *text) {
  size_t size = strlen(text);
  char *changed = malloc(size + 1);
  assert_non_null(changed);
  for (size_t n = 0; n < size; n++) assert_survives(name, text, n);

  for (const char *line = text; *line;) {
    const char *next = strchr(line, '\n') + 1;
    size_t before = (size_t)(line - text), after = strlen(next);
    memcpy(changed, text, before);
    memcpy(changed + before, next, after);
    assert_survives(name, changed, before + after);
    line = next;
  }

  const char bytes[] = {'\0', '\n', ' ', '-', '9', '.', '$', '\xFF'};
  for (size_t n = 0; n < size; n++)
    for (size_t b = 0; b < sizeof bytes; b++) {
      memcpy(changed, text, size);
      changed[n] = bytes[b];
      assert_survives(name, changed, size);
    }
  free(changed);
}

static void damaged_files_never_crash(void **state) {
  (void)state;
  write_samples();
  damage("a.1.node", node_text);
  write_samples();
  damage("a.1.ele", ele_text);
  damage("two.msh", msh2_text);
  damage("four.msh", msh4_text);
  damage("x.csv", csv_text);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
