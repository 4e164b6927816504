/* test_breakdown.c - conjugate gradients where they have no right to go on: on
 * indefinite, singular and infinite systems they stop, say why, and leave a finite
 * solution that is no worse than none.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/block.h"

#include <float.h>

/* Long enough that stiffness outweighs mass in (M + h^2 K). */
static const struct cb_step_parameters LONG = {.h = 1, .iterations = 20};

/* Everything that runs here, but `counted`, whose numbers no double can overflow. */
static bool chosen(const struct cb_variant *v, const char *model) {
  return strcmp(v->model->name, model) == 0 && strcmp(v->arithmetic->name, "counted") != 0;
}

/* 1/2 dv.A dv - b.dv, which each iteration lessens, and as much as it may be wrong by. */
static double form_of(const struct block *b, struct walk *w, double scale, double *doubt) {
  const struct cb_arithmetic *a = w->r.variant.arithmetic;
  const size_t n = 3 * w->r.nodes;
  quad *q = quads_new(3 * n), form = 0, size = 0;
  run_product(&w->r, cb_stepper_dv(w->stepper), q); /* c K dv: zero rows of fixed nodes below */
  vector_read(a, w->r.nodes, cb_stepper_dv(w->stepper), q + n);
  vector_read(a, w->r.nodes, cb_stepper_b(w->stepper), q + 2 * n);
  for (size_t i = 0; i < n; i++) {
    const quad A = (q[i] + scale * b->mass[i / 3] * q[n + i]) * q[n + i] / 2, B = q[2 * n + i];
    form += A - B * q[n + i];
    size += (A < 0 ? -A : A) + (B * q[n + i] < 0 ? -B * q[n + i] : B * q[n + i]);
  }
  *doubt = 100 * a->roundoff * (double)size;
  free(q);
  return (double)form;
}

static void assert_at_most(const struct walk *w, double most) {
  double dv[3 * NODES];
  w->r.variant.arithmetic->to_double(w->r.nodes, cb_stepper_dv(w->stepper), dv);
  for (size_t i = 0; i < 3 * w->r.nodes; i++) assert_within(w->r.name, fabs(dv[i]), most);
}

static void assert_finite(const struct walk *w) { assert_at_most(w, DBL_MAX); }

static void assert_ended(const struct walk *w, enum cb_ending why, size_t least, size_t most) {
  const struct cb_ended e = cb_stepper_ended(w->stepper);
  if (e.why != why || e.iterations < least || e.iterations > most)
    fail_msg("%s: ended by %d after %zu", w->r.name, (int)e.why, e.iterations);
}

/* At rest, scaled. */
static void squeeze(struct block *b, double factor) {
  for (size_t i = 0; i < 3 * b->scene.mesh.nodes; i++) {
    b->scene.x[i] = factor * b->scene.mesh.X[i];
    b->scene.v[i] = 0, b->load[i] = 0;
  }
}

static bool pushes_out(struct walk *w, double *dv) {
  double f[3 * NODES], along = 0;
  w->r.variant.arithmetic->to_double(w->r.nodes, cb_stepper_b(w->stepper), f);
  w->r.variant.arithmetic->to_double(w->r.nodes, cb_stepper_dv(w->stepper), dv);
  for (size_t i = 0; i < 3 * w->r.nodes; i++) along += f[i] * dv[i];
  return along > 0;
}

/* Green under compression (its tangent has negative eigenvalues below 1/sqrt 3 of the
 * length) and the derivative of the polar force, on every storage, arithmetic and on
 * threads: said, finite, downhill, never worse than no step. */
static void an_indefinite_operator_is_said(void **state) {
  (void)state;
  static const char *const models[] = {"green", "polar-tangent"};
  gsl_rng *rng = scene_rng();
  struct block b;
  double dv[3 * NODES], doubt;
  size_t seen[2] = {0};
  block_open(rng, false, &b);
  squeeze(&b, 0.3);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    for (int m = 0; m < 2; m++) {
      struct walk w;
      if (!chosen(v, models[m])) continue;
      walk_open(&w, &b, v, &LONG, NULL);
      cb_stepper_right_side(w.stepper, w.r.x, w.r.v, NULL);
      cb_stepper_solve(w.stepper);
      assert_ended(&w, CB_ENDED_INDEFINITE, 1, LONG.iterations - 1);
      assert_finite(&w);
      const double form = form_of(&b, &w, 1, &doubt);
      if (!(form < doubt) || !pushes_out(&w, dv)) fail_msg("%s: %g", w.r.name, form);
      walk_close(&w);
      seen[m]++;
    }
  assert_true(seen[0] > 0 && seen[1] > 0);
  block_close(&b);
  gsl_rng_free(rng);
}

/* The clamped derivative and the corotated operators are definite at the same shape. */
static void a_definite_operator_is_not_accused(void **state) {
  (void)state;
  static const char *const models[] = {"polar-tangent-clamped", "qr-updated", "qr-exact",
                                       "polar-exact", "linear"};
  gsl_rng *rng = scene_rng();
  struct block b;
  block_open(rng, false, &b);
  squeeze(&b, 0.3);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
      struct walk w;
      if (!chosen(v, models[m])) continue;
      walk_open(&w, &b, v, &LONG, b.fixed);
      cb_stepper_set_iterations(w.stepper, 3);
      cb_stepper_step(w.stepper, w.r.x, w.r.v, NULL);
      assert_ended(&w, CB_ENDED_ITERATIONS, 3, 3);
      cb_stepper_set_iterations(w.stepper, 1000);
      cb_stepper_step(w.stepper, w.r.x, w.r.v, NULL);
      assert_ended(&w, CB_ENDED_SOLVED, 4, 999);
      assert_finite(&w);
      walk_close(&w);
    }
  block_close(&b);
  gsl_rng_free(rng);
}

/* NaN, infinity and what overflows within: nothing of it reaches dv. */
static void what_is_not_finite_stays_out(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  block_open(rng, false, &b);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    struct walk w;
    if (!chosen(v, "qr-updated")) continue;
    const double most = v->arithmetic->scalar_bytes == sizeof(float) ? FLT_MAX : DBL_MAX;
    const double bad[] = {NAN, INFINITY, most / 2};
    const double kept = b.load[4];
    for (int n = 0; n < 3; n++) {
      b.load[4] = bad[n];
      walk_open(&w, &b, v, damped, b.fixed);
      cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
      assert_finite(&w);
      if (!isfinite(bad[n])) { /* the largest number may do: float is summed in double */
        assert_ended(&w, CB_ENDED_OVERFLOW, 0, 0);
        assert_at_most(&w, 0);
      }
      walk_close(&w);
    }
    b.load[4] = kept;
  }
  block_close(&b);
  gsl_rng_free(rng);
}

/* A load times a power of two gives dv times that, on either side of where the system is
 * scaled, and where A p or its square would be beyond the arithmetic without. */
static void systems_of_any_size_are_solved(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  double worst = 0;
  block_open(rng, false, &b);
  squeeze(&b, 1);
  for (size_t i = 0; i < 3 * b.scene.mesh.nodes; i++) b.load[i] = gsl_ran_gaussian(rng, 1);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (!chosen(v, "polar-exact")) continue;
    const bool single = v->arithmetic->scalar_bytes == sizeof(float);
    const int power[3] = {single ? 36 : 290, single ? 46 : 310, single ? 96 : 400};
    double dv[3][3 * NODES], far = 0, size = 0;
    for (int n = 0; n < 3; n++) {
      struct walk w;
      struct block loaded = b;
      double load[3 * NODES];
      for (size_t i = 0; i < 3 * NODES; i++) load[i] = ldexp(b.load[i], power[n]);
      loaded.load = load;
      walk_open(&w, &loaded, v, &LONG, b.fixed);
      cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
      v->arithmetic->to_double(w.r.nodes, cb_stepper_dv(w.stepper), dv[n]);
      assert_finite(&w); /* fmax below drops what is no number */
      walk_close(&w);
    }
    for (int n = 1; n < 3; n++)
      for (size_t i = 0; i < 3 * NODES; i++) {
        const double first = ldexp(dv[0][i], -power[0]);
        far = fmax(far, fabs(ldexp(dv[n][i], -power[n]) - first));
        size = fmax(size, fabs(first));
      }
    if (!(far <= 64 * v->arithmetic->roundoff * size))
      fail_msg("%s/%s: %g of %g", v->model->name, v->arithmetic->name, far, size);
    worst = fmax(worst, far / size / v->arithmetic->roundoff);
  }
  print_message("# scaled by powers of two: at most %.2g roundings apart\n", worst);
  block_close(&b);
  gsl_rng_free(rng);
}

/* No stiffness: dv = h f / m, to what a residual of a rounding of b leaves on the lightest
 * node (measured: at most 0.7). No mass either: nothing can be said, and nothing moves. */
static void singular_systems_end(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  double dv[3 * NODES];
  block_open(rng, false, &b);
  assert_int_equal(cb_material_isotropic(0, 0.3, 1000, &b.material), CB_OK);
  double load = 0, lightest = INFINITY;
  for (size_t i = 0; i < 3 * b.scene.mesh.nodes; i++) {
    load += b.load[i] * b.load[i];
    lightest = fmin(lightest, b.mass[i / 3]);
  }
  const double scale = LONG.h * sqrt(load) / lightest;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    struct walk w;
    if (!chosen(v, "qr-updated")) continue;
    walk_open(&w, &b, v, &LONG, NULL);
    cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
    assert_ended(&w, CB_ENDED_SOLVED, 1, LONG.iterations);
    v->arithmetic->to_double(w.r.nodes, cb_stepper_dv(w.stepper), dv);
    for (size_t i = 0; i < 3 * w.r.nodes; i++) {
      const double exact = LONG.h * b.load[i] / b.mass[i / 3];
      assert_within(w.r.name, fabs(dv[i] - exact) / (v->arithmetic->roundoff * scale), 4);
    }
    walk_close(&w);
    struct block massless = b;
    memset(massless.mass, 0, sizeof massless.mass);
    walk_open(&w, &massless, v, &LONG, NULL);
    cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
    assert_ended(&w, CB_ENDED_INDEFINITE, 0, 0);
    assert_finite(&w);
    walk_close(&w);
  }
  block_close(&b);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(an_indefinite_operator_is_said),
      cmocka_unit_test(a_definite_operator_is_not_accused),
      cmocka_unit_test(what_is_not_finite_stays_out),
      cmocka_unit_test(singular_systems_end),
      cmocka_unit_test(systems_of_any_size_are_solved),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
