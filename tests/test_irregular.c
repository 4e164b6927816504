/* test_irregular.c - the irregular mesh: a conforming mesh of the block, irregular
 * in topology, healthy in shape, the same again for the same seed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "tests/vectors.h"

static const size_t N[3] = {6, 5, 7};
static const double EDGE = 0.1;

static struct cb_mesh irregular_new(unsigned long seed) {
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_irregular(N[0], N[1], N[2], EDGE, seed, &mesh), CB_OK);
  assert_int_equal(mesh.nodes, 7 * 6 * 8);
  assert_int_equal(mesh.tets, 6 * 6 * 5 * 7);
  assert_true(mesh.share == 1);
  return mesh;
}

/* None is flat or turned, and together they have the volume of the block. */
static void volumes_fill_the_block(void **state) {
  (void)state;
  for (unsigned long seed = 0; seed < 20; seed++) {
    struct cb_mesh mesh = irregular_new(seed);
    const double cell = EDGE * EDGE * EDGE, block = 6 * 5 * 7 * cell;
    double sum = 0;
    for (size_t e = 0; e < mesh.tets; e++) {
      const double six = cb_mesh_six_volumes(&mesh, e);
      assert_true(six >= 0.2 * cell);
      sum += six / 6;
    }
    assert_within("volume", fabs(sum - block) / block, 1e-13);
    cb_mesh_free(&mesh);
  }
}

struct triangle {
  uint32_t node[3]; /* ascending */
  int sign;         /* of the sequence in which the tetrahedron has them */
};

static int by_nodes(const void *a, const void *b) { return memcmp(a, b, 3 * sizeof(uint32_t)); }

/* The face of tetrahedron t without vertex j, seen from outside. */
static struct triangle triangle_of(const uint32_t *t, size_t j) {
  struct triangle f = {.sign = j % 2 ? -1 : 1};
  for (size_t i = 0, n = 0; i < 4; i++)
    if (i != j) f.node[n++] = t[i];
  for (size_t i = 0; i < 3; i++) {
    uint32_t *pair = f.node + i % 2, first = pair[0];
    if (pair[0] < pair[1]) continue;
    pair[0] = pair[1], pair[1] = first, f.sign = -f.sign;
  }
  return f;
}

static bool in_surface(const struct cb_mesh *mesh, const uint32_t node[3]) {
  bool found = false;
  for (size_t k = 0; k < 3; k++) {
    const double *X = mesh->X + k, x = X[3 * node[0]];
    const bool side = x == 0 || x == EDGE * (double)N[k];
    found |= side && X[3 * node[1]] == x && X[3 * node[2]] == x;
  }
  return found;
}

/* Each triangle is in two tetrahedra, one on either side, or lies in the surface,
 * where there are two a square. */
static void mesh_is_conforming(void **state) {
  (void)state;
  struct cb_mesh mesh = irregular_new(1);
  const size_t n = 4 * mesh.tets;
  struct triangle *faces = malloc(n * sizeof *faces);
  assert_non_null(faces);
  for (size_t i = 0; i < n; i++) faces[i] = triangle_of(mesh.tet + i / 4 * 4, i % 4);
  qsort(faces, n, sizeof *faces, by_nodes);
  size_t once = 0;
  for (size_t i = 0, same; i < n; i += same) {
    for (same = 1; i + same < n && by_nodes(faces + i, faces + i + same) == 0;) same++;
    assert_true(same <= 2);
    if (same == 2)
      assert_int_equal(faces[i].sign + faces[i + 1].sign, 0);
    else
      assert_true(in_surface(&mesh, faces[i].node));
    once += same == 1;
  }
  assert_int_equal(once, 2 * 2 * (6 * 5 + 5 * 7 + 7 * 6));
  free(faces);
  cb_mesh_free(&mesh);
}

/* In a grid of one kind of cell every inner node would have as many tetrahedra; no
 * node and no coordinate in the inside is where the grid has it. */
static void mesh_is_irregular(void **state) {
  (void)state;
  struct cb_mesh mesh = irregular_new(1);
  unsigned *degree = calloc(mesh.nodes, sizeof *degree);
  bool seen[64] = {false};
  size_t kinds = 0, first_vertex_lowest = 0, ascending = 0;
  assert_non_null(degree);
  for (size_t i = 0; i < 4 * mesh.tets; i++) degree[mesh.tet[i]]++;
  for (size_t i = 0; i < mesh.nodes; i++) {
    bool inside = true;
    for (size_t k = 0; k < 3; k++) {
      const double x = mesh.X[3 * i + k];
      inside = inside && x != 0 && x != EDGE * (double)N[k];
    }
    if (!inside) continue;
    for (size_t k = 0; k < 3; k++) {
      const double cells = mesh.X[3 * i + k] / EDGE;
      assert_true(cells != round(cells));
    }
    assert_in_range(degree[i], 4, 63);
    kinds += !seen[degree[i]];
    seen[degree[i]] = true;
  }
  assert_in_range(kinds, 10, 63);
  for (size_t e = 0; e < mesh.tets; e++) {
    const uint32_t *t = mesh.tet + 4 * e;
    first_vertex_lowest += t[0] < t[1] && t[0] < t[2] && t[0] < t[3];
    ascending += e > 0 && t[0] > t[-4];
  }
  /* A quarter and a half, as chance has it; the limits are six deviations off. */
  assert_in_range(first_vertex_lowest, mesh.tets / 4 - 95, mesh.tets / 4 + 95);
  assert_in_range(ascending, mesh.tets / 2 - 110, mesh.tets / 2 + 110);
  free(degree);
  cb_mesh_free(&mesh);
}

static void seed_decides(void **state) {
  (void)state;
  struct cb_mesh a = irregular_new(3), b = irregular_new(3), c = irregular_new(4);
  const size_t X = 3 * a.nodes * sizeof *a.X, tet = 4 * a.tets * sizeof *a.tet;
  assert_memory_equal(a.X, b.X, X);
  assert_memory_equal(a.tet, b.tet, tet);
  assert_memory_not_equal(a.X, c.X, X);
  assert_memory_not_equal(a.tet, c.tet, tet);
  cb_mesh_free(&a);
  cb_mesh_free(&b);
  cb_mesh_free(&c);
}

static void bad_input_is_refused(void **state) {
  (void)state;
  struct cb_mesh mesh = {.nodes = 77};
  assert_int_equal(cb_mesh_irregular(0, 1, 1, 1, 0, &mesh), CB_INPUT);
  assert_int_equal(cb_mesh_irregular(1, 1, 1, -1, 0, &mesh), CB_INPUT);
  assert_int_equal(cb_mesh_irregular(1, 1, 1, NAN, 0, &mesh), CB_INPUT);
  assert_int_equal(mesh.nodes, 77);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(volumes_fill_the_block), cmocka_unit_test(mesh_is_conforming),
      cmocka_unit_test(mesh_is_irregular),      cmocka_unit_test(seed_decides),
      cmocka_unit_test(bad_input_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
