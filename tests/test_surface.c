/* test_surface.c - boundary nodes of grids that are split into tetrahedra in
 * several ways, with jittered nodes, both orientations and a cavity.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/surface.h"
#include "tests/vectors.h"

#include <stdlib.h>
#include <string.h>

enum split { SIX, FIVE_AND_FIVE };

/* Corner c of a cell: x in bit 0, y in bit 1, z in bit 2. */
static const uint8_t six[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                                  {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};
static const uint8_t five[5][4] = {
    {0, 3, 5, 6}, {1, 0, 3, 5}, {2, 0, 3, 6}, {4, 0, 5, 6}, {7, 3, 5, 6}};

struct grid {
  int n;
  struct cb_mesh mesh;
  uint8_t *outside; /* per node: on the grid's hull, or on the cavity's */
};

static void add_tet(struct grid *g, int x, int y, int z, const uint8_t corner[4], int mirror) {
  uint32_t *v = g->mesh.tet + 4 * g->mesh.tets++;
  for (int i = 0; i < 4; i++) {
    int c = corner[i] ^ mirror; /* 1 mirrors the cell along x */
    v[i] = (uint32_t)(x + (c & 1) + (g->n + 1) * (y + (c >> 1 & 1) + (g->n + 1) * (z + (c >> 2))));
  }
}

static void mark_corners(struct grid *g, int x, int y, int z) {
  for (int c = 0; c < 8; c++)
    g->outside[x + (c & 1) + (g->n + 1) * (y + (c >> 1 & 1) + (g->n + 1) * (z + (c >> 2)))] = 1;
}

/* n^3 cells, without the middle one when `hollow`; one more node that no
 * tetrahedron uses. jitter: in cell edges. */
static struct grid grid_new(int n, enum split split, bool hollow, double jitter) {
  size_t nodes = (size_t)((n + 1) * (n + 1) * (n + 1));
  struct grid g = {.n = n, .outside = calloc(nodes + 1, 1)};
  g.mesh = (struct cb_mesh){.nodes = nodes + 1,
                            .X = calloc(3 * (nodes + 1), sizeof(double)),
                            .tet = calloc(40 * nodes, sizeof(uint32_t)),
                            .share = split == SIX ? 1 : 0.5};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  assert_true(g.outside && g.mesh.X && g.mesh.tet && rng);
  for (int i = 0; i < (int)nodes; i++) {
    const int at[3] = {i % (n + 1), i / (n + 1) % (n + 1), i / (n + 1) / (n + 1)};
    for (int c = 0; c < 3; c++) {
      g.mesh.X[3 * i + c] = 0.1 * (at[c] + jitter * (2 * gsl_rng_uniform(rng) - 1));
      if (at[c] == 0 || at[c] == n) g.outside[i] = 1;
    }
  }
  for (int cell = 0; cell < n * n * n; cell++) {
    int x = cell % n, y = cell / n % n, z = cell / n / n;
    if (hollow && x == n / 2 && y == n / 2 && z == n / 2) {
      mark_corners(&g, x, y, z);
      continue;
    }
    for (int t = 0; t < 6 && split == SIX; t++) add_tet(&g, x, y, z, six[t], 0);
    for (int t = 0; t < 10 && split == FIVE_AND_FIVE; t++) add_tet(&g, x, y, z, five[t / 2], t % 2);
  }
  gsl_rng_free(rng);
  return g;
}

static void assert_surface_is_the_outside(struct grid *g) {
  uint32_t *list = calloc(g->mesh.nodes, sizeof *list);
  size_t count = 0, expected = 0;
  assert_non_null(list);
  assert_int_equal(cb_surface_nodes(&g->mesh, list, &count), CB_OK);
  for (uint32_t i = 0; i < g->mesh.nodes; i++)
    if (g->outside[i]) {
      assert_true(expected < count);
      assert_int_equal(list[expected++], i);
    }
  assert_int_equal(count, expected);
  free(list);
  free(g->outside);
  free(g->mesh.X);
  free(g->mesh.tet);
}

static void a_grid_has_its_hull(void **state) {
  (void)state;
  for (int n = 1; n <= 7; n++) {
    for (int kind = 0; kind < 4; kind++) {
      struct grid g = grid_new(n, kind % 2 ? FIVE_AND_FIVE : SIX, false, kind / 2 ? 0.15 : 0);
      assert_surface_is_the_outside(&g);
    }
  }
}

static void a_cavity_has_a_surface(void **state) {
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    struct grid g = grid_new(5, kind % 2 ? FIVE_AND_FIVE : SIX, true, kind / 2 ? 0.15 : 0);
    assert_surface_is_the_outside(&g);
  }
}

/* Each cell by either split, at random: the faces' diagonals do not match. */
static void faces_need_not_match(void **state) {
  (void)state;
  struct grid g = grid_new(6, FIVE_AND_FIVE, false, 0);
  size_t kept = 0;
  for (size_t t = 0; t < g.mesh.tets; t++)
    if (t % 2 == (t / 10 * 7 / 3) % 2)
      memcpy(g.mesh.tet + 4 * kept++, g.mesh.tet + 4 * t, 4 * sizeof(uint32_t));
  assert_int_equal(kept, g.mesh.tets / 2);
  g.mesh.tets = kept;
  g.mesh.share = 1;
  assert_surface_is_the_outside(&g);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_grid_has_its_hull),
      cmocka_unit_test(a_cavity_has_a_surface),
      cmocka_unit_test(faces_need_not_match),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
