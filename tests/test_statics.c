/* Equilibria, true tangents and the elastica; the table of truth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "harness/truth/beam.h"
#include "harness/truth/truth.h"
#include "reference/elastica.h"
#include "reference/equilibrium.h"
#include "reference/tangent.h"
#include "tests/process.h"

/* Mattiasson 1981, table 1. */
static void the_elastica_is_that_of_the_literature(void **state) {
  (void)state;
  static const double known[][3] = {{0.2, 0.00265, 0.06636},
                                    {1, 0.05643, 0.30172},
                                    {2, 0.16064, 0.49346},
                                    {5, 0.38763, 0.71379},
                                    {10, 0.55500, 0.81061}};
  for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
    double x, y;
    assert_int_equal(cb_elastica_tip(known[i][0], &x, &y), CB_OK);
    assert_true(fabs(x - known[i][1]) < 0.51e-5 && fabs(y - known[i][2]) < 0.51e-5);
  }
  double x, y; /* small: y = alpha / 3 */
  assert_int_equal(cb_elastica_tip(1e-4, &x, &y), CB_OK);
  assert_true(fabs(y / (1e-4 / 3) - 1) < 1e-6);
}

/* A bent beam of few elements, and the blocks of K at its shape. */
struct bent {
  struct cb_beam beam;
  struct cb_operator *op;
  const uint32_t *row_start, *column;
  size_t numbers;
  double *blocks, *other;
};

static void bend(const char *variant, struct bent *b) {
  assert_int_equal(cb_beam_create(0.1, 2, 1, 1e5, &b->beam), CB_OK);
  const size_t nodes = b->beam.mesh.nodes;
  for (size_t i = 0; i < nodes; i++) {
    const double *X = b->beam.mesh.X + 3 * i;
    b->beam.x[3 * i + 2] += 0.8 * X[0] * X[0] - 0.1 * X[1];
    b->beam.x[3 * i] += 0.3 * X[0] * X[2] + 0.05 * X[0];
  }
  assert_int_equal(
      cb_operator_create(cb_variant_find(variant), &b->beam.mesh, &b->beam.material, 1, 1, &b->op),
      CB_OK);
  cb_operator_pattern(b->op, &b->row_start, &b->column);
  b->numbers = 9 * b->row_start[nodes];
  b->blocks = malloc(b->numbers * sizeof *b->blocks);
  b->other = calloc(b->numbers + 3 * nodes, sizeof *b->other);
  cb_operator_update(b->op, b->beam.x, NULL, 1, b->other + b->numbers);
  cb_operator_blocks(b->op, b->blocks);
}

static void straighten(struct bent *b) {
  cb_operator_free(b->op);
  cb_beam_free(&b->beam);
  free(b->blocks);
  free(b->other);
}

static double difference(size_t n, const double *a, const double *b) {
  double d = 0, s = 0;
  for (size_t i = 0; i < n; i++) d += (a[i] - b[i]) * (a[i] - b[i]), s += b[i] * b[i];
  return sqrt(d / s);
}

/* b->other := the tangent by differences in that arithmetic; returns its skew part. */
static double by_differences(struct bent *b, const char *model, const char *arithmetic) {
  struct cb_tangent *t;
  char name[96];
  snprintf(name, sizeof name, "%s/ebe/%s", model, arithmetic);
  assert_int_equal(cb_tangent_create(cb_variant_find(name), &b->beam.mesh, &b->beam.material, &t),
                   CB_OK);
  const double skew = cb_tangent_blocks(t, b->beam.x, b->row_start, b->column, b->other);
  cb_tangent_free(t);
  return skew;
}

/* Differences in double are as good as in quad, to what they can be; both give the operator
 * of who claims to be the derivative, and neither that of who does not. */
static void tangents_by_differences_are_true(void **state) {
  (void)state;
  static const struct {
    const char *model;
    bool derivative, gradient;
  } models[] = {{"linear", true, true},        {"green", true, true},
                {"polar-tangent", true, true}, {"polar-exact", false, true},
                {"qr-exact", false, true},     {"qr-updated", false, false}};
  for (size_t m = 0; m < sizeof models / sizeof *models; m++) {
    struct bent b;
    char name[96];
    snprintf(name, sizeof name, "%s/bcsr/f64", models[m].model);
    bend(name, &b);
    double *quad = malloc(b.numbers * sizeof *quad);
    const double skew = by_differences(&b, models[m].model, "counted");
    memcpy(quad, b.other, b.numbers * sizeof *quad);
    by_differences(&b, models[m].model, "f64");
    assert_true(difference(b.numbers, b.other, quad) < 1e-7); /* 1e-16 / 1e-5 and condition */
    if (models[m].derivative)
      assert_true(difference(b.numbers, b.blocks, quad) < 1e-8);
    else
      assert_true(difference(b.numbers, b.blocks, quad) > 1e-3);
    assert_true(models[m].gradient ? skew < 1e-8 : skew > 1e-3);
    free(quad);
    straighten(&b);
  }
  struct cb_tangent *t;
  struct bent b;
  bend("linear/bcsr/f64", &b);
  assert_int_equal(
      cb_tangent_create(cb_variant_find("node-warp/ebe/f64"), &b.beam.mesh, &b.beam.material, &t),
      CB_INPUT);
  straighten(&b);
}

/* Wherever Newton starts and with whichever matrix, there is one equilibrium here; the
 * derivative needs the fewest iterations. */
static void equilibria_do_not_depend_on_the_matrix(void **state) {
  (void)state;
  struct cb_beam beams[3];
  struct cb_newton newton[3];
  static const char *const models[] = {"polar-exact", "polar-exact", "polar-tangent"};
  for (int n = 0; n < 3; n++) {
    assert_int_equal(cb_beam_create(0.1, 6, 1, 1e6, &beams[n]), CB_OK);
    cb_beam_push(&beams[n], 40);
    assert_int_equal(cb_equilibrium_solve(models[n], n == 1, &beams[n].mesh, &beams[n].material,
                                          beams[n].fixed, beams[n].external, 1e-9, beams[n].x,
                                          &newton[n]),
                     CB_OK);
    assert_true(newton[n].residual[newton[n].iterations] <= 1e-9);
    assert_true(difference(3 * beams[0].mesh.nodes, beams[n].x, beams[0].x) < 1e-8);
  }
  assert_true(newton[2].iterations < newton[0].iterations);
  double along, down;
  cb_beam_tip(&beams[0], &along, &down);
  assert_true(down > 0.1 && along > 0.005); /* it did bend far */
  for (int n = 0; n < 3; n++) cb_beam_free(&beams[n]);
}

static void what_cannot_rest_says_so(void **state) {
  (void)state;
  struct cb_beam beam;
  struct cb_newton newton;
  assert_int_equal(cb_beam_create(0.1, 2, 1, 1e5, &beam), CB_OK);
  assert_int_equal(cb_equilibrium_solve("node-warp", CB_NEWTON_USUAL, &beam.mesh, &beam.material,
                                        beam.fixed, NULL, 1e-9, beam.x, &newton),
                   CB_INPUT);
  beam.external[3 * (beam.mesh.nodes - 1)] = NAN;
  assert_int_equal(cb_equilibrium_solve("linear", CB_NEWTON_USUAL, &beam.mesh, &beam.material,
                                        beam.fixed, beam.external, 1e-9, beam.x, &newton),
                   CB_NUMERIC);
  cb_beam_free(&beam);
}

/* ---- the table of truth ------------------------------------------------------------------ */

static void nan_is_never_true(void **state) {
  (void)state;
  struct cb_truth_row row = cb_truth_row("a", "b", "c");
  assert_true(cb_truth_within(&row)); /* not judged */
  row.low = 0, row.high = 1;
  assert_false(cb_truth_within(&row));
  row.judged = 0.5;
  assert_true(cb_truth_within(&row));
  row.judged = 1.5;
  assert_false(cb_truth_within(&row));
  row.judged = -0.5;
  assert_false(cb_truth_within(&row));
}

static void orders_are_those_of_powers(void **state) {
  (void)state;
  assert_true(fabs(cb_truth_order(3, 3 + 0.16, 3 - 0.04, 2) - 2) < 1e-12);
  assert_true(fabs(cb_truth_order(0, 0.3, 0.2, 1.5) - 1) < 1e-12);
}

/* What a user gets: a table, status 0; and the models that must pass do. */
static void the_program_tells_the_truth(void **state) {
  (void)state;
  const char *const words[] = {"truth", "--variant", "polar-tangent", "--format", "csv", NULL};
  struct process p = run_words(NULL, words);
  assert_done(&p);
  assert_non_null(strstr(p.out, "\"patch, stretch\",polar-tangent,Irons 1966,0,"));
  assert_non_null(strstr(p.out, ",yes\n"));
  assert_null(strstr(p.out, ",NO\n"));
  process_free(&p);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_elastica_is_that_of_the_literature),
      cmocka_unit_test(tangents_by_differences_are_true),
      cmocka_unit_test(equilibria_do_not_depend_on_the_matrix),
      cmocka_unit_test(what_cannot_rest_says_so),
      cmocka_unit_test(nan_is_never_true),
      cmocka_unit_test(orders_are_those_of_powers),
      cmocka_unit_test(the_program_tells_the_truth),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
