/* test_storages.c - every storage of a model computes the same force and the
 * same product, in quad to the last digits and in double to its rounding.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/variants.h"

static const double H = 0.01, C = 0.3;

/* Roundings of an element's longest chain, on top of what its shape amplifies:
 * measured at most 9.4 (polar-eigen). */
static const double LIMIT = 16;

typedef void each_fn(struct run *run, const struct scene *s, double roundoff);

/* Every model x material x storage of f64 and of counted, on every mesh. */
static void for_each_variant(each_fn *each) {
  gsl_rng *rng = scene_rng();
  const struct cb_arithmetic *const both[] = {scene_f64(), scene_counted()};
  for (int kind = 0; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    for (int ortho = 0; ortho < 2; ortho++)
      for (int a = 0; a < 2; a++)
        for (const struct cb_model *const *m = both[a]->models; *m; m++)
          for (int storage = 0; storage < CB_STORAGES; storage++) {
            struct cb_variant v = {*m, (enum cb_storage)storage, both[a]};
            struct cb_material material = scene_material(ortho);
            struct run run;
            if (!(*m)->form[storage][ortho].update) continue;
            run_open(&run, &s, &v, &material, C);
            size_t length = strlen(run.name);
            snprintf(run.name + length, sizeof run.name - length, " %s %s",
                     ortho ? "orthotropic" : "isotropic", scene_name[kind]);
            each(&run, &s, both[a]->roundoff);
            run_close(&run);
          }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* The same model's ebe in quad. */
static void reference_open(struct run *reference, const struct run *run, const struct scene *s) {
  const struct cb_arithmetic *counted = scene_counted();
  struct cb_variant v = {scene_model(counted, run->variant.model->name), CB_EBE, counted};
  struct cb_material material = scene_material(strstr(run->name, "ortho") != NULL);
  run_open(reference, s, &v, &material, C);
}

static void agrees_with_quad(struct run *run, const struct scene *s, double roundoff) {
  size_t n = 3 * s->mesh.nodes;
  quad *q = quads_new(4 * n), *f = q, *y = q + n, *f_quad = q + 2 * n, *y_quad = q + 3 * n;
  struct run reference;
  reference_open(&reference, run, s);
  run_update(&reference, reference.v, H, f_quad);
  run_product(&reference, reference.u, y_quad);
  run_update(run, run->v, H, f);
  run_product(run, run->u, y);
  assert_rounding(run->name, n, f, f_quad, roundoff, s->condition, LIMIT);
  assert_rounding(run->name, n, y, y_quad, roundoff, s->condition, LIMIT);
  run_close(&reference);
  free(q);
}

static void storages_agree(void **state) {
  (void)state;
  for_each_variant(agrees_with_quad);
}

/* update(x, v) = update(x, none) - product(v) */
static void absorbs_velocity(struct run *run, const struct scene *s, double roundoff) {
  size_t n = 3 * s->mesh.nodes;
  quad *q = quads_new(3 * n), *with = q, *without = q + n, *product = q + 2 * n;
  run_update(run, NULL, H, without);
  run_product(run, run->v, product);
  run_update(run, run->v, H, with);
  for (size_t i = 0; i < n; i++) with[i] -= without[i], with[i] = -with[i];
  assert_rounding(run->name, n, with, product, roundoff, s->condition, LIMIT);
  free(q);
}

static void update_absorbs_the_velocity(void **state) {
  (void)state;
  for_each_variant(absorbs_velocity);
}

static void product_of_blocks(const struct run *run, const double *u, double *y) {
  const uint32_t *row_start, *column;
  cb_operator_pattern(run->op, &row_start, &column);
  double *blocks = malloc(9 * row_start[run->nodes] * sizeof *blocks);
  assert_non_null(blocks);
  cb_operator_blocks(run->op, blocks);
  for (size_t i = 0; i < 3 * run->nodes; i++) {
    y[i] = 0;
    for (uint32_t b = row_start[i / 3]; b < row_start[i / 3 + 1]; b++)
      for (size_t c = 0; c < 3; c++) y[i] += blocks[9 * b + 3 * (i % 3) + c] * u[3 * column[b] + c];
  }
  free(blocks);
}

static void has_those_blocks(struct run *run, const struct scene *s, double roundoff) {
  if (run->variant.storage != CB_CSR && run->variant.storage != CB_BCSR) return;
  size_t n = 3 * s->mesh.nodes;
  quad *q = quads_new(3 * n), *f = q, *product = q + n, *by_blocks = q + 2 * n;
  double *y = malloc(n * sizeof *y);
  assert_non_null(y);
  run_update(run, NULL, H, f);
  run_product(run, run->u, product);
  product_of_blocks(run, s->u, y);
  for (size_t i = 0; i < n; i++) by_blocks[i] = y[i];
  (void)roundoff; /* blocks are double, whatever the arithmetic */
  assert_rounding(run->name, n, by_blocks, product, 0x1p-53, s->condition, LIMIT);
  free(q);
  free(y);
}

static void blocks_are_the_operator(void **state) {
  (void)state;
  for_each_variant(has_those_blocks);
}

/* Every node moved alike: against the product of the same size of motion. */
static void ignores_translation(struct run *run, const struct scene *s, double roundoff) {
  size_t n = 3 * s->mesh.nodes;
  quad *q = quads_new(3 * n), *f = q, *y = q + n, *shifted = q + 2 * n;
  double *shift = malloc(n * sizeof *shift);
  assert_non_null(shift);
  for (size_t i = 0; i < n; i++) shift[i] = i % 3 == 0 ? 0.7 : i % 3 == 1 ? -0.4 : 0.2;
  void *u = vector_new(run->variant.arithmetic, s->mesh.nodes, shift);
  run_update(run, NULL, H, f);
  run_product(run, run->u, y);
  run_product(run, u, shifted);
  assert_within(run->name, quad_norm(n, shifted) / (quad_norm(n, y) * roundoff * s->condition),
                LIMIT);
  free(u);
  free(shift);
  free(q);
}

static void translation_costs_nothing(void **state) {
  (void)state;
  for_each_variant(ignores_translation);
}

/* K has half the entries when each tetrahedron carries half its volume; the
 * orientation of a tetrahedron is a matter of numbering only. */
static void share_scales_and_orientation_does_not(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_RANDOM);
  size_t n = 3 * s.mesh.nodes;
  quad *q = quads_new(4 * n), *whole = q, *half = q + n, *y = q + 2 * n, *y_half = q + 3 * n;
  struct cb_material material = scene_material(false);
  for (const struct cb_model *const *m = scene_counted()->models; *m; m++) {
    struct cb_variant v = {*m, CB_EBE, scene_counted()};
    struct run run;
    bool numbering = (*m)->laws[0] & CB_KEEPS(CB_LAW_ORDER);
    run_open(&run, &s, &v, &material, C);
    run_update(&run, run.v, H, whole);
    run_product(&run, run.u, y);
    run_close(&run);
    s.mesh.share = 0.5;
    for (size_t e = 0; numbering && e < s.mesh.tets; e++) {
      uint32_t *t = s.mesh.tet + 4 * e, first = t[1];
      t[1] = t[3], t[3] = first;
    }
    run_open(&run, &s, &v, &material, C);
    run_update(&run, run.v, H, half);
    run_product(&run, run.u, y_half);
    for (size_t i = 0; i < n; i++) half[i] *= 2, y_half[i] *= 2;
    assert_rounding(run.name, n, half, whole, v.arithmetic->roundoff, s.condition, LIMIT);
    assert_rounding(run.name, n, y_half, y, v.arithmetic->roundoff, s.condition, LIMIT);
    run_close(&run);
    s.mesh.share = 1;
  }
  scene_free(&s);
  gsl_rng_free(rng);
  free(q);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(storages_agree),
      cmocka_unit_test(update_absorbs_the_velocity),
      cmocka_unit_test(blocks_are_the_operator),
      cmocka_unit_test(translation_costs_nothing),
      cmocka_unit_test(share_scales_and_orientation_does_not),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
