/* test_clusters.c - clusters are a partition of the mesh, say the same as the mesh,
 * find the cells of grids, and save node visits.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/error.h"
#include "harness/files/order.h"
#include "kernels/clusters.h"
#include "tests/scene.h"

enum { NODES = CB_CLUSTER_NODES, TETS = CB_CLUSTER_TETS };

/* ---- meshes ---------------------------------------------------------------------- */

/* Nodes and tetrahedra in any sequence; the vertex order of each stays. */
static void mesh_shuffle(gsl_rng *rng, struct cb_mesh *mesh) {
  uint32_t *number = malloc((mesh->nodes + 1) * sizeof *number);
  assert_non_null(number);
  for (size_t i = 0; i < mesh->nodes; i++) number[i] = (uint32_t)i;
  gsl_ran_shuffle(rng, number, mesh->nodes, sizeof *number);
  for (size_t i = 0; i < 4 * mesh->tets; i++) mesh->tet[i] = number[mesh->tet[i]];
  gsl_ran_shuffle(rng, mesh->tet, mesh->tets, 4 * sizeof *mesh->tet);
  free(number);
}

/* Any four nodes, with no regard to geometry; every seventh node is in none. */
static struct cb_mesh mesh_of_chance(gsl_rng *rng, size_t nodes, size_t tets) {
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_allocate(nodes, tets, &mesh), CB_OK);
  random_vector(rng, 3 * nodes, mesh.X);
  for (size_t e = 0; e < tets; e++)
    for (size_t j = 0; j < 4; j++) {
      uint32_t *t = mesh.tet + 4 * e;
      bool good;
      do {
        t[j] = (uint32_t)gsl_rng_uniform_int(rng, nodes);
        good = t[j] % 7 != 0;
        for (size_t k = 0; k < j; k++) good = good && t[k] != t[j];
      } while (!good);
    }
  return mesh;
}

/* Each cell cut into six around its diagonal, with vertices in any order. */
static struct cb_mesh voxels_new(gsl_rng *rng, size_t n) {
  static const uint8_t around[6] = {1, 3, 2, 6, 4, 5};
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(n, n, n, 1, &mesh), CB_OK);
  mesh.tets = 0;
  for (size_t i = 0; i < mesh.nodes; i++) {
    const double *X = mesh.X + 3 * i;
    if (X[0] == (double)n || X[1] == (double)n || X[2] == (double)n) continue;
    for (size_t e = 0; e < 6; e++, mesh.tets++) {
      const uint8_t corner[4] = {0, 7, around[e], around[(e + 1) % 6]};
      uint32_t *t = mesh.tet + 4 * mesh.tets;
      for (size_t j = 0; j < 4; j++) {
        const size_t x = corner[j] & 1, y = corner[j] >> 1 & 1, z = corner[j] >> 2;
        t[j] = (uint32_t)(i + x + (n + 1) * (y + (n + 1) * z));
      }
      gsl_ran_shuffle(rng, t, 4, sizeof *t);
    }
  }
  return mesh;
}

static struct cb_mesh irregular_new(size_t n) {
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_irregular(n, n, n, 1, 1, &mesh), CB_OK);
  return mesh;
}

static struct cb_mesh grid_new(size_t n) {
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(n, n, n, 1, &mesh), CB_OK);
  return mesh;
}

/* ---- what must hold on every mesh -------------------------------------------------- */

static void assert_template(const struct cb_template *s) {
  unsigned all = 0;
  assert_in_range(s->tets, 1, TETS);
  assert_in_range(s->nodes, 4, NODES);
  for (size_t i = 0; i < s->tets; i++) {
    unsigned mask = 0;
    for (size_t j = 0; j < 4; j++) mask |= 1u << s->vertex[i][j];
    assert_int_equal(__builtin_popcount(mask), 4);
    all |= mask;
  }
  assert_int_equal(all, (1u << s->nodes) - 1);
}

/* Cluster n of that shape: no node twice, and the mesh's vertices found again. */
static void assert_cluster(const struct cb_mesh *mesh, const struct cb_clusters *c,
                           const struct cb_template *s, size_t n, uint8_t *used) {
  const uint32_t *node = c->node + NODES * n, *tet = c->tet + TETS * n;
  const uint8_t *order = c->order + TETS * n;
  for (size_t v = 0; v < s->nodes; v++)
    for (size_t u = 0; u < v; u++) assert_int_not_equal(node[u], node[v]);
  for (size_t v = s->nodes; v < NODES; v++) assert_int_equal(node[v], node[0]);
  for (size_t i = s->tets; i < TETS; i++) assert_int_equal(tet[i], tet[0]);
  for (size_t i = s->tets; i < TETS; i++) assert_int_equal(order[i], order[0]);
  for (size_t i = 0; i < s->tets; i++) {
    assert_true(tet[i] < mesh->tets && order[i] < 24);
    assert_int_equal(used[tet[i]]++, 0);
    for (size_t j = 0; j < 4; j++) {
      const uint8_t vertex = s->vertex[i][cb_permutation[order[i]][j]];
      assert_int_equal(node[vertex], mesh->tet[4 * (size_t)tet[i] + j]);
    }
  }
}

static uint32_t lowest_tet(const struct cb_clusters *c, size_t n) {
  uint32_t lowest = c->tet[TETS * n];
  for (size_t i = 1; i < TETS; i++)
    if (c->tet[TETS * n + i] < lowest) lowest = c->tet[TETS * n + i];
  return lowest;
}

/* In the sequence of the mesh; 0 for the order of a tetrahedron if all agree. */
static void assert_shape(const struct cb_clusters *c, size_t t) {
  assert_true(c->first[t] < c->first[t + 1]);
  for (size_t n = c->first[t] + 1; n < c->first[t + 1]; n++)
    assert_true(lowest_tet(c, n - 1) < lowest_tet(c, n));
  for (size_t i = 0; i < TETS; i++) {
    const uint8_t order = c->order[TETS * c->first[t] + i];
    bool same = true;
    for (size_t n = c->first[t]; n < c->first[t + 1]; n++)
      same = same && c->order[TETS * n + i] == order;
    assert_true(!same || order == 0);
  }
}

static struct cb_clusters *clusters_new(const struct cb_mesh *mesh, size_t lanes) {
  struct cb_clusters *c;
  assert_int_equal(cb_clusters_create(mesh, lanes, &c), CB_OK);
  uint8_t *used = calloc(mesh->tets + 1, 1);
  assert_non_null(used);
  assert_int_equal(c->first[0], 0);
  assert_int_equal(c->first[c->templates], c->clusters);
  size_t tets = 0;
  for (size_t t = 0; t < c->templates; t++) {
    assert_template(c->shape + t);
    assert_shape(c, t);
    for (size_t n = c->first[t]; n < c->first[t + 1]; n++)
      assert_cluster(mesh, c, c->shape + t, n, used);
    tets += (c->first[t + 1] - c->first[t]) * c->shape[t].tets;
  }
  assert_int_equal(tets, mesh->tets);
  free(used);
  return c;
}

/* Node visits a tetrahedron, lanes without a cluster included. */
static double visits(const struct cb_mesh *mesh, const struct cb_clusters *c, size_t lanes) {
  size_t sum = 0;
  for (size_t t = 0; t < c->templates; t++) {
    const size_t packs = (c->first[t + 1] - c->first[t] + lanes - 1) / lanes;
    sum += packs * lanes * c->shape[t].nodes;
  }
  return (double)sum / (double)mesh->tets;
}

static void clusters_are_a_partition(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < 40; trial++)
    for (size_t lanes = 1; lanes <= 16; lanes *= 2) {
      const size_t tets = gsl_rng_uniform_int(rng, 400);
      struct cb_mesh mesh = mesh_of_chance(rng, 8 + gsl_rng_uniform_int(rng, 60), tets);
      cb_clusters_free(clusters_new(&mesh, lanes));
      cb_mesh_free(&mesh);
    }
  for (int kind = 0; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    cb_clusters_free(clusters_new(&s.mesh, 4));
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

static void one_tetrahedron_is_a_cluster(void **state) {
  (void)state;
  uint32_t tet[4] = {3, 7, 1, 4};
  const struct cb_mesh mesh = {.nodes = 9, .tets = 1, .tet = tet};
  struct cb_clusters *c = clusters_new(&mesh, 16);
  assert_int_equal(c->clusters, 1);
  assert_int_equal(c->order[0], 0);
  cb_clusters_free(c);
  cb_clusters_free(NULL);
}

/* More on the same nodes than a cluster holds. */
static void repeated_tetrahedra_are_allowed(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (size_t n = 1; n < 40; n++) {
    struct cb_mesh mesh;
    assert_int_equal(cb_mesh_allocate(5, n, &mesh), CB_OK);
    for (uint32_t i = 0; i < 4 * n; i++) mesh.tet[i] = i % 4;
    for (size_t e = 0; e < n; e++) gsl_ran_shuffle(rng, mesh.tet + 4 * e, 4, sizeof *mesh.tet);
    struct cb_clusters *c = clusters_new(&mesh, 8);
    assert_int_equal(c->clusters, (n + TETS - 1) / TETS);
    cb_clusters_free(c);
    cb_mesh_free(&mesh);
  }
  gsl_rng_free(rng);
}

/* A node, or an edge, of all tetrahedra: the time must not grow with their square. */
static void hubs_are_allowed(void **state) {
  (void)state;
  enum { RIM = 30000 };
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_allocate(RIM + 3, RIM, &mesh), CB_OK);
  for (uint32_t hubs = 1; hubs <= 3; hubs++) {
    for (uint32_t e = 0; e < RIM; e++)
      for (uint32_t j = 0; j < 4; j++)
        mesh.tet[4 * e + j] = j < hubs ? RIM + j : (e + j - hubs) % RIM;
    struct cb_clusters *c = clusters_new(&mesh, 8);
    assert_within("visits", visits(&mesh, c, 8), 1.7);
    cb_clusters_free(c);
  }
  cb_mesh_free(&mesh);
}

/* ---- grids --------------------------------------------------------------------------- */

static void assert_cells(const struct cb_clusters *c, size_t cells, uint8_t tets) {
  assert_int_equal(c->templates, 1);
  assert_int_equal(c->clusters, cells);
  assert_int_equal(c->shape->nodes, 8);
  assert_int_equal(c->shape->tets, tets);
}

/* And every vertex order is the grid's, whether or not the count fills the packs. */
static void grid_is_clustered_by_its_cells(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (size_t n = 3; n <= 8; n++)
    for (int shuffled = 0; shuffled < 4; shuffled++) {
      struct cb_mesh mesh = grid_new(n);
      if (shuffled) mesh_shuffle(rng, &mesh);
      struct cb_clusters *c = clusters_new(&mesh, 16);
      assert_cells(c, n * n * n, 10);
      for (size_t i = 0; i < TETS * c->clusters; i++) assert_int_equal(c->order[i], 0);
      cb_clusters_free(c);
      cb_mesh_free(&mesh);
    }
  gsl_rng_free(rng);
}

/* The cubes alone would be 1.33; measured 1.42. */
static void voxels_save_visits(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int shuffled = 0; shuffled < 2; shuffled++) {
    struct cb_mesh mesh = voxels_new(rng, 12);
    if (shuffled) mesh_shuffle(rng, &mesh);
    struct cb_clusters *c = clusters_new(&mesh, 8);
    assert_within("visits", visits(&mesh, c, 8), 1.5);
    cb_clusters_free(c);
    cb_mesh_free(&mesh);
  }
  gsl_rng_free(rng);
}

/* Measured 1.31 to 1.32 with 8 lanes, 1.34 with 16. */
static void irregular_mesh_saves_visits(void **state) {
  (void)state;
  struct cb_mesh mesh = irregular_new(18), ordered;
  struct cb_order order;
  assert_int_equal(cb_order_create(&mesh, &order), CB_OK);
  assert_int_equal(cb_order_mesh(&order, &mesh, &ordered), CB_OK);
  for (size_t lanes = 8; lanes <= 16; lanes *= 2) {
    struct cb_clusters *c = clusters_new(&mesh, lanes), *d = clusters_new(&ordered, lanes);
    assert_within("visits, shuffled", visits(&mesh, c, lanes), 1.4);
    assert_within("visits, ordered", visits(&ordered, d, lanes), 1.4);
    cb_clusters_free(c);
    cb_clusters_free(d);
  }
  cb_order_free(&order);
  cb_mesh_free(&ordered);
  cb_mesh_free(&mesh);
}

/* ---- the same again, and errors -------------------------------------------------------- */

static void clusters_are_the_same_again(void **state) {
  (void)state;
  struct cb_mesh mesh = irregular_new(6);
  struct cb_clusters *a = clusters_new(&mesh, 8), *b = clusters_new(&mesh, 8);
  assert_int_equal(a->templates, b->templates);
  assert_int_equal(a->clusters, b->clusters);
  assert_memory_equal(a->shape, b->shape, a->templates * sizeof *a->shape);
  assert_memory_equal(a->first, b->first, (a->templates + 1) * sizeof *a->first);
  assert_memory_equal(a->node, b->node, NODES * a->clusters * sizeof *a->node);
  assert_memory_equal(a->tet, b->tet, TETS * a->clusters * sizeof *a->tet);
  assert_memory_equal(a->order, b->order, TETS * a->clusters);
  cb_clusters_free(a);
  cb_clusters_free(b);
  cb_mesh_free(&mesh);
}

static void permutations_are_all_there(void **state) {
  (void)state;
  for (size_t i = 0; i < 24; i++) {
    const uint8_t *p = cb_permutation[i];
    assert_int_equal(1 << p[0] | 1 << p[1] | 1 << p[2] | 1 << p[3], 15);
    for (size_t j = 0; j < 4; j++) assert_true(i > 0 || p[j] == j);
    for (size_t k = 0; k < i; k++) assert_memory_not_equal(p, cb_permutation[k], 4);
  }
}

static void too_many_are_refused(void **state) {
  (void)state;
  struct cb_clusters *c = NULL;
  const struct cb_mesh most = {.nodes = SIZE_MAX / 64, .tets = 1}, more = {.tets = 1u << 30};
  assert_int_equal(cb_clusters_create(&most, 8, &c), CB_MEMORY);
  assert_int_equal(cb_clusters_create(&more, 8, &c), CB_INPUT);
  assert_null(c);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(clusters_are_a_partition),
      cmocka_unit_test(one_tetrahedron_is_a_cluster),
      cmocka_unit_test(repeated_tetrahedra_are_allowed),
      cmocka_unit_test(hubs_are_allowed),
      cmocka_unit_test(grid_is_clustered_by_its_cells),
      cmocka_unit_test(voxels_save_visits),
      cmocka_unit_test(irregular_mesh_saves_visits),
      cmocka_unit_test(clusters_are_the_same_again),
      cmocka_unit_test(permutations_are_all_there),
      cmocka_unit_test(too_many_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
