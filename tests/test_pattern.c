/* test_pattern.c - the block pattern of an assembled matrix, against a dense
 * table of which nodes share an element.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/pattern.h"
#include "tests/scene.h"

/* shared[nodes*nodes] */
static bool *brute_force(const struct cb_mesh *mesh) {
  bool *shared = calloc(mesh->nodes * mesh->nodes, sizeof *shared);
  assert_non_null(shared);
  for (size_t i = 0; i < mesh->nodes; i++) shared[i * mesh->nodes + i] = true;
  for (size_t e = 0; e < mesh->tets; e++)
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++)
        shared[mesh->tet[4 * e + i] * mesh->nodes + mesh->tet[4 * e + j]] = true;
  return shared;
}

static void check_rows(const struct cb_pattern *p, const struct cb_mesh *mesh) {
  bool *shared = brute_force(mesh);
  size_t blocks = 0;
  assert_int_equal(p->nodes, mesh->nodes);
  assert_int_equal(p->blocks, p->nodes + 2 * p->edges);
  assert_int_equal(p->row_start[0], 0);
  assert_int_equal(p->row_start[p->nodes], p->blocks);
  for (size_t i = 0; i < p->nodes; i++) {
    for (uint32_t b = p->row_start[i]; b < p->row_start[i + 1]; b++) {
      assert_true(shared[i * p->nodes + p->column[b]]);
      if (b > p->row_start[i]) assert_true(p->column[b - 1] < p->column[b]);
    }
    for (size_t j = 0; j < p->nodes; j++) blocks += shared[i * p->nodes + j];
    assert_true(p->row_start[i] <= p->diagonal[i] && p->diagonal[i] < p->row_start[i + 1]);
    assert_int_equal(p->column[p->diagonal[i]], i);
  }
  assert_int_equal(p->blocks, blocks);
  free(shared);
}

static bool in_row(const struct cb_pattern *p, uint32_t row, uint32_t block) {
  return p->row_start[row] <= block && block < p->row_start[row + 1];
}

static void check_edges(const struct cb_pattern *p) {
  for (size_t e = 0; e < p->edges; e++) {
    uint32_t low = p->low[e], high = p->high[e];
    assert_true(low < high);
    assert_true(in_row(p, low, p->upper[e]) && p->column[p->upper[e]] == high);
    assert_true(in_row(p, high, p->lower[e]) && p->column[p->lower[e]] == low);
  }
}

/* Each lane's six edges are those of its four nodes. */
static void check_map(const struct cb_pattern *p, const struct cb_packs *packs) {
  const size_t lanes = packs->lanes;
  for (size_t n = 0; n < packs->packs * lanes; n++) {
    uint32_t tet[4];
    for (size_t j = 0; j < 4; j++) tet[j] = packs->node[(n / lanes * 4 + j) * lanes + n % lanes];
    for (size_t k = 0; k < 6; k++) {
      uint32_t code = p->edge_of[(n / lanes * 6 + k) * lanes + n % lanes], edge = code / 2;
      uint32_t from = tet[cb_tet_edge[k][0]], to = tet[cb_tet_edge[k][1]];
      assert_true(edge < p->edges);
      assert_int_equal(p->low[edge], code % 2 ? to : from);
      assert_int_equal(p->high[edge], code % 2 ? from : to);
    }
  }
}

static struct cb_pattern *pattern_new(const struct cb_mesh *mesh, size_t lanes) {
  struct cb_packs *packs;
  struct cb_pattern *p;
  assert_int_equal(cb_packs_create(mesh, lanes, 1, false, &packs), CB_OK);
  assert_int_equal(cb_pattern_create(mesh, packs, &p), CB_OK);
  check_map(p, packs);
  cb_packs_free(packs);
  return p;
}

static void pattern_is_who_shares_an_element(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < 10; trial++)
    for (int kind = 0; kind < SCENES; kind++)
      for (size_t lanes = 1; lanes <= 8; lanes *= 2) {
        struct scene s = scene_new(rng, (enum scene_kind)kind);
        struct cb_pattern *p = pattern_new(&s.mesh, lanes);
        check_rows(p, &s.mesh);
        check_edges(p);
        cb_pattern_free(p);
        scene_free(&s);
      }
  gsl_rng_free(rng);
}

/* Along 6 axes and, as both splits are there, 12 diagonals of faces. */
static void a_node_inside_the_grid_has_eighteen_neighbours(void **state) {
  (void)state;
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(4, 4, 4, 1, &mesh), CB_OK);
  struct cb_pattern *p = pattern_new(&mesh, 1);
  size_t inside = 0;
  for (size_t i = 0; i < mesh.nodes; i++) {
    bool boundary = false;
    for (size_t k = 0; k < 3; k++)
      boundary = boundary || mesh.X[3 * i + k] == 0 || mesh.X[3 * i + k] == 4;
    if (boundary) continue;
    assert_int_equal(p->row_start[i + 1] - p->row_start[i], 1 + 18);
    inside++;
  }
  assert_int_equal(inside, 27);
  cb_pattern_free(p);
  cb_mesh_free(&mesh);
}

static void free_allows_null(void **state) {
  (void)state;
  cb_pattern_free(NULL);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pattern_is_who_shares_an_element),
      cmocka_unit_test(a_node_inside_the_grid_has_eighteen_neighbours),
      cmocka_unit_test(free_allows_null),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
