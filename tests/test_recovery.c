/* test_recovery.c - bodies let go from inverted and collapsed shapes: where they start from,
 * what is said of where they end.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/recovery/recovery.h"
#include "harness/verify/claim.h"
#include "harness/verify/probe.h"
#include "reference/oracles.h"
#include "tests/process.h"

static struct cb_recovery_body make(const char *start) {
  struct cb_recovery_body body;
  assert_non_null(cb_recovery_start(start));
  assert_int_equal(cb_recovery_body_create(cb_recovery_start(start), NULL, 2005, &body), CB_OK);
  return body;
}

static struct cb_recovery run(const struct cb_recovery_body *body, const char *variant) {
  struct cb_recovery r;
  assert_non_null(cb_variant_find(variant));
  assert_int_equal(cb_recovery_run(body, cb_variant_find(variant), &r), CB_OK);
  return r;
}

/* F[9] of element e of the start. */
static void gradient(const struct cb_recovery_body *body, size_t e, double F[9]) {
  const uint32_t *t = body->at.mesh.tet + 4 * e;
  const double *x = body->at.x;
  for (size_t i = 0; i < 9; i++) {
    F[i] = 0;
    for (size_t k = 0; k < 3; k++)
      F[i] +=
          (x[3 * t[k + 1] + i / 3] - x[3 * t[0] + i / 3]) * body->inverse[9 * e + 3 * k + i % 3];
  }
}

/* ---- starts ------------------------------------------------------------------------------- */

/* Singular values say how far: half through a plane is 1, 1, -1/2 with the plane's rest. */
static void tetrahedra_start_inverted(void **state) {
  (void)state;
  for (size_t i = 0; i < CB_RECOVERY_STARTS; i++) {
    const struct cb_recovery_start *start = &cb_recovery_starts[i];
    if (start->block) continue;
    struct cb_recovery_body body = make(start->name);
    double F[9], U[9], S[3], V[9];
    gradient(&body, 0, F);
    const double det = F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                       F[2] * (F[3] * F[7] - F[4] * F[6]);
    assert_int_equal(cb_oracle_svd(F, U, S, V), CB_OK);
    /* the plane stays as it is, and so does the volume but for the share that is left */
    const double left = strcmp(start->name, "centre") == 0 ? 1 : CB_RECOVERY_DEPTH;
    assert_true(fabs(det + left) <= 1e-12);
    assert_true(fabs(S[1] - 1) <= 1e-12);
    cb_recovery_body_free(&body);
  }
}

static void blocks_start_where_they_say(void **state) {
  (void)state;
  const struct {
    const char *name;
    double s[3];
  } cases[] = {
      {"mirrored", {1, 1, 1}}, {"plane", {1, 1, 0}}, {"line", {1, 0, 0}}, {"point", {0, 0, 0}}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cb_recovery_body body = make(cases[i].name);
    for (size_t e = 0; e < body.at.mesh.tets; e++) {
      double F[9], U[9], S[3], V[9];
      gradient(&body, e, F);
      assert_int_equal(cb_oracle_svd(F, U, S, V), CB_OK);
      for (int k = 0; k < 3; k++) assert_true(fabs(S[k] - cases[i].s[k]) <= 1e-12);
    }
    cb_recovery_body_free(&body);
  }
}

static void random_places_are_in_the_block(void **state) {
  (void)state;
  struct cb_recovery_body body = make("random"), again = make("random");
  size_t inverted = 0;
  for (size_t i = 0; i < 3 * body.at.mesh.nodes; i++) {
    assert_true(body.at.x[i] >= 0 && body.at.x[i] <= body.size);
    assert_true(body.at.x[i] == again.at.x[i]);
  }
  for (size_t e = 0; e < body.at.mesh.tets; e++) {
    double F[9];
    gradient(&body, e, F);
    inverted += F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) +
                    F[2] * (F[3] * F[7] - F[4] * F[6]) <
                0;
  }
  assert_true(inverted > body.at.mesh.tets / 3 && inverted < 2 * body.at.mesh.tets / 3);
  cb_recovery_body_free(&body);
  cb_recovery_body_free(&again);
}

/* ---- ends ---------------------------------------------------------------------------------- */

/* A body at rest that is only turned is back at once, and the turn is found. */
static void what_is_at_rest_is_back(void **state) {
  (void)state;
  struct cb_recovery_body body = make("plane");
  const double c = cos(2.5), s = sin(2.5);
  for (size_t n = 0; n < body.at.mesh.nodes; n++) {
    const double *X = body.at.mesh.X + 3 * n;
    const double x[3] = {c * X[0] - s * X[1] + 7, s * X[0] + c * X[1] - 3, X[2] + 1};
    memcpy(body.at.x + 3 * n, x, sizeof x);
  }
  const struct cb_recovery r = run(&body, "qr-exact/ebe/f64");
  assert_string_equal(cb_recovery_outcome(&r), "recovered");
  assert_true(r.time <= cb_recovery_step.h);
  assert_true(r.distance <= 1e-12);
  assert_true(fabs(r.turn - 2.5) <= 1e-9);
  assert_true(r.share[0] == 1 && r.share[CB_RECOVERY_LOOKS - 1] == 1);
  cb_recovery_body_free(&body);
}

static void polar_without_sign_ends_mirrored(void **state) {
  (void)state;
  const char *const starts[] = {"vertex b", "edge ac", "mirrored"};
  for (size_t i = 0; i < 3; i++) {
    struct cb_recovery_body body = make(starts[i]);
    const struct cb_recovery r = run(&body, "polar-reflected-precomputed/ebe/f64");
    assert_string_equal(cb_recovery_outcome(&r), "mirrored");
    assert_true(r.mirrored == 1 && r.back == 0 && isnan(r.time) && isnan(r.lost));
    assert_true(r.distance > 0.1); /* the mirrored shape is not the rest shape */
    cb_recovery_body_free(&body);
  }
}

static void a_rotation_brings_it_back(void **state) {
  (void)state;
  const char *const variants[] = {"polar-closed-precomputed/ebe/f64", "svd-precomputed/ebe/f64",
                                  "qr-updated/ebe/f64", "polar-exact/ebe/f32"};
  for (size_t i = 0; i < CB_RECOVERY_STARTS; i++)
    for (size_t v = 0; v < 4 && !cb_recovery_starts[i].block; v++) {
      struct cb_recovery_body body = make(cb_recovery_starts[i].name);
      const struct cb_recovery r = run(&body, variants[v]);
      assert_string_equal(cb_recovery_outcome(&r), "recovered");
      assert_true(r.time > 0 && r.time < CB_RECOVERY_STEPS * cb_recovery_step.h / 2);
      assert_true(r.distance <= 1e-3); /* by then it has come to rest */
      cb_recovery_body_free(&body);
    }
}

static void what_is_not_finite_is_named(void **state) {
  (void)state;
  struct cb_recovery_body body = make("random");
  body.at.x[5] = NAN;
  const struct cb_recovery r = run(&body, "polar-closed-precomputed/ebe/f64");
  assert_string_equal(cb_recovery_outcome(&r), "NaN");
  assert_true(r.lost == 0 && r.back == 0 && isnan(r.distance) && isnan(r.time));
  cb_recovery_body_free(&body);
}

/* Nothing pulls back what has no stiffness worth its distance: far off is not "stuck". */
static void what_flies_apart_is_named(void **state) {
  (void)state;
  struct cb_recovery_body body = make("random");
  for (size_t i = 0; i < 3; i++) body.at.v[i] = 1e5;
  const struct cb_recovery r = run(&body, "polar-reflected-precomputed/ebe/f64");
  assert_string_equal(cb_recovery_outcome(&r), "exploded");
  cb_recovery_body_free(&body);
}

/* F = t diag(1, 1, -1) in the frame: with updated B the force along t is
 * (3 lambda + 2 mu) t^2 (t - 3) V0, outwards, so that beyond t = 3 it never comes back. */
static void updated_B_drives_large_inverted_elements_apart(void **state) {
  (void)state;
  const struct {
    double t;
    const char *variant, *outcome;
  } cases[] = {{1, "qr-updated/ebe/f64", "recovered"},
               {4, "qr-updated/ebe/f64", "exploded"},
               {4, "qr-precomputed/ebe/f64", "recovered"},
               {4, "qr-exact/ebe/f64", "recovered"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct cb_recovery_body body = make("centre");
    for (int k = 0; k < 12; k++) body.at.x[k] *= cases[i].t;
    const struct cb_recovery r = run(&body, cases[i].variant);
    if (strcmp(cb_recovery_outcome(&r), cases[i].outcome) != 0)
      fail_msg("%s, t = %g: %s", cases[i].variant, cases[i].t, cb_recovery_outcome(&r));
    cb_recovery_body_free(&body);
  }
}

/* The same of the force itself, at the shape: its work along t, on either side of 3. */
static void the_force_along_t_is_as_derived(void **state) {
  (void)state;
  struct cb_recovery_body body = make("centre");
  const struct cb_mesh *mesh = &body.at.mesh;
  const double young = body.at.material.young, nu = body.at.material.poisson;
  const double lambda = young * nu / ((1 + nu) * (1 - 2 * nu)), mu = young / (2 * (1 + nu));
  const double volume = fabs(cb_mesh_six_volumes(mesh, 0)) / 6;
  struct cb_probe probe;
  assert_int_equal(
      cb_probe_open(cb_variant_find("qr-updated/ebe/f64"), mesh, &body.at.material, &probe), CB_OK);
  for (double t = 0.5; t < 6; t += 0.5) {
    double x[12], f[12], along = 0;
    for (int k = 0; k < 12; k++) x[k] = -t * mesh->X[k];
    cb_probe_force(&probe, x, f);
    for (int k = 0; k < 12; k++) along -= mesh->X[k] * f[k];
    const double derived = (3 * lambda + 2 * mu) * t * t * (t - 3) * volume;
    assert_true(fabs(along - derived) <= 1e-12 * t * t * (t + 3) * (3 * lambda + 2 * mu) * volume);
  }
  cb_probe_close(&probe);
  cb_recovery_body_free(&body);
}

/* ---- the verb -----------------------------------------------------------------------------------
 */

#define RECOVERY(...) run_words(NULL, (const char *const[]){"recovery", __VA_ARGS__, NULL})

static void the_verb_prints_and_writes(void **state) {
  (void)state;
  char path[300];
  struct process p = RECOVERY("--variant", "linear/ebe/f64", "--variant", "node-warp/ebe/f64",
                              "--format", "csv", "--output", temporary_path("out"));
  assert_done(&p);
  assert_int_equal(lines(p.out), 1 + 2 * CB_RECOVERY_STARTS);
  snprintf(path, sizeof path, "%s/recovery.csv", temporary_path("out"));
  char *csv = read_text(path);
  assert_string_equal(csv, p.out);
  snprintf(path, sizeof path, "%s/recovery-time.csv", temporary_path("out"));
  char *times = read_text(path);
  assert_int_equal(lines(times), 1 + 2 * 5 * CB_RECOVERY_LOOKS);
  free(csv);
  free(times);
  process_free(&p);
  assert_refused(RECOVERY("--variant", "nothing"), "no variant matches 'nothing'");
  assert_refused(RECOVERY("--variant", "*/*/counted"), "nothing that is selected runs here");
}

/* ---- claims -------------------------------------------------------------------------------------
 */

/* The verdict follows from the numbers, and the text is not cut. */
static void the_claim_about_vertices_has_a_verdict(void **state) {
  (void)state;
  struct cb_claim claim = {.failed = false};
  assert_int_equal(cb_claim_vertex(&(struct cb_claimant){NULL, 2005, &claim}), CB_OK);
  assert_true(strlen(claim.measured) < sizeof claim.measured - 1);
  assert_non_null(strstr(claim.measured, "come back"));
  assert_true(strlen(claim.verdict) > 0 && strlen(claim.verdict) < sizeof claim.verdict - 1);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tetrahedra_start_inverted),
      cmocka_unit_test(blocks_start_where_they_say),
      cmocka_unit_test(random_places_are_in_the_block),
      cmocka_unit_test(what_is_at_rest_is_back),
      cmocka_unit_test(polar_without_sign_ends_mirrored),
      cmocka_unit_test(a_rotation_brings_it_back),
      cmocka_unit_test(what_is_not_finite_is_named),
      cmocka_unit_test(what_flies_apart_is_named),
      cmocka_unit_test(updated_B_drives_large_inverted_elements_apart),
      cmocka_unit_test(the_force_along_t_is_as_derived),
      cmocka_unit_test(the_verb_prints_and_writes),
      cmocka_unit_test(the_claim_about_vertices_has_a_verdict),
  };
  (void)argc;
  find_program(argv[0]);
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
