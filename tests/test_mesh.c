/* test_mesh.c - the readers of meshes: what they accept, and the sentence for what they refuse.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/mesh_files.h"

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

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(samples_are_read),        cmocka_unit_test(windows_line_ends_are_read),
      cmocka_unit_test(tetgen_from_zero),        cmocka_unit_test(tetgen_refuses),
      cmocka_unit_test(missing_files_are_named), cmocka_unit_test(gmsh_refuses),
      cmocka_unit_test(gmsh_without_sections),   cmocka_unit_test(flat_tetrahedra_are_refused),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
