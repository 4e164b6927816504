/* What changes while a scene runs: a ground, stiffness in stages, handles that let go; and how
 * far a shape is from rest.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/scene/run.h"

/* A block of 0.1 x 0.1 x 0.15 m; 100 steps. */
static struct cb_scene block(double young) {
  struct cb_scene s = {.name = "block",
                       .cells = {2, 2, 3},
                       .cell = 0.05,
                       .stretch = {1, 1, 1},
                       .step = 1e-3,
                       .duration = 0.1};
  assert_int_equal(cb_material_isotropic(young, 0.3, 1000, &s.material), CB_OK);
  return s;
}

/* Positions at every step. */
struct track {
  size_t nodes, steps;
  double *x;
};

static enum cb_status see(void *context, double t, const double *x) {
  struct track *track = context;
  (void)t;
  memcpy(track->x + 3 * track->nodes * track->steps++, x, 3 * track->nodes * sizeof *x);
  return CB_OK;
}

static struct track run(const struct cb_scene *s, const char *variant, size_t iterations,
                        struct cb_outcome *o) {
  const struct cb_trial trial = {
      .variant = cb_variant_find(variant), .threads = 1, .iterations = iterations, .step = s->step};
  struct cb_body b;
  assert_int_equal(cb_body_create(s, 1, &b), CB_OK);
  struct track track = {.nodes = b.at.mesh.nodes};
  const struct cb_watch watch = {1, see, &track};
  track.x = malloc(3 * track.nodes * 102 * sizeof *track.x);
  assert_non_null(track.x);
  assert_int_equal(cb_body_show(&b, &trial, &watch, o), CB_OK);
  assert_true(o->finite && track.steps == 101);
  cb_body_free(&b);
  return track;
}

static double lowest(const struct track *t, size_t step) {
  double low = INFINITY;
  for (size_t i = 0; i < t->nodes; i++) low = fmin(low, t->x[3 * (step * t->nodes + i) + 2]);
  return low;
}

/* ---- ground ------------------------------------------------------------------------------ */

static void no_node_is_below_the_ground(void **state) {
  (void)state;
  static const char *const variants[] = {"polar-exact/ebe/f64", "polar-exact/ebe/f32",
                                         "polar-exact/bcsr/f64"};
  static struct cb_outcome o;
  struct cb_scene s = block(1e5);
  s.gravity[2] = -10, s.velocity[2] = -1;
  s.grounded = true, s.ground = -0.0625; /* exact in float */
  for (size_t v = 0; v < 3; v++) {
    struct track t = run(&s, variants[v], v == 2 ? 0 : 30, &o);
    for (size_t n = 0; n < t.steps; n++) assert_true(lowest(&t, n) >= s.ground);
    assert_true(lowest(&t, 0) == 0 && lowest(&t, 75) == s.ground);
    free(t.x);
  }
}

static void dust_lies_flat(void **state) {
  (void)state;
  static struct cb_outcome o;
  struct cb_scene s = block(0);
  s.gravity[2] = -100, s.grounded = true, s.ground = -0.01;
  struct track t = run(&s, "polar-exact/ebe/f64", 5, &o);
  for (size_t i = 0; i < 3 * t.nodes; i++) { /* and nothing has moved sideways */
    const double end = t.x[3 * t.nodes * 100 + i];
    assert_true(end == (i % 3 == 2 ? s.ground : t.x[i]));
  }
  assert_true(o.distance > 0.3 && o.inverted == 0);
  free(t.x);
}

/* It takes up the blow, not the recoil; without one it keeps what it holds. */
static void the_ground_lets_go_of_what_is_pulled_up(void **state) {
  (void)state;
  static struct cb_outcome o;
  struct cb_scene s = block(1e5);
  s.velocity[2] = -1, s.grounded = true, s.ground = -0.005;
  struct track t = run(&s, "polar-exact/ebe/f64", 60, &o);
  double least = INFINITY;
  for (size_t n = 0; n < t.steps; n++) least = fmin(least, lowest(&t, n));
  assert_true(least == s.ground && lowest(&t, 100) > s.ground + 1e-3);
  free(t.x);
  s.gravity[2] = -50, s.beta = 50; /* pressed down it stays, sunk by about rho g h / 2 E */
  t = run(&s, "polar-exact/ebe/f64", 60, &o);
  assert_true(lowest(&t, 100) == s.ground && o.distance < 0.075);
  free(t.x);
}

/* ---- stages ---------------------------------------------------------------------------------- */

/* Nothing moves without stiffness; from then on all is as if it began there. */
static void a_stage_is_a_beginning(void **state) {
  (void)state;
  static const char *const variants[] = {"polar-exact/ebe/f64", "qr-exact/bcsr/f64"};
  static struct cb_outcome o;
  struct cb_scene stiff = block(1e5), staged = block(0);
  staged.fixed[0] = stiff.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}};
  staged.fixed_count = stiff.fixed_count = 1;
  staged.twist = stiff.twist = 0.5;
  staged.stage[0] = (struct cb_stiffening){0.04, 1e5}, staged.stage_count = 1;
  for (size_t v = 0; v < 2; v++) {
    struct track a = run(&stiff, variants[v], v ? 0 : 20, &o);
    struct track b = run(&staged, variants[v], v ? 0 : 20, &o);
    const size_t n = 3 * a.nodes;
    for (size_t i = 0; i < n * 40; i++) assert_true(b.x[n + i] == b.x[i % n]);
    assert_memory_equal(b.x + 40 * n, a.x, 61 * n * sizeof *a.x);
    assert_true(a.x[n - 1] != a.x[61 * n - 1]); /* it does move */
    free(a.x);
    free(b.x);
  }
}

static void stages_follow_each_other(void **state) {
  (void)state;
  static struct cb_outcome soft, o;
  struct cb_scene s = block(1e5);
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.gravity[2] = -10;
  struct track a = run(&s, "polar-exact/ebe/f64", 20, &soft);
  s.stage[0] = (struct cb_stiffening){0.02, 1e7}, s.stage[1] = (struct cb_stiffening){0.05, 1e5};
  s.stage_count = 2;
  struct track b = run(&s, "polar-exact/ebe/f64", 20, &o);
  const size_t n = 3 * a.nodes;
  assert_memory_equal(a.x, b.x, 21 * n * sizeof *a.x); /* alike up to the first, and not after */
  assert_true(memcmp(a.x + 21 * n, b.x + 21 * n, n * sizeof *a.x) != 0);
  double sunk[2] = {0, 0}; /* the stiff one less */
  for (size_t i = 2; i < n; i += 3) {
    sunk[0] += a.x[i] - a.x[50 * n + i];
    sunk[1] += b.x[i] - b.x[50 * n + i];
  }
  assert_true(sunk[1] < sunk[0] / 2 && sunk[0] > 0);
  free(a.x);
  free(b.x);
}

/* ---- handles ------------------------------------------------------------------------------------
 */

/* Held to the very end of its time, then falling from rest by backward Euler: g h^2 n (n + 1) / 2.
 */
static void what_is_let_go_falls_from_rest(void **state) {
  (void)state;
  static const char *const variants[] = {"polar-exact/ebe/f64", "polar-exact/bcsr/f64"};
  static struct cb_outcome o;
  struct cb_scene s = block(0);
  s.gravity[2] = -10;
  s.handle[0] = (struct cb_handle){{{0, 0, 1}, {1, 1, 1}}, {0}, {0.02, 0, 0.03}, 0.03, 0.06};
  s.handle_count = 1;
  for (size_t v = 0; v < 2; v++) {
    struct track t = run(&s, variants[v], v ? 0 : 5, &o);
    for (size_t n = 0; n < t.steps; n++)
      for (size_t i = 0; i < t.nodes; i++) {
        const double *X = t.x + 3 * i, *x = t.x + 3 * (n * t.nodes + i);
        const double way = fmin(1, (double)n / 30), fallen = n > 60 ? (double)(n - 60) : 0;
        if (X[2] < 0.14) continue;
        assert_true(fabs(x[0] - X[0] - 0.02 * way) < 1e-12);
        assert_true(fabs(x[2] - X[2] - 0.03 * way + 10e-6 * fallen * (fallen + 1) / 2) < 1e-12);
      }
    free(t.x);
  }
}

/* A handle without an end holds to the end of the scene; what is fixed as well stays fixed. */
static void what_is_fixed_is_not_let_go(void **state) {
  (void)state;
  static struct cb_outcome o;
  struct cb_scene s = block(1e5);
  s.gravity[2] = -10;
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.handle[0] = (struct cb_handle){{{0, 0, 0}, {0, 1, 1}}, {0}, {0}, 0.01, 0.05};
  s.handle[1] = (struct cb_handle){{{1, 0, 1}, {1, 0, 1}}, {0}, {0}, 0.01, 0};
  s.handle_count = 2;
  struct track t = run(&s, "polar-exact/ebe/f64", 20, &o);
  double moved = 0;
  for (size_t i = 0; i < t.nodes; i++) {
    const double *X = t.x + 3 * i, *x = t.x + 3 * (100 * t.nodes + i);
    const double way = hypot(hypot(x[0] - X[0], x[1] - X[1]), x[2] - X[2]);
    const bool corner = X[0] > 0.09 && X[1] < 0.01 && X[2] > 0.14;
    if (X[2] == 0 || corner) assert_true(way == 0);
    if (X[0] == 0) moved = fmax(moved, way);
  }
  assert_true(moved > 1e-4);
  free(t.x);
}

/* All of it at once, iterated to the end and solved directly. */
static void changes_are_the_same_for_both_solvers(void **state) {
  (void)state;
  static struct cb_outcome o;
  struct cb_scene s = block(1e4);
  s.gravity[2] = -10, s.velocity[2] = -0.5, s.grounded = true, s.ground = -0.003;
  s.stage[0] = (struct cb_stiffening){0.05, 1e5}, s.stage_count = 1;
  s.handle[0] = (struct cb_handle){{{0, 0, 1}, {0, 0, 1}}, {0}, {0.01, 0, 0}, 0.02, 0.04};
  s.handle_count = 1;
  struct track a = run(&s, "polar-exact/ebe/f64", 120, &o);
  struct track b = run(&s, "polar-exact/bcsr/f64", 0, &o);
  for (size_t i = 0; i < 3 * a.nodes * 101; i++) assert_true(fabs(a.x[i] - b.x[i]) < 1e-9);
  free(a.x);
  free(b.x);
}

/* ---- distance from rest
 * ----------------------------------------------------------------------------- */

static void only_the_shape_counts(void **state) {
  (void)state;
  struct cb_scene s = block(1);
  struct cb_body b;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  const double c = cos(2), d = sin(2);
  for (size_t i = 0; i < b.at.mesh.nodes; i++) {
    const double *X = b.at.mesh.X + 3 * i;
    double *x = b.at.x + 3 * i;
    x[0] = c * X[0] - d * X[1] + 7, x[1] = d * X[0] + c * X[1], x[2] = X[2] - 3;
  }
  assert_true(cb_body_distance(&b, b.at.x) < 1e-13);
  b.at.x[2] -= 0.015; /* a corner by a tenth of the size: the fit follows it somewhat */
  const double corner = cb_body_distance(&b, b.at.x);
  assert_true(corner < 0.1 && corner > 0.08);
  for (size_t i = 0; i < b.at.mesh.nodes; i++) b.at.x[3 * i] = -b.at.mesh.X[3 * i];
  for (size_t i = 0; i < b.at.mesh.nodes; i++)
    for (size_t k = 1; k < 3; k++) b.at.x[3 * i + k] = b.at.mesh.X[3 * i + k];
  assert_true(cb_body_distance(&b, b.at.x) > 0.3); /* mirrored: half a width at the least */
  b.at.x[5] = NAN;
  assert_true(isnan(cb_body_distance(&b, b.at.x)));
  cb_body_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(no_node_is_below_the_ground),
      cmocka_unit_test(dust_lies_flat),
      cmocka_unit_test(the_ground_lets_go_of_what_is_pulled_up),
      cmocka_unit_test(a_stage_is_a_beginning),
      cmocka_unit_test(stages_follow_each_other),
      cmocka_unit_test(what_is_let_go_falls_from_rest),
      cmocka_unit_test(what_is_fixed_is_not_let_go),
      cmocka_unit_test(changes_are_the_same_for_both_solvers),
      cmocka_unit_test(only_the_shape_counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
