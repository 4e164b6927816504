/* What can be set at run time: iterations and tolerance of a frame, and how long B is
 * kept.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "harness/verify/patches.h"
#include "harness/verify/probe.h"

enum { PATCHES = 60 };

struct shapes {
  struct cb_patches patches;
  struct cb_material material;
  size_t numbers;
  double *f, *g;
};

static int make(void **state) {
  struct shapes *s = calloc(1, sizeof *s);
  if (!s || cb_patches_random(PATCHES, 1, 0.2, 2005, &s->patches)) return -1;
  s->numbers = 3 * s->patches.mesh.nodes;
  s->f = malloc(s->numbers * sizeof *s->f);
  s->g = malloc(s->numbers * sizeof *s->g);
  *state = s;
  return s->f && s->g && cb_material_isotropic(1000, 0.3, 1000, &s->material) == CB_OK ? 0 : -1;
}

static int unmake(void **state) {
  struct shapes *s = *state;
  cb_patches_free(&s->patches);
  free(s->f);
  free(s->g);
  free(s);
  return 0;
}

/* f := forces at x, after those at the shape before it. */
static void force(const struct shapes *s, const char *variant, const struct cb_tuning *tuning,
                  double *f) {
  struct cb_probe p;
  assert_int_equal(cb_probe_open(cb_variant_find(variant), &s->patches.mesh, &s->material, &p),
                   CB_OK);
  if (tuning) assert_int_equal(cb_operator_tune(p.op, tuning), CB_OK);
  cb_probe_force(&p, s->patches.before, f);
  cb_probe_force(&p, s->patches.x, f);
  cb_probe_close(&p);
}

/* The worst patch. */
static double difference(const struct shapes *s, const double *f, const double *g) {
  const size_t each = s->numbers / PATCHES;
  double worst = 0;
  for (size_t n = 0; n < PATCHES; n++) {
    double d = 0, size = 0;
    for (size_t i = n * each; i < (n + 1) * each; i++)
      d += (f[i] - g[i]) * (f[i] - g[i]), size += g[i] * g[i];
    worst = fmax(worst, sqrt(d / size));
  }
  return worst;
}

/* Worst relative torque of the patches. */
static double torque(const struct shapes *s, const double *f) {
  const size_t each = s->patches.nodes;
  double worst = 0;
  for (size_t n = 0; n < PATCHES; n++) {
    double t[3] = {0}, lever = 0;
    const double *c = s->patches.x + 3 * n * each;
    for (size_t i = n * each; i < (n + 1) * each; i++) {
      const double *F = f + 3 * i;
      double r[3];
      for (int k = 0; k < 3; k++) r[k] = s->patches.x[3 * i + k] - c[k];
      for (int k = 0; k < 3; k++)
        t[k] += r[(k + 1) % 3] * F[(k + 2) % 3] - r[(k + 2) % 3] * F[(k + 1) % 3];
      lever += sqrt((r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) *
                    (F[0] * F[0] + F[1] * F[1] + F[2] * F[2]));
    }
    worst = fmax(worst, sqrt(t[0] * t[0] + t[1] * t[1] + t[2] * t[2]) / lever);
  }
  return worst;
}

static void enough_iterations_are_the_model_itself(void **state) {
  struct shapes *s = *state;
  const struct cb_tuning many = {.frame_iterations = 30};
  force(s, "polar-higham-precomputed/ebe/f64", NULL, s->g);
  force(s, "polar-higham-tuned/ebe/f64", &many, s->f);
  assert_true(difference(s, s->f, s->g) < 1e-11);
  force(s, "polar-quaternion-precomputed/ebe/f64", NULL, s->g);
  force(s, "polar-quaternion-tuned/ebe/f64", NULL, s->f); /* four turns, as that one */
  assert_true(difference(s, s->f, s->g) < 1e-11);
}

/* A truncated Newton iterate is R g(S): no torque. A quaternion's is not. */
static void a_frame_that_ends_early_may_make_a_torque(void **state) {
  struct shapes *s = *state;
  double before = 1;
  for (size_t n = 1; n <= 6; n++) {
    const struct cb_tuning tuning = {.frame_iterations = n};
    force(s, "polar-higham-tuned/ebe/f64", &tuning, s->f);
    assert_true(torque(s, s->f) < 1e-13);
    force(s, "polar-quaternion-tuned/ebe/f64", &tuning, s->f);
    const double now = torque(s, s->f);
    assert_true(now > 1e-9 && now < before);
    before = now;
  }
}

static void a_tolerance_ends_where_iterations_would(void **state) {
  struct shapes *s = *state;
  const struct cb_tuning rough = {.frame_iterations = 50, .frame_tolerance = 1e-3};
  const struct cb_tuning fine = {.frame_iterations = 50, .frame_tolerance = 1e-12};
  force(s, "polar-higham-precomputed/ebe/f64", NULL, s->g);
  force(s, "polar-quaternion-tuned/ebe/f64", &rough, s->f);
  const double far = difference(s, s->f, s->g);
  force(s, "polar-quaternion-tuned/ebe/f64", &fine, s->f);
  const double near = difference(s, s->f, s->g);
  assert_true(near < 1e-9 && far > 10 * near && far < 1);
}

static void lazy_updates_have_their_limits(void **state) {
  struct shapes *s = *state;
  static const char *const pairs[][2] = {
      {"qr-lazy/ebe/f64", "qr-updated/ebe/f64"},
      {"qr-lazy/ebe-paper/f64", "qr-updated/ebe-paper/f64"},
      {"polar-closed-lazy/ebe/f64", "polar-closed-updated/ebe/f64"},
      {"polar-closed-lazy/ebe-paper/f64", "polar-closed-updated/ebe-paper/f64"},
      {"polar-closed-lazy/ebe-cluster/f64", "polar-closed-updated/ebe/f64"}};
  for (size_t n = 0; n < sizeof pairs / sizeof *pairs; n++) {
    const struct cb_tuning always = {0}, never = {.lazy = 1e9};
    force(s, pairs[n][1], NULL, s->g);
    force(s, pairs[n][0], &always, s->f);
    assert_true(difference(s, s->f, s->g) < 1e-11);
    force(s, pairs[n][0], &never, s->f); /* B of the shape before */
    assert_true(difference(s, s->f, s->g) > 1e-3);
    assert_true(torque(s, s->f) > 1e-5);
  }
}

static void who_has_no_knob_refuses(void **state) {
  struct shapes *s = *state;
  struct cb_probe p;
  const struct cb_tuning frame = {.frame_iterations = 2}, lazy = {.lazy = 0.1}, none = {0};
  assert_int_equal(
      cb_probe_open(cb_variant_find("qr-updated/ebe/f64"), &s->patches.mesh, &s->material, &p),
      CB_OK);
  assert_int_equal(cb_operator_tune(p.op, &none), CB_OK);
  assert_int_equal(cb_operator_tune(p.op, &frame), CB_INPUT);
  assert_int_equal(cb_operator_tune(p.op, &lazy), CB_INPUT);
  cb_probe_close(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(enough_iterations_are_the_model_itself),
      cmocka_unit_test(a_frame_that_ends_early_may_make_a_torque),
      cmocka_unit_test(a_tolerance_ends_where_iterations_would),
      cmocka_unit_test(lazy_updates_have_their_limits),
      cmocka_unit_test(who_has_no_knob_refuses),
  };
  return cmocka_run_group_tests(tests, make, unmake);
}
