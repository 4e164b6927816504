/* test_mesh.c - the readers of meshes and positions: what they accept, and the
 * sentence for what they refuse.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "tests/temporary.h"

/* ---- reading --------------------------------------------------------------- */

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

/* A new file each time: some file systems flush one that is written again, which
 * is slow for the thousands of damaged ones below. */
static void write_bytes(const char *name, const char *bytes, size_t size) {
  remove(temporary_path(name));
  FILE *stream = fopen(temporary_path(name), "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(bytes, 1, size, stream), size);
  assert_int_equal(fclose(stream), 0);
}

static void write_text(const char *name, const char *text) {
  write_bytes(name, text, strlen(text));
}

static enum cb_status read_named(const char *name, struct cb_mesh *mesh, long long **numbers) {
  cb_fail(CB_BROKEN, "%s", "");
  return cb_mesh_read(temporary_path(name), mesh, numbers);
}

static void assert_sample(const char *name, const long long *expected_numbers) {
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
static const char *refusal(const char *name) {
  struct cb_mesh mesh = {.nodes = 77};
  long long *numbers = NULL;
  if (read_named(name, &mesh, &numbers) != CB_INPUT)
    fail_msg("%s: not refused as input (%s)", name, cb_error_message());
  assert_int_equal(mesh.nodes, 77);
  assert_null(mesh.X);
  assert_null(numbers);
  return cb_error_message();
}

static void assert_contains(const char *message, const char *part) {
  if (!strstr(message, part)) fail_msg("\"%s\" is not in \"%s\"", part, message);
}

/* text with the first occurrence of a part replaced; to be freed. */
static char *replaced(const char *text, const char *part, const char *by) {
  const char *at = strstr(text, part);
  assert_non_null(at);
  char *made;
  assert_true(asprintf(&made, "%.*s%s%s", (int)(at - text), text, by, at + strlen(part)) > 0);
  return made;
}

static void assert_refused(const char *name, const char *text, const char *part, const char *by,
                           const char *where, const char *why) {
  char *changed = replaced(text, part, by);
  write_text(name, changed);
  const char *message = refusal(name);
  assert_contains(message, temporary_path(name));
  if (where) assert_contains(message, where);
  assert_contains(message, why);
  free(changed);
}

/* Every line feed preceded by a carriage return; to be freed. */
static char *with_crlf(const char *text) {
  char *made = malloc(2 * strlen(text) + 1), *p = made;
  assert_non_null(made);
  for (; *text; text++) {
    if (*text == '\n') *p++ = '\r';
    *p++ = *text;
  }
  *p = '\0';
  return made;
}

static void write_samples(void) {
  write_text("a.1.node", node_text);
  write_text("a.1.ele", ele_text);
  write_text("two.msh", msh2_text);
  write_text("four.msh", msh4_text);
}

static void samples_are_read(void **state) {
  (void)state;
  write_samples();
  assert_sample("a.1.node", NULL);
  assert_sample("a.1.ele", NULL);
  assert_sample("two.msh", msh_numbers);
  assert_sample("four.msh", msh_numbers);
  struct cb_mesh mesh;
  assert_int_equal(read_named("four.msh", &mesh, NULL), CB_OK);
  assert_true(cb_mesh_six_volumes(&mesh, 0) == 1 && cb_mesh_six_volumes(&mesh, 1) == 2);
  cb_mesh_free(&mesh);
}

static void windows_line_ends_are_read(void **state) {
  (void)state;
  const char *const names[] = {"a.1.node", "a.1.ele", "two.msh", "four.msh"};
  const char *const texts[] = {node_text, ele_text, msh2_text, msh4_text};
  for (size_t i = 0; i < 4; i++) {
    char *text = with_crlf(texts[i]);
    write_text(names[i], text);
    free(text);
  }
  assert_sample("a.1.node", NULL);
  assert_sample("two.msh", msh_numbers);
  assert_sample("four.msh", msh_numbers);
}

static void tetgen_from_zero(void **state) {
  (void)state;
  write_text("zero.node", "5\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n4 1 1 1");
  write_text("zero.ele", "2\n0 0 1 2 3\n1 1 2 4 3"); /* no line feed at the end */
  struct cb_mesh mesh;
  long long *numbers;
  assert_int_equal(read_named("zero.ele", &mesh, &numbers), CB_OK);
  assert_int_equal(numbers[0], 0);
  assert_int_equal(numbers[4], 4);
  assert_int_equal(mesh.tet[6], 4);
  assert_true(cb_mesh_six_volumes(&mesh, 1) == -2); /* negative: kept */
  free(numbers);
  cb_mesh_free(&mesh);
}

static void tetgen_refuses(void **state) {
  (void)state;
  write_samples();
  assert_refused("a.1.node", node_text, "6 3", "6 2", "line 2", "three");
  assert_refused("a.1.node", node_text, "6 3", "x 3", "line 2", "number of nodes");
  assert_refused("a.1.node", node_text, "6 3", "-6 3", "line 2", "number of nodes");
  assert_refused("a.1.node", node_text, "6 3", "1000000000000000 3", "line 2", "can be numbered");
  assert_refused("a.1.node", node_text, "6 3", "4294967295 3", "line 2", "can be numbered");
  assert_refused("a.1.node", node_text, "6 3", "4294967294 3", "line 2", "can hold");
  assert_refused("a.1.node", node_text, "6 3", "99999999999999999999 3", "line 2",
                 "number of nodes");
  assert_refused("a.1.node", node_text, "6 3", "7 3", "line 10", "file ends");
  assert_refused("a.1.node", node_text, "6 3", "5 3", "line 9", "more nodes");
  assert_refused("a.1.node", node_text, "1e0", "nan", "line 6", "found \"  3");
  assert_refused("a.1.node", node_text, "1e0", "inf", "line 6", "coordinates");
  assert_refused("a.1.node", node_text, "1e0", "1e999", "line 6", "coordinates");
  assert_refused("a.1.node", node_text, "1e0", "1e0x", "line 6", "coordinates");
  assert_refused("a.1.node", node_text, "5 1 1 1", "7 1 1 1", "line 8", "one after the other");
  assert_refused("a.1.node", node_text, "1 0 0 0", "2 0 0 0", "line 4", "from 0 or 1");
  write_text("a.1.node", node_text);
  assert_refused("a.1.ele", ele_text, "2  4", "2 10", "line 1", "second order");
  assert_refused("a.1.ele", ele_text, "2  4", "2 8", "line 1", "8 nodes");
  assert_refused("a.1.ele", ele_text, "2  4", "0 4", "line 1", "no tetrahedra");
  assert_refused("a.1.ele", ele_text, "2  4", "1000 4", "line 1", "can hold");
  assert_refused("a.1.ele", ele_text, "2  4", "1 4", "line 4", "more tetrahedra");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4 0", "line 4", "node 0");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4 7", "line 4", "node 7");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4 -9223372036854775808", "line 4", "node -9");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4 1.5", "line 4", "four nodes");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4", "line 4", "node 7");
  assert_refused("a.1.ele", ele_text, "2 3 4 5", "2 3 4 3", "line 4", "same node twice");
}

static void missing_files_are_named(void **state) {
  (void)state;
  struct cb_mesh mesh;
  write_text("alone.node", node_text);
  assert_int_equal(read_named("alone.node", &mesh, NULL), CB_IO);
  assert_contains(cb_error_message(), "alone.ele");
  assert_contains(cb_error_message(), "No such file");
  assert_int_equal(read_named("none.msh", &mesh, NULL), CB_IO);
  assert_int_equal(read_named("mesh.stl", &mesh, NULL), CB_INPUT);
  assert_contains(cb_error_message(), ".msh (Gmsh)");
  assert_int_equal(read_named("mesh", &mesh, NULL), CB_INPUT);
  assert_int_equal(cb_mesh_read("/tmp/", &mesh, NULL), CB_INPUT);
}

static void gmsh_refuses(void **state) {
  (void)state;
  assert_refused("x.msh", msh2_text, "2.2 0 8", "2.2 1 8", "line 2", "ASCII");
  assert_refused("x.msh", msh2_text, "2.2 0 8", "4 0 8", "line 2", "version is 4;");
  assert_refused("x.msh", msh2_text, "$MeshFormat", "$NOD", "line 1", "$MeshFormat");
  assert_refused("x.msh", msh2_text, "300 0 1 0", "10 0 1 0", NULL, "number 10");
  assert_refused("x.msh", msh2_text, "300 0 1 0", "300 0 1", "line 12", "three coordinates");
  assert_refused("x.msh", msh2_text, "10 11 300 4\n", "10 11 301 4\n", "line 20", "node 301");
  assert_refused("x.msh", msh2_text, "10 11 300 4\n", "10 11 300\n", "line 20", "four nodes");
  assert_refused("x.msh", msh2_text, "10 11 300 4\n", "10 11 300 10\n", "line 20", "twice");
  assert_refused("x.msh", msh2_text, "4 2 1 1 10", "4 99 1 1 10", "line 20", "more tags");
  assert_refused("x.msh", msh2_text, "4 2 1", "4 9223372036854775807 1", "line 20", "more tags");
  assert_refused("x.msh", msh2_text, "$EndNodes\n", "", "line 16", "$EndNodes");
  assert_refused("x.msh", msh2_text, "$Nodes\n6\n", "$Nodes\n5\n", "line 15", "$EndNodes");
  assert_refused("x.msh", msh2_text, "$Nodes\n6\n", "$Nodes\n1000000000000000\n", "line 9",
                 "can be numbered");
  assert_refused("x.msh", msh2_text, "$Nodes\n6\n", "$Nodes\n1000000\n", "line 9", "can hold");
  assert_refused("x.msh", msh2_text, "$Elements\n4\n", "$Elements\n999\n", "line 18", "can hold");
  assert_refused("x.msh", msh2_text, "$PhysicalNames", "PhysicalNames", "line 4", "section");
  assert_refused("x.msh", msh2_text, "$EndPhysicalNames\n", "", "line 16", "before $Nodes");
  assert_refused("x.msh", msh2_text, "$EndElements\n", "", "line 22", "$EndElements");
  assert_refused("x.msh", msh2_text, "$EndElements\n", "$EndElements\n$Nodes\n1\n", "line 24",
                 "second $Nodes");
  assert_refused("x.msh", msh4_text, "3 1 0 2", "3 1 0 3", "line 23", "only 2 are left");
  assert_refused("x.msh", msh4_text, "$Nodes\n4 6", "$Nodes\n3 6", "line 22", "4 nodes, 6");
  assert_refused("x.msh", msh4_text, "$Nodes\n4 6", "$Nodes\n5 6", "line 28", "begin a block");
  assert_refused("x.msh", msh4_text, "2 1 1 3", "2 1 1 -3", "line 16", "number of nodes");
  assert_refused("x.msh", msh4_text, "3 1 4 2", "3 1 4 99999", "line 34", "can hold");
  assert_refused("x.msh", msh4_text, "3 1 4 2", "3 1 11 2", NULL, "-order 1");
}

static void gmsh_without_sections(void **state) {
  (void)state;
  const char head[] = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  write_text("x.msh", head);
  assert_contains(refusal("x.msh"), "$Nodes");
  assert_refused("x.msh", head, "$EndMeshFormat\n", "$EndMeshFormat\n$Elements\n0 0 0 0\n",
                 "line 4", "before $Nodes");
  assert_refused("x.msh", head, "$EndMeshFormat\n", "$EndMeshFormat\n$Nodes\n0 0 0 0\n$EndNodes\n",
                 "line 6", "$Elements");
  assert_refused("x.msh", head, "$EndMeshFormat\n",
                 "$EndMeshFormat\n$Nodes\n0 0 0 0\n$EndNodes\n$Elements\n0 0 0 0\n$EndElements\n",
                 NULL, "no tetrahedra");
}

/* Node 4 at height z over the plane of the others, all coordinates times scale. */
static enum cb_status read_flat(double z, double scale) {
  char text[512];
  snprintf(text, sizeof text,
           "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 %.17g 0 0\n3 0 %.17g 0\n"
           "4 %.17g %.17g %.17g\n$EndNodes\n$Elements\n1\n17 4 0 1 2 3 4\n$EndElements\n",
           scale, scale, scale / 3, scale / 3, z * scale);
  write_text("flat.msh", text);
  struct cb_mesh mesh;
  enum cb_status status = read_named("flat.msh", &mesh, NULL);
  if (status == CB_OK) cb_mesh_free(&mesh);
  return status;
}

static void flat_tetrahedra_are_refused(void **state) {
  (void)state;
  const double scales[] = {1e-6, 1, 1e6};
  for (size_t i = 0; i < 3; i++) {
    assert_int_equal(read_flat(0, scales[i]), CB_INPUT);
    assert_contains(cb_error_message(), "line 13");
    assert_contains(cb_error_message(), "rest volume");
    assert_int_equal(read_flat(1e-12, scales[i]), CB_INPUT);
    assert_int_equal(read_flat(-1e-12, scales[i]), CB_INPUT);
    assert_int_equal(read_flat(1e-11, scales[i]), CB_OK);
    assert_int_equal(read_flat(-1e-11, scales[i]), CB_OK);
  }
  assert_int_equal(read_flat(1, 1e200), CB_INPUT); /* the volume overflows */
}

/* ---- positions ------------------------------------------------------------- */

static const char csv_text[] = "node,x,y,z\n"
                               "6,6,6.5,6.25\n300,3,-3,3e1\n10,0.1,0.2,0.3\n4,4,4,4\n"
                               "5000000000,5,5,5\n11,1,1,1\n";

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

/* ---- damage ---------------------------------------------------------------- */

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
      cmocka_unit_test(samples_are_read),          cmocka_unit_test(windows_line_ends_are_read),
      cmocka_unit_test(tetgen_from_zero),          cmocka_unit_test(tetgen_refuses),
      cmocka_unit_test(missing_files_are_named),   cmocka_unit_test(gmsh_refuses),
      cmocka_unit_test(gmsh_without_sections),     cmocka_unit_test(flat_tetrahedra_are_refused),
      cmocka_unit_test(positions_are_read),        cmocka_unit_test(positions_refuse),
      cmocka_unit_test(damaged_files_never_crash),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
