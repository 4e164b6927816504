/* test_threads_assembled.c - assembled storages by many threads: the same numbers
 * as by one, to rounding; the same to the last bit each time; padding stays zero.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/variants.h"

static const double H = 0.01, C = 0.3;
static const size_t THREADS[] = {2, 3, 5};

/* Elements are added up in another order: measured at most 0.5 units of rounding
 * times the condition. */
static const double LIMIT = 4;

/* A mesh whose rows, packs and columns go over several threads: 180 elements. */
static struct scene wide_scene(gsl_rng *rng) {
  struct scene s = {.condition = 1};
  assert_int_equal(cb_mesh_grid(3, 3, 2, 0.5, &s.mesh), CB_OK);
  const size_t n = 3 * s.mesh.nodes;
  s.x = malloc(n * sizeof *s.x);
  s.v = malloc(n * sizeof *s.v);
  s.u = malloc(n * sizeof *s.u);
  assert_true(s.x && s.v && s.u);
  random_vector(rng, n, s.v);
  random_vector(rng, n, s.u);
  deform(rng, &s);
  return s;
}

/* What one operator computes. */
struct result {
  size_t bytes;
  void *update, *product;
};

static void result_free(struct result *r) {
  free(r->update);
  free(r->product);
}

static void assert_padding(const struct cb_arithmetic *a, size_t nodes, const void *vector) {
  const unsigned char *bytes = vector;
  for (size_t n = 0; n < nodes; n++)
    for (size_t k = 3 * a->scalar_bytes; k < a->stride * a->scalar_bytes; k++)
      assert_int_equal(bytes[n * a->stride * a->scalar_bytes + k], 0);
}

static void compute(struct run *r, struct result *out) {
  const struct cb_arithmetic *a = r->variant.arithmetic;
  out->bytes = r->nodes * a->stride * a->scalar_bytes;
  out->update = vector_new(a, r->nodes, NULL);
  out->product = vector_new(a, r->nodes, NULL);
  cb_operator_reset(r->op);
  cb_operator_update(r->op, r->x, r->v, H, out->update);
  cb_operator_product(r->op, r->u, out->product);
  assert_padding(a, r->nodes, out->update);
  assert_padding(a, r->nodes, out->product);
}

static void assert_same_bits(const struct result *a, const struct result *b) {
  assert_memory_equal(a->update, b->update, a->bytes);
  assert_memory_equal(a->product, b->product, a->bytes);
}

static void assert_near(const struct run *r, const struct scene *s, const struct result *a,
                        const struct result *b) {
  const struct cb_arithmetic *arithmetic = r->variant.arithmetic;
  const size_t n = 3 * r->nodes;
  quad *q = quads_new(2 * n);
  const void *pairs[2][2] = {{a->update, b->update}, {a->product, b->product}};
  for (int i = 0; i < 2; i++) {
    vector_read(arithmetic, r->nodes, pairs[i][0], q);
    vector_read(arithmetic, r->nodes, pairs[i][1], q + n);
    assert_rounding(r->name, n, q, q + n, arithmetic->roundoff, s->condition, LIMIT);
  }
  free(q);
}

static void open_with(struct run *r, const struct scene *s, const struct cb_variant *v,
                      const struct cb_material *m, size_t threads) {
  run_open(r, s, v, m, C);
  cb_operator_free(r->op);
  assert_int_equal(cb_operator_create(&r->variant, &s->mesh, m, C, threads, &r->op), CB_OK);
}

static void check_variant(const struct scene *s, const struct cb_variant *v,
                          const struct cb_material *m) {
  struct run run;
  struct result one;
  open_with(&run, s, v, m, 1);
  compute(&run, &one);
  run_close(&run);
  for (size_t t = 0; t < sizeof THREADS / sizeof *THREADS; t++) {
    struct result first, again, other;
    open_with(&run, s, v, m, THREADS[t]);
    compute(&run, &first);
    compute(&run, &again);
    assert_near(&run, s, &first, &one);
    run_close(&run);
    open_with(&run, s, v, m, THREADS[t]);
    compute(&run, &other);
    run_close(&run);
    assert_same_bits(&first, &again);
    assert_same_bits(&first, &other);
    result_free(&first);
    result_free(&again);
    result_free(&other);
  }
  result_free(&one);
}

/* Models whose elements keep gradients, blocks, and what is assembled once; meshes of
 * 1, 23 (with isolated nodes), 20 and 180 elements. */
static void threads_agree(void **state) {
  (void)state;
  static const char *const names[] = {"qr-updated", "green", "linear"};
  gsl_rng *rng = scene_rng();
  for (int kind = 0; kind <= SCENES; kind++) {
    struct scene s = kind < SCENES ? scene_new(rng, (enum scene_kind)kind) : wide_scene(rng);
    for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
      for (size_t m = 0; m < sizeof names / sizeof *names && cb_arithmetic_runs(*a); m++)
        for (int storage = CB_CSR; storage < CB_STORAGES; storage++)
          for (int ortho = 0; ortho < 2; ortho++) {
            struct cb_variant v = {scene_model(*a, names[m]), (enum cb_storage)storage, *a};
            struct cb_material material = scene_material(ortho);
            check_variant(&s, &v, &material);
          }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* Every model offers each assembled storage if it offers one. */
static void assembled_storages_come_together(void **state) {
  (void)state;
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
    for (const struct cb_model *const *m = (*a)->models; *m; m++)
      for (int storage = CB_CSR; storage < CB_STORAGES; storage++)
        for (int ortho = 0; ortho < 2; ortho++)
          assert_true(!(*m)->form[storage][ortho].update == !(*m)->form[CB_BCSR][ortho].update);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(threads_agree),
      cmocka_unit_test(assembled_storages_come_together),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
