/* test_lanes.c - the same sources with several elements at once, f64x4 to f32x16,
 * compute what f64 computes: forces, products and whole steps of every
 * model and storage, with packs that are not full, and never touch the padding
 * of node vectors.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/variants.h"

/* Those of the program that run on this processor. */
enum { MOST = 8 };
static const struct cb_arithmetic *lanes[MOST];
static int lane_count;

static int find_lanes(void **state) {
  (void)state;
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a && lane_count < MOST; a++)
    if ((*a)->lanes > 1 && cb_arithmetic_runs(*a)) lanes[lane_count++] = *a;
  return 0;
}

static const double H = 0.01;
static const struct cb_step_parameters PARAMETERS = {
    .h = 0.01, .alpha = 0.002, .beta = 0.5, .iterations = 5};

/* Units of roundoff times the condition; measured at most 6 for one update or
 * product, 20 for the steps. Not to the last bit, not even double: lanes add the
 * shares of elements to a node in another order. */
static const double LIMIT = 16, STEP_LIMIT = 64;

/* f64x4 has 4 lanes of 8 bytes; lanes of a processor without them are not listed. */
static void lanes_are_what_they_say(void **state) {
  (void)state;
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++) {
    unsigned bits = 0, width = 1;
    if (sscanf((*a)->name, "f%ux%u", &bits, &width) < 1) continue;
    assert_true((*a)->lanes == width && (*a)->scalar_bytes == bits / 8);
    assert_true((*a)->stride == (width > 1 ? 4 : 3));
    assert_true((*a)->roundoff == (bits == 64 ? 0x1p-53 : 0x1p-24));
    bool listed = false;
    for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
      listed = listed || v->arithmetic == *a;
    assert_true(listed == cb_arithmetic_runs(*a));
  }
}

/* Bit by bit: not even a negative zero. */
static void assert_padding(const struct cb_arithmetic *a, size_t nodes, const void *vector) {
  const unsigned char *bytes = vector;
  for (size_t n = 0; n < nodes; n++)
    for (size_t k = 0; k < a->scalar_bytes; k++)
      assert_int_equal(bytes[(n * a->stride + 3) * a->scalar_bytes + k], 0);
}

typedef void each_fn(const struct cb_variant *lanes, const struct cb_variant *scalar,
                     const struct scene *s, const struct cb_material *m);

/* Every model x material x storage x lanes, on meshes of 1, 20 and 23 elements. */
static void for_each_variant(each_fn *each) {
  gsl_rng *rng = scene_rng();
  for (int kind = 0; kind < SCENES; kind++) {
    struct scene s = scene_new(rng, (enum scene_kind)kind);
    for (int ortho = 0; ortho < 2; ortho++) {
      struct cb_material material = scene_material(ortho);
      for (int a = 0; a < lane_count; a++)
        for (const struct cb_model *const *m = lanes[a]->models; *m; m++)
          for (int storage = 0; storage < CB_STORAGES; storage++) {
            struct cb_variant v = {*m, (enum cb_storage)storage, lanes[a]};
            struct cb_variant scalar = {scene_model(scene_f64(), (*m)->name),
                                        (enum cb_storage)storage, scene_f64()};
            /* the paper's chain is for scalars: lanes are held against it */
            if (storage != CB_EBE_PAPER)
              assert_true(!(*m)->form[storage][ortho].update ==
                          !scalar.model->form[storage][ortho].update);
            if ((*m)->form[storage][ortho].update) each(&v, &scalar, &s, &material);
          }
    }
    scene_free(&s);
  }
  gsl_rng_free(rng);
}

static void same_operator(const struct cb_variant *variant, const struct cb_variant *scalar,
                          const struct scene *s, const struct cb_material *m) {
  size_t n = 3 * s->mesh.nodes;
  quad *q = quads_new(4 * n), *f = q, *y = q + n, *f64 = q + 2 * n, *y64 = q + 3 * n;
  struct run one, many;
  run_open(&one, s, scalar, m, 0.3);
  run_update(&one, one.v, H, f64);
  run_product(&one, one.u, y64);
  run_close(&one);
  run_open(&many, s, variant, m, 0.3);
  run_update(&many, many.v, H, f);
  assert_padding(variant->arithmetic, s->mesh.nodes, many.out);
  run_product(&many, many.u, y);
  assert_padding(variant->arithmetic, s->mesh.nodes, many.out);
  double roundoff = variant->arithmetic->roundoff, limit = LIMIT;
  assert_rounding(many.name, n, f, f64, roundoff, s->condition, limit);
  assert_rounding(many.name, n, y, y64, roundoff, s->condition, limit);
  run_close(&many);
  free(q);
}

static void lanes_give_the_operator(void **state) {
  (void)state;
  for_each_variant(same_operator);
}

static bool is_widest(int a) {
  for (int b = 0; b < lane_count; b++)
    if (lanes[b]->scalar_bytes == lanes[a]->scalar_bytes && lanes[b]->lanes > lanes[a]->lanes)
      return false;
  return true;
}

/* A mesh whose numbers no cache holds, where they are asked for ahead of time (kernels/elements.h):
 * the loops are others, or take other ways. */
static void lanes_give_the_operator_of_large_meshes(void **state) {
  (void)state;
  static const struct {
    const char *model;
    enum cb_storage storage;
  } larges[] = {{"qr-updated", CB_EBE_CLUSTER},
                {"linear", CB_EBE_CLUSTER},
                {"polar-tangent", CB_EBE_CLUSTER},
                {"qr-updated", CB_BCSR},
                {"qr-updated", CB_BCSR_SYMMETRIC},
                {"qr-updated", CB_CSR}};
  gsl_rng *rng = scene_rng();
  struct scene s = {.condition = 1};
  struct cb_material m = scene_material(false);
  assert_int_equal(cb_mesh_grid(27, 27, 27, 1, &s.mesh), CB_OK);
  scene_complete(rng, &s);
  for (int a = 0; a < lane_count; a++)
    for (size_t i = 0; is_widest(a) && i < sizeof larges / sizeof *larges; i++) {
      const char *name = larges[i].model;
      const struct cb_variant v = {scene_model(lanes[a], name), larges[i].storage, lanes[a]};
      const struct cb_variant scalar = {scene_model(scene_f64(), name), CB_EBE, scene_f64()};
      struct run r;
      run_open(&r, &s, &v, &m, 1);
      assert_true(cb_operator_bytes(r.op) > 8500000);
      run_close(&r);
      same_operator(&v, &scalar, &s, &m);
    }
  scene_free(&s);
  gsl_rng_free(rng);
}

/* x[3*nodes] := positions after three steps; node 1 is fixed. */
static void three_steps(const struct cb_variant *variant, const struct scene *s,
                        const struct cb_material *m, quad *x) {
  const struct cb_arithmetic *a = variant->arithmetic;
  size_t nodes = s->mesh.nodes;
  double *mass = calloc(nodes, sizeof *mass);
  uint8_t *fixed = calloc(nodes, 1);
  assert_true(mass && fixed);
  fixed[1] = 1;
  cb_mesh_mass(&s->mesh, m->density, mass);
  struct run r;
  struct cb_stepper *stepper;
  run_open(&r, s, variant, m, cb_step_scale(&PARAMETERS));
  assert_int_equal(cb_stepper_create(r.op, &PARAMETERS, mass, fixed, &stepper), CB_OK);
  for (int n = 0; n < 3; n++) {
    cb_stepper_step(stepper, r.x, r.v, r.u); /* u: any external force */
    if (a->stride == 4) {
      assert_padding(a, nodes, r.x);
      assert_padding(a, nodes, r.v);
      assert_padding(a, nodes, cb_stepper_b(stepper));
      assert_padding(a, nodes, cb_stepper_dv(stepper));
    }
  }
  vector_read(a, nodes, r.x, x);
  cb_stepper_free(stepper);
  run_close(&r);
  free(mass);
  free(fixed);
}

static void same_steps(const struct cb_variant *variant, const struct cb_variant *scalar,
                       const struct scene *s, const struct cb_material *m) {
  size_t n = 3 * s->mesh.nodes;
  char name[96];
  quad *q = quads_new(2 * n), *x = q, *x64 = q + n;
  struct scene loaded = *s;
  loaded.u = calloc(n, sizeof *loaded.u); /* isolated nodes have no mass: no load there */
  assert_non_null(loaded.u);
  for (size_t e = 0; e < 4 * s->mesh.tets; e++) loaded.u[3 * s->mesh.tet[e] + 1] = -10;
  three_steps(variant, &loaded, m, x);
  three_steps(scalar, &loaded, m, x64);
  for (size_t i = 0; i < n; i++) x[i] -= s->x[i], x64[i] -= s->x[i];
  cb_variant_name(variant, name);
  assert_rounding(name, n, x, x64, variant->arithmetic->roundoff, s->condition, STEP_LIMIT);
  free(loaded.u);
  free(q);
}

static void lanes_give_the_steps(void **state) {
  (void)state;
  for_each_variant(same_steps);
}

/* Masses and moduli of any size: in float the squares of what is left of the
 * residual underflow, and p . A p may do so first. Still no 0/0. */
static void finite_after_convergence(const struct cb_arithmetic *a, struct scene *s, double unit) {
  struct cb_step_parameters p = PARAMETERS;
  struct cb_material m;
  struct run r;
  struct cb_stepper *stepper;
  double mass[4];
  quad x[12];
  p.iterations = 500;
  assert_int_equal(cb_material_isotropic(1500 * unit, 0.3, 1000 * unit, &m), CB_OK);
  cb_mesh_mass(&s->mesh, m.density, mass);
  struct cb_variant v = {scene_model(a, "qr-updated"), CB_EBE, a};
  run_open(&r, s, &v, &m, cb_step_scale(&p));
  assert_int_equal(cb_stepper_create(r.op, &p, mass, NULL, &stepper), CB_OK);
  cb_stepper_step(stepper, r.x, r.v, NULL);
  vector_read(a, 4, r.x, x);
  for (int i = 0; i < 12; i++) assert_within(r.name, fabs((double)x[i] - s->x[i]), 0.1);
  cb_stepper_free(stepper);
  run_close(&r);
}

static void lanes_stay_finite_after_convergence(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  for (int a = 0; a < lane_count; a++)
    for (double scale = 1; scale > 1e-9; scale *= 0.1)
      for (double unit = 1e6; unit > 1e-9; unit *= 0.1) {
        for (int i = 0; i < 12; i++) s.x[i] = s.mesh.X[i] * (1 + scale), s.v[i] = scale;
        finite_after_convergence(lanes[a], &s, unit);
      }
  scene_free(&s);
  gsl_rng_free(rng);
}

/* A flat element has a frame in float too. */
static void flat_elements_are_finite(void **state) {
  (void)state;
  static const char *const names[] = {"polar-higham-updated", "polar-closed-updated",
                                      "polar-eigen-updated",  "polar-quaternion-updated",
                                      "polar-edges-updated",  "svd-updated",
                                      "qr-updated",           "polar-exact"};
  gsl_rng *rng = scene_rng();
  struct scene s = scene_new(rng, SCENE_ONE);
  struct cb_material m = scene_material(false);
  for (int i = 0; i < 12; i++) s.x[i] = i % 3 == 2 ? 0 : s.mesh.X[i];
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    for (int a = 0; a < lane_count; a++) {
      struct cb_variant v = {scene_model(lanes[a], names[n]), CB_EBE, lanes[a]};
      struct run r;
      quad f[12];
      run_open(&r, &s, &v, &m, 1);
      run_update(&r, NULL, 1, f);
      assert_true(quad_norm(12, f) > 0);
      assert_within(r.name, quad_norm(12, f), 10 * m.young);
      run_close(&r);
    }
  scene_free(&s);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lanes_are_what_they_say),
      cmocka_unit_test(lanes_give_the_operator),
      cmocka_unit_test(lanes_give_the_operator_of_large_meshes),
      cmocka_unit_test(lanes_give_the_steps),
      cmocka_unit_test(lanes_stay_finite_after_convergence),
      cmocka_unit_test(flat_elements_are_finite),
  };
  return cmocka_run_group_tests(tests, find_lanes, NULL);
}
