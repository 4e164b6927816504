/* test_models.c - force and product of every model on strongly deformed
 * tetrahedra, in quad precision, against the formulas of tests/element.h; and
 * the cases in which models coincide.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/element.h"

enum { SHAPES = 30 };

/* Roundings of double, even in quad: frames iterate no further, and materials
 * are given in double. Times the condition; measured at most 1. */
static const double ROUNDING = 0x1p-53, LIMIT = 8;

/* ---- forces and products by independent formulas -------------------------------- */

static const struct {
  const char *stem;
  enum frame frame;
} frames[] = {{"qr", FRAME_QR},
              {"polar-higham", FRAME_POLAR},
              {"polar-closed", FRAME_POLAR},
              {"polar-eigen", FRAME_POLAR},
              {"polar-quaternion", FRAME_POLAR},
              {"svd", FRAME_POLAR},
              {"polar-edges", FRAME_EDGES},
              {"polar-reflected", FRAME_REFLECTED}};
static const char *const policy[] = {"precomputed", "updated", "updated-volume"};
enum { FRAMES = sizeof frames / sizeof *frames, POLICIES = sizeof policy / sizeof *policy };

static void against_formulas(struct run *r, const struct scene *s, const struct cb_material *m,
                             enum frame frame, enum gradients b) {
  quad q[60], *x = q, *u = q + 12, *f = q + 24, *expected = q + 36, *y = q + 48;
  for (int i = 0; i < 12; i++) x[i] = s->x[i], u[i] = s->u[i];
  struct element t = element_of(frame, m, s->mesh.X, x);
  reopen(r, s, m);
  run_update(r, NULL, 1, f);
  run_product(r, r->u, y);
  /* The rest and the current edges have polar factors of their own. */
  double condition = s->condition;
  if (frame == FRAME_EDGES) condition *= shape_condition(&s->mesh, s->mesh.X);
  element_force(&t, b, expected);
  assert_rounding(r->name, 12, f, expected, ROUNDING, condition, LIMIT);
  element_product(&t, b, u, expected);
  assert_rounding(r->name, 12, y, expected, ROUNDING, condition, LIMIT);
  run_close(r);
}

static void corotated_models_follow_their_formulas(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < SHAPES; trial++) {
    struct scene s = wild_scene(rng, trial);
    struct cb_material m = scene_material(trial / 2 % 2);
    for (int n = 0; n < FRAMES; n++)
      for (int b = 0; b < POLICIES; b++) {
        char name[64];
        snprintf(name, sizeof name, "%s-%s", frames[n].stem, policy[b]);
        struct run r = counted_run(name);
        against_formulas(&r, &s, &m, frames[n].frame, (enum gradients)b);
      }
    struct run linear = counted_run("linear");
    against_formulas(&linear, &s, &m, FRAME_NONE, REST_B);
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* All its nodes have the element's own gradient. */
static void node_warp_on_one_element_is_polar(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < SHAPES; trial++) {
    struct scene s = wild_scene(rng, trial);
    struct cb_material m = scene_material(trial / 2 % 2);
    struct run r = counted_run("node-warp");
    against_formulas(&r, &s, &m, FRAME_POLAR, REST_B);
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* ---- special cases --------------------------------------------------------------------- */

static void at_rest_every_model_is_linear(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int ortho = 0; ortho < 2; ortho++) {
    struct scene s = scene_new(rng, SCENE_RANDOM);
    struct cb_material m = scene_material(ortho);
    size_t n = 3 * s.mesh.nodes;
    quad *q = quads_new(3 * n), *f = q, *y = q + n, *linear = q + 2 * n;
    memcpy(s.x, s.mesh.X, n * sizeof *s.x);
    double condition = shape_condition(&s.mesh, s.x);
    struct run reference = counted_run("linear");
    reopen(&reference, &s, &m);
    run_update(&reference, NULL, 1, f);
    run_product(&reference, reference.u, linear);
    for (const struct cb_model *const *model = scene_counted()->models; *model; model++) {
      struct run r = counted_run((*model)->name);
      if (!(*model)->form[CB_EBE][ortho].update) continue;
      reopen(&r, &s, &m);
      run_update(&r, NULL, 1, f);
      run_product(&r, r.u, y);
      assert_rounding(r.name, n, y, linear, r.variant.arithmetic->roundoff, condition, LIMIT);
      run_close(&r);
    }
    run_close(&reference);
    scene_free(&s);
    free(q);
  }
  gsl_rng_free(rng);
}

static void orthotropic_with_isotropic_constants_is_isotropic(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct cb_material iso = scene_material(false), ortho;
  double E = iso.young, nu = iso.poisson, G = E / (2 * (1 + nu));
  assert_int_equal(cb_material_orthotropic((double[]){E, E, E}, (double[]){nu, nu, nu},
                                           (double[]){G, G, G}, 1000, &ortho),
                   CB_OK);
  for (int kind = 0; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    size_t n = 3 * s.mesh.nodes;
    quad *q = quads_new(4 * n), *f = q, *y = q + n, *f_iso = q + 2 * n, *y_iso = q + 3 * n;
    for (const struct cb_model *const *model = scene_counted()->models; *model; model++) {
      struct run r = counted_run((*model)->name);
      if (!(*model)->form[CB_EBE][1].update) continue;
      reopen(&r, &s, &iso);
      run_update(&r, r.v, 0.1, f_iso);
      run_product(&r, r.u, y_iso);
      run_close(&r);
      reopen(&r, &s, &ortho);
      run_update(&r, r.v, 0.1, f);
      run_product(&r, r.u, y);
      assert_rounding(r.name, n, f, f_iso, ROUNDING, s.condition, LIMIT);
      assert_rounding(r.name, n, y, y_iso, ROUNDING, s.condition, LIMIT);
      run_close(&r);
    }
    free(q);
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

static void no_stiffness_is_exactly_nothing(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_RANDOM);
  size_t n = 3 * s.mesh.nodes, count;
  struct cb_material m;
  assert_int_equal(cb_material_isotropic(0, 0.3, 1000, &m), CB_OK);
  quad *q = quads_new(2 * n);
  const struct cb_variant *variants = cb_variants(&count);
  for (size_t i = 0; i < count; i++) {
    struct run r;
    run_open(&r, &s, variants + i, &m, 1);
    run_update(&r, r.v, 1, q);
    run_product(&r, r.u, q + n);
    for (size_t k = 0; k < 2 * n; k++) assert_true(q[k] == 0);
    run_close(&r);
  }
  free(q);
  scene_free(&s);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(corotated_models_follow_their_formulas),
      cmocka_unit_test(node_warp_on_one_element_is_polar),
      cmocka_unit_test(at_rest_every_model_is_linear),
      cmocka_unit_test(orthotropic_with_isotropic_constants_is_isotropic),
      cmocka_unit_test(no_stiffness_is_exactly_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
