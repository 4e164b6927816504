/* test_motion.c - what a sequence of implicit steps keeps: fixed nodes, momentum,
 * finite numbers after convergence.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/block.h"

static void fixed_nodes_stay_to_the_last_bit(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  block_open(rng, false, &b);
  size_t nodes = b.scene.mesh.nodes;
  for (const struct cb_model *const *m = scene_f64()->models; *m; m++)
    for (int storage = 0; storage < CB_STORAGES; storage++) {
      struct cb_step_parameters p = damped[3];
      struct cb_variant v = {*m, (enum cb_storage)storage, scene_f64()};
      struct walk w;
      if (!(*m)->form[storage][0].update) continue;
      p.iterations = 7;
      walk_open(&w, &b, &v, &p, b.fixed);
      for (int n = 0; n < 20; n++) cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
      const double *x = w.r.x, *velocity = w.r.v;
      for (size_t i = 0; i < 3 * nodes; i++) {
        if (!b.fixed[i / 3]) {
          assert_true(x[i] != b.scene.x[i]);
          continue;
        }
        assert_memory_equal(x + i, b.scene.x + i, sizeof *x);
        assert_true(velocity[i] == 0);
      }
      walk_close(&w);
    }
  block_close(&b);
  gsl_rng_free(rng);
}

/* Of a free body in twenty steps: |sum of m dv| in roundings of sum of m |v|, the
 * worst of the models that keep Newton's law, and of those that do not. */
static void momentum_drift(struct block *b, size_t iterations, double *kept, double *broken) {
  enum { STEPS = 20 };
  struct cb_step_parameters p = damped[1];
  p.iterations = iterations;
  *kept = *broken = 0;
  for (const struct cb_model *const *m = scene_f64()->models; *m; m++)
    for (int storage = 0; storage < CB_STORAGES; storage++) {
      struct cb_variant v = {*m, (enum cb_storage)storage, scene_f64()};
      struct walk w;
      double change[3] = {0}, size = 0;
      if (!(*m)->form[storage][0].update) continue;
      walk_open(&w, b, &v, &p, NULL);
      for (int n = 0; n < STEPS; n++) cb_stepper_step(w.stepper, w.r.x, w.r.v, NULL);
      const double *velocity = w.r.v;
      for (size_t i = 0; i < 3 * NODES; i++) {
        change[i % 3] += b->mass[i / 3] * (velocity[i] - b->scene.v[i]);
        size += b->mass[i / 3] * (fabs(velocity[i]) + fabs(b->scene.v[i]));
      }
      double drift = norm(3, change) / (size * STEPS * 0x1p-53);
      double *worst = (*m)->laws[0] & CB_KEEPS(CB_LAW_NEWTON) ? kept : broken;
      if (!(drift <= *worst)) *worst = drift;
      walk_close(&w);
    }
}

/* Elastic forces sum to zero, but conjugate gradients that stop early see them
 * through A = M + c K: with unequal masses what is left of the residual has a sum. */
static void momentum_is_conserved(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  double kept, broken;
  block_open(rng, false, &b);
  momentum_drift(&b, 200, &kept, &broken);
  assert_within("converged", kept, 1);
  assert_true(broken > 1e6); /* node-warp */
  momentum_drift(&b, 5, &kept, &broken);
  assert_true(kept > 1e6); /* so much for unequal masses */
  for (size_t i = 0; i < NODES; i++) b.mass[i] = 100;
  momentum_drift(&b, 5, &kept, &broken);
  assert_within("equal masses", kept, 1);
  block_close(&b);
  gsl_rng_free(rng);
}

static void beta_brakes_a_rigid_flight(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  struct walk w;
  block_open(rng, false, &b);
  size_t nodes = b.scene.mesh.nodes;
  memcpy(b.scene.x, b.scene.mesh.X, 3 * nodes * sizeof *b.scene.x);
  for (size_t i = 0; i < 3 * nodes; i++) b.scene.v[i] = i % 3 == 1 ? 2 : 0;
  struct cb_variant v = f64_variant("qr-updated", CB_EBE);
  const struct cb_step_parameters *p = damped + 2;
  walk_open(&w, &b, &v, p, NULL);
  cb_stepper_step(w.stepper, w.r.x, w.r.v, NULL);
  for (size_t i = 0; i < 3 * nodes; i++) {
    double expected = b.scene.v[i] / (1 + p->h * p->beta);
    assert_within("velocity", fabs(((double *)w.r.v)[i] - expected) / 0x1p-53, 8);
  }
  walk_close(&w);
  block_close(&b);
  gsl_rng_free(rng);
}

/* 500 iterations for twelve unknowns, at rest, in motion, and with nothing to do. */
static void nothing_is_nan_after_convergence(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  const struct cb_step_parameters p = {.h = 0.01, .alpha = 0.01, .beta = 0.1, .iterations = 500};
  const struct cb_arithmetic *const both[] = {scene_f64(), scene_counted()};
  for (int trial = 0; trial < 3; trial++)
    for (int a = 0; a < 2; a++) {
      struct block b = {.scene = scene_new(rng, SCENE_ONE), .material = scene_material(false)};
      struct cb_variant v = {scene_model(both[a], "polar-exact"), CB_EBE, both[a]};
      struct walk w;
      quad q[12];
      cb_mesh_mass(&b.scene.mesh, b.material.density, b.mass);
      b.load = calloc(12, sizeof *b.load);
      assert_non_null(b.load);
      for (int i = 0; i < 12; i++) {
        if (trial > 0) b.scene.x[i] = b.scene.mesh.X[i];
        if (trial > 1) b.scene.v[i] = 0;
      }
      walk_open(&w, &b, &v, &p, NULL);
      for (int n = 0; n < 3; n++) cb_stepper_step(w.stepper, w.r.x, w.r.v, NULL);
      vector_read(both[a], 4, w.r.x, q);
      for (int i = 0; i < 12; i++) assert_within("x", fabs((double)q[i]), 10);
      vector_read(both[a], 4, cb_stepper_dv(w.stepper), q);
      for (int i = 0; i < 12; i++) assert_within("dv", fabs((double)q[i]), 10);
      walk_close(&w);
      block_close(&b);
    }
  gsl_rng_free(rng);
}

/* A NaN does not pass for convergence: it is said, and no velocity has changed. */
static void nan_is_not_hidden(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  struct walk w;
  block_open(rng, false, &b);
  b.scene.x[0] = NAN;
  struct cb_variant v = f64_variant("qr-updated", CB_EBE);
  walk_open(&w, &b, &v, damped, b.fixed);
  cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
  assert_int_equal(cb_stepper_ended(w.stepper).why, CB_ENDED_OVERFLOW);
  const double *velocity = w.r.v;
  for (size_t i = 0; i < 3 * w.r.nodes; i++)
    assert_true(velocity[i] == (b.fixed[i / 3] ? 0 : b.scene.v[i]));
  walk_close(&w);
  block_close(&b);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(fixed_nodes_stay_to_the_last_bit),
      cmocka_unit_test(momentum_is_conserved),
      cmocka_unit_test(beta_brakes_a_rigid_flight),
      cmocka_unit_test(nothing_is_nan_after_convergence),
      cmocka_unit_test(nan_is_not_hidden),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
