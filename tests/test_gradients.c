/* test_gradients.c - forces as gradients of energies, operators as derivatives of
 * forces, and the laws of Newton and Euler, in quad precision on strongly
 * deformed tetrahedra.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/element.h"

enum { SHAPES = 30 };

/* Roundings of double, even in quad: frames iterate no further, and materials
 * are given in double. Times the condition; measured at most 1. */
static const double ROUNDING = 0x1p-53, LIMIT = 8;

/* ---- gradients of energies ------------------------------------------------------- */

enum { ISOTROPIC = 1, ORTHOTROPIC = 2, BOTH = 3 };
static const struct {
  const char *name;
  enum frame frame;
  int materials;
} potentials[] = {{"linear", FRAME_NONE, BOTH},
                  {"green", FRAME_GREEN, BOTH},
                  {"qr-exact", FRAME_QR, BOTH},
                  {"polar-exact", FRAME_POLAR, BOTH},
                  {"polar-higham-precomputed", FRAME_POLAR, ISOTROPIC},
                  {"polar-closed-precomputed", FRAME_POLAR, ISOTROPIC},
                  {"polar-eigen-precomputed", FRAME_POLAR, ISOTROPIC},
                  {"polar-quaternion-precomputed", FRAME_POLAR, ISOTROPIC},
                  {"svd-precomputed", FRAME_POLAR, ISOTROPIC},
                  {"polar-reflected-precomputed", FRAME_REFLECTED, ISOTROPIC}};

/* f := -dW/dx by central differences, exact to about 1e-18. */
static void energy_gradient(enum frame frame, const struct cb_material *m, const struct scene *s,
                            quad *f) {
  const quad step = 1e-11;
  quad x[12];
  for (int i = 0; i < 12; i++) x[i] = s->x[i];
  for (int i = 0; i < 12; i++) {
    quad W[2];
    for (int side = 0; side < 2; side++) {
      x[i] = s->x[i] + (side ? step : -step);
      struct element t = element_of(frame, m, s->mesh.X, x);
      W[side] = element_energy(&t);
    }
    x[i] = s->x[i];
    f[i] = (W[0] - W[1]) / (2 * step);
  }
}

/* |f - gradient| / |gradient| */
static double off_gradient(const char *model, enum frame frame, const struct scene *s,
                           const struct cb_material *m) {
  quad f[12], gradient[12];
  struct run r = counted_run(model);
  reopen(&r, s, m);
  run_update(&r, NULL, 1, f);
  energy_gradient(frame, m, s, gradient);
  run_close(&r);
  return quad_distance(12, f, gradient) / quad_norm(12, gradient);
}

static void potentials_have_gradients(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < SHAPES; trial++) {
    struct scene s = wild_scene(rng, trial);
    for (size_t n = 0; n < sizeof potentials / sizeof *potentials; n++)
      for (int ortho = 0; ortho < 2; ortho++) {
        struct cb_material m = scene_material(ortho);
        if (!(potentials[n].materials & (1 << ortho))) continue;
        assert_within(potentials[n].name,
                      off_gradient(potentials[n].name, potentials[n].frame, &s, &m) /
                          (ROUNDING * s.condition),
                      LIMIT);
      }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* The test above can fail: what the usual methods drop is not small. */
static void usual_methods_are_no_gradients(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = wild_scene(rng, 1);
  struct cb_material iso = scene_material(false), ortho = scene_material(true);
  assert_true(off_gradient("qr-precomputed", FRAME_QR, &s, &iso) > 1e-3);
  assert_true(off_gradient("polar-higham-precomputed", FRAME_POLAR, &s, &ortho) > 1e-3);
  scene_free(&s);
  gsl_rng_free(rng);
}

/* ---- tangents ----------------------------------------------------------------------- */

/* change := -df/dx u by central differences. */
static void force_change(struct run *r, const struct scene *s, const double *u, quad *change) {
  const quad step = 1e-11;
  size_t n = 3 * s->mesh.nodes;
  quad *back = quads_new(n), *x = r->x;
  for (int side = 0; side < 2; side++) {
    for (size_t i = 0; i < n; i++) x[i] = s->x[i] + (side ? step : -step) * u[i];
    run_update(r, NULL, 1, side ? change : back);
  }
  for (size_t i = 0; i < n; i++) x[i] = s->x[i], change[i] = (back[i] - change[i]) / (2 * step);
  free(back);
}

static void claimed_tangents_are_derivatives(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  int claims = 0;
  for (int kind = 0; kind < SCENES; kind++)
    for (int ortho = 0; ortho < 2; ortho++) {
      struct scene s = scene_new(rng, (enum scene_kind)kind);
      struct cb_material m = scene_material(ortho);
      size_t n = 3 * s.mesh.nodes;
      quad *q = quads_new(3 * n), *f = q, *y = q + n, *change = q + 2 * n;
      for (const struct cb_model *const *model = scene_counted()->models; *model; model++) {
        struct run r = counted_run((*model)->name);
        if (!((*model)->laws[ortho] & CB_KEEPS(CB_LAW_TANGENT))) continue;
        reopen(&r, &s, &m);
        assert_int_equal(r.variant.arithmetic->stride, 3);
        force_change(&r, &s, s.u, change);
        run_update(&r, NULL, 1, f);
        run_product(&r, r.u, y);
        assert_rounding(r.name, n, y, change, ROUNDING, s.condition, LIMIT);
        run_close(&r);
        claims++;
      }
      free(q);
      scene_free(&s);
    }
  assert_int_equal(claims, (2 * 2 + 1) * SCENES); /* linear, green; polar-tangent: isotropic */
  gsl_rng_free(rng);
}

/* Current B over rest volume, polar frame: conservative if and only if lambda =
 * 2 mu. */
static double asymmetry(const char *model, const struct scene *s, const struct cb_material *m) {
  quad K[144], *symmetric = K, difference = 0, size = 0;
  struct run r = counted_run(model);
  reopen(&r, s, m);
  for (int i = 0; i < 12; i++) {
    double u[12] = {0};
    u[i] = 1;
    force_change(&r, s, u, K + 12 * i);
  }
  run_close(&r);
  for (int i = 0; i < 144; i++) {
    quad other = symmetric[i % 12 * 12 + i / 12];
    difference += (K[i] - other) * (K[i] - other), size += K[i] * K[i];
  }
  return sqrt((double)(difference / size));
}

static void current_b_is_conservative_at_one_third(void **state) {
  (void)state;
  static const char *const models[] = {"polar-higham-updated", "polar-eigen-updated",
                                       "svd-updated"};
  gsl_rng *rng = scene_rng();
  struct cb_material third, other = scene_material(false);
  assert_int_equal(cb_material_isotropic(1500, 1. / 3, 1, &third), CB_OK);
  for (int trial = 0; trial < 6; trial++) {
    struct scene s = wild_scene(rng, trial);
    for (size_t n = 0; n < sizeof models / sizeof *models; n++) {
      assert_within(models[n], asymmetry(models[n], &s, &third) / (ROUNDING * s.condition), LIMIT);
      assert_true(asymmetry(models[n], &s, &other) > 1e-4);
    }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

/* ---- laws --------------------------------------------------------------------------- */

/* |sum f| / sum |f|, |sum x' x f| / sum |x'| |f|, x' from the centre. */
static void imbalance(const struct scene *s, const quad *f, double *newton, double *euler) {
  quad centre[3], force[3] = {0}, torque[3] = {0};
  double forces = 0, torques = 0;
  for (int i = 0; i < 3; i++)
    centre[i] = ((quad)s->x[i] + s->x[3 + i] + s->x[6 + i] + s->x[9 + i]) / 4;
  for (int v = 0; v < 12; v += 3) {
    quad r[3];
    for (int i = 0; i < 3; i++) r[i] = s->x[v + i] - centre[i];
    for (int i = 0; i < 3; i++) {
      int j = (i + 1) % 3, k = (i + 2) % 3;
      force[i] += f[v + i];
      torque[i] += r[j] * f[v + k] - r[k] * f[v + j];
    }
    forces += quad_norm(3, f + v);
    torques += quad_norm(3, f + v) * quad_norm(3, r);
  }
  *newton = quad_norm(3, force) / forces;
  *euler = quad_norm(3, torque) / torques;
}

static void claimed_newton_and_euler_hold(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  double ghost = 0;
  for (int trial = 0; trial < SHAPES; trial++) {
    struct scene s = wild_scene(rng, trial);
    int ortho = trial / 2 % 2;
    struct cb_material m = scene_material(ortho);
    for (const struct cb_model *const *model = scene_counted()->models; *model; model++) {
      unsigned laws = (*model)->laws[ortho];
      quad f[12];
      if (!(*model)->form[CB_EBE][ortho].update) continue;
      double newton, euler;
      struct run r = counted_run((*model)->name);
      reopen(&r, &s, &m);
      run_update(&r, NULL, 1, f);
      imbalance(&s, f, &newton, &euler);
      if (laws & CB_KEEPS(CB_LAW_NEWTON))
        assert_within(r.name, newton / r.variant.arithmetic->roundoff, LIMIT);
      if (laws & CB_KEEPS(CB_LAW_EULER))
        assert_within(r.name, euler / (ROUNDING * s.condition), LIMIT);
      if (strcmp((*model)->name, "qr-precomputed") == 0) ghost = fmax(ghost, euler);
      run_close(&r);
    }
    scene_free(&s);
  }
  assert_true(ghost > 1e-2); /* the test can fail */
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(potentials_have_gradients),
      cmocka_unit_test(usual_methods_are_no_gradients),
      cmocka_unit_test(claimed_tangents_are_derivatives),
      cmocka_unit_test(current_b_is_conservative_at_one_third),
      cmocka_unit_test(claimed_newton_and_euler_hold),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
