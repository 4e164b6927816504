/* test_collapse.c - forces of elements that have collapsed to a plane, a line or a point,
 * are far too large, too small or too far away: finite, bounded, and continuous where
 * the energy is.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/element.h"

enum { SHAPES = 20 };

/* Divides by the current volume, which the paper drops for that. */
static bool blows_up(const char *name) { return strstr(name, "-updated-volume") != NULL; }

typedef void shape_fn(gsl_rng *rng, const double *X, double size, double *x);

static void point(gsl_rng *rng, const double *X, double size, double *x) {
  (void)rng, (void)X;
  for (int i = 0; i < 12; i++) x[i] = size;
}

static void line(gsl_rng *rng, const double *X, double size, double *x) {
  double along[3], axis[3];
  random_vector(rng, 3, along);
  random_vector(rng, 3, axis);
  for (int i = 0; i < 12; i++) {
    const double *p = X + i / 3 * 3;
    x[i] = size * (along[0] * p[0] + along[1] * p[1] + along[2] * p[2]) * axis[i % 3];
  }
}

static void axis_line(gsl_rng *rng, const double *X, double size, double *x) {
  (void)rng;
  for (int i = 0; i < 12; i++) x[i] = i % 3 == 1 ? size * X[i] : 0;
}

static void plane(gsl_rng *rng, const double *X, double size, double *x) {
  int flat = (int)gsl_rng_uniform_int(rng, 3);
  for (int i = 0; i < 12; i++) x[i] = i % 3 == flat ? 0 : size * X[i];
}

/* Two vertices in one place, or three. */
static void merged(gsl_rng *rng, const double *X, double size, double *x) {
  int count = 1 + (int)gsl_rng_uniform_int(rng, 2), first = (int)gsl_rng_uniform_int(rng, 4);
  for (int i = 0; i < 12; i++) x[i] = size * X[i];
  for (int n = 1; n <= count; n++)
    for (int i = 0; i < 3; i++) x[(first + n) % 4 * 3 + i] = x[first * 3 + i];
}

static void mirrored(gsl_rng *rng, const double *X, double size, double *x) {
  (void)rng;
  for (int i = 0; i < 12; i++) x[i] = -size * X[i];
}

static void offset(gsl_rng *rng, const double *X, double size, double *x) {
  double far = pow(10, 3 + (double)gsl_rng_uniform_int(rng, 7));
  for (int i = 0; i < 12; i++) x[i] = size * X[i] + far;
}

static shape_fn *const shapes[] = {point, line, axis_line, plane, merged, mirrored, offset};

/* Largest of the force and the product there; not finite: infinite. */
static double most_at(const struct cb_variant *v, const struct scene *s,
                      const struct cb_material *m) {
  struct run r;
  quad q[12];
  double most = 0;
  run_open(&r, s, v, m, 1);
  run_update(&r, r.v, 1, q);
  most = quad_norm(12, q);
  run_product(&r, r.u, q);
  if (!(quad_norm(12, q) < most)) most = quad_norm(12, q);
  run_close(&r);
  return isfinite(most) ? most : INFINITY;
}

static bool is_tested(const struct cb_variant *v, bool ortho) {
  return cb_arithmetic_runs(v->arithmetic) && !blows_up(v->model->name) &&
         v->arithmetic->scalar_bytes != sizeof(quad) && v->storage != CB_CSR &&
         v->storage != CB_BCSR_SYMMETRIC && v->model->form[v->storage][ortho].update;
}

/* What the derivative of a force that is bounded by a thousandth may have: turning, over
 * stretches of a thousandth at least. */
static bool is_derivative(const char *name) { return strncmp(name, "polar-tangent", 13) == 0; }

/* Worst over the shapes of a size, of every variant; limit of a derivative 100 times. */
static void of_size(double size, double most_allowed) {
  double worst[2] = {0};
  for (int ortho = 0; ortho < 2; ortho++)
    for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
      if (!is_tested(v, ortho)) continue;
      gsl_rng *rng = scene_rng();
      struct scene s = scene_new(rng, SCENE_ONE);
      struct cb_material m = scene_material(ortho);
      char name[96];
      cb_variant_name(v, name);
      for (size_t n = 0; n < SHAPES * sizeof shapes / sizeof *shapes; n++) {
        shapes[n / SHAPES](rng, s.mesh.X, size, s.x);
        double most = most_at(v, &s, &m);
        const bool derivative = is_derivative(v->model->name);
        const double limit = derivative ? 100 * most_allowed : most_allowed;
        worst[derivative] = fmax(worst[derivative], most);
        if (!(most <= limit))
          fail_msg("%s, shape %zu, size %g: %.3g, limit %.3g", name, n / SHAPES, size, most, limit);
      }
      scene_free(&s);
      gsl_rng_free(rng);
    }
  print_message("# size %g: at most %.2g, derivatives %.2g\n", size, worst[0], worst[1]);
}

/* Unit size, moduli up to 2600 Pa. */
static void collapsed_elements_push_within_bounds(void **state) {
  (void)state;
  of_size(1, 1e7);
}

/* Green's force is a cube: beyond float from 1e12 on. */
static void sizes_are_finite(void **state) {
  (void)state;
  of_size(1e-12, 1e6);
  of_size(1e-6, 1e6);
  of_size(1e6, 1e30);
}

/* ---- continuity ------------------------------------------------------------------- */

static void force_at(const struct cb_variant *v, const struct scene *s, const struct cb_material *m,
                     quad *f) {
  struct run r;
  run_open(&r, s, v, m, 1);
  run_update(&r, NULL, 1, f);
  run_close(&r);
}

/* Vertex j goes through the plane of the others: what the force does between just
 * before and just after is in proportion to the way between. */
static void through_the_plane(const struct cb_variant *v, struct scene *s,
                              const struct cb_material *m, int j) {
  const double *p = s->x + (j + 1) % 4 * 3, *q = s->x + (j + 2) % 4 * 3,
               *r = s->x + (j + 3) % 4 * 3;
  double a[3], b[3], normal[3], middle[3], way = 1e-2;
  for (int i = 0; i < 3; i++) {
    a[i] = q[i] - p[i], b[i] = r[i] - p[i];
    middle[i] = (p[i] + q[i] + r[i]) / 3;
  }
  for (int i = 0; i < 3; i++)
    normal[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
  for (; way > 1e-9; way /= 10) {
    quad f[24];
    for (int side = 0; side < 2; side++) {
      for (int i = 0; i < 3; i++) s->x[3 * j + i] = middle[i] + (side ? way : -way) * normal[i];
      force_at(v, s, m, f + 12 * side);
    }
    /* A stiffness of moduli up to 2600 Pa; measured at most 8. */
    assert_within(v->model->name, quad_distance(12, f, f + 12) / (way * 2600), 40);
  }
}

static void exact_forces_are_continuous_when_flat(void **state) {
  static const char *const names[] = {"qr-exact", "polar-exact"};
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int trial = 0; trial < SHAPES; trial++)
    for (int n = 0; n < 4; n++) {
      struct scene s = scene_new(rng, trial % 2 ? SCENE_ONE : SCENE_MIRRORED);
      struct cb_material m = scene_material(n % 2);
      const struct cb_variant v = {scene_model(scene_f64(), names[n / 2]), CB_EBE, scene_f64()};
      through_the_plane(&v, &s, &m, trial % 4);
      scene_free(&s);
    }
  gsl_rng_free(rng);
}

/* ---- torque ------------------------------------------------------------------------ */

/* |sum (x - x_a) x f| by the longest arm and |f|. */
static double torque_of(const double *x, const quad *f) {
  quad torque[3] = {0};
  double arm = 0;
  for (int j = 3; j < 12; j += 3) {
    const double a[3] = {x[j] - x[0], x[j + 1] - x[1], x[j + 2] - x[2]};
    arm = fmax(arm, sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]));
    for (int i = 0; i < 3; i++) {
      const int p = (i + 1) % 3, q = (i + 2) % 3;
      torque[i] += a[p] * f[j + q] - a[q] * f[j + p];
    }
  }
  return arm > 0 ? (double)quad_norm(3, torque) / arm / (double)quad_norm(12, f) : 0;
}

/* The gradient of the QR energy makes no torque, also where it is bounded, but for what
 * rounding the vertices explains: that turns the frame by a rounding over the thickness. Not
 * balanced, the bounded gradient had 1e13 times that. */
static void exact_forces_do_not_turn_what_collapsed(void **state) {
  (void)state;
  double worst = 0;
  for (int ortho = 0; ortho < 2; ortho++)
    for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
      if (!is_tested(v, ortho) || strcmp(v->model->name, "qr-exact") != 0) continue;
      gsl_rng *rng = scene_rng();
      struct scene s = scene_new(rng, SCENE_ONE);
      struct cb_material m = scene_material(ortho);
      for (int n = 0; n < 4 * SHAPES; n++) { /* thin by 1e-3 to 1e-6 in a plane, or two ways */
        static shape_fn *const thin[] = {plane, line, merged, axis_line};
        const double thickness = pow(10, -3 - 3 * gsl_rng_uniform(rng));
        double x[12];
        quad f[12];
        thin[n % 4](rng, s.mesh.X, n % 3 ? 1 : thickness, s.x);
        random_vector(rng, 12, x);
        for (int i = 0; i < 12; i++) s.x[i] += 0.1 * thickness * x[i];
        for (int i = 0; i < 12 && v->arithmetic->scalar_bytes == sizeof(float); i++)
          s.x[i] = (float)s.x[i];
        force_at(v, &s, &m, f);
        const double torque = thickness * torque_of(s.x, f) / v->arithmetic->roundoff;
        assert_within("qr-exact", torque, 64); /* each: fmax drops what is no number */
        worst = fmax(worst, torque);
      }
      scene_free(&s);
      gsl_rng_free(rng);
    }
  print_message("# torque: at most %.2g roundings, over the thickness, of arm times force\n",
                worst);
}

/* ---- neighbours ----------------------------------------------------------------------- */

/* f := 0 for the nodes of elements that have that node. */
static void keep_apart(const struct cb_mesh *mesh, uint32_t node, quad *f) {
  for (size_t e = 0; e < mesh->tets; e++) {
    const uint32_t *t = mesh->tet + 4 * e;
    if (t[0] != node && t[1] != node && t[2] != node && t[3] != node) continue;
    for (int i = 0; i < 12; i++) f[3 * t[i / 3] + i % 3] = 0;
  }
}

/* Lanes and clusters make whole packs again where one element has collapsed: what the
 * others of the pack push is what they push elsewhere. */
static void neighbours_of_what_collapsed_push_as_ever(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = {.condition = 1};
  assert_int_equal(cb_mesh_grid(3, 2, 2, 0.5, &s.mesh), CB_OK);
  scene_complete(rng, &s);
  const uint32_t moved = s.mesh.tet[0], onto = s.mesh.tet[1];
  for (int i = 0; i < 3; i++) s.x[3 * moved + (size_t)i] = s.x[3 * onto + (size_t)i];
  const size_t n = 3 * s.mesh.nodes;
  quad *f = quads_new(2 * n), *exact = f + n;
  const struct cb_material m = scene_material(false);
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (!is_tested(v, false) || strncmp(v->model->name, "qr-", 3) != 0) continue;
    const struct cb_arithmetic *counted = scene_counted();
    const struct cb_variant whole = {scene_model(counted, v->model->name), CB_EBE, counted};
    char name[96];
    cb_variant_name(v, name);
    force_at(&whole, &s, &m, exact);
    force_at(v, &s, &m, f);
    keep_apart(&s.mesh, moved, exact);
    keep_apart(&s.mesh, moved, f);
    assert_rounding(name, n, f, exact, v->arithmetic->roundoff, s.condition, 16);
  }
  free(f);
  scene_free(&s);
  gsl_rng_free(rng);
}

/* Units of clusters that have inverted elements are made again in another way, and some that
 * follow as well: a mesh of many units, with inverted elements in two places. */
static void units_with_inverted_elements_push_as_single_elements_do(void **state) {
  (void)state;
  static const char *const names[] = {"polar-closed-updated", "polar-closed-precomputed",
                                      "polar-exact",          "polar-higham-updated",
                                      "svd-updated",          "qr-updated"};
  gsl_rng *rng = scene_rng();
  struct scene s = {.condition = 1};
  assert_int_equal(cb_mesh_grid(12, 12, 8, 1, &s.mesh), CB_OK);
  scene_complete(rng, &s);
  for (size_t e = 0; e < s.mesh.tets; e += s.mesh.tets / 2) { /* two vertices swap places */
    double *a = s.x + 3 * s.mesh.tet[4 * e], *b = s.x + 3 * s.mesh.tet[4 * e + 1];
    for (int i = 0; i < 3; i++) {
      const double at = a[i];
      a[i] = b[i], b[i] = at;
    }
  }
  const size_t n = 3 * s.mesh.nodes;
  quad *f = quads_new(2 * n), *exact = f + n;
  const struct cb_material m = scene_material(false);
  for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
    const struct cb_variant scalar = {scene_model(scene_f64(), names[k]), CB_EBE, scene_f64()};
    force_at(&scalar, &s, &m, exact);
    for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
      if (!is_tested(v, false) || strcmp(v->model->name, names[k]) != 0) continue;
      if (v->storage != CB_EBE_CLUSTER && v->storage != CB_EBE_RECOMPUTE) continue;
      char name[96];
      cb_variant_name(v, name);
      force_at(v, &s, &m, f);
      assert_rounding(name, n, f, exact, v->arithmetic->roundoff, s.condition, 16);
    }
  }
  free(f);
  scene_free(&s);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(collapsed_elements_push_within_bounds),
      cmocka_unit_test(sizes_are_finite),
      cmocka_unit_test(exact_forces_are_continuous_when_flat),
      cmocka_unit_test(exact_forces_do_not_turn_what_collapsed),
      cmocka_unit_test(neighbours_of_what_collapsed_push_as_ever),
      cmocka_unit_test(units_with_inverted_elements_push_as_single_elements_do),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
