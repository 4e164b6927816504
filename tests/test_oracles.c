/* test_oracles.c - the oracles of the frames keep their defining properties on
 * random, inverted, nearly flat and flat matrices.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/oracles.h"
#include "tests/vectors.h"

#include <float.h>
#include <string.h>

enum { TRIALS = 2000 };
enum shape { STRETCHED, INVERTED, NEARLY_FLAT, FLAT, SHAPES };

static void multiply(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

static void multiply_transposed(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

static double determinant(const double A[9]) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

static double orthogonality_error(const double R[9]) {
  const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double C[9];
  multiply_transposed(R, R, C);
  return distance(9, C, identity) / DBL_EPSILON;
}

/* Rodrigues' formula about a unit axis */
static void rotation(const double axis[3], double angle, double R[9]) {
  const double K[9] = {0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0};
  double KK[9], versine = 2 * sin(angle / 2) * sin(angle / 2);
  multiply(K, K, KK);
  for (int i = 0; i < 9; i++) R[i] = (i % 4 == 0) + sin(angle) * K[i] + versine * KK[i];
}

static void random_axis(gsl_rng *rng, double axis[3]) {
  random_vector(rng, 3, axis);
  double length = norm(3, axis);
  for (int i = 0; i < 3; i++) axis[i] /= length;
}

static void random_rotation(gsl_rng *rng, double R[9]) {
  double axis[3];
  random_axis(rng, axis);
  rotation(axis, acos(-1) * gsl_rng_uniform(rng), R);
}

/* F = P diag(s) Q^T with s1 > s2 > |s3|, so that the nearest rotation is P Q^T
 * and the nearest orthogonal matrix P diag(1, 1, sign s3) Q^T. */
struct known {
  double F[9], rotation[9], orthogonal[9], s[3];
};

static struct known random_shape(gsl_rng *rng, enum shape shape) {
  const double third[SHAPES] = {1, -1, 1e-12, 0};
  double P[9], Q[9], Ps[9], Pm[9];
  struct known k = {.s = {3, 2, third[shape] * (0.5 + gsl_rng_uniform(rng))}};
  random_rotation(rng, P);
  random_rotation(rng, Q);
  for (int i = 0; i < 9; i++) {
    Ps[i] = P[i] * k.s[i % 3];
    Pm[i] = P[i] * (i % 3 == 2 && k.s[2] < 0 ? -1 : 1);
  }
  multiply(Ps, Q, k.F);
  multiply(P, Q, k.rotation);
  multiply(Pm, Q, k.orthogonal);
  return k;
}

static gsl_rng *rng_new(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  assert_non_null(rng);
  return rng;
}

static double decomposition_error(const double F[9], const double U[9], const double S[3],
                                  const double V[9]) {
  double US[9], VT[9], product[9];
  for (int i = 0; i < 9; i++) {
    US[i] = U[i] * S[i % 3];
    VT[i] = V[3 * (i % 3) + i / 3];
  }
  multiply(US, VT, product);
  return distance(9, product, F) / (DBL_EPSILON * (norm(9, F) + DBL_MIN));
}

static void singular_values_decompose(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  double product = 0, frames = 0, values = 0, U[9], S[3], V[9];
  for (int trial = 0; trial < TRIALS; trial++) {
    struct known k = random_shape(rng, trial % SHAPES);
    const double expected[3] = {k.s[0], k.s[1], fabs(k.s[2])};
    assert_int_equal(cb_oracle_svd(k.F, U, S, V), CB_OK);
    assert_true(S[0] >= S[1] && S[1] >= S[2] && S[2] >= 0);
    product = fmax(product, decomposition_error(k.F, U, S, V));
    frames = fmax(frames, fmax(orthogonality_error(U), orthogonality_error(V)));
    values = fmax(values, distance(3, S, expected) / (S[0] * DBL_EPSILON));
  }
  assert_within("F - U S V^T, roundings", product, 40);    /* measured 9 */
  assert_within("orthogonality, roundings", frames, 40);   /* measured 11 */
  assert_within("singular values, roundings", values, 40); /* measured 7 */
  gsl_rng_free(rng);
}

static void singular_values_of_collapsed_matrices(void **state) {
  (void)state;
  const double collapsed[][9] = {{0},
                                 {0, 0, 0, 0, 5, 0, 0, 0, 0},
                                 {1, 2, 3, 2, 4, 6, -3, -6, -9},
                                 {1, 1, 1, 1, 1, 1, 1, 1, 1},
                                 {0, 0, 1, 0, 0, 2, 0, 0, 3},
                                 {1e-300, 0, 0, 0, 1e-310, 0, 0, 0, 0}};
  for (size_t i = 0; i < sizeof collapsed / sizeof *collapsed; i++) {
    double U[9], S[3], V[9], R[9];
    assert_int_equal(cb_oracle_svd(collapsed[i], U, S, V), CB_OK);
    assert_within("product", decomposition_error(collapsed[i], U, S, V), 20);
    assert_within("frames", fmax(orthogonality_error(U), orthogonality_error(V)), 20);
    assert_int_equal(cb_oracle_polar(collapsed[i], R), CB_OK);
    assert_within("polar", fmax(orthogonality_error(R), fabs(determinant(R) - 1) / DBL_EPSILON),
                  20);
  }
}

static void polar_is_the_nearest_rotation(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  double rotations = 0, error = 0, nearer = -INFINITY, R[9];
  for (int trial = 0; trial < TRIALS; trial++) {
    struct known k = random_shape(rng, trial % SHAPES);
    double other[9];
    assert_int_equal(cb_oracle_polar(k.F, R), CB_OK);
    rotations = fmax(rotations, orthogonality_error(R));
    rotations = fmax(rotations, fabs(determinant(R) - 1) / DBL_EPSILON);
    /* The condition of the nearest rotation is 1 / (s2 + s3). */
    error = fmax(error, distance(9, R, k.rotation) * (k.s[1] + k.s[2]) / k.s[0] / DBL_EPSILON);
    random_rotation(rng, other);
    nearer = fmax(nearer, distance(9, k.F, R) - distance(9, k.F, other));
  }
  assert_within("rotation, roundings", rotations, 40);          /* measured 15 */
  assert_within("error, roundings times condition", error, 40); /* measured 11 */
  assert_within("distance beyond that of some other rotation", nearer, 0);
  gsl_rng_free(rng);
}

static void orthogonal_polar_keeps_reflections(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  double frames = 0, error = 0, symmetry = 0, R[9], S[9];
  for (int trial = 0; trial < TRIALS; trial++) {
    enum shape shape = trial % SHAPES;
    struct known k = random_shape(rng, shape);
    assert_int_equal(cb_oracle_polar_orthogonal(k.F, R), CB_OK);
    frames = fmax(frames, orthogonality_error(R));
    multiply_transposed(R, k.F, S);
    symmetry = fmax(symmetry, hypot(hypot(S[1] - S[3], S[2] - S[6]), S[5] - S[7]) / DBL_EPSILON);
    if (shape == NEARLY_FLAT || shape == FLAT) continue; /* which side is not determined */
    assert_true(determinant(R) * k.s[2] > 0);
    error = fmax(error, distance(9, R, k.orthogonal) / DBL_EPSILON);
  }
  assert_within("orthogonality, roundings", frames, 40);       /* measured 14 */
  assert_within("symmetry of R^T F, roundings", symmetry, 40); /* measured 13 */
  assert_within("error, roundings", error, 40);                /* measured 8 */
  gsl_rng_free(rng);
}

static void qr_leaves_a_positive_triangle(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  double rotations = 0, below = 0, R[9], U[9];
  for (int trial = 0; trial < TRIALS; trial++) {
    enum shape shape = trial % SHAPES;
    struct known k = random_shape(rng, shape);
    assert_int_equal(cb_oracle_qr(k.F, R), CB_OK);
    rotations = fmax(rotations, orthogonality_error(R));
    rotations = fmax(rotations, fabs(determinant(R) - 1) / DBL_EPSILON);
    multiply_transposed(R, k.F, U);
    below = fmax(below, hypot(hypot(U[3], U[6]), U[7]) / DBL_EPSILON);
    assert_true(U[0] > 0 && U[4] > 0);
    if (shape == STRETCHED || shape == INVERTED) assert_true(U[8] * k.s[2] > 0);
  }
  assert_within("rotation, roundings", rotations, 40);       /* measured 7 */
  assert_within("below the diagonal, roundings", below, 40); /* measured 7 */
  gsl_rng_free(rng);
}

static void qr_refuses_dependent_columns(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  for (int trial = 0; trial < TRIALS; trial++) {
    double F[9], R[9] = {7};
    random_vector(rng, 9, F);
    double factor = trial % 10 ? 2 * gsl_rng_uniform(rng) - 1 : 0;
    for (int i = 0; i < 9; i += 3) F[i + trial % 2] = factor * F[i + 1 - trial % 2];
    assert_int_equal(cb_oracle_qr(F, R), CB_NUMERIC);
    assert_true(R[0] == 7);
  }
  gsl_rng_free(rng);
}

static void numbers_that_are_not_finite_are_refused(void **state) {
  (void)state;
  const double bad[] = {NAN, INFINITY, -INFINITY};
  for (int i = 0; i < 27; i++) {
    double F[9] = {1, 0.1, 0.2, 0.1, 1, 0.3, 0.2, 0.3, 1}, U[9] = {7}, S[3] = {7}, V[9] = {7};
    F[i % 9] = bad[i / 9];
    assert_int_equal(cb_oracle_svd(F, U, S, V), CB_NUMERIC);
    assert_int_equal(cb_oracle_polar(F, U), CB_NUMERIC);
    assert_int_equal(cb_oracle_polar_orthogonal(F, U), CB_NUMERIC);
    assert_int_equal(cb_oracle_qr(F, U), CB_NUMERIC);
    assert_int_equal(cb_oracle_eigenvalues(3, F, S), i % 9 / 3 >= i % 3 ? CB_NUMERIC : CB_OK);
    assert_true(U[0] == 7 && V[0] == 7 && (S[0] == 7 || i % 9 / 3 < i % 3));
  }
}

static void outputs_may_be_inputs(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  enum cb_status (*const oracle[])(const double *, double *) = {
      cb_oracle_polar, cb_oracle_polar_orthogonal, cb_oracle_qr};
  for (size_t i = 0; i < 3; i++) {
    struct known k = random_shape(rng, INVERTED);
    double R[9];
    assert_int_equal(oracle[i](k.F, R), CB_OK);
    assert_int_equal(oracle[i](k.F, k.F), CB_OK);
    assert_memory_equal(R, k.F, sizeof R);
  }
  gsl_rng_free(rng);
}

static void angles_are_accurate_from_zero_to_pi(void **state) {
  (void)state;
  gsl_rng *rng = rng_new();
  const double pi = acos(-1), identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double small = 0, any = 0, axis[3], R[9];
  for (int trial = 0; trial < TRIALS; trial++) {
    double tiny = pow(10, -200 * gsl_rng_uniform(rng)), angle = pi * gsl_rng_uniform(rng);
    random_axis(rng, axis);
    rotation(axis, tiny, R);
    small = fmax(small, fabs(cb_rotation_angle(R) - tiny) / tiny);
    rotation(axis, angle, R);
    any = fmax(any, fabs(cb_rotation_angle(R) - angle));
    rotation(axis, pi - tiny, R);
    any = fmax(any, fabs(cb_rotation_angle(R) - (pi - tiny)));
  }
  assert_true(cb_rotation_angle(identity) == 0);
  assert_within("small angles, relative, roundings", small / DBL_EPSILON, 10); /* measured 1.5 */
  assert_within("all angles, absolute, roundings", any / DBL_EPSILON, 10);     /* measured 3 */
  gsl_rng_free(rng);
}

/* Second differences: 2 - 2 cos(k pi / (n + 1)), k = 1 .. n. The upper triangle
 * is not read. */
static void eigenvalues_are_those_of_second_differences(void **state) {
  (void)state;
  enum { MOST = 40 };
  double A[MOST * MOST] = {0}, values[MOST], worst = 0;
  for (size_t n = 0; n <= MOST; n++) {
    for (size_t i = 0; i < n; i++)
      for (size_t j = 0; j < n; j++)
        A[i * n + j] = j > i ? NAN : (i == j) * 2.0 - (i == j + 1) * 1.0;
    assert_int_equal(cb_oracle_eigenvalues(n, A, values), CB_OK);
    for (size_t k = 0; k < n; k++) {
      double half = sin((double)(k + 1) * acos(-1) / (double)(2 * (n + 1)));
      worst = fmax(worst, fabs(values[k] - 4 * half * half) / (4 * DBL_EPSILON));
    }
  }
  assert_within("error, roundings of the largest", worst, 40); /* measured 11 */
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(singular_values_decompose),
      cmocka_unit_test(singular_values_of_collapsed_matrices),
      cmocka_unit_test(polar_is_the_nearest_rotation),
      cmocka_unit_test(orthogonal_polar_keeps_reflections),
      cmocka_unit_test(qr_leaves_a_positive_triangle),
      cmocka_unit_test(qr_refuses_dependent_columns),
      cmocka_unit_test(numbers_that_are_not_finite_are_refused),
      cmocka_unit_test(outputs_may_be_inputs),
      cmocka_unit_test(angles_are_accurate_from_zero_to_pi),
      cmocka_unit_test(eigenvalues_are_those_of_second_differences),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
