/* test_order.c - an order of a mesh is a permutation that can be undone, changes
 * no force, and brings neighbours close together.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/files/order.h"
#include "tests/temporary.h"
#include "tests/variants.h"

/* ---- meshes ------------------------------------------------------------------ */

static struct cb_mesh grid_new(size_t n) {
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_grid(n, n, n, 1.0 / (double)n, &mesh), CB_OK);
  return mesh;
}

/* The numbers from 0 to n-1 in any sequence, to be freed. */
static uint32_t *shuffled_numbers(gsl_rng *rng, size_t n) {
  uint32_t *numbers = malloc(n * sizeof *numbers);
  assert_non_null(numbers);
  for (size_t i = 0; i < n; i++) numbers[i] = (uint32_t)i;
  gsl_ran_shuffle(rng, numbers, n, sizeof *numbers);
  return numbers;
}

static struct cb_order shuffled_order(gsl_rng *rng, const struct cb_mesh *mesh) {
  return (struct cb_order){.nodes = mesh->nodes,
                           .tets = mesh->tets,
                           .node = shuffled_numbers(rng, mesh->nodes),
                           .tet = shuffled_numbers(rng, mesh->tets)};
}

/* *mesh := itself in that order. */
static void mesh_reorder(const struct cb_order *order, struct cb_mesh *mesh) {
  struct cb_mesh ordered;
  assert_int_equal(cb_order_mesh(order, mesh, &ordered), CB_OK);
  cb_mesh_free(mesh);
  *mesh = ordered;
}

static void mesh_shuffle(gsl_rng *rng, struct cb_mesh *mesh) {
  struct cb_order order = shuffled_order(rng, mesh);
  mesh_reorder(&order, mesh);
  cb_order_free(&order);
}

/* Two shuffled grids apart from each other, and `lonely` nodes in no tetrahedron. */
static struct cb_mesh pieces_new(gsl_rng *rng, size_t lonely) {
  struct cb_mesh grid = grid_new(3), mesh;
  const size_t n = grid.nodes, t = 4 * grid.tets;
  assert_int_equal(cb_mesh_allocate(2 * n + lonely, 2 * grid.tets, &mesh), CB_OK);
  random_vector(rng, 3 * mesh.nodes, mesh.X);
  for (size_t i = 0; i < 6 * n; i++) mesh.X[i] = grid.X[i % (3 * n)] + (i < 3 * n ? 0 : 2);
  for (size_t i = 0; i < 2 * t; i++) mesh.tet[i] = grid.tet[i % t] + (uint32_t)(i < t ? 0 : n);
  cb_mesh_free(&grid);
  mesh_shuffle(rng, &mesh);
  return mesh;
}

/* Lowest and highest node of a tetrahedron. */
static void tet_extremes(const uint32_t *t, uint32_t *low, uint32_t *high) {
  *low = *high = t[0];
  for (int j = 1; j < 4; j++) {
    *low = t[j] < *low ? t[j] : *low;
    *high = t[j] > *high ? t[j] : *high;
  }
}

/* Largest and mean distance of the node numbers in a tetrahedron. */
struct span {
  double largest, mean;
};

static struct span mesh_span(const struct cb_mesh *mesh) {
  struct span span = {0, 0};
  for (size_t e = 0; e < mesh->tets; e++) {
    uint32_t low, high;
    tet_extremes(mesh->tet + 4 * e, &low, &high);
    span.largest = fmax(span.largest, high - low);
    span.mean += (double)(high - low) / (double)mesh->tets;
  }
  return span;
}

/* ---- permutations -------------------------------------------------------------- */

static void assert_permutation(const uint32_t *p, size_t n) {
  uint8_t *seen = calloc(n + 1, 1);
  assert_non_null(seen);
  for (size_t i = 0; i < n; i++) {
    assert_true(p[i] < n);
    assert_int_equal(seen[p[i]]++, 0);
  }
  free(seen);
}

/* Both parts are permutations; each tetrahedron keeps its vertices in their
 * sequence, where they are, and its share; vectors come back. */
static void assert_order(gsl_rng *rng, const struct cb_mesh *mesh) {
  const size_t n = 3 * mesh->nodes;
  struct cb_order order;
  struct cb_mesh ordered;
  assert_int_equal(cb_order_create(mesh, &order), CB_OK);
  assert_int_equal(order.nodes, mesh->nodes);
  assert_int_equal(order.tets, mesh->tets);
  assert_permutation(order.node, mesh->nodes);
  assert_permutation(order.tet, mesh->tets);

  assert_int_equal(cb_order_mesh(&order, mesh, &ordered), CB_OK);
  assert_true(ordered.share == mesh->share);
  for (size_t i = 0; i < 4 * mesh->tets; i++) {
    const uint32_t old = mesh->tet[4 * (size_t)order.tet[i / 4] + i % 4];
    assert_int_equal(ordered.tet[i], order.node[old]);
    assert_memory_equal(ordered.X + 3 * (size_t)ordered.tet[i], mesh->X + 3 * (size_t)old,
                        3 * sizeof(double));
  }

  double *in = malloc(3 * n * sizeof *in), *there = in + n, *back = in + 2 * n;
  assert_non_null(in);
  random_vector(rng, n, in);
  cb_order_forward(&order, 3, in, there);
  for (size_t i = 0; i < n; i++) assert_true(there[3 * order.node[i / 3] + i % 3] == in[i]);
  cb_order_backward(&order, 3, there, back);
  assert_memory_equal(back, in, n * sizeof *in);
  cb_order_forward(&order, 1, in, there);
  cb_order_backward(&order, 1, there, back);
  assert_memory_equal(back, in, mesh->nodes * sizeof *in);

  free(in);
  cb_mesh_free(&ordered);
  cb_order_free(&order);
  assert_null(order.node);
}

static void order_is_a_permutation(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int kind = 0; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    assert_order(rng, &s.mesh);
    mesh_shuffle(rng, &s.mesh);
    assert_order(rng, &s.mesh);
    scene_free(&s);
  }
  for (size_t lonely = 0; lonely < 9; lonely += 4) {
    struct cb_mesh mesh = pieces_new(rng, lonely);
    assert_order(rng, &mesh);
    cb_mesh_free(&mesh);
  }
  struct cb_mesh lonely = grid_new(1);
  lonely.tets = 0;
  assert_order(rng, &lonely);
  cb_mesh_free(&lonely);
  gsl_rng_free(rng);
}

static void order_is_the_same_again(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh = pieces_new(rng, 5);
  struct cb_order first, second;
  assert_int_equal(cb_order_create(&mesh, &first), CB_OK);
  assert_int_equal(cb_order_create(&mesh, &second), CB_OK);
  assert_memory_equal(first.node, second.node, mesh.nodes * sizeof *first.node);
  assert_memory_equal(first.tet, second.tet, mesh.tets * sizeof *first.tet);
  cb_order_free(&first);
  cb_order_free(&second);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

static void order_without_memory(void **state) {
  (void)state;
  const struct cb_mesh endless = {.nodes = 4, .tets = SIZE_MAX / 64};
  struct cb_order order = {.nodes = 77};
  cb_fail(CB_BROKEN, "none");
  assert_int_equal(cb_order_create(&endless, &order), CB_MEMORY);
  assert_non_null(strstr(cb_error_message(), "the order of the mesh"));
  assert_int_equal(order.nodes, 77);
}

/* ---- forces ---------------------------------------------------------------------- */

static const char *const models[] = {"qr-updated", "svd-precomputed"};

/* f[3*nodes] := the force on the mesh in shape x, in f64. */
static void force(const char *model, const struct cb_mesh *mesh, const double *x, double *f) {
  const struct cb_arithmetic *a = scene_f64();
  const struct cb_variant variant = {scene_model(a, model), CB_EBE, a};
  const struct cb_material material = scene_material(false);
  struct cb_operator *op;
  void *shape = vector_new(a, mesh->nodes, x), *out = vector_new(a, mesh->nodes, NULL);
  assert_int_equal(cb_operator_create(&variant, mesh, &material, 1, 1, &op), CB_OK);
  cb_operator_update(op, shape, NULL, 1, out);
  a->to_double(mesh->nodes, out, f);
  cb_operator_free(op);
  free(shape);
  free(out);
}

/* f[3*nodes] := the same through the ordered mesh, numbered as in `mesh`. */
static void force_through_order(const char *model, const struct cb_mesh *mesh, const double *x,
                                double *f) {
  const size_t n = 3 * mesh->nodes;
  struct cb_order order;
  struct cb_mesh ordered;
  double *shape = malloc(2 * n * sizeof *shape), *out = shape + n;
  assert_non_null(shape);
  assert_int_equal(cb_order_create(mesh, &order), CB_OK);
  assert_int_equal(cb_order_mesh(&order, mesh, &ordered), CB_OK);
  cb_order_forward(&order, 3, x, shape);
  force(model, &ordered, shape, out);
  cb_order_backward(&order, 3, out, f);
  cb_mesh_free(&ordered);
  cb_order_free(&order);
  free(shape);
}

/* A shape near rest: every node moved by about a tenth of an edge. */
static double *shape_new(gsl_rng *rng, const struct cb_mesh *mesh, double edge) {
  double *x = malloc(3 * mesh->nodes * sizeof *x);
  assert_non_null(x);
  random_vector(rng, 3 * mesh->nodes, x);
  for (size_t i = 0; i < 3 * mesh->nodes; i++) x[i] = mesh->X[i] + 0.1 * edge * x[i];
  return x;
}

/* A node sums the forces of its tetrahedra in another sequence. */
static void forces_agree_to_rounding(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh = pieces_new(rng, 5);
  const size_t n = 3 * mesh.nodes;
  double *x = shape_new(rng, &mesh, 1.0 / 3), *f = malloc(2 * n * sizeof *f), *g = f + n;
  assert_non_null(f);
  for (size_t m = 0; m < 2; m++) {
    force(models[m], &mesh, x, f);
    force_through_order(models[m], &mesh, x, g);
    assert_true(norm(n, f) > 0);
    assert_within(models[m], distance(n, f, g) / (norm(n, f) * DBL_EPSILON), 4);
  }
  free(f);
  free(x);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

/* Tetrahedra that share no node: nothing is summed, no bit may change. */
static void forces_of_an_element_are_the_same_bits(void **state) {
  (void)state;
  enum { TETS = 30 };
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh;
  assert_int_equal(cb_mesh_allocate(4 * TETS, TETS, &mesh), CB_OK);
  for (size_t e = 0; e < TETS; e++) {
    struct cb_mesh one;
    one_tet(rng, e % 2 == 1, &one);
    memcpy(mesh.X + 12 * e, one.X, 12 * sizeof *one.X);
    for (size_t j = 0; j < 4; j++) mesh.tet[4 * e + j] = (uint32_t)(4 * e + j);
    cb_mesh_free(&one);
  }
  mesh_shuffle(rng, &mesh);
  const size_t n = 3 * mesh.nodes;
  double *x = shape_new(rng, &mesh, 1), *f = malloc(2 * n * sizeof *f), *g = f + n;
  assert_non_null(f);
  for (size_t m = 0; m < 2; m++) {
    force(models[m], &mesh, x, f);
    force_through_order(models[m], &mesh, x, g);
    assert_true(norm(n, f) > 0);
    assert_memory_equal(g, f, n * sizeof *f);
  }
  free(f);
  free(x);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

/* ---- locality ---------------------------------------------------------------------- */

/* Levels about a corner are shells of three faces, those of the grid one face. */
static const double LARGEST = 3.5, MEAN = 2.5;

static void shuffled_grid_is_as_local_as_the_grid(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (size_t n = 4; n <= 16; n *= 2) {
    struct cb_mesh mesh = grid_new(n);
    struct cb_order order;
    const struct span natural = mesh_span(&mesh);
    mesh_shuffle(rng, &mesh);
    assert_int_equal(cb_order_create(&mesh, &order), CB_OK);
    mesh_reorder(&order, &mesh);
    const struct span found = mesh_span(&mesh);
    assert_within("largest distance", found.largest / natural.largest, LARGEST);
    assert_within("mean distance", found.mean / natural.mean, MEAN);
    cb_order_free(&order);
    cb_mesh_free(&mesh);
  }
  gsl_rng_free(rng);
}

/* A walk from somewhere within a bar goes both ways at once, with larger levels:
 * measured 1.55 times the grid's distance, and 0.99 from an end. */
static void bar_is_walked_from_an_end(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh;
  struct cb_order order;
  assert_int_equal(cb_mesh_grid(1, 1, 100, 1, &mesh), CB_OK);
  const struct span natural = mesh_span(&mesh);
  mesh_shuffle(rng, &mesh);
  assert_int_equal(cb_order_create(&mesh, &order), CB_OK);
  mesh_reorder(&order, &mesh);
  assert_within("mean distance", mesh_span(&mesh).mean / natural.mean, 1.2);
  cb_order_free(&order);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

/* The tetrahedra come by their lowest nodes, so their nodes are met one after the
 * other. */
static void tetrahedra_come_in_the_sequence_of_their_nodes(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh = pieces_new(rng, 3);
  struct cb_order order;
  assert_int_equal(cb_order_create(&mesh, &order), CB_OK);
  mesh_reorder(&order, &mesh);
  uint64_t before = 0;
  for (size_t e = 0; e < mesh.tets; e++) {
    uint32_t low, high;
    tet_extremes(mesh.tet + 4 * e, &low, &high);
    const uint64_t key = (uint64_t)low << 32 | high;
    assert_true(before <= key);
    before = key;
  }
  cb_order_free(&order);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

static void mesh_write(const struct cb_mesh *mesh, const char *node, const char *ele) {
  FILE *file = fopen(node, "w");
  assert_non_null(file);
  fprintf(file, "%zu 3 0 0\n", mesh->nodes);
  for (size_t n = 0; n < mesh->nodes; n++)
    fprintf(file, "%zu %.17g %.17g %.17g\n", n, mesh->X[3 * n], mesh->X[3 * n + 1],
            mesh->X[3 * n + 2]);
  assert_int_equal(fclose(file), 0);
  file = fopen(ele, "w");
  assert_non_null(file);
  fprintf(file, "%zu 4 0\n", mesh->tets);
  for (size_t e = 0; e < mesh->tets; e++)
    fprintf(file, "%zu %u %u %u %u\n", e, mesh->tet[4 * e], mesh->tet[4 * e + 1],
            mesh->tet[4 * e + 2], mesh->tet[4 * e + 3]);
  assert_int_equal(fclose(file), 0);
}

static void bench_puts_a_file_in_order(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_mesh mesh = grid_new(8);
  struct cb_bench_scene scene;
  const struct span natural = mesh_span(&mesh);
  mesh_shuffle(rng, &mesh);
  mesh_write(&mesh, temporary_path("grid.node"), temporary_path("grid.ele"));
  assert_int_equal(cb_bench_scene_mesh(temporary_path("grid.ele"), 1, &scene), CB_OK);
  assert_int_equal(scene.mesh.nodes, mesh.nodes);
  assert_int_equal(scene.mesh.tets, mesh.tets);
  assert_within("largest distance", mesh_span(&scene.mesh).largest / natural.largest, LARGEST);
  cb_bench_scene_free(&scene);
  cb_mesh_free(&mesh);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(order_is_a_permutation),
      cmocka_unit_test(order_is_the_same_again),
      cmocka_unit_test(order_without_memory),
      cmocka_unit_test(forces_agree_to_rounding),
      cmocka_unit_test(forces_of_an_element_are_the_same_bits),
      cmocka_unit_test(shuffled_grid_is_as_local_as_the_grid),
      cmocka_unit_test(bar_is_walked_from_an_end),
      cmocka_unit_test(tetrahedra_come_in_the_sequence_of_their_nodes),
      cmocka_unit_test(bench_puts_a_file_in_order),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
