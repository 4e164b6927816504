/* test_material.c - stress-strain matrices and lumped masses.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "kernels/kernel.h"

static void isotropic_is_lame(void **state) {
  (void)state;
  const double young = 3e6, poisson = 0.3;
  const double mu = young / 2.6, lambda = young * 0.3 / (1.3 * 0.4);
  struct cb_material m;
  assert_int_equal(cb_material_isotropic(young, poisson, 1000, &m), CB_OK);
  assert_false(m.orthotropic);
  assert_true(m.young == young && m.poisson == poisson && m.density == 1000);
  for (size_t i = 0; i < 6; i++)
    for (size_t j = 0; j < 6; j++) {
      double expected = i < 3 && j < 3 ? lambda : 0;
      if (i == j) expected += i < 3 ? 2 * mu : mu;
      assert_true(fabs(m.D[6 * i + j] - expected) <= 4 * DBL_EPSILON * young);
      assert_true(m.D[6 * i + j] == m.D[6 * j + i]);
    }
}

static void zero_young_exerts_nothing(void **state) {
  (void)state;
  struct cb_material m;
  assert_int_equal(cb_material_isotropic(0, 0.3, 1, &m), CB_OK);
  for (size_t i = 0; i < 36; i++) assert_true(m.D[i] == 0);
}

static void isotropic_refuses(void **state) {
  (void)state;
  struct cb_material m, before;
  memset(&m, 0x5a, sizeof m);
  before = m;
  const double bad[][3] = {{-1, 0.3, 1},      {NAN, 0.3, 1},      {INFINITY, 0.3, 1},
                           {1, -1, 1},        {1, 0.5, 1},        {1, NAN, 1},
                           {1, -INFINITY, 1}, {1, 0.3, 0},        {1, 0.3, -1},
                           {1, 0.3, NAN},     {1, 0.3, INFINITY}, {DBL_MAX, 0.4999999, 1}};
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    assert_int_equal(cb_material_isotropic(bad[i][0], bad[i][1], bad[i][2], &m), CB_INPUT);
    assert_memory_equal(&m, &before, sizeof m);
  }
}

static void orthotropic_of_isotropic_constants(void **state) {
  (void)state;
  const double poissons[] = {-0.9, -0.3, 0, 0.3, 0.49, 0.4999};
  for (size_t n = 0; n < sizeof poissons / sizeof *poissons; n++) {
    double p = poissons[n], young = 7e5, G = young / (2 * (1 + p));
    struct cb_material a, b;
    assert_int_equal(cb_material_isotropic(young, p, 500, &a), CB_OK);
    assert_int_equal(cb_material_orthotropic((double[]){young, young, young}, (double[]){p, p, p},
                                             (double[]){G, G, G}, 500, &b),
                     CB_OK);
    assert_true(b.orthotropic && b.density == 500);
    /* The determinant (1 + nu)^2 (1 - 2 nu) is a difference of numbers near 1. */
    double condition = 1 / ((1 + p) * (1 + p) * (1 - 2 * p));
    for (size_t i = 0; i < 36; i++)
      assert_true(fabs(a.D[i] - b.D[i]) <= 8 * DBL_EPSILON * condition * a.D[0]);
  }
}

static void orthotropic_inverts_compliance(void **state) {
  (void)state;
  const double E[3] = {1.1e10, 8e8, 4e8}, nu[3] = {0.4, 0.35, 0.02}, G[3] = {7e8, 6e7, 6.5e8};
  double S[36] = {0};
  for (size_t i = 0; i < 3; i++) {
    size_t j = (i + 1) % 3;
    S[7 * i] = 1 / E[i];
    S[6 * i + j] = S[6 * j + i] = -nu[i] / E[i];
    S[7 * (3 + i)] = 1 / G[i];
  }
  struct cb_material m;
  assert_int_equal(cb_material_orthotropic(E, nu, G, 450, &m), CB_OK);
  for (size_t i = 0; i < 6; i++)
    for (size_t j = 0; j < 6; j++) {
      double sum = 0, size = 0;
      for (size_t k = 0; k < 6; k++) {
        sum += S[6 * i + k] * m.D[6 * k + j];
        size += fabs(S[6 * i + k] * m.D[6 * k + j]);
      }
      assert_true(fabs(sum - (i == j)) <= 32 * DBL_EPSILON * fmax(size, 1));
      assert_true(m.D[6 * i + j] == m.D[6 * j + i]);
    }
}

static void orthotropic_refuses(void **state) {
  (void)state;
  const double good[10] = {2, 3, 4, 0.2, 0.3, 0.1, 1, 1, 1, 5};
  const struct {
    size_t which;
    double value;
  } bad[] = {{0, 0},   {1, -1},  {2, NAN}, {0, INFINITY}, {3, NAN},     {4, INFINITY}, {5, NAN},
             {3, 1.5}, {4, 1.5}, {5, 1.5}, {6, 0},        {7, -1},      {8, NAN},      {9, 0},
             {9, NAN}, {9, -1},  {3, -5},  {8, INFINITY}, {9, INFINITY}};
  struct cb_material m, before;
  assert_int_equal(cb_material_orthotropic(good, good + 3, good + 6, good[9], &m), CB_OK);
  memset(&m, 0x5a, sizeof m);
  before = m;
  for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
    double p[10];
    memcpy(p, good, sizeof p);
    p[bad[i].which] = bad[i].value;
    assert_int_equal(cb_material_orthotropic(p, p + 3, p + 6, p[9], &m), CB_INPUT);
    assert_memory_equal(&m, &before, sizeof m);
  }
  /* A positive determinant alone does not do: two eigenvalues are negative. */
  assert_int_equal(cb_material_orthotropic((double[]){1, 1, 1}, (double[]){-2, -2, -4},
                                           (double[]){1, 1, 1}, 1, &m),
                   CB_INPUT);
  /* Incompressible: every parameter is fine, the compliance is singular. */
  assert_int_equal(cb_material_orthotropic((double[]){1, 1, 1}, (double[]){0.5, 0.5, 0.5},
                                           (double[]){1, 1, 1}, 1, &m),
                   CB_INPUT);
}

static void mass_of_two_tetrahedra(void **state) {
  (void)state;
  /* The second is negatively oriented and as heavy. */
  double X[] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 1, 0, 0, -1};
  uint32_t tet[] = {0, 1, 2, 3, 0, 1, 2, 4};
  struct cb_mesh mesh = {.nodes = 5, .tets = 2, .X = X, .tet = tet, .share = 0.5};
  assert_true(cb_mesh_six_volumes(&mesh, 0) == 6 && cb_mesh_six_volumes(&mesh, 1) == -6);
  double mass[5] = {9, 9, 9, 9, 9};
  cb_mesh_mass(&mesh, 8, mass);
  const double expected[] = {2, 2, 2, 1, 1};
  for (size_t i = 0; i < 5; i++) assert_true(mass[i] == expected[i]);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(isotropic_is_lame),
      cmocka_unit_test(zero_young_exerts_nothing),
      cmocka_unit_test(isotropic_refuses),
      cmocka_unit_test(orthotropic_of_isotropic_constants),
      cmocka_unit_test(orthotropic_inverts_compliance),
      cmocka_unit_test(orthotropic_refuses),
      cmocka_unit_test(mass_of_two_tetrahedra),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
