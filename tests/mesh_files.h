/* mesh_files.h - a mesh in every format that is read, files made of it, and what the readers say.
 * Include cmocka.h first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_MESH_FILES_H
#define CB_TESTS_MESH_FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "tests/temporary.h"

/* Two tetrahedra on five nodes, the second negatively oriented; a node that no
 * tetrahedron uses. The same mesh in every format below. */
static const double sample_X[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 5, 5, 5};
static const uint32_t sample_tet[] = {0, 1, 2, 3, 1, 2, 3, 4};

static const char node_text[] = "# made by hand\n"
                                "6 3 1 1\n"
                                "\n"
                                "1 0 0 0 9.5 1 # attribute and marker\n"
                                "2 1. 0 0 9.5 0\n"
                                "  3\t0 1e0 0 9.5 0\n"
                                "4 0 0 +1 9.5 0\n"
                                "5 1 1 1 9.5 0\n"
                                "6 5 5 5 9.5 0\n"
                                "# end\n";
static const char ele_text[] = "2  4  1\n"
                               "1 1 2 3 4 7\n"
                               "# between\n"
                               "2 2 3 4 5 7\n";
static const char msh2_text[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n1\n3 1 \"body\"\n$EndPhysicalNames\n"
    "$Nodes\n6\n"
    "10 0 0 0\n11 1 0 0\n300 0 1 0\n4 0 0 1\n5000000000 1 1 1\n6 5 5 5\n"
    "$EndNodes\n"
    "$Elements\n4\n"
    "1 15 2 0 1 6\n"
    "2 4 2 1 1 10 11 300 4\n"
    "3 2 3 0 1 0 10 11 300\n"
    "4 4 0 11 300 4 5000000000\n"
    "$EndElements\n";
static const char msh4_text[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
                                "$Entities\n1 0 1 1\n1 0 0 0 0\n"
                                "1 0 0 0 1 1 1 0 0\n1 0 0 0 1 1 1 0 0\n$EndEntities\n"
                                "$Nodes\n4 6 4 5000000000\n"
                                "0 1 0 1\n10\n0 0 0\n"
                                "1 1 0 0\n"
                                "2 1 1 3\n11\n300\n4\n1 0 0 0.5 0.5\n0 1 0 0.1 0\n0 0 1 0 0\n"
                                "3 1 0 2\n5000000000\n6\n1 1 1\n5 5 5\n"
                                "$EndNodes\n"
                                "$Elements\n2 4 1 9\n"
                                "2 1 2 2\n1 10 11 300\n2 11 300 4\n"
                                "3 1 4 2\n3 10 11 300 4\n9 11 300 4 5000000000\n"
                                "$EndElements\n"
                                "$NodeData\n1\n\"u\"\n$EndNodeData\n";

static const long long msh_numbers[] = {10, 11, 300, 4, 5000000000, 6};
/* Positions of its nodes, by these numbers. */
static const char csv_text[] = "node,x,y,z\n"
                               "6,6,6.5,6.25\n300,3,-3,3e1\n10,0.1,0.2,0.3\n4,4,4,4\n"
                               "5000000000,5,5,5\n11,1,1,1\n";

/* A new file each time: some file systems flush one that is written again, which
 * is slow for the thousands of damaged ones. */
static inline void write_bytes(const char *name, const char *bytes, size_t size) {
  remove(temporary_path(name));
  FILE *stream = fopen(temporary_path(name), "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(bytes, 1, size, stream), size);
  assert_int_equal(fclose(stream), 0);
}

static inline void write_text(const char *name, const char *text) {
  write_bytes(name, text, strlen(text));
}

static inline enum cb_status read_named(const char *name, struct cb_mesh *mesh,
                                        long long **numbers) {
  cb_fail(CB_BROKEN, "%s", "");
  return cb_mesh_read(temporary_path(name), mesh, numbers);
}

static inline void assert_sample(const char *name, const long long *expected_numbers) {
  struct cb_mesh mesh;
  long long *numbers;
  if (read_named(name, &mesh, &numbers) != CB_OK) fail_msg("%s", cb_error_message());
  assert_int_equal(mesh.nodes, 6);
  assert_int_equal(mesh.tets, 2);
  assert_true(mesh.share == 1);
  assert_memory_equal(mesh.X, sample_X, sizeof sample_X);
  assert_memory_equal(mesh.tet, sample_tet, sizeof sample_tet);
  for (long long i = 0; i < 6; i++)
    assert_true(numbers[i] == (expected_numbers ? expected_numbers[i] : 1 + i));
  free(numbers);
  cb_mesh_free(&mesh);
}

/* The message of a file that is refused; the outputs are untouched. */
static inline const char *refusal(const char *name) {
  struct cb_mesh mesh = {.nodes = 77};
  long long *numbers = NULL;
  if (read_named(name, &mesh, &numbers) != CB_INPUT)
    fail_msg("%s: not refused as input (%s)", name, cb_error_message());
  assert_int_equal(mesh.nodes, 77);
  assert_null(mesh.X);
  assert_null(numbers);
  return cb_error_message();
}

static inline void assert_contains(const char *message, const char *part) {
  if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

/* text with the first occurrence of a part replaced; to be freed. */
static inline char *replaced(const char *text, const char *part, const char *by) {
  const char *at = strstr(text, part);
  assert_non_null(at);
  char *made;
  assert_true(asprintf(&made, "%.*s%s%s", (int)(at - text), text, by, at + strlen(part)) > 0);
  return made;
}

static inline void assert_refused(const char *name, const char *text, const char *part,
                                  const char *by, const char *where, const char *why) {
  char *changed = replaced(text, part, by);
  write_text(name, changed);
  const char *message = refusal(name);
  assert_contains(message, temporary_path(name));
  if (where) assert_contains(message, where);
  assert_contains(message, why);
  free(changed);
}

/* Every line feed preceded by a carriage return; to be freed. */
static inline char *with_crlf(const char *text) {
  char *made = malloc(2 * strlen(text) + 1), *p = made;
  assert_non_null(made);
  for (; *text; text++) {
    if (*text == '\n') *p++ = '\r';
    *p++ = *text;
  }
  *p = '\0';
  return made;
}

static inline void write_samples(void) {
  write_text("a.1.node", node_text);
  write_text("a.1.ele", ele_text);
  write_text("two.msh", msh2_text);
  write_text("four.msh", msh4_text);
}

#endif
