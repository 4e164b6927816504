/* test_laws.c - the laws and the gate tell right kernels from wrong ones: one
 * that must fail for each law, and one that returns NaN.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "harness/verify/gate.h"
#include "harness/verify/laws.h"
#define CB_SCALAR double /* the view of f64 on its elements */
#define CB_LANES 1
#define CB_SUFFIX f64
#include "kernels/elements.h"

/* A variant whose forces or products are spoilt before they are handed back. */
static const struct cb_variant *sound;
static enum { ADD_FORCE, ADD_TORQUE, ADD_NAN, SCALE, SKEW, NEGATE } fault;

static const struct cb_form *sound_form(void) { return &sound->model->form[sound->storage][0]; }

enum { PATCH = 12 }; /* numbers in the vector of one tetrahedron */

static size_t length(const struct cb_elements *elements) { return 3 * elements->nodes; }

static void spoilt_update(struct cb_elements *elements, size_t thread, const void *x, const void *v,
                          double h, void *out) {
  double *f = out;
  const double *p = x;
  sound_form()->update(elements, thread, x, v, h, out);
  for (size_t i = 0; i < length(elements); i += PATCH) {
    double size = fabs(f[i]) + fabs(f[i + 1]) + fabs(f[i + 2]);
    if (fault == ADD_FORCE) f[i] += 1e-6 * size;
    if (fault == ADD_NAN && i == PATCH) f[i] = NAN;
    if (fault == SCALE) /* grows with height: not invariant */
      for (size_t j = i; j < i + PATCH; j++) f[j] *= 1 + 1e-6 * fabs(p[i + 3] - p[i]);
    if (fault == ADD_TORQUE) f[i] += 1e-6 * size, f[i + 3] -= 1e-6 * size;
  }
}

static void spoilt_product(const struct cb_elements *elements, size_t thread, const void *u,
                           void *y) {
  double *f = y;
  const double *p = u;
  sound_form()->product(elements, thread, u, y);
  for (size_t i = 0; i < length(elements); i += PATCH) {
    if (fault == SKEW) f[i] += 1e-3 * p[i + 1], f[i + 1] -= 1e-3 * p[i];
    if (fault == NEGATE)
      for (size_t j = i; j < i + PATCH; j++) f[j] = -f[j];
  }
}

static struct cb_variant spoil(struct cb_model *model, const char *name, int how) {
  sound = cb_variant_find(name);
  assert_non_null(sound);
  *model = *sound->model;
  model->form[sound->storage][0].update = spoilt_update;
  model->form[sound->storage][0].product = spoilt_product;
  fault = how;
  return (struct cb_variant){model, sound->storage, sound->arithmetic};
}

static struct cb_law_value measure(const struct cb_variant *v, enum cb_law law) {
  struct cb_patches p;
  struct cb_material m;
  struct cb_law_value values[CB_LAWS];
  assert_int_equal(cb_material_isotropic(1000, 0.3, 1000, &m), CB_OK);
  assert_int_equal(cb_patches_random(40, 1, 0.2, 11, &p), CB_OK);
  assert_int_equal(cb_laws_measure(v, &m, &p, CB_KEEPS(law), values), CB_OK);
  cb_patches_free(&p);
  return values[law];
}

static void faults_are_found(void **state) {
  static const struct {
    int fault;
    enum cb_law law;
  } cases[] = {{ADD_FORCE, CB_LAW_NEWTON},   {ADD_FORCE, CB_LAW_EULER}, {ADD_TORQUE, CB_LAW_EULER},
               {SCALE, CB_LAW_ROTATION},     {SCALE, CB_LAW_ENERGY},    {SKEW, CB_LAW_SYMMETRIC},
               {NEGATE, CB_LAW_SEMIDEFINITE}};
  (void)state;
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cb_model model;
    struct cb_variant v = spoil(&model, "polar-higham-precomputed/ebe/f64", cases[i].fault);
    double limit = cb_law_limit(v.arithmetic);
    double good = measure(sound, cases[i].law).worst, bad = measure(&v, cases[i].law).worst;
    print_message("%s: sound %.1e, spoilt %.1e, limit %.1e\n", cb_law_name[cases[i].law], good, bad,
                  limit);
    assert_true(cb_law_kept(good, limit));
    assert_false(cb_law_kept(bad, limit));
  }
}

static void nan_breaks_every_law_of_the_force(void **state) {
  static const enum cb_law laws[] = {CB_LAW_ROTATION, CB_LAW_NEWTON, CB_LAW_EULER, CB_LAW_ENERGY,
                                     CB_LAW_ORDER};
  (void)state;
  for (size_t i = 0; i < sizeof laws / sizeof *laws; i++) {
    struct cb_model model;
    struct cb_variant v = spoil(&model, "polar-higham-precomputed/ebe/f64", ADD_NAN);
    struct cb_law_value value = measure(&v, laws[i]);
    assert_true(isnan(value.worst));
    assert_false(cb_law_kept(value.worst, cb_law_limit(v.arithmetic)));
  }
}

static void gate_refuses(void **state) {
  static const int faults[] = {ADD_FORCE, ADD_TORQUE, ADD_NAN, SCALE, SKEW, NEGATE};
  (void)state;
  for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
    struct cb_model model;
    char reason[160] = "";
    struct cb_variant v = spoil(&model, "qr-exact/ebe/f64", faults[i]);
    assert_int_equal(cb_gate(&v, reason), CB_BROKEN);
    assert_true(strlen(reason) > 10);
    print_message("%s\n", reason);
  }
}

/* A model that claims what it does not keep is refused, and passes without. */
static void gate_holds_models_to_their_claims(void **state) {
  char reason[160] = "";
  (void)state;
  const struct cb_variant *honest = cb_variant_find("qr-precomputed/ebe/f64");
  struct cb_model boasting = *honest->model;
  boasting.laws[0] |= CB_KEEPS(CB_LAW_EULER);
  struct cb_variant v = {&boasting, honest->storage, honest->arithmetic};
  assert_int_equal(cb_gate(honest, reason), CB_OK);
  assert_int_equal(cb_gate(&v, reason), CB_BROKEN);
  assert_non_null(strstr(reason, "euler"));
}

static void every_timed_variant_passes_the_gate(void **state) {
  (void)state;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    char name[96], reason[160] = "";
    if (strcmp(v->arithmetic->name, "counted") == 0) continue;
    cb_variant_name(v, name);
    if (cb_gate(v, reason) != CB_OK) fail_msg("%s: %s", name, reason);
  }
}

/* What depends on the numbering cannot be spoilt from outside: qr does. */
static void order_dependence_is_found(void **state) {
  (void)state;
  const struct cb_variant *qr = cb_variant_find("qr-exact/ebe/f64");
  const struct cb_variant *svd = cb_variant_find("svd-precomputed/ebe/f64");
  assert_true(measure(qr, CB_LAW_ORDER).median > 1e-3);
  assert_true(cb_law_kept(measure(svd, CB_LAW_ORDER).worst, cb_law_limit(svd->arithmetic)));
}

static void worst_never_forgets_nan(void **state) {
  (void)state;
  assert_true(isnan(cb_worst(NAN, 1)));
  assert_true(isnan(cb_worst(1, NAN)));
  assert_true(cb_worst(2, 1) == 2 && cb_worst(1, 2) == 2 && isinf(cb_worst(INFINITY, 1)));
}

/* The patches are what their header says. */
static void paths_stay_clear_of_inversion(void **state) {
  struct cb_patches p;
  (void)state;
  assert_int_equal(cb_patches_random(200, 2, 0.3, 5, &p), CB_OK);
  struct cb_mesh moved = p.mesh;
  double x[3 * 5 * 200];
  moved.X = x;
  for (int k = 0; k < 16; k++) {
    for (size_t i = 0; i < 3 * p.mesh.nodes; i++)
      x[i] = p.mesh.X[i] + cos(k * M_PI / 8) * p.cosine[i] + sin(k * M_PI / 8) * p.sine[i];
    for (size_t t = 0; t < p.mesh.tets; t++) /* det F >= 0.4^3 */
      assert_true(cb_mesh_six_volumes(&moved, t) / cb_mesh_six_volumes(&p.mesh, t) > 0.06);
  }
  cb_patches_free(&p);
}

static void rotations_are_rotations(void **state) {
  (void)state;
  for (int n = 0; n < 100; n++) {
    double u[3] = {n / 100.0, fmod(n * 0.37, 1), fmod(n * 0.73, 1)}, Q[9];
    cb_random_rotation(u, n % 2 ? -1 : 0.05, Q);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        double dot =
            Q[3 * i] * Q[3 * j] + Q[3 * i + 1] * Q[3 * j + 1] + Q[3 * i + 2] * Q[3 * j + 2];
        assert_true(fabs(dot - (i == j)) <= 1e-14);
      }
    if (n % 2 == 0) assert_true(fabs(Q[0] + Q[4] + Q[8] - 1 - 2 * cos(0.05)) <= 1e-13);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(faults_are_found),
      cmocka_unit_test(nan_breaks_every_law_of_the_force),
      cmocka_unit_test(gate_refuses),
      cmocka_unit_test(gate_holds_models_to_their_claims),
      cmocka_unit_test(every_timed_variant_passes_the_gate),
      cmocka_unit_test(order_dependence_is_found),
      cmocka_unit_test(worst_never_forgets_nan),
      cmocka_unit_test(paths_stay_clear_of_inversion),
      cmocka_unit_test(rotations_are_rotations),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
