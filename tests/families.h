/* families.h - random deformation gradients of the kinds that element frames
 * meet: strained, inverted, turned, flat, barely moved, needles.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_FAMILIES_H
#define CB_TESTS_FAMILIES_H

#include "tests/scene.h"

enum family {
  STRAINED,      /* I + N/2, N normal: inverted or not */
  INVERTED,      /* the same with det < 0 */
  TURNED,        /* any rotation times I + N/5 */
  FLAT,          /* smallest singular value 1e-6, the others about 1 */
  FLAT_INVERTED, /* the same with det < 0 */
  RESTING,       /* I + 1e-8 N */
  STRETCHED,     /* singular values between 1/20 and 20 */
  NEEDLE,        /* singular values 1, 1e-3, 1e-6 */
  FAMILIES
};
static const char *const family_name[FAMILIES] = {
    "strained", "inverted", "turned", "flat", "flat inverted", "resting", "stretched", "needle"};

/* F := U diag(s) V^T with random rotations. */
static inline void random_of_values(gsl_rng *rng, double a, double b, double c, double F[9]) {
  double U[9], V[9];
  const double s[3] = {a, b, c};
  random_rotation(rng, U);
  random_rotation(rng, V);
  for (int i = 0; i < 9; i++) U[i] *= s[i % 3];
  product3_nt(U, V, F);
}

/* F[9], and its singular values s[3], descending, the last with the sign of det F. */
static inline void random_gradient(gsl_rng *rng, enum family family, double F[9], double s[3]) {
  double R[9], A[9], U[9], V[9], about = 0.5 + gsl_rng_uniform(rng);
  const double spread[FAMILIES] = {
      [STRAINED] = 0.5, [INVERTED] = 0.5, [TURNED] = 0.2, [RESTING] = 1e-8};
  do {
    for (int i = 0; i < 9; i++) A[i] = (i % 4 == 0) + gsl_ran_gaussian(rng, spread[family]);
  } while (family == INVERTED && determinant3(A) >= 0);
  memcpy(F, A, sizeof A);
  random_rotation(rng, R);
  if (family == TURNED) product3_nt(R, A, F);
  if (family == FLAT) random_of_values(rng, about, 1, 1e-6, F);
  if (family == FLAT_INVERTED) random_of_values(rng, about, 1, -1e-6, F);
  if (family == NEEDLE) random_of_values(rng, 1, 1e-3 * about, 1e-6, F);
  if (family == STRETCHED) {
    double e[3];
    for (int i = 0; i < 3; i++) e[i] = exp(gsl_ran_flat(rng, -3, 3));
    random_of_values(rng, e[0], e[1], e[2], F);
  }
  assert_int_equal(cb_oracle_svd(F, U, s, V), CB_OK);
  if (determinant3(F) < 0) s[2] = -s[2];
}

#endif
