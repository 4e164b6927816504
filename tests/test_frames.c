/* test_frames.c - every frame, in double: a rotation, and the one that GSL's
 * decompositions give, to the rounding that F's singular values amplify.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/element.h"
#include "tests/families.h"

#define CB_SCALAR double
#define CB_LANES 1
#define CB_SUFFIX test
#include "kernels/frames/polar_closed.h"
#include "kernels/frames/polar_eigen.h"
#include "kernels/frames/polar_higham.h"
#include "kernels/frames/polar_quaternion.h"
#include "kernels/frames/qr.h"
#include "kernels/frames/svd.h"

enum { TRIALS = 2000 };

/* Units of 2^-53, times the condition for distances: measured at most 32 (at rest),
 * of which GSL contributes about 20. */
static const double LIMIT = 100;

typedef void frame_fn(const T *F, T *R);
static void orthogonal(const T *F, T *R) { orthogonal_higham(F, R); }
static void higham(const T *F, T *R) { frame_polar_higham(F, R); }
static void closed_orthogonal(const T *F, T *R) { orthogonal_closed(F, R); }
static void closed(const T *F, T *R) { frame_polar_closed(F, R); }
static void eigen(const T *F, T *R) { frame_polar_eigen(F, R); }
static void svd(const T *F, T *R) { frame_svd(F, R); }
static void quaternion_cold(const T *F, T *R) {
  T q[4] = {0};
  frame_polar_quaternion(F, q, R);
}

static void assert_orthogonal(const char *what, const double *R, double determinant) {
  double RR[9];
  product3_nt(R, R, RR);
  for (int i = 0; i < 9; i += 4) RR[i] -= 1;
  assert_within(what, norm(9, RR) / 0x1p-53, LIMIT);
  assert_within(what, fabs(determinant3(R) - determinant) / 0x1p-53, LIMIT);
}

/* s[2] has the sign of det F. The nearest rotation turns by 1/(s_2 + s_3) of
 * what F moves by, the nearest orthogonal matrix by 1/(s_2 + |s_3|). */
static double condition_rotation(const double s[3]) { return s[0] / (s[1] + s[2]); }
static double condition_orthogonal(const double s[3]) { return s[0] / (s[1] + fabs(s[2])); }
static double condition_squared(const double s[3]) { return condition_rotation(s) * s[0] / s[1]; }

static void check(const char *name, frame_fn *frame, bool reflects,
                  double (*condition)(const double s[3])) {
  gsl_rng *rng = scene_rng();
  for (int family = 0; family < FAMILIES; family++)
    for (int t = 0; t < TRIALS; t++) {
      char what[64];
      double F[9], s[3], R[9], oracle[9];
      random_gradient(rng, (enum family)family, F, s);
      frame(F, R);
      snprintf(what, sizeof what, "%s, %s", name, family_name[family]);
      assert_orthogonal(what, R, reflects && s[2] < 0 ? -1 : 1);
      assert_int_equal((reflects ? cb_oracle_polar_orthogonal : cb_oracle_polar)(F, oracle), CB_OK);
      assert_within(what, distance(9, R, oracle) / (0x1p-53 * condition(s)), LIMIT);
    }
  gsl_rng_free(rng);
}

static void higham_is_the_nearest_rotation(void **state) {
  (void)state;
  check("higham", higham, false, condition_rotation);
}

static void closed_is_the_nearest_rotation(void **state) {
  (void)state;
  check("closed", closed, false, condition_rotation);
}

static void without_sign_handling_they_reflect(void **state) {
  (void)state;
  check("closed, orthogonal", closed_orthogonal, true, condition_orthogonal);
  check("orthogonal", orthogonal, true, condition_orthogonal);
}

static void svd_is_the_nearest_rotation(void **state) {
  (void)state;
  check("svd", svd, false, condition_rotation);
}

static void eigen_is_the_nearest_rotation(void **state) {
  (void)state;
  check("eigen", eigen, false, condition_squared);
}

static void a_cold_quaternion_is_the_nearest_rotation(void **state) {
  (void)state;
  check("quaternion", quaternion_cold, false, condition_rotation);
}

/* A warm start that is right stays right. */
static void a_warm_quaternion_stays(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int t = 0; t < TRIALS; t++) {
    double F[9], s[3], R[9], again[9], q[4] = {0};
    random_gradient(rng, t % 2 ? TURNED : RESTING, F, s);
    frame_polar_quaternion(F, q, R);
    for (int n = 0; n < 10; n++) frame_polar_quaternion(F, q, again);
    assert_within("ten calls on", distance(9, R, again) / (0x1p-53 * condition_rotation(s)), LIMIT);
  }
  gsl_rng_free(rng);
}

/* Also where a turn is by pi and the real part vanishes. */
static void quaternions_and_matrices_agree(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int t = 0; t < TRIALS; t++) {
    double R[9], back[9], q[4];
    random_rotation(rng, R);
    if (t % 4 == 0) {
      double axis[3];
      random_vector(rng, 3, axis);
      double length = norm(3, axis);
      for (int i = 0; i < 9; i++)
        R[i] = 2 * axis[i / 3] * axis[i % 3] / (length * length) - (i % 4 == 0);
    }
    quaternion_from(R, q);
    quaternion_matrix(q, back);
    assert_within("unit", fabs(norm(4, q) - 1) / 0x1p-53, LIMIT);
    assert_within("matrix", distance(9, R, back) / 0x1p-53, LIMIT);
  }
  gsl_rng_free(rng);
}

/* Edges e_b, e_c, e_d are the columns of F. */
static void qr_is_gram_schmidt(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int family = 0; family < FAMILIES; family++)
    for (int t = 0; t < TRIALS; t++) {
      double F[9], s[3], e[9], R[9], oracle[9], y[6];
      random_gradient(rng, (enum family)family, F, s);
      for (int i = 0; i < 9; i++) e[i] = F[i % 3 * 3 + i / 3];
      frame_qr(e, R, y);
      assert_int_equal(cb_oracle_qr(F, oracle), CB_OK);
      /* c - a loses what lies along b - a */
      double condition = 1 + norm(3, e + 3) / fabs(y[2]);
      const char *what = family_name[family];
      assert_within(what, distance(9, R, oracle) / (0x1p-53 * condition), LIMIT);
      assert_within(what, fabs(determinant3(R) - 1) / (0x1p-53 * condition), LIMIT);
      const double local[9] = {y[0], 0, 0, y[1], y[2], 0, y[3], y[4], y[5]};
      double world[9];
      product3_nt(local, R, world); /* rows R y_j */
      assert_within(what, distance(9, world, e) / (0x1p-53 * condition * norm(9, e)), LIMIT);
      assert_true(y[0] > 0 && y[2] > 0);
      if (fabs(s[2]) > 1e-12) assert_true((y[5] < 0) == (s[2] < 0));
    }
  gsl_rng_free(rng);
}

/* Rank 2: a rotation is still defined, the normal follows from the plane. */
static void flat_shapes_have_a_frame(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  frame_fn *const frames[] = {higham, closed, svd, eigen, quaternion_cold};
  for (int t = 0; t < TRIALS; t++) {
    double F[9], R[9], oracle[9];
    random_of_values(rng, 1.5, 0.75, 0, F);
    if (t % 2) F[2] = F[5] = F[8] = 0; /* not only to rounding */
    assert_int_equal(cb_oracle_polar(F, oracle), CB_OK);
    double U[9], s[3], V[9];
    assert_int_equal(cb_oracle_svd(F, U, s, V), CB_OK);
    for (size_t n = 0; n < sizeof frames / sizeof *frames; n++) {
      frames[n](F, R);
      assert_orthogonal("flat", R, 1);
      assert_within("flat", distance(9, R, oracle) / (0x1p-53 * s[0] * s[0] / (s[1] * s[1])),
                    LIMIT);
    }
  }
  gsl_rng_free(rng);
}

/* R := the frames that a model offers, through the arithmetic's own numbers. */
static void frames_of(const struct cb_model *model, const struct cb_arithmetic *a, size_t count,
                      const double *F, double *R) {
  float f[9 * 32], r[9 * 32];
  if (a->scalar_bytes == sizeof(double)) {
    model->frame(count, F, R);
    return;
  }
  for (size_t i = 0; i < 9 * count; i++) f[i] = (float)F[i];
  model->frame(count, f, r);
  for (size_t i = 0; i < 9 * count; i++) R[i] = (double)r[i];
}

/* What a model offers as its frame, in each arithmetic, whether or not the lanes are
 * filled: the same as in quad precision, and as the routine itself. */
static void models_offer_their_frames(void **state) {
  (void)state;
  enum { COUNT = 21 };
  gsl_rng *rng = scene_rng();
  double F[9 * COUNT], s[3], R[9 * COUNT], direct[9];
  quad exact[9 * COUNT], from[9 * COUNT];
  size_t offered = 0;
  for (size_t n = 0; n < COUNT; n++) random_gradient(rng, TURNED, F + 9 * n, s);
  for (size_t i = 0; i < 9 * COUNT; i++) from[i] = (float)F[i], F[i] = (float)F[i];
  for (size_t a = 0; cb_arithmetics[a]; a++) {
    const struct cb_arithmetic *A = cb_arithmetics[a];
    for (size_t m = 0; A->models[m] && cb_arithmetic_runs(A); m++) {
      const struct cb_model *model = A->models[m];
      if (!model->frame || A->scalar_bytes == sizeof(quad)) continue;
      const struct cb_model *c = scene_model(scene_counted(), model->name);
      c->frame(COUNT, from, exact);
      frames_of(model, A, COUNT, F, R);
      double far = 0;
      for (size_t i = 0; i < 9 * COUNT; i++) far = fmax(far, fabs(R[i] - (double)exact[i]));
      assert_within(model->name, far / A->roundoff, LIMIT);
      if (strcmp(A->name, "f64") == 0 && strcmp(model->name, "svd-updated") == 0) {
        frame_svd(F, direct);
        assert_memory_equal(direct, R, sizeof direct);
      }
      offered++;
    }
  }
  assert_true(offered >= 2 * 20); /* f64 and f32 at least */
  gsl_rng_free(rng);
}

/* Nothing, a line, a needle, a plane; test_degenerate.c has the rest. */
static void every_finite_input_has_a_frame(void **state) {
  (void)state;
  frame_fn *const frames[] = {orthogonal, higham, closed_orthogonal, closed,
                              svd,        eigen,  quaternion_cold};
  const double inputs[][9] = {{0},
                              {1, 2, 3, 0, 0, 0, -1, -2, -3},
                              {1, 0, 0, 0, 1e-12, 0, 0, 0, 1e-24},
                              {1e12, 0, 0, 0, 0, 1e12, 0, 0, 0}};
  double R[9], y[6];
  for (size_t i = 0; i < sizeof inputs / sizeof *inputs; i++)
    for (size_t n = 0; n < sizeof frames / sizeof *frames; n++) {
      frames[n](inputs[i], R);
      assert_orthogonal("any", R, 1);
    }
  const double edges[][9] = {{0}, {0, 0, 0, 0, 1, 0, 0, 0, 1}, {1, 0, 0, 2, 0, 0, 0, 0, 1}};
  for (size_t i = 0; i < sizeof edges / sizeof *edges; i++) {
    frame_qr(edges[i], R, y);
    assert_orthogonal("edges", R, 1);
    for (int j = 0; j < 6; j++) assert_true(isfinite(y[j]));
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(higham_is_the_nearest_rotation),
      cmocka_unit_test(closed_is_the_nearest_rotation),
      cmocka_unit_test(without_sign_handling_they_reflect),
      cmocka_unit_test(svd_is_the_nearest_rotation),
      cmocka_unit_test(eigen_is_the_nearest_rotation),
      cmocka_unit_test(a_cold_quaternion_is_the_nearest_rotation),
      cmocka_unit_test(a_warm_quaternion_stays),
      cmocka_unit_test(quaternions_and_matrices_agree),
      cmocka_unit_test(qr_is_gram_schmidt),
      cmocka_unit_test(flat_shapes_have_a_frame),
      cmocka_unit_test(models_offer_their_frames),
      cmocka_unit_test(every_finite_input_has_a_frame),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
