/* test_step.c - one implicit step solves its system: conjugate gradients against
 * the direct solver and against a system put together by hand.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/block.h"

#include <gsl/gsl_linalg.h>

#include "reference/direct.h"

/* Units of roundoff times the condition of the system: measured at most 2.4. */
static const double LIMIT = 8;

/* A := (1 + h beta) M + (h^2 + h alpha) K, K column by column from the operator of
 * another storage with c = 1; b := h (f + load) - (h^2 + h alpha) K v - h beta M v;
 * rows and columns of fixed nodes: identity, zero. */
static void dense_system(const struct block *b, const char *model,
                         const struct cb_step_parameters *p, double *A, double *rhs) {
  size_t n = 3 * b->scene.mesh.nodes;
  double stiff = p->h * p->h + p->h * p->alpha, drag = p->h * p->beta;
  struct cb_variant v = f64_variant(model, CB_EBE);
  struct run r;
  double *unit = calloc(n, sizeof *unit);
  quad *column = quads_new(n);
  assert_non_null(unit);
  run_open(&r, &b->scene, &v, &b->material, 1);
  run_update(&r, NULL, 1, column);
  for (size_t i = 0; i < n; i++)
    rhs[i] = p->h * ((double)column[i] + b->load[i]) - drag * b->mass[i / 3] * b->scene.v[i];
  for (size_t j = 0; j < n; j++) {
    unit[j] = 1;
    r.variant.arithmetic->from_double(n / 3, unit, r.u);
    unit[j] = 0;
    run_product(&r, r.u, column);
    for (size_t i = 0; i < n; i++) {
      A[n * i + j] = stiff * (double)column[i] + (i == j ? (1 + drag) * b->mass[i / 3] : 0);
      rhs[i] -= stiff * (double)column[i] * b->scene.v[j];
    }
  }
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (b->fixed[i / 3] || b->fixed[j / 3]) A[n * i + j] = i == j;
  for (size_t i = 0; i < n; i++)
    if (b->fixed[i / 3]) rhs[i] = 0;
  run_close(&r);
  free(column);
  free(unit);
}

/* Largest over smallest eigenvalue, without the identity rows of fixed nodes. */
static double condition_of(const struct block *b, const double *A) {
  size_t n = 3 * b->scene.mesh.nodes, free_count = 0;
  double *small = malloc(n * n * sizeof *small), *values = malloc(n * sizeof *values);
  assert_true(small && values);
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++)
      if (!b->fixed[i / 3] && !b->fixed[j / 3]) small[free_count++] = A[n * i + j];
  size_t m = n - 6;
  assert_int_equal(free_count, m * m);
  assert_int_equal(cb_oracle_eigenvalues(m, small, values), CB_OK);
  double condition = values[m - 1] / values[0];
  assert_true(condition >= 1);
  free(small);
  free(values);
  return condition;
}

static void assert_same_dv(const char *what, const struct walk *w, const double *dv,
                           double condition) {
  size_t n = 3 * w->r.nodes;
  quad *q = quads_new(2 * n);
  vector_read(w->r.variant.arithmetic, w->r.nodes, cb_stepper_dv(w->stepper), q);
  for (size_t i = 0; i < n; i++) q[n + i] = dv[i];
  assert_rounding(what, n, q, q + n, 0x1p-53, condition, LIMIT);
  free(q);
}

static const char *const solved[] = {"linear", "qr-precomputed", "qr-updated", "polar-exact",
                                     "svd-updated"};
enum { SOLVED = sizeof solved / sizeof *solved };

/* Every storage and both materials; damping by one term, by the other, by both. */
static void steps_solve_the_system_put_together_by_hand(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (size_t n = 0; n < SOLVED * 4; n++) {
    struct block b;
    block_open(rng, n % 2, &b);
    const struct cb_step_parameters *p = damped + n % 4;
    size_t length = 3 * b.scene.mesh.nodes;
    double *A = malloc(length * length * sizeof *A), *rhs = malloc(length * sizeof *rhs);
    double *x = malloc(length * sizeof *x);
    assert_true(A && rhs && x);
    dense_system(&b, solved[n / 4], p, A, rhs);
    double condition = condition_of(&b, A);
    gsl_matrix_view Av = gsl_matrix_view_array(A, length, length);
    gsl_vector_view rv = gsl_vector_view_array(rhs, length), xv = gsl_vector_view_array(x, length);
    assert_int_equal(gsl_linalg_cholesky_decomp1(&Av.matrix), 0);
    assert_int_equal(gsl_linalg_cholesky_solve(&Av.matrix, &rv.vector, &xv.vector), 0);
    for (int storage = 0; storage < CB_STORAGES; storage++) {
      struct cb_variant v = f64_variant(solved[n / 4], (enum cb_storage)storage);
      struct walk w;
      if (!v.model->form[storage][n % 2].update) continue;
      walk_open(&w, &b, &v, p, b.fixed);
      cb_stepper_step(w.stepper, w.r.x, w.r.v, w.f);
      assert_same_dv(w.r.name, &w, x, condition);
      walk_close(&w);
    }
    free(A);
    free(rhs);
    free(x);
    block_close(&b);
  }
  gsl_rng_free(rng);
}

/* The direct solver on the blocks and the right-hand side of the stepper itself. */
static void conjugate_gradients_reach_the_direct_solution(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  for (int storage = CB_CSR; storage <= CB_BCSR; storage++)
    for (size_t n = 0; n < SOLVED; n++) {
      const struct cb_step_parameters *p = damped + 3;
      const uint32_t *row_start, *column;
      double diagonal[NODES], b[3 * NODES], x[3 * NODES];
      struct cb_variant v = f64_variant(solved[n], (enum cb_storage)storage);
      struct block block;
      struct cb_direct *direct;
      struct walk w;
      block_open(rng, false, &block);
      size_t nodes = block.scene.mesh.nodes, length = 3 * nodes;
      double *A = malloc(length * length * sizeof *A);
      assert_non_null(A);
      dense_system(&block, solved[n], p, A, b);
      walk_open(&w, &block, &v, p, block.fixed);
      cb_operator_pattern(w.r.op, &row_start, &column);
      double *blocks = malloc(9 * row_start[nodes] * sizeof *blocks);
      assert_non_null(blocks);
      cb_stepper_right_side(w.stepper, w.r.x, w.r.v, w.f);
      cb_stepper_solve(w.stepper);
      cb_operator_blocks(w.r.op, blocks);
      for (size_t i = 0; i < nodes; i++) diagonal[i] = (1 + p->h * p->beta) * block.mass[i];
      v.arithmetic->to_double(nodes, cb_stepper_b(w.stepper), b);
      assert_int_equal(cb_direct_create(nodes, row_start, column, block.fixed, &direct), CB_OK);
      assert_int_equal(cb_direct_factor(direct, blocks, diagonal), CB_OK);
      assert_int_equal(cb_direct_solve(direct, b, x), CB_OK);
      assert_same_dv(w.r.name, &w, x, condition_of(&block, A));
      cb_direct_free(direct);
      walk_close(&w);
      free(blocks);
      free(A);
      block_close(&block);
    }
  gsl_rng_free(rng);
}

/* The parts of a step in their order are the step; fewer iterations are fewer. */
static void a_step_is_its_parts(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  struct block b;
  struct walk whole, parts;
  block_open(rng, false, &b);
  size_t nodes = b.scene.mesh.nodes, bytes = 3 * nodes * sizeof(double);
  struct cb_variant v = f64_variant("qr-updated", CB_EBE);
  walk_open(&whole, &b, &v, damped + 3, b.fixed);
  walk_open(&parts, &b, &v, damped + 3, b.fixed);
  cb_stepper_set_iterations(whole.stepper, 5);
  cb_stepper_set_iterations(parts.stepper, 5);
  for (int n = 0; n < 3; n++) {
    cb_stepper_step(whole.stepper, whole.r.x, whole.r.v, whole.f);
    cb_stepper_right_side(parts.stepper, parts.r.x, parts.r.v, parts.f);
    cb_stepper_solve(parts.stepper);
    cb_stepper_advance(parts.stepper, parts.r.x, parts.r.v);
    assert_memory_equal(whole.r.x, parts.r.x, bytes);
    assert_memory_equal(whole.r.v, parts.r.v, bytes);
  }
  cb_stepper_set_iterations(parts.stepper, 6);
  cb_stepper_step(whole.stepper, whole.r.x, whole.r.v, whole.f);
  cb_stepper_step(parts.stepper, parts.r.x, parts.r.v, parts.f);
  assert_memory_not_equal(whole.r.x, parts.r.x, bytes);
  walk_close(&whole);
  walk_close(&parts);
  block_close(&b);
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(steps_solve_the_system_put_together_by_hand),
      cmocka_unit_test(conjugate_gradients_reach_the_direct_solution),
      cmocka_unit_test(a_step_is_its_parts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
