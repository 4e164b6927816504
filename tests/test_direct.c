/* test_direct.c - the direct solver against dense algebra, with new numbers,
 * fixed nodes, singular matrices and failing allocations.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/direct.h"
#include "reference/oracles.h"
#include "tests/block_system.h"

#include <SuiteSparse_config.h>
#include <dlfcn.h>
#include <float.h>
#include <gsl/gsl_linalg.h>
#include <string.h>

enum { SIDE = 4, NODES = SIDE * SIDE * SIDE, N = 3 * NODES };

struct problem {
  gsl_rng *rng;
  struct block_system s;
  uint8_t fixed[NODES];
  double mass[NODES], b[N];
};

static struct problem problem_new(unsigned long seed) {
  struct problem p = {.rng = gsl_rng_alloc(gsl_rng_mt19937)};
  assert_non_null(p.rng);
  gsl_rng_set(p.rng, seed);
  p.s = block_system_new(p.rng, SIDE);
  for (size_t i = 0; i < NODES; i++) {
    p.fixed[i] = gsl_rng_uniform(p.rng) < 0.2;
    p.mass[i] = gsl_rng_uniform(p.rng);
  }
  random_vector(p.rng, N, p.b);
  return p;
}

static void problem_free(struct problem *p) {
  block_system_free(&p->s);
  gsl_rng_free(p->rng);
}

/* The systems have conditions of 160 to 200 with masses. */
static double roundings(const double x[N], const double y[N]) {
  return distance(N, x, y) / norm(N, x) / DBL_EPSILON;
}

static struct cb_direct *direct_new(const struct problem *p, const uint8_t *fixed) {
  struct cb_direct *d = NULL;
  assert_int_equal(cb_direct_create(p->s.nodes, p->s.row_start, p->s.column, fixed, &d), CB_OK);
  assert_non_null(d);
  return d;
}

/* b with zeros at fixed nodes, as the dense identity rows need it */
static void masked(const struct problem *p, double b[N]) {
  for (size_t i = 0; i < N; i++) b[i] = p->fixed[i / 3] ? 0 : p->b[i];
}

static void solve_dense(const double *A, const double b[N], double x[N]) {
  gsl_matrix_const_view given = gsl_matrix_const_view_array(A, N, N);
  gsl_vector_const_view right = gsl_vector_const_view_array(b, N);
  gsl_vector_view solution = gsl_vector_view_array(x, N);
  gsl_matrix *lu = gsl_matrix_alloc(N, N);
  gsl_permutation *rows = gsl_permutation_alloc(N);
  int sign;
  gsl_matrix_memcpy(lu, &given.matrix);
  assert_int_equal(gsl_linalg_LU_decomp(lu, rows, &sign), 0);
  assert_int_equal(gsl_linalg_LU_solve(lu, rows, &right.vector, &solution.vector), 0);
  gsl_permutation_free(rows);
  gsl_matrix_free(lu);
}

static void solution_is_that_of_dense_elimination(void **state) {
  (void)state;
  double worst_error = 0;
  for (unsigned long seed = 1; seed <= 3; seed++) {
    struct problem p = problem_new(seed);
    struct cb_direct *d = direct_new(&p, p.fixed);
    double b[N], x[N], expected[N], values[N];
    double *A = block_system_dense(&p.s, p.fixed, p.mass);
    masked(&p, b);
    assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
    assert_int_equal(cb_direct_solve(d, p.b, x), CB_OK);
    solve_dense(A, b, expected);
    assert_int_equal(cb_oracle_eigenvalues(N, A, values), CB_OK);
    double condition = values[N - 1] / values[0];
    worst_error = fmax(worst_error, distance(N, x, expected) / norm(N, x) / condition);
    free(A);
    cb_direct_free(d);
    problem_free(&p);
  }
  /* measured 0.04 */
  assert_within("error, roundings times condition", worst_error / DBL_EPSILON, 1);
}

/* Masses from 1e-4 to 1e4. The residual of every single row, against the terms
 * that it is made of: measured 2.5 roundings, 7.6 without the refinement. */
static void every_row_holds_to_rounding(void **state) {
  (void)state;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  struct block_system s = block_system_new(rng, 10);
  size_t n = 3 * s.nodes;
  double *mass = calloc(s.nodes, sizeof *mass), *x = calloc(2 * n, sizeof *x), *b = x + n;
  struct cb_direct *d = NULL;
  double worst = 0;
  assert_true(mass && x);
  for (size_t i = 0; i < s.nodes; i++) mass[i] = pow(10, 8 * gsl_rng_uniform(rng) - 4);
  random_vector(rng, n, b);
  assert_int_equal(cb_direct_create(s.nodes, s.row_start, s.column, NULL, &d), CB_OK);
  assert_int_equal(cb_direct_factor(d, s.blocks, mass), CB_OK);
  assert_int_equal(cb_direct_solve(d, b, x), CB_OK);
  for (size_t i = 0; i < n; i++) {
    long double residual = b[i] - (long double)mass[i / 3] * x[i];
    double terms = fabs(b[i]) + fabs(mass[i / 3] * x[i]);
    for (uint32_t k = s.row_start[i / 3]; k < s.row_start[i / 3 + 1]; k++) {
      for (size_t c = 0; c < 3; c++) {
        long double term = (long double)s.blocks[9 * k + 3 * (i % 3) + c] * x[3 * s.column[k] + c];
        residual -= term;
        terms += fabs((double)term);
      }
    }
    worst = fmax(worst, fabs((double)residual) / terms);
  }
  assert_within("row residual, roundings", worst / DBL_EPSILON, 4);
  cb_direct_free(d);
  free(mass);
  free(x);
  block_system_free(&s);
  gsl_rng_free(rng);
}

static void fixed_nodes_stay_exactly_zero(void **state) {
  (void)state;
  struct problem p = problem_new(4);
  struct cb_direct *d = direct_new(&p, p.fixed);
  double x[N], pushed[N], y[N];
  memcpy(pushed, p.b, sizeof pushed);
  for (size_t i = 0; i < N; i++)
    if (p.fixed[i / 3]) pushed[i] = 1e300;
  assert_int_equal(cb_direct_factor(d, p.s.blocks, NULL), CB_OK);
  assert_int_equal(cb_direct_solve(d, p.b, x), CB_OK);
  assert_int_equal(cb_direct_solve(d, pushed, y), CB_OK);
  for (size_t i = 0; i < N; i++) assert_true(p.fixed[i / 3] ? x[i] == 0 : x[i] != 0);
  assert_memory_equal(x, y, sizeof x);
  cb_direct_free(d);
  problem_free(&p);
}

static void everything_fixed_gives_zero(void **state) {
  (void)state;
  struct problem p = problem_new(5);
  memset(p.fixed, 1, sizeof p.fixed);
  struct cb_direct *d = direct_new(&p, p.fixed);
  double x[N] = {1};
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
  assert_int_equal(cb_direct_solve(d, p.b, x), CB_OK);
  for (size_t i = 0; i < N; i++) assert_true(x[i] == 0);
  cb_direct_free(d);
  problem_free(&p);
}

static void new_numbers_replace_old_ones(void **state) {
  (void)state;
  struct problem p = problem_new(6);
  struct cb_direct *used = direct_new(&p, p.fixed), *fresh = direct_new(&p, p.fixed);
  double x[N], y[N], z[N];
  assert_int_equal(cb_direct_factor(used, p.s.blocks, p.mass), CB_OK);
  assert_int_equal(cb_direct_solve(used, p.b, x), CB_OK);
  for (size_t i = 0; i < 9 * p.s.row_start[NODES]; i++) p.s.blocks[i] *= 3;
  for (size_t i = 0; i < NODES; i++) p.mass[i] = 1 - p.mass[i];
  assert_int_equal(cb_direct_factor(used, p.s.blocks, p.mass), CB_OK);
  assert_int_equal(cb_direct_solve(used, p.b, y), CB_OK);
  assert_int_equal(cb_direct_factor(fresh, p.s.blocks, p.mass), CB_OK);
  assert_int_equal(cb_direct_solve(fresh, p.b, z), CB_OK);
  assert_within("used and fresh solver, roundings", roundings(y, z), 1000); /* measured 0 */
  assert_true(distance(N, x, y) > 0.1 * norm(N, x));
  cb_direct_free(used);
  cb_direct_free(fresh);
  problem_free(&p);
}

/* Free to move three ways: about one Cholesky decomposition in ten of such a matrix
 * ends without a negative pivot, so many are tried. */
static void singular_systems_are_refused(void **state) {
  (void)state;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (int trial = 0; trial < 100; trial++) {
    struct block_system s = block_system_new(rng, 2 + trial % 2);
    struct cb_direct *d = NULL;
    double mass[27], x[81], before[81];
    for (size_t i = 0; i < 27; i++) mass[i] = 1e-6;
    random_vector(rng, 81, x);
    memcpy(before, x, sizeof x);
    assert_int_equal(cb_direct_create(s.nodes, s.row_start, s.column, NULL, &d), CB_OK);
    assert_int_equal(cb_direct_solve(d, x, x), CB_NUMERIC);
    assert_int_equal(cb_direct_factor(d, s.blocks, NULL), CB_NUMERIC);
    assert_int_equal(cb_direct_solve(d, x, x), CB_NUMERIC);
    assert_memory_equal(x, before, sizeof x);
    assert_int_equal(cb_direct_factor(d, s.blocks, mass), CB_OK);
    assert_int_equal(cb_direct_solve(d, x, x), CB_OK);
    cb_direct_free(d);
    block_system_free(&s);
  }
  gsl_rng_free(rng);
}

static void indefinite_and_nan_are_refused(void **state) {
  (void)state;
  struct problem p = problem_new(7);
  struct cb_direct *d = direct_new(&p, NULL);
  double mass = p.mass[NODES / 2], x[N];
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
  p.mass[NODES / 2] = -1e6;
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_NUMERIC);
  assert_int_equal(cb_direct_solve(d, p.b, x), CB_NUMERIC);
  p.mass[NODES / 2] = mass;
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
  for (uint32_t k = p.s.row_start[NODES / 2]; k < p.s.row_start[NODES / 2 + 1]; k++) {
    const double bad[] = {NAN, INFINITY, -INFINITY};
    if (p.s.column[k] < NODES / 2) continue;
    for (size_t i = 0; i < 3; i++) {
      double kept = p.s.blocks[9 * k + 2];
      p.s.blocks[9 * k + 2] = bad[i];
      assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_NUMERIC);
      p.s.blocks[9 * k + 2] = kept;
    }
  }
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
  cb_direct_free(d);
  problem_free(&p);
}

/* A heavy node beside a light one is no singularity: S A S with S diagonal. */
static void scale_of_single_nodes_does_not_matter(void **state) {
  (void)state;
  struct problem p = problem_new(8);
  struct cb_direct *d = direct_new(&p, p.fixed);
  double scale[NODES], b[N], x[N], y[N];
  assert_int_equal(cb_direct_factor(d, p.s.blocks, NULL), CB_OK);
  assert_int_equal(cb_direct_solve(d, p.b, x), CB_OK);
  for (size_t i = 0; i < NODES; i++) scale[i] = ldexp(1, (int)(i * 13 % 61) - 30);
  for (uint32_t i = 0; i < NODES; i++)
    for (uint32_t k = p.s.row_start[i]; k < p.s.row_start[i + 1]; k++)
      for (int e = 0; e < 9; e++) p.s.blocks[9 * k + e] *= scale[i] * scale[p.s.column[k]];
  for (size_t i = 0; i < N; i++) b[i] = p.b[i] * scale[i / 3];
  assert_int_equal(cb_direct_factor(d, p.s.blocks, NULL), CB_OK);
  assert_int_equal(cb_direct_solve(d, b, y), CB_OK);
  for (size_t i = 0; i < N; i++) y[i] *= scale[i / 3];
  /* Powers of two: measured 0. */
  assert_within("scaled and unscaled, roundings", roundings(x, y), 1000);
  cb_direct_free(d);
  problem_free(&p);
}

/* ---- CHOLMOD's allocations, counted and made to fail ---------------------- */

static long allocations, allowed;

static void *counted_malloc(size_t bytes) { return allocations++ < allowed ? malloc(bytes) : NULL; }
static void *counted_calloc(size_t count, size_t bytes) {
  return allocations++ < allowed ? calloc(count, bytes) : NULL;
}
static void *counted_realloc(void *p, size_t bytes) {
  return allocations++ < allowed ? realloc(p, bytes) : NULL;
}

/* Looked up by name, since only libcholmod is linked against its library. */
static void use_allocators(void *(*m)(size_t), void *(*c)(size_t, size_t),
                           void *(*r)(void *, size_t)) {
  struct SuiteSparse_config_struct *config = dlsym(RTLD_DEFAULT, "SuiteSparse_config");
  assert_non_null(config);
  config->malloc_func = m;
  config->calloc_func = c;
  config->realloc_func = r;
}

static void count_allocations(long limit) {
  allocations = 0;
  allowed = limit;
  use_allocators(counted_malloc, counted_calloc, counted_realloc);
}

static int stop_counting(void **state) {
  (void)state;
  use_allocators(malloc, calloc, realloc);
  return 0;
}

static void later_solves_allocate_nothing(void **state) {
  (void)state;
  struct problem p = problem_new(9);
  struct cb_direct *d = direct_new(&p, p.fixed);
  double x[N], y[N];
  size_t before = cb_direct_bytes(d);
  assert_int_equal(cb_direct_factor(d, p.s.blocks, p.mass), CB_OK);
  assert_int_equal(cb_direct_solve(d, p.b, x), CB_OK);
  size_t after = cb_direct_bytes(d);
  assert_true(after > before + N * sizeof *x);
  memcpy(y, p.b, sizeof y);
  count_allocations(0);
  assert_int_equal(cb_direct_solve(d, y, y), CB_OK);
  assert_int_equal(allocations, 0);
  stop_counting(NULL);
  assert_memory_equal(x, y, sizeof x);
  assert_int_equal(cb_direct_bytes(d), after);
  cb_direct_free(d);
  problem_free(&p);
}

/* Let the first, the second, ... allocation fail until none does. */
static void every_failing_allocation_is_reported(void **state) {
  (void)state;
  struct problem p = problem_new(10);
  enum cb_status status = CB_MEMORY;
  long limit = 0;
  for (; status != CB_OK; limit++) {
    struct cb_direct *d = NULL;
    double x[N] = {7};
    assert_in_range(limit, 0, 10000);
    count_allocations(limit);
    status = cb_direct_create(p.s.nodes, p.s.row_start, p.s.column, p.fixed, &d);
    assert_true(status == CB_OK ? d != NULL : d == NULL);
    if (status == CB_OK) status = cb_direct_factor(d, p.s.blocks, p.mass);
    if (status == CB_OK) status = cb_direct_solve(d, p.b, x);
    stop_counting(NULL);
    assert_true(status == CB_OK || (status == CB_MEMORY && x[0] == 7));
    cb_direct_free(d);
  }
  assert_true(limit > 10);
  problem_free(&p);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(solution_is_that_of_dense_elimination),
      cmocka_unit_test(every_row_holds_to_rounding),
      cmocka_unit_test(fixed_nodes_stay_exactly_zero),
      cmocka_unit_test(everything_fixed_gives_zero),
      cmocka_unit_test(new_numbers_replace_old_ones),
      cmocka_unit_test(singular_systems_are_refused),
      cmocka_unit_test(indefinite_and_nan_are_refused),
      cmocka_unit_test(scale_of_single_nodes_does_not_matter),
      cmocka_unit_test_teardown(later_solves_allocate_nothing, stop_counting),
      cmocka_unit_test_teardown(every_failing_allocation_is_reported, stop_counting),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
