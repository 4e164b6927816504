/* test_scene_run.c - what a body made of a scene does: points, falls, handles, truth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/error.h"
#include "tests/body.h"

static void points_follow_an_affine_motion(void **state) {
  (void)state;
  static const double resolutions[] = {0.5, 1, 2};
  static const double A[9] = {1.2, 0.3, 0, -0.1, 0.9, 0.2, 0.4, 0, 1.1};
  struct cb_scene s = plain();
  for (size_t r = 0; r < 3; r++) {
    struct cb_body b;
    double p[3 * CB_POINTS], q[3 * CB_POINTS];
    assert_int_equal(cb_body_create(&s, resolutions[r], &b), CB_OK);
    cb_body_points(&b, b.at.mesh.X, p);
    for (size_t i = 0; i < 3 * b.at.mesh.nodes; i++) {
      const double *X = b.at.mesh.X + i / 3 * 3, *row = A + 3 * (i % 3);
      b.at.x[i] = row[0] * X[0] + row[1] * X[1] + row[2] * X[2];
    }
    cb_body_points(&b, b.at.x, q);
    for (size_t i = 0; i < 3 * CB_POINTS; i++) {
      const double *P = p + i / 3 * 3, *row = A + 3 * (i % 3);
      assert_true(fabs(q[i] - (row[0] * P[0] + row[1] * P[1] + row[2] * P[2])) < 1e-14);
    }
    /* the same places at every resolution: the corners of a grid of 4 x 4 x 4 */
    assert_true(fabs(p[3 * 63 + 2] - 0.15) < 1e-14 && fabs(p[3 * 1] - 0.1 / 3) < 1e-14);
    cb_body_free(&b);
  }
}

/* The surface of a shape is another one at every resolution. */
static void points_of_a_shape_are_the_same_in_every_mesh(void **state) {
  (void)state;
  static const double resolutions[] = {0.4, 0.6, 1, 1.5};
  static const char *const shapes[] = {"rabbit", "liver"};
  for (size_t n = 0; n < 2; n++) {
    struct cb_scene s = plain();
    double p[3 * CB_POINTS], q[3 * CB_POINTS];
    snprintf(s.shape, sizeof s.shape, "%s", shapes[n]);
    s.cells[0] = 12, s.cell = 0.3;
    for (size_t r = 0; r < 4; r++) {
      struct cb_body b;
      assert_int_equal(cb_body_create(&s, resolutions[r], &b), CB_OK);
      cb_body_points(&b, b.at.mesh.X, r ? q : p);
      for (size_t i = 0; r && i < 3 * CB_POINTS; i++) assert_true(fabs(q[i] - p[i]) < 1e-14);
      /* continued by no more than some cells: strains at the surface are not blown up */
      for (size_t i = 0; i < 4 * CB_POINTS; i++)
        assert_true(fabs(b.point[i / 4].weight[i % 4]) < 5);
      cb_body_free(&b);
    }
    double low = INFINITY, high = -INFINITY; /* they reach from end to end of the body */
    for (size_t i = 0; i < 3 * CB_POINTS; i += 3) low = fmin(low, p[i]), high = fmax(high, p[i]);
    assert_true(high - low > 0.9 * 0.3);
  }
}

/* Backward Euler: v = g n h, x = g h^2 n (n + 1) / 2. */
static void what_nothing_holds_falls(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  static struct cb_outcome o;
  s.gravity[2] = -10;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  const struct cb_trial t = trial("polar-exact/bcsr/f64", 0);
  assert_int_equal(cb_body_run(&b, &t, &o), CB_OK);
  assert_true(o.finite && o.steps == 100 && o.inverted == 0);
  const double fallen = -10 * 1e-6 * 100 * 101 / 2;
  assert_true(fabs(o.point[CB_SAMPLES - 1][3 * 5 + 2] - fallen) < 1e-12);
  assert_true(o.step_s > 0 && fabs(o.seconds - o.step_s / 1e-3) < 1e-9 * o.seconds);
  cb_body_free(&b);
}

static void handles_end_where_they_should(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  static struct cb_outcome cg, direct, again;
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.handle[0] = (struct cb_handle){{{0, 0, 1}, {1, 1, 1}}, {0, 0, 1}, {0, 0, 0.02}, 0.05, 0};
  s.handle_count = 1;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  const struct cb_trial t = trial("polar-exact/ebe/f64", 60), d = trial("polar-exact/bcsr/f64", 0);
  assert_int_equal(cb_body_run(&b, &t, &cg), CB_OK);
  assert_int_equal(cb_body_run(&b, &d, &direct), CB_OK);
  assert_int_equal(cb_body_run(&b, &t, &again), CB_OK);
  /* the far corner, turned by 1 rad about (0.05, 0.05) and lifted */
  const double *p = cg.point[CB_SAMPLES - 1] + 3 * 63;
  assert_true(fabs(p[0] - (0.05 + 0.05 * (cos(1) - sin(1)))) < 1e-12);
  assert_true(fabs(p[1] - (0.05 + 0.05 * (sin(1) + cos(1)))) < 1e-12);
  assert_true(fabs(p[2] - 0.17) < 1e-12);
  /* iterated to the end is solved directly; and the same again */
  assert_true(cb_outcome_error(&cg, &direct, b.size) < 1e-9);
  assert_memory_equal(cg.point, again.point, sizeof cg.point);
  cb_body_free(&b);
}

/* Everything that a right-hand side may have in it. */
static void solved_directly_is_iterated_to_the_end(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  static struct cb_outcome cg, direct, other;
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.load[0] = (struct cb_load){{{0, 0, 1}, {1, 1, 1}}, {2, 0, 1}}, s.load_count = 1;
  s.gravity[1] = -10, s.twist = 0.3, s.alpha = 2e-3, s.beta = 3;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  const struct cb_trial t = trial("polar-exact/ebe/f64", 80), d = trial("polar-exact/bcsr/f64", 0);
  assert_int_equal(cb_body_run(&b, &t, &cg), CB_OK);
  assert_int_equal(cb_body_run(&b, &d, &direct), CB_OK);
  assert_true(cb_outcome_error(&cg, &direct, b.size) < 1e-9);
  double *const parts[] = {&s.alpha, &s.beta, &s.gravity[1], &s.load[0].force[0]};
  for (size_t i = 0; i < 4; i++) { /* and each of them is there */
    const double kept = *parts[i];
    struct cb_body without;
    *parts[i] = 0;
    assert_int_equal(cb_body_create(&s, 1, &without), CB_OK);
    assert_int_equal(cb_body_run(&without, &d, &other), CB_OK);
    assert_true(cb_outcome_error(&other, &direct, b.size) > 1e-5);
    cb_body_free(&without);
    *parts[i] = kept;
  }
  cb_body_free(&b);
}

/* Halving the step halves the distance to the truth; the truth's own is a tenth. */
static void the_truth_is_the_limit(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  static struct cb_outcome truth, iterated, o;
  double error[2];
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.twist = 0.5, s.duration = 0.05;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  assert_int_equal(cb_body_truth(&b, &truth), CB_OK);
  assert_int_equal(cb_body_truth_iterated(&b, 1, &iterated), CB_OK);
  assert_true(cb_outcome_error(&iterated, &truth, b.size) < 1e-9);
  assert_true(cb_outcome_error(&truth, &truth, b.size) == 0);
  for (int n = 0; n < 2; n++) {
    struct cb_trial t = trial("polar-exact/bcsr/f64", 0);
    t.step /= 1 << n;
    assert_int_equal(cb_body_run(&b, &t, &o), CB_OK);
    error[n] = cb_outcome_error(&o, &truth, b.size);
  }
  assert_true(error[0] > 1e-4 && error[0] > 1.5 * error[1] && error[0] < 3 * error[1]);
  cb_body_free(&b);
}

static void what_is_not_finite_is_refused(void **state) {
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  struct cb_body b;
  for (int n = 0; n < 3; n++)
    for (int where = 0; where < 4; where++) {
      struct cb_scene s = plain();
      *(where == 0   ? s.velocity
        : where == 1 ? s.spin + 1
        : where == 2 ? s.gravity + 2
                     : s.stretch) = bad[n];
      assert_int_equal(cb_body_create(&s, 1, &b), CB_INPUT);
      assert_non_null(strstr(cb_error_message(), "not a finite number"));
    }
}

static void a_broken_run_is_an_outcome(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  static struct cb_outcome o, truth;
  s.velocity[0] = 1e300; /* finite, its square is not */
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  const struct cb_trial t = trial("qr-updated/ebe/f64", 5);
  assert_int_equal(cb_body_run(&b, &t, &o), CB_OK);
  assert_false(o.finite);
  assert_true(isnan(cb_outcome_error(&o, &truth, b.size)) && isnan(o.torque));
  cb_body_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_follow_an_affine_motion),
      cmocka_unit_test(points_of_a_shape_are_the_same_in_every_mesh),
      cmocka_unit_test(what_nothing_holds_falls),
      cmocka_unit_test(handles_end_where_they_should),
      cmocka_unit_test(solved_directly_is_iterated_to_the_end),
      cmocka_unit_test(the_truth_is_the_limit),
      cmocka_unit_test(what_is_not_finite_is_refused),
      cmocka_unit_test(a_broken_run_is_an_outcome),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
