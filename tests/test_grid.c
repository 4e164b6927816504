/* test_grid.c - the paper's block: numbering, volumes, symmetry, conformity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

static void grid_is_the_papers_block(void **state) {
  (void)state;
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(7, 7, 7, 0.1, &mesh), CB_OK);
  assert_int_equal(mesh.nodes, 512);
  assert_int_equal(mesh.tets, 3430);
  assert_true(mesh.share == 0.5);
  double volume = 0;
  for (size_t e = 0; e < mesh.tets; e++) {
    double six = cb_mesh_six_volumes(&mesh, e);
    /* Inner tetrahedra have a third of the cell, corners a sixth. */
    assert_true(fabs(six - 1e-3) <= 1e-15 || fabs(six - 2e-3) <= 1e-15);
    volume += mesh.share * six / 6;
  }
  assert_true(fabs(volume - 0.343) <= 1e-12 * 0.343);
  cb_mesh_free(&mesh);
  assert_null(mesh.X);
  cb_mesh_free(&mesh);
}

static size_t grid_node(const size_t n[3], size_t i, size_t j, size_t k) {
  return i + (n[0] + 1) * (j + (n[1] + 1) * k);
}

static void grid_is_numbered_x_fastest(void **state) {
  (void)state;
  const size_t n[3] = {2, 3, 4};
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(n[0], n[1], n[2], 0.5, &mesh), CB_OK);
  assert_int_equal(mesh.nodes, 3 * 4 * 5);
  assert_int_equal(mesh.tets, 10 * 2 * 3 * 4);
  for (size_t k = 0; k <= n[2]; k++)
    for (size_t j = 0; j <= n[1]; j++)
      for (size_t i = 0; i <= n[0]; i++) {
        const double *X = mesh.X + 3 * grid_node(n, i, j, k);
        assert_true(X[0] == 0.5 * (double)i && X[1] == 0.5 * (double)j && X[2] == 0.5 * (double)k);
      }
  cb_mesh_free(&mesh);
}

static void grid_mass_is_symmetric(void **state) {
  (void)state;
  const size_t n[3] = {2, 3, 4};
  struct cb_mesh mesh;
  double mass[60], total = 0;
  assert_int_equal(cb_mesh_grid(n[0], n[1], n[2], 0.5, &mesh), CB_OK);
  cb_mesh_mass(&mesh, 1000, mass);
  for (size_t k = 0; k <= n[2]; k++)
    for (size_t j = 0; j <= n[1]; j++)
      for (size_t i = 0; i <= n[0]; i++) {
        double m = mass[grid_node(n, i, j, k)];
        const size_t mirror[3] = {grid_node(n, n[0] - i, j, k), grid_node(n, i, n[1] - j, k),
                                  grid_node(n, i, j, n[2] - k)};
        for (size_t a = 0; a < 3; a++) assert_true(fabs(mass[mirror[a]] - m) <= 1e-14 * m);
        total += m;
      }
  assert_true(fabs(total - 1000 * 3.0) <= 1e-12 * total);
  cb_mesh_free(&mesh);
}

/* The tetrahedra of the grid as sets of nodes, each an unordered bit mask of the
 * eight corners of a cell; one cell, so that masks suffice. */
static void grid_cell_is_its_own_mirror_image(void **state) {
  (void)state;
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(1, 1, 1, 1, &mesh), CB_OK);
  for (unsigned axis = 0; axis < 3; axis++)
    for (size_t e = 0; e < 10; e++) {
      unsigned mirrored = 0;
      for (size_t j = 0; j < 4; j++) mirrored |= 1u << (mesh.tet[4 * e + j] ^ 1u << axis);
      size_t found = 0;
      for (size_t g = 0; g < 10; g++) {
        unsigned mask = 0;
        for (size_t j = 0; j < 4; j++) mask |= 1u << mesh.tet[4 * g + j];
        found += mask == mirrored;
      }
      assert_int_equal(found, 1);
    }
  cb_mesh_free(&mesh);
}

/* Conforming: each triangle is in two tetrahedra, of either side, or lies in the
 * surface, where both diagonals make 4 triangles a square. */
static void grid_is_conforming(void **state) {
  (void)state;
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(2, 2, 2, 1, &mesh), CB_OK);
  static unsigned char used[27][27][27];
  memset(used, 0, sizeof used);
  for (size_t e = 0; e < mesh.tets; e++)
    for (size_t skip = 0; skip < 4; skip++) {
      uint32_t face[3];
      for (size_t j = 0, f = 0; j < 4; j++)
        if (j != skip) face[f++] = mesh.tet[4 * e + j];
      for (size_t a = 0; a < 3; a++)
        for (size_t b = 0; b < 3; b++)
          if (a != b) used[face[a]][face[b]][face[3 - a - b]]++;
    }
  size_t once = 0;
  for (size_t a = 0; a < 27; a++)
    for (size_t b = a + 1; b < 27; b++)
      for (size_t c = b + 1; c < 27; c++) {
        assert_true(used[a][b][c] <= 2);
        if (used[a][b][c] != 1) continue;
        once++;
        bool surface = false;
        for (size_t k = 0; k < 3; k++) {
          const double *X = mesh.X + k;
          surface |= X[3 * a] == X[3 * b] && X[3 * a] == X[3 * c] && X[3 * a] != 1;
        }
        assert_true(surface);
      }
  assert_int_equal(once, 6 * 4 * 4);
  cb_mesh_free(&mesh);
}

static void grid_refuses(void **state) {
  (void)state;
  struct cb_mesh mesh = {.nodes = 77};
  assert_int_equal(cb_mesh_grid(0, 1, 1, 1, &mesh), CB_INPUT);
  assert_int_equal(cb_mesh_grid(1, 1, 0, 1, &mesh), CB_INPUT);
  assert_int_equal(cb_mesh_grid(SIZE_MAX, 1, 1, 1, &mesh), CB_INPUT);
  assert_int_equal(cb_mesh_grid(1625, 1625, 1625, 1, &mesh), CB_INPUT);
  const double edges[] = {0, -1, NAN, INFINITY, 1e-200, 1e200};
  for (size_t i = 0; i < 6; i++) {
    cb_fail(CB_BROKEN, "none");
    assert_int_equal(cb_mesh_grid(1, 1, 1, edges[i], &mesh), CB_INPUT);
    assert_non_null(strstr(cb_error_message(), "positive length"));
  }
  assert_int_equal(mesh.nodes, 77);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(grid_is_the_papers_block),
      cmocka_unit_test(grid_is_numbered_x_fastest),
      cmocka_unit_test(grid_mass_is_symmetric),
      cmocka_unit_test(grid_cell_is_its_own_mirror_image),
      cmocka_unit_test(grid_is_conforming),
      cmocka_unit_test(grid_refuses),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
