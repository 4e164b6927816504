/* corobench advise and trade, as a user runs them; and the needs that they judge by.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <jansson.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/advise/advise.h"
#include "tests/process.h"

/* A small scene that takes a second: a block that spins. */
static const char *scene(const char *needs) {
  const char *path = temporary_path("spin.json");
  FILE *f = fopen(path, "w");
  fprintf(f,
          "{\"about\": \"spins\", \"geometry\": {\"block\": {\"cells\": [2, 2, 2], \"cell_m\": "
          "0.02}},\n\"material\": {\"young_pa\": 1e5, \"poisson\": 0.3, \"density_kg_m3\": 1000},\n"
          "\"start\": {\"spin_rad_s\": [0, 0, 30], \"stretch\": [1.1, 0.95, 1]},\n"
          "\"step_s\": 0.001, \"duration_s\": 0.1,\n\"needs\": {%s}}\n",
          needs);
  fclose(f);
  return path;
}

static json_t *advice(const char *needs, const char *option, const char *value, int status) {
  const char *const words[] = {"advise", scene(needs), "--quick", "--format",
                               "json",   option,       value,     NULL};
  struct process p = run_words(NULL, words);
  if (p.exit_status != status) fail_msg("exit status %d: %s", p.exit_status, p.err);
  json_t *json = json_loads(p.out, 0, NULL);
  assert_non_null(json);
  process_free(&p);
  return json;
}

static const char *text(const json_t *object, const char *key) {
  return json_string_value(json_object_get(object, key));
}
static double number(const json_t *object, const char *key) {
  const json_t *n = json_object_get(object, key);
  return json_is_number(n) ? json_number_value(n) : NAN;
}

static void the_cheapest_that_does_is_recommended(void **state) {
  (void)state;
  size_t i;
  json_t *one, *json = advice("\"rotation\": true, \"euler\": true, \"torque\": 1e-5, "
                              "\"displacement_error\": 0.1",
                              NULL, NULL, 0);
  const json_t *best = json_object_get(json, "recommended");
  const json_t *ranking = json_object_get(json, "ranking");
  assert_string_equal(text(best, "variant"), text(json_array_get(ranking, 0), "variant"));
  double before = 0;
  json_array_foreach(ranking, i, one) {
    assert_true(number(one, "step_s") >= before);
    before = number(one, "step_s");
    assert_true(number(one, "error") <= 0.1 && number(one, "torque") <= 1e-5);
    assert_true(number(json_object_get(one, "laws"), "euler") < 1e-9);
    assert_null(strstr(text(one, "variant"), "qr-precomputed"));
  }
  assert_true(json_array_size(ranking) > 3);
  bool linear = false, stale = false;
  json_array_foreach(json_object_get(json, "rejected"), i, one) {
    const bool rotation = strcmp(text(one, "need"), "rotation") == 0;
    linear |= strncmp(text(one, "variant"), "linear/", 7) == 0 && rotation;
    stale |= strncmp(text(one, "variant"), "qr-precomputed/", 15) == 0 &&
             strcmp(text(one, "need"), "euler") == 0;
    assert_false(number(one, "value") <= number(one, "limit"));
  }
  assert_true(linear && stale);
  /* the scene's own step and mesh meet the needs; so many of the others are tried */
  const json_t *settings = json_object_get(json, "settings");
  assert_int_equal(json_array_size(settings), CB_SETTINGS);
  json_array_foreach(settings, i, one) {
    if (i == 0) assert_true(number(one, "step_s") == 0.001 && number(one, "tetrahedra") == 80);
    if (i == 0) assert_true(json_is_true(json_object_get(one, "meets")));
    if (json_is_true(json_object_get(one, "meets"))) assert_true(number(one, "error") <= 0.1);
  }
  json_decref(json);
}

/* Without needs the cheapest is the one that computes least. */
static void without_needs_nothing_is_rejected(void **state) {
  (void)state;
  json_t *json = advice("\"displacement_error\": 1e9", NULL, NULL, 0);
  assert_int_equal(json_array_size(json_object_get(json, "rejected")), 0);
  assert_int_equal(number(json_object_get(json, "recommended"), "iterations"), 1);
  json_decref(json);
}

static void what_cannot_be_met_exits_with_three(void **state) {
  (void)state;
  json_t *json = advice("\"newton\": true, \"displacement_error\": 0.1", "--tolerance", "1e-12", 3);
  assert_true(json_is_null(json_object_get(json, "recommended")));
  assert_int_equal(json_array_size(json_object_get(json, "ranking")), 0);
  json_decref(json);
  /* a frame of a tenth of a microsecond: that alone binds, ten times would not help either */
  json = advice("\"frames_per_s\": 30", "--budget", "1e-4", 3);
  assert_true(json_array_size(json_object_get(json, "rejected")) > 10);
  json_decref(json);
}

static void bad_words_are_refused(void **state) {
  (void)state;
  const char *const none[] = {"advise", NULL};
  const char *const two[] = {"advise", "a.json", "b.json", NULL};
  const char *const bad[] = {"advise", "scenes/block.json", "--tolerance", "-1", NULL};
  const char *const absent[] = {"trade", "none.json", NULL};
  struct process p = run_words(NULL, none);
  assert_one_sentence(&p, "no scene is given: name a file");
  process_free(&p);
  p = run_words(NULL, two);
  assert_one_sentence(&p, "unexpected word 'b.json'");
  process_free(&p);
  p = run_words(NULL, bad);
  assert_one_sentence(&p, "--tolerance needs a finite number");
  process_free(&p);
  p = run_words(NULL, absent);
  assert_one_sentence(&p, "cannot read none.json");
  process_free(&p);
}

/* ---- needs -------------------------------------------------------------------------- */

static void nan_meets_no_need(void **state) {
  (void)state;
  struct cb_advice a = {.needs = {.laws = CB_KEEPS(CB_LAW_EULER),
                                  .displacement = 1,
                                  .torque = INFINITY,
                                  .energy = INFINITY,
                                  .inversion = true},
                        .frame_s = INFINITY};
  struct cb_candidate c = {.finite = true, .error = 0.5};
  assert_int_equal(cb_needs_unmet(&a, &c), 0);
  c.error = NAN;
  assert_int_equal(cb_needs_unmet(&a, &c), 1u << CB_NEED_DISPLACEMENT);
  c.error = 0.5, c.law[CB_LAW_EULER] = NAN;
  assert_int_equal(cb_needs_unmet(&a, &c), 1u << CB_LAW_EULER);
  c.law[CB_LAW_EULER] = 0, c.inverted = 1;
  assert_int_equal(cb_needs_unmet(&a, &c), 1u << CB_NEED_INVERSION);
  c.inverted = 0, c.finite = false;
  assert_int_equal(cb_needs_unmet(&a, &c), 1u << CB_NEED_FINITE | 1u << CB_NEED_INVERSION);
  a.frame_s = 1, a.steps_per_frame = 10, a.needs.inversion = false, c.finite = true, c.step_s = 0.2;
  assert_int_equal(cb_needs_unmet(&a, &c), 1u << CB_NEED_FRAMES);
}

/* ---- trade --------------------------------------------------------------------------------- */

static void trade_writes_its_rows_and_the_front(void **state) {
  (void)state;
  const char *const words[] = {"trade",         scene("\"newton\": true"),
                               "--quick",       "--output",
                               temporary,       "--variant",
                               "qr-exact",      "--variant",
                               "polar-*-tuned", NULL};
  struct process p = run_words(NULL, words);
  assert_done(&p);
  assert_non_null(strstr(p.out, "Front of the scene's own mesh"));
  char *csv = read_text(temporary_path("trade.csv"));
  json_t *json = json_load_file(temporary_path("trade.json"), 0, NULL);
  assert_int_equal(lines(csv), json_array_size(json) + 1);
  /* Newton-Higham makes no torque however early it ends, the quaternion does */
  size_t i, front = 0;
  json_t *row;
  double quaternion = 0, higham = 0;
  json_array_foreach(json, i, row) {
    front += json_integer_value(json_object_get(row, "front"));
    if (number(row, "frame_iterations") != 1) continue;
    if (strcmp(text(row, "model"), "polar-higham-tuned") == 0)
      higham = fmax(higham, number(row, "torque"));
    else
      quaternion = fmax(quaternion, number(row, "torque"));
  }
  assert_true(front > 0 && front < i);
  assert_true(higham < 1e-13 && quaternion > 1e-6);
  free(csv);
  json_decref(json);
  process_free(&p);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_cheapest_that_does_is_recommended),
      cmocka_unit_test(without_needs_nothing_is_rejected),
      cmocka_unit_test(what_cannot_be_met_exits_with_three),
      cmocka_unit_test(bad_words_are_refused),
      cmocka_unit_test(nan_meets_no_need),
      cmocka_unit_test(trade_writes_its_rows_and_the_front),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
