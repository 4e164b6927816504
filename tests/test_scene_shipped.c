/* test_scene_shipped.c - the scenes that are shipped run, and are what they say.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/body.h"

/* A shipped scene's body. */
static struct cb_body shipped(const char *name, double resolution, struct cb_scene *s) {
  char path[96];
  struct cb_body b;
  snprintf(path, sizeof path, "scenes/%s.json", name);
  assert_int_equal(cb_scene_read(path, s), CB_OK);
  assert_string_equal(s->name, name);
  assert_int_equal(cb_body_create(s, resolution, &b), CB_OK);
  return b;
}

static void run_at_own_step(const struct cb_body *b, const char *variant, size_t iterations,
                            struct cb_outcome *o) {
  struct cb_trial t = trial(variant, iterations);
  t.step = b->scene->step;
  assert_int_equal(cb_body_run(b, &t, o), CB_OK);
  assert_true(o->finite);
}

static void shipped_scenes_run(void **state) {
  (void)state;
  glob_t files;
  assert_int_equal(glob("scenes/*.json", 0, NULL, &files), 0);
  assert_true(files.gl_pathc >= 6);
  for (size_t n = 0; n < files.gl_pathc; n++) {
    struct cb_scene s;
    struct cb_body b;
    static struct cb_outcome o;
    assert_int_equal(cb_scene_read(files.gl_pathv[n], &s), CB_OK);
    s.duration = 10 * s.step;
    assert_int_equal(cb_body_create(&s, 0.6, &b), CB_OK);
    run_at_own_step(&b, "polar-exact/ebe/f64", 20, &o);
    assert_true(o.steps == 10 && o.torque < 1e-12);
    cb_body_free(&b);
  }
  globfree(&files);
}

static double moved(const struct cb_body *b, const struct cb_outcome *o) {
  double rest[3 * CB_POINTS], most = 0;
  cb_body_points(b, b->at.mesh.X, rest);
  for (size_t n = 0; n < CB_SAMPLES * CB_POINTS; n++) {
    const double *p = o->point[n / CB_POINTS] + 3 * (n % CB_POINTS);
    const double *P = rest + 3 * (n % CB_POINTS);
    most = fmax(most, hypot(hypot(p[0] - P[0], p[1] - P[1]), p[2] - P[2]));
  }
  return most / b->size;
}

/* By how much the line between two corners turns about z, from look to look. */
static double turned(const struct cb_outcome *o) {
  double angle = 0, before = NAN;
  for (size_t n = 0; n < CB_SAMPLES; n++) {
    const double *p = o->point[n];
    const double now = atan2(p[3 * 63 + 1] - p[1], p[3 * 63] - p[0]);
    if (n) angle += remainder(now - before, 2 * M_PI);
    before = now;
  }
  return fabs(angle);
}

static void shipped_scenes_are_what_they_say(void **state) {
  (void)state;
  static struct cb_outcome truth, o;
  struct cb_scene s;
  struct cb_body b = shipped("small-displacement", 1, &s);
  run_at_own_step(&b, "polar-exact/bcsr/f64", 0, &o);
  assert_true(moved(&b, &o) < 1e-3);
  cb_body_free(&b);
  b = shipped("small-displacement", 0.5, &s); /* linear is enough */
  assert_int_equal(cb_body_truth(&b, &truth), CB_OK);
  run_at_own_step(&b, "linear/bcsr/f64", 0, &o);
  assert_true(cb_outcome_error(&o, &truth, b.size) <= s.needs.displacement);
  cb_body_free(&b);

  b = shipped("cantilever", 1, &s); /* bends far, and linear is not enough */
  run_at_own_step(&b, "polar-exact/bcsr/f64", 0, &truth);
  run_at_own_step(&b, "linear/bcsr/f64", 0, &o);
  assert_true(moved(&b, &truth) > 0.5 && cb_outcome_error(&o, &truth, b.size) > 0.1);
  cb_body_free(&b);

  b = shipped("stiff", 1, &s); /* few iterations are not enough, many are */
  assert_int_equal(cb_body_truth(&b, &truth), CB_OK);
  run_at_own_step(&b, "polar-exact/ebe/f64", 5, &o);
  assert_true(cb_outcome_error(&o, &truth, b.size) > 0.1);
  run_at_own_step(&b, "polar-exact/ebe/f64", 100, &o);
  assert_true(cb_outcome_error(&o, &truth, b.size) <= s.needs.displacement);
  cb_body_free(&b);

  b = shipped("spinning-body", 1, &s); /* from the first look to the last */
  run_at_own_step(&b, "polar-exact/bcsr/f64", 0, &o);
  assert_true(turned(&o) > 2.5 * 2 * M_PI && moved(&b, &o) > 1);
  cb_body_free(&b);
}

/* Half its step moves the truth by half of its error; so that what is held against it is
 * misjudged by no more than half of what the scene allows. */
static void the_truth_is_closer_than_what_is_held_against_it(void **state) {
  (void)state;
  static const char *const names[] = {"block",         "cantilever",         "twisted-bar",
                                      "spinning-body", "small-displacement", "stiff"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
    static struct cb_outcome truth, finer;
    struct cb_scene s;
    struct cb_body b = shipped(names[n], 0.5, &s);
    struct cb_trial t = trial("polar-exact/bcsr/f64", 0);
    t.step = s.step / 20;
    assert_int_equal(cb_body_truth(&b, &truth), CB_OK);
    assert_int_equal(cb_body_run(&b, &t, &finer), CB_OK);
    const double error = cb_outcome_error(&truth, &finer, b.size);
    if (!(error < s.needs.displacement / 4))
      fail_msg("%s: the truth moves by %g, %g is needed", names[n], error, s.needs.displacement);
    cb_body_free(&b);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shipped_scenes_run),
      cmocka_unit_test(shipped_scenes_are_what_they_say),
      cmocka_unit_test(the_truth_is_closer_than_what_is_held_against_it),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
