/* test_scene_cost.c - what a scene does not ask for costs nothing: counted operations of a step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/verify/counter.h"
#include "tests/body.h"

static unsigned long all_operations(void) {
  struct cb_counts c[STAGES];
  unsigned long sum = 0;
  cb_counter_read(c);
  for (int i = 0; i < STAGES; i++) sum += c[i].mul + c[i].add + c[i].div + c[i].sqrt;
  return sum;
}

/* Operations of one step of the bare kernel, on the body's own start. */
static unsigned long bare(const struct cb_body *b, const void *external, double alpha,
                          double beta) {
  const struct cb_variant *v = cb_variant_find("qr-updated/ebe/counted");
  const struct cb_step_parameters step = {1e-3, alpha, beta, 3};
  struct cb_job job;
  assert_int_equal(cb_job_create(v, 1, &b->at, &step, &job), CB_OK);
  cb_counter_reset();
  cb_stepper_step(job.stepper, job.x, job.v, external);
  const unsigned long sum = all_operations();
  cb_job_free(&job);
  return sum;
}

/* The same within a run of the scene: what two runs of ten and of twenty steps differ by. */
static unsigned long in_scene(struct cb_scene s) {
  unsigned long sum[2];
  for (int n = 0; n < 2; n++) {
    struct cb_body b;
    static struct cb_outcome o;
    s.duration = 10 * (n + 1) * 1e-3;
    assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
    const struct cb_trial t = trial("qr-updated/ebe/counted", 3);
    cb_counter_reset();
    assert_int_equal(cb_body_run(&b, &t, &o), CB_OK);
    sum[n] = all_operations();
    cb_body_free(&b);
  }
  return (sum[1] - sum[0]) / 10;
}

static void what_is_absent_costs_nothing(void **state) {
  (void)state;
  struct cb_scene s = plain();
  struct cb_body b;
  s.cells[2] = 2;
  s.fixed[0] = (struct cb_selection){{0, 0, 0}, {1, 1, 0}}, s.fixed_count = 1;
  s.twist = 0.2;
  assert_int_equal(cb_body_create(&s, 1, &b), CB_OK);
  assert_null(b.external);
  const unsigned long least = bare(&b, NULL, 0, 0);
  assert_int_equal(in_scene(s), least);
  struct cb_scene with = s; /* gravity: h f is added to each number of the right-hand side */
  with.gravity[2] = -10;
  assert_int_equal(in_scene(with), least + 3 * b.at.mesh.nodes);
  with = s; /* damping by mass takes work, by stiffness none: it is in c */
  with.beta = 1;
  assert_true(in_scene(with) > least);
  with = s;
  with.alpha = 1e-3;
  assert_int_equal(in_scene(with), least);
  with = s; /* a ground looks at positions, until somebody is on it */
  with.grounded = true, with.ground = -1;
  assert_int_equal(in_scene(with), least);
  with = s; /* handles are moved, not computed */
  with.handle[0] = (struct cb_handle){{{0, 0, 1}, {1, 1, 1}}, {0, 0, 1}, {0}, 0.01, 0};
  with.handle_count = 1;
  assert_int_equal(in_scene(with), least);
  cb_body_free(&b);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_absent_costs_nothing),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
