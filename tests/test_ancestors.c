/* test_ancestors.c - precomputed inverse and condensation give the surface
 * displacements of a full direct solution, whatever is surface and fixed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/ancestors.h"
#include "reference/direct.h"
#include "tests/block_system.h"

#include <float.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_randist.h>
#include <string.h>

enum { SIDE = 4, NODES = SIDE * SIDE * SIDE, N = 3 * NODES };

/* A block held at node 0 and others; the first `count` nodes of `surface` are the surface. */
struct problem {
  gsl_rng *rng;
  struct block_system s;
  uint8_t fixed[NODES];
  uint32_t surface[NODES];
  size_t count;
};

static struct problem problem_new(size_t count, double held) {
  struct problem p = {.rng = gsl_rng_alloc(gsl_rng_mt19937), .count = count};
  assert_non_null(p.rng);
  p.s = block_system_new(p.rng, SIDE);
  for (uint32_t i = 0; i < NODES; i++) {
    p.surface[i] = i;
    p.fixed[i] = i == 0 || gsl_rng_uniform(p.rng) < held;
  }
  gsl_ran_shuffle(p.rng, p.surface, NODES, sizeof *p.surface);
  return p;
}

static void problem_free(struct problem *p) {
  block_system_free(&p->s);
  gsl_rng_free(p->rng);
}

static enum cb_status new_inverse(const struct problem *p, struct cb_inverse **out) {
  return cb_inverse_create(NODES, p->s.row_start, p->s.column, p->s.blocks, p->fixed, p->count,
                           p->surface, out);
}

static enum cb_status new_condensation(const struct problem *p, struct cb_condensation **out) {
  return cb_condensation_create(NODES, p->s.row_start, p->s.column, p->s.blocks, p->fixed, p->count,
                                p->surface, out);
}

/* u[3 count] from the whole system, nothing loading the interior. */
static void solve_whole(const struct problem *p, const double *f, double *u) {
  struct cb_direct *d = NULL;
  double b[N] = {0}, x[N];
  for (size_t i = 0; i < 3 * p->count; i++) b[3 * p->surface[i / 3] + i % 3] = f[i];
  assert_int_equal(cb_direct_create(NODES, p->s.row_start, p->s.column, p->fixed, &d), CB_OK);
  assert_int_equal(cb_direct_factor(d, p->s.blocks, NULL), CB_OK);
  assert_int_equal(cb_direct_solve(d, b, x), CB_OK);
  for (size_t i = 0; i < 3 * p->count; i++) u[i] = x[3 * p->surface[i / 3] + i % 3];
  cb_direct_free(d);
}

/* Largest relative distance of the two methods from the direct solution. */
static void compare(const struct problem *p, double *inverse_error, double *condensation_error) {
  size_t n = 3 * p->count;
  struct cb_inverse *inverse = NULL;
  struct cb_condensation *condensation = NULL;
  assert_int_equal(new_inverse(p, &inverse), CB_OK);
  assert_int_equal(new_condensation(p, &condensation), CB_OK);
  for (int load = 0; load < 3; load++) {
    double f[N], expected[N], by_inverse[N], by_condensation[N];
    random_vector(p->rng, n, f);
    solve_whole(p, f, expected);
    cb_inverse_apply(inverse, f, by_inverse);
    cb_condensation_apply(condensation, f, by_condensation);
    for (size_t i = 0; i < n; i++)
      if (p->fixed[p->surface[i / 3]]) assert_true(by_inverse[i] == 0 && by_condensation[i] == 0);
    double size = norm(n, expected) + DBL_MIN;
    *inverse_error = fmax(*inverse_error, distance(n, by_inverse, expected) / size);
    *condensation_error = fmax(*condensation_error, distance(n, by_condensation, expected) / size);
    cb_condensation_apply(condensation, f, f);
    assert_memory_equal(f, by_condensation, n * sizeof *f);
  }
  cb_inverse_free(inverse);
  cb_condensation_free(condensation);
}

static void both_agree_with_the_whole_system(void **state) {
  (void)state;
  const size_t counts[] = {1, 10, NODES / 2, NODES};
  double inverse_error = 0, condensation_error = 0;
  for (size_t i = 0; i < 4; i++) {
    struct problem p = problem_new(counts[i], 0.2);
    compare(&p, &inverse_error, &condensation_error);
    problem_free(&p);
  }
  /* The limit is about their condition, 146; measured 4 and 3.5. */
  assert_within("inverse, roundings", inverse_error / DBL_EPSILON, 140);
  assert_within("condensation, roundings", condensation_error / DBL_EPSILON, 140);
}

static void nothing_moves_where_all_is_fixed(void **state) {
  (void)state;
  double inverse_error = 0, condensation_error = 0;
  struct problem p = problem_new(NODES, 2);
  compare(&p, &inverse_error, &condensation_error);
  /* Only the surface fixed: the interior is eliminated all the same. */
  p.count = 10;
  memset(p.fixed, 0, sizeof p.fixed);
  for (size_t i = 0; i < p.count; i++) p.fixed[p.surface[i]] = 1;
  compare(&p, &inverse_error, &condensation_error);
  assert_true(inverse_error == 0 && condensation_error == 0);
  problem_free(&p);
}

/* Maxwell, Betti: f1 . u2 = f2 . u1. */
static void forces_and_displacements_are_reciprocal(void **state) {
  (void)state;
  struct problem p = problem_new(20, 0.1);
  struct cb_inverse *inverse = NULL;
  struct cb_condensation *condensation = NULL;
  double f[2][60], u[2][60];
  assert_int_equal(new_inverse(&p, &inverse), CB_OK);
  assert_int_equal(new_condensation(&p, &condensation), CB_OK);
  for (int method = 0; method < 2; method++) {
    double work = 0, difference = 0;
    for (int load = 0; load < 2; load++) {
      random_vector(p.rng, 60, f[load]);
      if (method == 0)
        cb_inverse_apply(inverse, f[load], u[load]);
      else
        cb_condensation_apply(condensation, f[load], u[load]);
    }
    for (int i = 0; i < 60; i++) {
      work += fabs(f[0][i] * u[1][i]);
      difference += f[0][i] * u[1][i] - f[1][i] * u[0][i];
    }
    /* measured 0.6 and 0.1 */
    assert_within("reciprocity, roundings", fabs(difference) / work / DBL_EPSILON, 140);
  }
  cb_inverse_free(inverse);
  cb_condensation_free(condensation);
  problem_free(&p);
}

static void the_handler(const char *reason, const char *file, int line, int error) {
  fail_msg("GSL's handler was called: %s, %s:%d, %d", reason, file, line, error);
}

/* Nothing held: whatever is surface, with many numbers (see test_direct.c). */
static void bodies_that_float_are_refused(void **state) {
  (void)state;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  gsl_error_handler_t *before = gsl_set_error_handler(the_handler);
  for (size_t trial = 0; trial < 200; trial++) {
    struct block_system s = block_system_new(rng, 2);
    const uint32_t surface[8] = {3, 1, 7, 2, 0, 4, 6, 5};
    struct cb_inverse *inverse = NULL;
    struct cb_condensation *condensation = NULL;
    assert_int_equal(cb_inverse_create(8, s.row_start, s.column, s.blocks, NULL, 1 + trial % 8,
                                       surface, &inverse),
                     CB_NUMERIC);
    assert_int_equal(cb_condensation_create(8, s.row_start, s.column, s.blocks, NULL, 1 + trial % 8,
                                            surface, &condensation),
                     CB_NUMERIC);
    assert_true(!inverse && !condensation);
    block_system_free(&s);
  }
  assert_true(gsl_set_error_handler(before) == the_handler);
  gsl_rng_free(rng);
}

/* A surface node on a spring that pushes. */
static void indefinite_and_nan_are_refused(void **state) {
  (void)state;
  gsl_error_handler_t *before = gsl_set_error_handler(the_handler);
  const double bad[] = {-1e4, NAN};
  for (int i = 0; i < 2; i++) {
    struct problem p = problem_new(10, 0.2);
    struct cb_inverse *inverse = NULL;
    struct cb_condensation *condensation = NULL;
    uint32_t node = p.surface[7], k = p.s.row_start[node];
    while (p.s.column[k] != node) k++;
    p.fixed[node] = 0;
    p.s.blocks[9 * k + 4] = bad[i];
    assert_int_equal(new_inverse(&p, &inverse), CB_NUMERIC);
    assert_int_equal(new_condensation(&p, &condensation), CB_NUMERIC);
    assert_true(!inverse && !condensation);
    problem_free(&p);
  }
  assert_true(gsl_set_error_handler(before) == the_handler);
}

static void an_empty_surface_is_refused(void **state) {
  (void)state;
  struct problem p = problem_new(0, 0.2);
  struct cb_inverse *inverse = NULL;
  struct cb_condensation *condensation = NULL;
  assert_int_equal(new_inverse(&p, &inverse), CB_INPUT);
  assert_int_equal(new_condensation(&p, &condensation), CB_INPUT);
  assert_true(!inverse && !condensation);
  problem_free(&p);
}

/* Both keep a dense matrix of the surface and forget the interior. */
static void memory_is_that_of_the_surface(void **state) {
  (void)state;
  struct problem p = problem_new(10, 0);
  struct cb_inverse *inverse = NULL;
  struct cb_condensation *condensation = NULL;
  assert_int_equal(new_inverse(&p, &inverse), CB_OK);
  assert_int_equal(new_condensation(&p, &condensation), CB_OK);
  assert_in_range(cb_inverse_bytes(inverse), 30 * 30 * 8, 30 * 30 * 8 + 100);
  assert_in_range(cb_condensation_bytes(condensation), 30 * 32 * 8, 30 * 32 * 8 + 300);
  cb_inverse_free(inverse);
  cb_condensation_free(condensation);
  problem_free(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(both_agree_with_the_whole_system),
      cmocka_unit_test(nothing_moves_where_all_is_fixed),
      cmocka_unit_test(forces_and_displacements_are_reciprocal),
      cmocka_unit_test(bodies_that_float_are_refused),
      cmocka_unit_test(indefinite_and_nan_are_refused),
      cmocka_unit_test(an_empty_surface_is_refused),
      cmocka_unit_test(memory_is_that_of_the_surface),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
