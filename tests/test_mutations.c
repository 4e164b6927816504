/* test_mutations.c - every shipped scene with each of its bytes and lines cut, changed, left
 * out or doubled is read or refused in one sentence that names the file. The same ones in
 * every run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/scene/body.h"
#include "tests/process.h"
#include "tests/tally.h"

/* A scene, and what is made of it. */
struct mutant {
  const char *original, *path;
  int fd; /* of the path */
  size_t length;
  size_t accepted, refused;
};

/* Bodies of large meshes would take the time of all else. */
static void make_body(const struct cb_scene *s) {
  struct cb_body body = {0};
  const double resolution = s->shape[0] ? 0.01 : 0.1;
  if (s->mesh_path[0] || s->cells[0] * s->cells[1] * s->cells[2] > 100000) return;
  if (cb_body_create(s, resolution, &body) != CB_OK) {
    assert_true(cb_error_message()[0] != '\0');
    return;
  }
  for (size_t i = 0; i < 3 * body.at.mesh.nodes; i++) assert_true(isfinite(body.at.mesh.X[i]));
  cb_body_free(&body);
}

/* original[0, first), piece, original[rest, ...) as a file that is read. */
static void try(struct mutant *m, size_t first, const char *piece, size_t length, size_t rest) {
  char text[4096];
  struct cb_scene scene;
  const size_t tail = rest < m->length ? m->length - rest : 0, size = first + length + tail;
  assert_true(size < sizeof text);
  memcpy(text, m->original, first);
  memcpy(text + first, piece, length);
  memcpy(text + first + length, m->original + m->length - tail, tail);
  assert_int_equal(pwrite(m->fd, text, size, 0), size);
  assert_int_equal(ftruncate(m->fd, (off_t)size), 0);
  cb_fail(CB_INPUT, "%s", "");
  const enum cb_status status = cb_scene_read(m->path, &scene);
  if (status == CB_OK) {
    if (m->accepted++ % 64 == 0) make_body(&scene);
    return;
  }
  m->refused++;
  if (status != CB_INPUT || !strstr(cb_error_message(), m->path) ||
      strchr(cb_error_message(), '\n'))
    fail_msg("status %d of byte %zu of %s: '%s'", status, first, m->path, cb_error_message());
}

static void mutate_bytes(struct mutant *m) {
  static const char hard[] = {'\0', '\xff', '"', '{', '}', '[', ']', ',', ':', '-', '9', 'e', '\\'};
  for (size_t i = 0; i < m->length; i++) {
    const char *byte = m->original + i;
    const char twice[2] = {*byte, *byte};
    try(m, i, "", 0, m->length);
    try(m, i, "", 0, i + 1);
    try(m, i, twice, 2, i + 1);
    for (int bit = 0; bit < 8; bit++) try(m, i, &(char){(char)(*byte ^ 1 << bit)}, 1, i + 1);
    for (size_t k = 0; k < sizeof hard; k++) try(m, i, hard + k, 1, i + 1);
  }
}

/* Each line, and each that is followed by another one. */
static void mutate_lines(struct mutant *m) {
  for (size_t begin = 0, end; begin < m->length; begin = end) {
    const char *stop = memchr(m->original + begin, '\n', m->length - begin);
    end = stop ? (size_t)(stop + 1 - m->original) : m->length;
    try(m, begin, "", 0, end);
    try(m, end, m->original + begin, end - begin, end);
    for (size_t other = end, last; other < m->length; other = last) {
      stop = memchr(m->original + other, '\n', m->length - other);
      last = stop ? (size_t)(stop + 1 - m->original) : m->length;
      try(m, begin, m->original + other, last - other, end);
    }
  }
}

static void broken_scenes_are_refused(void **state) {
  (void)state;
  glob_t found;
  size_t accepted = 0, refused = 0;
  assert_int_equal(glob("scenes/*.json", 0, NULL, &found), 0);
  for (size_t i = 0; i < found.gl_pathc; i++) {
    char *text = read_text(found.gl_pathv[i]);
    struct mutant m = {.original = text,
                       .path = temporary_path(strrchr(found.gl_pathv[i], '/') + 1),
                       .length = strlen(text)};
    m.fd = open(m.path, O_RDWR | O_CREAT, 0600);
    assert_true(m.fd >= 0 && m.length > 100);
    mutate_bytes(&m);
    mutate_lines(&m);
    close(m.fd);
    accepted += m.accepted, refused += m.refused;
    free(text);
  }
  tally("scenes mutated", found.gl_pathc);
  tally("mutations of scenes", accepted + refused);
  tally("mutations refused", refused);
  globfree(&found);
  assert_true(accepted > 0 && refused > accepted);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(broken_scenes_are_refused)};
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
