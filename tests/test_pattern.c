/* test_pattern.c - the block pattern of an assembled matrix, against a dense
 * table of which nodes share an element.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/pattern.h"
#include "tests/scene.h"

enum { STRIDE = 3 };

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
  assert_int_equal(p->blocks, p->nodes + (p->symmetric ? 1 : 2) * p->edges);
  assert_int_equal(p->row_start[0], 0);
  assert_int_equal(p->row_start[p->nodes], p->blocks);
  for (size_t i = 0; i < p->nodes; i++) {
    for (uint32_t b = p->row_start[i]; b < p->row_start[i + 1]; b++) {
      assert_true(shared[i * p->nodes + p->column[b]]);
      if (b > p->row_start[i]) assert_true(p->column[b - 1] < p->column[b]);
    }
    for (size_t j = p->symmetric ? i : 0; j < p->nodes; j++) blocks += shared[i * p->nodes + j];
    assert_int_equal(p->column[cb_pattern_diagonal(p, i)], i);
  }
  assert_int_equal(p->blocks, blocks);
  free(shared);
}

/* Of the node pairs of edge e, which is of row i. */
static uint32_t high_end(const struct cb_pattern *p, size_t i, size_t e) {
  return p->column[cb_pattern_diagonal(p, i) + 1 + (e - p->edge_start[i])];
}

/* Each element is at its six edges, low node first, and nowhere else. */
static void check_terms(const struct cb_pattern *p, const struct cb_mesh *mesh,
                        const struct cb_packs *packs) {
  const size_t lanes = packs->lanes, elements = packs->packs * lanes;
  uint8_t *times = calloc(16 * elements, 1);
  size_t terms = 0;
  assert_non_null(times);
  assert_int_equal(p->edge_start[0], 0);
  assert_int_equal(p->edge_start[p->nodes], p->edges);
  assert_int_equal(p->term_start[0], 0);
  assert_int_equal(p->term_start[p->edges], 6 * mesh->tets);
  for (size_t i = 0; i < p->nodes; i++)
    for (size_t e = p->edge_start[i]; e < p->edge_start[i + 1]; e++) {
      assert_true(p->term_start[e] < p->term_start[e + 1]);
      for (size_t n = p->term_start[e]; n < p->term_start[e + 1]; n++, terms++) {
        const uint32_t *ends = p->term + 2 * n;
        assert_true(ends[0] % STRIDE == 0 && ends[1] % STRIDE == 0);
        const size_t element = ends[0] / (4 * STRIDE);
        const size_t low = ends[0] / STRIDE % 4, high = ends[1] / STRIDE % 4;
        const uint32_t *tet = packs->node + 4 * (element / lanes) * lanes + element % lanes;
        assert_true(element < elements);
        assert_int_equal(tet[low * lanes], i);
        assert_int_equal(tet[high * lanes], high_end(p, i, e));
        assert_int_equal(ends[1] / (4 * STRIDE), element);
        assert_int_equal(times[16 * element + 4 * low + high]++, 0);
      }
    }
  assert_int_equal(terms, 6 * mesh->tets);
  free(times);
}

/* Every block above the diagonal is the mirror of one below, by rows and columns. */
static void check_mirror(const struct cb_pattern *p) {
  assert_int_equal(p->lower_start[0], 0);
  assert_int_equal(p->lower_start[p->nodes], p->edges);
  for (size_t i = 0; i < p->nodes; i++)
    for (size_t n = p->lower_start[i], before = 0; n < p->lower_start[i + 1]; n++) {
      const uint32_t block = p->mirror[n];
      size_t row = before;
      while (p->row_start[row + 1] <= block) row++;
      assert_true(row < i && cb_pattern_diagonal(p, row) < block);
      assert_int_equal(p->column[block], i);
      if (n > p->lower_start[i]) assert_true(row > before);
      if (!p->symmetric) assert_int_equal(p->column[p->row_start[i] + n - p->lower_start[i]], row);
      before = row;
    }
}

/* Rows are shared out, and columns of each share end where it says. */
static void check_shares(const struct cb_pattern *p) {
  size_t row = 0, beyond = 0;
  for (size_t t = 0; t < p->threads; t++) {
    const struct cb_rows *r = &p->rows[t];
    size_t reach = r->last;
    assert_int_equal(r->first, row);
    assert_true(r->last >= r->first);
    assert_int_equal(r->beyond, beyond);
    for (size_t b = p->row_start[r->first]; b < p->row_start[r->last]; b++)
      if (p->column[b] >= reach) reach = p->column[b] + 1;
    assert_int_equal(r->reach, reach);
    row = r->last, beyond += reach - r->last;
  }
  assert_int_equal(row, p->nodes);
  assert_int_equal(beyond, p->beyond);
}

static struct cb_pattern *pattern_new(const struct cb_mesh *mesh, size_t lanes, size_t threads,
                                      bool symmetric) {
  struct cb_packs *packs;
  struct cb_pattern *p;
  assert_int_equal(cb_packs_create(mesh, lanes, threads, false, false, &packs), CB_OK);
  assert_int_equal(cb_pattern_create(mesh, packs, STRIDE, symmetric, &p), CB_OK);
  check_terms(p, mesh, packs);
  cb_packs_free(packs);
  return p;
}

static void pattern_is_who_shares_an_element(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < 3; trial++)
    for (int kind = 0; kind < SCENES; kind++)
      for (size_t n = 0; n < 4 * 4 * 2; n++) {
        const size_t lanes = (size_t)1 << n % 4, threads = 1 + n / 4 % 4;
        struct scene s = scene_new(rng, (enum scene_kind)kind);
        struct cb_pattern *p = pattern_new(&s.mesh, lanes, threads, n / 16);
        check_rows(p, &s.mesh);
        check_mirror(p);
        check_shares(p);
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
  struct cb_pattern *p = pattern_new(&mesh, 1, 1, false);
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
