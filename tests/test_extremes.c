/* test_extremes.c - the sweeps find what is wrong: frames, forces and products that are
 * spoilt on purpose; and their rows are all there.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/families.h"
#include "tests/process.h"

#include "harness/extremes/exact.h"
#include "harness/extremes/paths.h"
#include "harness/extremes/report.h"
#define CB_SCALAR double /* the view of f64 on its elements */
#define CB_LANES 1
#define CB_SUFFIX f64
#include "kernels/elements.h"

/* ---- a variant, spoilt ------------------------------------------------------ */

static enum {
  NOTHING,
  FRAME_TURNED,
  FRAME_REFLECTED_TOO,
  FRAME_JUMPS,
  FRAME_NAN,
  FORCE_PUSHED,
  FORCE_TWISTED,
  OBLIQUE_PUSHED, /* where no edge is in a plane of the axes */
  OBLIQUE_SCALED,
  FORCE_JUMPS,
  FORCE_NAN,
  PRODUCT_SKEW,
  PRODUCT_NAN
} fault;
static const struct cb_variant *sound;

static const struct cb_form *sound_form(void) { return &sound->model->form[sound->storage][0]; }

static void spoilt_frame(size_t count, const void *F, void *R) {
  const double *from = F;
  double *to = R;
  sound->model->frame(count, F, R);
  for (size_t n = 0; n < count; n++) {
    double *Q = to + 9 * n;
    const double c = cos(1e-8), s = sin(1e-8);
    for (int i = 0; i < 3; i++) {
      const double first = Q[i], second = Q[3 + i];
      if (fault == FRAME_TURNED) Q[i] = c * first - s * second, Q[3 + i] = s * first + c * second;
      if (fault == FRAME_REFLECTED_TOO) Q[i] = -first;
      if (fault == FRAME_JUMPS && from[9 * n + 8] < 0.5) Q[i] = -first, Q[3 + i] = -second;
    }
    if (fault == FRAME_NAN && n == 3) Q[4] = NAN;
  }
}

static void spoilt_update(struct cb_elements *E, size_t thread, const void *x, const void *v,
                          double h, void *out) {
  double *f = out;
  const double *p = x;
  sound_form()->update(E, thread, x, v, h, out);
  for (size_t i = 0; i < 3 * E->nodes; i += 12) {
    bool oblique = true;
    for (size_t j = i + 3; j < i + 12; j++) oblique = oblique && p[j] != 0;
    const double size = fabs(f[i]) + fabs(f[i + 4]) + fabs(f[i + 8]);
    if (fault == FORCE_PUSHED || (fault == OBLIQUE_PUSHED && oblique)) f[i] += 1e-6 * size;
    if (fault == FORCE_TWISTED) f[i + 1] += 1e-6 * size, f[i + 4] -= 1e-6 * size;
    for (size_t j = i; fault == OBLIQUE_SCALED && oblique && j < i + 12; j++) f[j] *= 1 + 3e-8;
    if (fault == FORCE_NAN && i == 24) f[i] = NAN;
    for (size_t j = i; fault == FORCE_JUMPS && p[i + 11] < 0.5 && j < i + 12; j++) f[j] = -f[j];
  }
}

static void spoilt_product(const struct cb_elements *E, size_t thread, const void *u, void *y) {
  double *f = y;
  const double *p = u;
  sound_form()->product(E, thread, u, y);
  for (size_t i = 0; i < 3 * E->nodes; i += 12) {
    if (fault == PRODUCT_SKEW) f[i] += 0.1 * p[i + 1], f[i + 1] -= 0.1 * p[i];
    if (fault == PRODUCT_NAN && i == 24) f[i] = NAN;
  }
}

/* Rows of one sweep on it, of ebe in f64. Free with cb_extremes_free. */
static struct cb_extremes spoilt_model(const char *name, int how, const char *sweep) {
  static struct cb_model model;
  static struct cb_variant variant;
  static const struct cb_variant *list[2];
  sound = cb_variant_find(name);
  assert_non_null(sound);
  model = *sound->model;
  if (model.frame) model.frame = spoilt_frame;
  model.form[CB_EBE][0].update = spoilt_update;
  model.form[CB_EBE][0].product = spoilt_product;
  variant = *sound, variant.model = &model, list[0] = &variant;
  fault = how;
  struct cb_extremes all = {.seed = SCENE_SEED, .variants = list};
  assert_int_equal(cb_extremes_run(sweep, &all), CB_OK);
  assert_true(all.count > 0);
  return all;
}

static struct cb_extremes spoilt(int how, const char *sweep) {
  return spoilt_model("svd-updated/ebe/f64", how, sweep);
}

/* How many rows are in that state and (law not NULL) break that law. */
static size_t rows_in(const struct cb_extremes *all, enum cb_extreme_state state, const char *law) {
  size_t n = 0;
  for (size_t i = 0; i < all->count; i++)
    n += cb_extreme_state(&all->row[i]) == state && (!law || strcmp(all->row[i].law, law) == 0);
  return n;
}

static void assert_all_are(int how, const char *sweep, enum cb_extreme_state state,
                           const char *law) {
  struct cb_extremes all = spoilt(how, sweep);
  assert_int_equal(rows_in(&all, state, law), all.count);
  assert_int_equal(cb_extremes_judge(&all), state >= CB_BREAKS ? CB_BROKEN : CB_OK);
  cb_extremes_free(&all);
}

static void what_is_sound_is_right(void **state) {
  (void)state;
  static const char *const sweeps[] = {"turned", "near",   "inversion", "jumps",
                                       "sliver", "aspect", "offset",    "units"};
  for (size_t s = 0; s < sizeof sweeps / sizeof *sweeps; s++)
    assert_all_are(NOTHING, sweeps[s], CB_RIGHT, NULL);
}

static void a_wrong_frame_is_found(void **state) {
  (void)state;
  assert_all_are(FRAME_TURNED, "turned", CB_INACCURATE, NULL);
  assert_all_are(FRAME_REFLECTED_TOO, "turned", CB_BREAKS, "handedness");
}

static void a_wrong_force_is_found(void **state) {
  (void)state;
  assert_all_are(FORCE_PUSHED, "aspect", CB_BREAKS, "newton");
  assert_all_are(FORCE_TWISTED, "offset", CB_BREAKS, "euler");
}

static void a_wrong_product_is_found(void **state) {
  (void)state;
  assert_all_are(PRODUCT_SKEW, "turned", CB_BREAKS, "symmetric");
}

static void what_is_not_a_number_is_found(void **state) {
  (void)state;
  static const int how[] = {FRAME_NAN, FORCE_NAN, PRODUCT_NAN};
  for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
    struct cb_extremes all = spoilt(how[i], "near");
    assert_int_equal(rows_in(&all, CB_NOT_FINITE, NULL), 1);
    assert_int_equal(cb_extremes_judge(&all), CB_BROKEN);
    cb_extremes_free(&all);
  }
  struct cb_extremes all = spoilt(FRAME_NAN, "jumps");
  assert_int_equal(rows_in(&all, CB_NOT_FINITE, NULL), 1);
  cb_extremes_free(&all);
}

/* On its way through vertex d the element is spoilt from a sixth on. */
static void a_jump_that_is_not_the_definitions_is_found(void **state) {
  (void)state;
  static const int how[] = {FRAME_JUMPS, FORCE_JUMPS};
  for (size_t i = 0; i < sizeof how / sizeof *how; i++) {
    struct cb_extremes all = spoilt(how[i], "jumps");
    bool found = false;
    for (size_t n = 0; n < all.count; n++)
      if (strcmp(all.row[n].parameter, "through vertex d straight") == 0) {
        assert_string_equal(all.row[n].law, "continuity");
        assert_true(fabs(all.row[n].value - 1. / 6) < 1.5 / CB_PATH_STEPS);
        found = true;
      }
    assert_true(found);
    cb_extremes_free(&all);
  }
}

/* ---- rows -------------------------------------------------------------------------- */

static void rows_are_complete(void **state) {
  (void)state;
  static const char *const sweeps[] = {"values", "inverted", "flat",      "collapsed",
                                       "turned", "near",     "inversion", "jumps",
                                       "sliver", "aspect",   "offset",    "units"};
  const struct cb_variant *list[] = {cb_variant_find("linear/ebe/f64"),
                                     cb_variant_find("qr-updated/ebe/f32"), NULL};
  for (size_t s = 0; s < sizeof sweeps / sizeof *sweeps; s++) {
    struct cb_extremes all = {.seed = SCENE_SEED, .variants = list};
    assert_int_equal(cb_extremes_run(sweeps[s], &all), CB_OK);
    size_t of[2] = {0};
    for (size_t i = 0; i < all.count; i++) {
      const struct cb_extreme *r = &all.row[i];
      assert_string_equal(r->sweep, sweeps[s]);
      assert_true(r->parameter[0] && !isnan(r->value));
      of[r->variant == list[1]]++;
      for (size_t j = 0; j < i; j++)
        if (all.row[j].variant == r->variant)
          assert_string_not_equal(all.row[j].parameter, r->parameter);
    }
    assert_true(of[0] > 0);
    assert_int_equal(of[0], of[1]);
    cb_extremes_free(&all);
  }
}

static void states_are_told_apart(void **state) {
  (void)state;
  const struct cb_variant *v = cb_variant_find("linear/ebe/f64");
  struct cb_extreme row = cb_extreme_blank("values", v), worse = row;
  assert_int_equal(cb_extreme_state(&row), CB_RIGHT);
  worse.force_error = INFINITY;
  assert_int_equal(cb_extreme_state(&worse), CB_INACCURATE);
  cb_extreme_fold(&row, &worse);
  assert_int_equal(cb_extreme_state(&row), CB_INACCURATE);
  worse.law = "newton";
  assert_int_equal(cb_extreme_state(&worse), CB_BREAKS);
  worse.finite = false;
  assert_int_equal(cb_extreme_state(&worse), CB_NOT_FINITE);
  cb_extreme_fold(&row, &worse);
  assert_int_equal(cb_extreme_state(&row), CB_NOT_FINITE);
  strcpy(worse.note, "not judged: only a note, which says nothing of the state");
  assert_int_equal(cb_extreme_state(&worse), CB_NOT_FINITE);
  worse.why = CB_WHY_METHOD;
  assert_int_equal(cb_extreme_state(&worse), CB_BY_METHOD);
  cb_extreme_fold(&worse, &row);
  assert_int_equal(cb_extreme_state(&worse), CB_NOT_FINITE);
}

static struct cb_extreme row_that_is(enum cb_why why, double error, const char *law) {
  struct cb_extreme row = cb_extreme_blank("values", cb_variant_find("linear/ebe/f64"));
  row.why = why, row.frame_error = error, row.law = law;
  return row;
}

/* The worse one, whatever the order: what is the method's hides no fault of the model's, and
 * what is not judged hides nothing. */
static void a_row_is_in_the_worst_state_of_its_cases(void **state) {
  (void)state;
  const struct cb_extreme rows[] = {
      row_that_is(CB_WHY_UNJUDGED, NAN, ""), row_that_is(CB_WHY_MODEL, 1, ""),
      row_that_is(CB_WHY_METHOD, 1e9, "rotation"), row_that_is(CB_WHY_MODEL, 1e6, ""),
      row_that_is(CB_WHY_MODEL, 1, "newton")};
  enum { ROWS = sizeof rows / sizeof *rows };
  for (int i = 0; i < ROWS; i++)
    for (int j = 0; j < ROWS; j++) {
      struct cb_extreme both = rows[i];
      assert_int_equal(cb_extreme_state(&rows[i]), CB_NOT_JUDGED + i);
      cb_extreme_fold(&both, &rows[j]);
      assert_int_equal(cb_extreme_state(&both), CB_NOT_JUDGED + (i > j ? i : j));
    }
}

/* ---- whose it is ------------------------------------------------------------------- */

static enum cb_extreme_state state_of(const struct cb_extremes *all, const char *parameter) {
  for (size_t i = 0; i < all->count; i++)
    if (strcmp(all->row[i].parameter, parameter) == 0) return cb_extreme_state(&all->row[i]);
  fail_msg("no row '%s'", parameter);
  return CB_NOT_JUDGED;
}

/* The same fault, small beside what the method loses on the worse shape, and not on the
 * better one; and without one, nothing is worse than by method. */
static void assert_method_explains(const char *method, const char *other, int how,
                                   const char *better, const char *worse, const char *says) {
  struct cb_extremes all = spoilt_model(other, how, "values");
  assert_int_equal(rows_in(&all, CB_BY_METHOD, NULL), 0);
  assert_int_equal(state_of(&all, better), CB_INACCURATE);
  assert_int_equal(state_of(&all, worse), CB_INACCURATE);
  cb_extremes_free(&all);
  all = spoilt_model(method, how, "values");
  assert_int_equal(state_of(&all, better), CB_INACCURATE);
  assert_int_equal(state_of(&all, worse), CB_BY_METHOD);
  cb_extremes_free(&all);
  all = spoilt_model(method, NOTHING, "values");
  size_t named = 0;
  for (size_t i = 0; i < all.count; i++) {
    assert_true(cb_extreme_state(&all.row[i]) <= CB_BY_METHOD);
    named += strstr(all.row[i].note, says) != NULL;
  }
  assert_true(named > 0 && named < all.count);
  cb_extremes_free(&all);
}

static void what_a_method_loses_is_the_methods(void **state) {
  (void)state;
  assert_method_explains("polar-eigen-updated/ebe/f64", "svd-updated/ebe/f64", FRAME_TURNED,
                         "values 1 1 1", "values 1 0.0001 0.0001", "squares the condition");
  assert_method_explains("svd-updated-volume/ebe/f64", "svd-updated/ebe/f64", OBLIQUE_SCALED,
                         "values 1 0.01 0.01", "values 1 0.0001 0.0001", "divided by a volume");
}

/* A law that the method's rounding says nothing of stays broken, however large that is. */
static void other_laws_are_never_the_methods(void **state) {
  (void)state;
  static const char *const methods[] = {"polar-eigen-updated/ebe/f64",
                                        "svd-updated-volume/ebe/f64"};
  for (int n = 0; n < 2; n++) {
    struct cb_extremes all = spoilt_model(methods[n], OBLIQUE_PUSHED, "values");
    assert_int_equal(state_of(&all, "values 1 0.0001 0.0001"), CB_BREAKS);
    assert_true(rows_in(&all, CB_BREAKS, "newton") > 5);
    cb_extremes_free(&all);
  }
}

/* Where its frames are not defined, on a line and in a point, nothing is asked of it. */
static void frames_of_nodes_are_judged_where_they_are_defined(void **state) {
  (void)state;
  static const char name[] = "node-warp/ebe/f64";
  static const char *const sweeps[] = {"values", "inverted", "flat", "collapsed", "inputs"};
  for (size_t s = 0; s < sizeof sweeps / sizeof *sweeps; s++) {
    struct cb_extremes all = spoilt_model(name, NOTHING, sweeps[s]);
    assert_int_equal(rows_in(&all, CB_RIGHT, NULL), all.count);
    cb_extremes_free(&all);
  }
  struct cb_extremes all = spoilt_model(name, FORCE_PUSHED, "inversion");
  assert_int_equal(rows_in(&all, CB_BREAKS, "rotation"), all.count);
  cb_extremes_free(&all);
  all = spoilt_model(name, FORCE_PUSHED, "flat");
  assert_int_equal(state_of(&all, "values 1 0.01 0"), CB_BREAKS);
  cb_extremes_free(&all);
}

/* ---- as a user --------------------------------------------------------------------- */

static void the_verb_writes_what_it_found(void **state) {
  (void)state;
  const char *directory = temporary_path("extremes");
  struct process p = run_words(
      NULL, (const char *const[]){"extremes", "--variant", "svd-updated/ebe/f64", "--sweep", "near",
                                  "--format", "csv", "--output", directory, NULL});
  assert_done(&p);
  assert_string_equal(p.out + strcspn(p.out, "\n") - strlen(",near"), strstr(p.out, ",near"));
  process_free(&p);
  static const struct {
    const char *name, *begins;
    size_t lines;
  } files[] = {
      {"extremes/extremes.csv",
       "sweep,parameter,variant,finite,frame_error,force_error,orthogonality,torque,"
       "first_broken_law,",
       1 + 8},
      {"extremes/extremes-map.csv", "sweep,model,storage,arithmetic,state,", 1 + 1},
      {"extremes/extremes-paths.csv", "path,t,model,", 1 + CB_PATHS * (CB_PATH_STEPS + 1)}};
  for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
    char *text = read_text(temporary_path(files[i].name));
    assert_int_equal(strncmp(text, files[i].begins, strlen(files[i].begins)), 0);
    assert_int_equal(lines(text), files[i].lines);
    free(text);
  }
  assert_refused(run_words(NULL, (const char *const[]){"extremes", "--sweep", "valves", NULL}),
                 "there is no sweep 'valves' (nearest: 'values')");
  assert_refused(run_words(NULL, (const char *const[]){"extremes", "--variant", "*/counted", NULL}),
                 "--variant selects nothing that can be judged");
}

/* ---- exact frames ------------------------------------------------------------------ */

/* GSL's share of the roundings, as in test_frames. */
static const double LIMIT = 100;

static void exact_frames_are_those_of_gsl(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  static enum cb_status (*const oracle[])(const double F[9], double R[9]) = {
      [CB_NEAREST_ROTATION] = cb_oracle_polar,
      [CB_NEAREST_ORTHOGONAL] = cb_oracle_polar_orthogonal,
      [CB_GRAM_SCHMIDT] = cb_oracle_qr};
  for (int family = 0; family < FAMILIES; family++)
    for (int t = 0; t < 100; t++)
      for (int d = CB_NEAREST_ROTATION; d <= CB_GRAM_SCHMIDT; d++) {
        double F[9], s[3], R[9], expected[9], condition;
        random_gradient(rng, (enum family)family, F, s);
        cb_frame_exact((enum cb_definition)d, F, R, &condition);
        assert_int_equal(oracle[d](F, expected), CB_OK);
        assert_within(family_name[family], distance(9, R, expected) / (0x1p-53 * condition), LIMIT);
        if (d == CB_NEAREST_ROTATION)
          assert_within("condition", fabs(condition * (s[1] + s[2]) / s[0] - 1), 1e-12 * condition);
      }
  gsl_rng_free(rng);
}

static void frames_that_are_not_defined_have_no_condition(void **state) {
  (void)state;
  const double line[9] = {1, 2, 0, 2, 4, 0, 0, 0, 0}, mirrored[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  double R[9], condition;
  for (int d = CB_NEAREST_ROTATION; d <= CB_GRAM_SCHMIDT; d++) {
    cb_frame_exact((enum cb_definition)d, line, R, &condition);
    assert_true(condition > 1e30);
  }
  cb_frame_exact(CB_NEAREST_ROTATION, mirrored, R, &condition);
  assert_true(condition > 1e30);
  cb_frame_exact(CB_GRAM_SCHMIDT, mirrored, R, &condition);
  assert_true(condition < 3);
}

int main(int argc, char **argv) {
  (void)argc;
  find_program(argv[0]);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_is_sound_is_right),
      cmocka_unit_test(a_wrong_frame_is_found),
      cmocka_unit_test(a_wrong_force_is_found),
      cmocka_unit_test(a_wrong_product_is_found),
      cmocka_unit_test(what_is_not_a_number_is_found),
      cmocka_unit_test(a_jump_that_is_not_the_definitions_is_found),
      cmocka_unit_test(rows_are_complete),
      cmocka_unit_test(the_verb_writes_what_it_found),
      cmocka_unit_test(states_are_told_apart),
      cmocka_unit_test(a_row_is_in_the_worst_state_of_its_cases),
      cmocka_unit_test(what_a_method_loses_is_the_methods),
      cmocka_unit_test(other_laws_are_never_the_methods),
      cmocka_unit_test(frames_of_nodes_are_judged_where_they_are_defined),
      cmocka_unit_test(exact_frames_are_those_of_gsl),
      cmocka_unit_test(frames_that_are_not_defined_have_no_condition),
  };
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
