/* test_sweeps.c - the sweeps of materials, contrasts, steps, systems and inputs say what is
 * known otherwise: closed forms, conserved quantities, what must be refused.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/vectors.h"

#include <stdlib.h>
#include <string.h>

#include "harness/extremes/report.h"
#include "harness/extremes/steps.h"
#include "harness/verify/probe.h"
#include "reference/oracles.h"

static struct cb_extremes swept(const char *sweep, const struct cb_variant **variants) {
  struct cb_extremes all = {.seed = 2005, .variants = variants};
  assert_int_equal(cb_extremes_run(sweep, &all), CB_OK);
  assert_true(all.count > 0);
  return all;
}

static const struct cb_variant *variant(const char *name) {
  const struct cb_variant *v = cb_variant_find(name);
  if (!v) fail_msg("no variant %s", name);
  return v;
}

static const struct cb_extreme *row_of(const struct cb_extremes *all, const char *parameter,
                                       const struct cb_variant *v) {
  for (size_t i = 0; i < all->count; i++)
    if (strcmp(all->row[i].parameter, parameter) == 0 && all->row[i].variant == v)
      return &all->row[i];
  fail_msg("no row '%s'", parameter);
  return NULL;
}

/* ---- materials and contrasts --------------------------------------------------------- */

/* To what the condition explains, up to 0.4999999; and no stiffness makes no force. */
static void any_material_is_accurate(void **state) {
  (void)state;
  const struct cb_variant *v[] = {variant("qr-exact/ebe/f64"), variant("polar-exact/ebe/f32"),
                                  variant("polar-exact/ebe/f64"), NULL};
  struct cb_extremes all = swept("materials", v);
  for (size_t i = 0; i < all.count; i++) {
    const struct cb_extreme *r = &all.row[i];
    if (cb_extreme_state(r) != CB_RIGHT) fail_msg("%s: %s", r->parameter, r->law);
    assert_true(r->force_error <= cb_extreme_limit && r->product_error <= cb_extreme_limit);
  }
  assert_true(row_of(&all, "Poisson's ratio 0.4999999", v[0])->finite);
  assert_true(row_of(&all, "Young's modulus 0", v[0])->force_error == 0);
  cb_extremes_free(&all);
}

static int iterations_of(const struct cb_extreme *r) {
  double residual;
  int n = 0;
  assert_int_equal(sscanf(r->note, "residual %lf after %d", &residual, &n), 2);
  return n;
}

/* The stiffer the other half, the more iterations; the sum stays accurate. */
static void a_contrast_costs_iterations_not_accuracy(void **state) {
  (void)state;
  const struct cb_variant *v[] = {variant("qr-updated/ebe/f64"), variant("qr-updated/ebe/f32"),
                                  NULL};
  struct cb_extremes all = swept("contrast", v);
  for (int n = 0; n < 2; n++) {
    const int even = iterations_of(row_of(&all, "Young's moduli 1 : 1", v[n]));
    const int some = iterations_of(row_of(&all, "Young's moduli 1 : 1e+06", v[n]));
    const int most = iterations_of(row_of(&all, "Young's moduli 1 : 1e+12", v[n]));
    assert_true(even < some && some < most);
  }
  for (size_t i = 0; i < all.count; i++) assert_int_equal(cb_extreme_state(&all.row[i]), CB_RIGHT);
  cb_extremes_free(&all);
}

/* ---- steps ------------------------------------------------------------------------------ */

/* 2 / omega of the fastest mode of M^-1 K at rest, s. */
static double longest_step(const struct cb_variant *v, const struct cb_bench_scene *s) {
  const size_t n = 3 * s->mesh.nodes;
  double *A = malloc(n * n * sizeof *A), *u = malloc(n * sizeof *u), *y = malloc(n * sizeof *y);
  struct cb_probe probe;
  assert_true(A && u && y);
  assert_int_equal(cb_probe_open(v, &s->mesh, &s->material, &probe), CB_OK);
  cb_probe_force(&probe, s->mesh.X, y);
  for (size_t j = 0; j < n; j++) {
    for (size_t i = 0; i < n; i++) u[i] = i == j;
    cb_probe_product(&probe, u, y);
    for (size_t i = 0; i < n; i++) A[n * i + j] = y[i] / sqrt(s->mass[i / 3] * s->mass[j / 3]);
  }
  assert_int_equal(cb_oracle_eigenvalues(n, A, y), CB_OK);
  const double h = 2 / sqrt(y[n - 1]);
  cb_probe_close(&probe);
  free(A);
  free(u);
  free(y);
  return h;
}

/* Symplectic Euler of a linear body is stable below 2 / omega and nowhere above. */
static void the_largest_explicit_step_is_that_of_theory(void **state) {
  (void)state;
  const struct cb_variant *v = variant("linear/ebe/f64");
  struct cb_bench_scene body;
  struct cb_swing s;
  assert_int_equal(cb_swing_body(2005, &body), CB_OK);
  const double h = longest_step(v, &body);
  assert_int_equal(cb_swing(v, &body, CB_EXPLICIT, 0.9 * h, 1000, 100, &s), CB_OK);
  assert_true(s.finite && s.most < 10);
  assert_int_equal(cb_swing(v, &body, CB_EXPLICIT, 1.02 * h, 1000, 100, &s), CB_OK);
  assert_false(s.finite && s.most < 10);
  cb_bench_scene_free(&body);
  const struct cb_variant *list[] = {v, NULL};
  struct cb_extremes all = swept("steps", list);
  const struct cb_extreme *r = row_of(&all, "symplectic Euler: largest stable step, s", v);
  /* the energy is ten times at 0.95 h, and five halvings of a decade leave 7 percent */
  assert_true(r->value < 1.02 * h && r->value > 0.95 * h / 1.075);
  assert_true(all.step_count == 7);
  cb_extremes_free(&all);
}

/* The exact gradient keeps both momenta; a stale B turns the body. */
static void only_a_ghost_torque_changes_a_momentum(void **state) {
  (void)state;
  struct cb_bench_scene one;
  struct cb_swing kept, turned;
  assert_int_equal(cb_swing_tetrahedron(2005, &one), CB_OK);
  assert_int_equal(cb_swing(variant("qr-exact/ebe/f64"), &one, CB_EXPLICIT, 1e-4, 20000, 10, &kept),
                   CB_OK);
  assert_int_equal(
      cb_swing(variant("qr-precomputed/ebe/f64"), &one, CB_EXPLICIT, 1e-4, 20000, 10, &turned),
      CB_OK);
  /* 20000 steps of a rounding each, which do not all go one way */
  assert_within("momentum", kept.momentum, 20000 * 0x1p-53);
  assert_within("momentum, stale B", turned.momentum, 20000 * 0x1p-53);
  assert_within("angular momentum", kept.angular, 20000 * 0x1p-53);
  assert_true(turned.angular > 1e-3);
  cb_bench_scene_free(&one);
}

/* The direct solver takes one storage, and says so. */
static void an_integrator_refuses_what_it_cannot(void **state) {
  (void)state;
  struct cb_bench_scene body;
  struct cb_swing s;
  assert_int_equal(cb_swing_body(2005, &body), CB_OK);
  assert_int_equal(cb_swing(variant("linear/ebe/f64"), &body, CB_IMPLICIT_DIRECT, 1, 1, 1, &s),
                   CB_INPUT);
  assert_int_equal(cb_swing(variant("linear/bcsr/f64"), &body, CB_IMPLICIT_DIRECT, 1, 9, 3, &s),
                   CB_OK);
  assert_true(s.finite && s.most <= 1 + 1e-12); /* backward Euler only loses energy */
  cb_bench_scene_free(&body);
}

/* ---- systems and inputs -------------------------------------------------------------------- */

static bool says(const struct cb_extreme *r, const char *words) {
  return strncmp(r->note, words, strlen(words)) == 0;
}

static void what_a_system_is_is_said(void **state) {
  (void)state;
  const struct cb_variant *v[] = {variant("green/ebe/f64"), variant("green/ebe/f32"),
                                  variant("linear/ebe/f64"), NULL};
  struct cb_extremes all = swept("breakdown", v);
  for (int n = 0; n < 3; n++) {
    const bool linear = n == 2;
    assert_true(says(row_of(&all, "squeezed to 0.3", v[n]), "not positive definite") == !linear);
    assert_true(says(row_of(&all, "no stiffness", v[n]), "solved"));
    assert_true(says(row_of(&all, "no stiffness, no mass", v[n]), "not positive definite after 0"));
    assert_true(
        says(row_of(&all, "isolated nodes under load", v[n]), "not positive definite after"));
    assert_true(says(row_of(&all, "everything fixed", v[n]), "solved after 0"));
    assert_true(says(row_of(&all, "a position NaN", v[n]), "not finite after 0"));
    assert_true(says(row_of(&all, "a position infinite", v[n]), "not finite after 0"));
  }
  for (size_t i = 0; i < all.count; i++) assert_string_equal(all.row[i].law, "");
  cb_extremes_free(&all);
}

static void files_are_right_or_refused(void **state) {
  (void)state;
  const struct cb_variant *v[] = {variant("linear/ebe/f64"), NULL};
  struct cb_extremes all = swept("inputs", v);
  size_t files = 0, refused = 0;
  for (size_t i = 0; i < all.count; i++) {
    const struct cb_extreme *r = &all.row[i];
    if (strncmp(r->parameter, "mesh", 4) != 0 && strncmp(r->parameter, "positions", 9) != 0)
      continue;
    files++, refused += says(r, "refused: ");
    if (!r->finite) fail_msg("%s: %s", r->parameter, r->note);
  }
  assert_int_equal(files, 15);
  assert_int_equal(refused, 13);
  cb_extremes_free(&all);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(any_material_is_accurate),
      cmocka_unit_test(a_contrast_costs_iterations_not_accuracy),
      cmocka_unit_test(the_largest_explicit_step_is_that_of_theory),
      cmocka_unit_test(only_a_ghost_torque_changes_a_momentum),
      cmocka_unit_test(an_integrator_refuses_what_it_cannot),
      cmocka_unit_test(what_a_system_is_is_said),
      cmocka_unit_test(files_are_right_or_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
