/* test_frames_check.c - the conformance set for rotation routines: its exact answers, and what
 * `corobench frames --check` says of libraries that are right and of such that are not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "harness/frames/frames.h"
#include "reference/oracles.h"
#include "tests/process.h"

enum { SEED = 2005 };
static char libraries[4096];

static const char *library(const char *name) {
  static char path[4200];
  snprintf(path, sizeof path, "%s%s.so", libraries, name);
  return path;
}

typedef __float128 quad;
static quad magnitude(quad a) { return a < 0 ? -a : a; }
static quad larger(quad a, quad b) { return a > b ? a : b; }

/* ---- the set ------------------------------------------------------------------------------ */

static struct cb_frame_set make(enum cb_frame_kind kind, size_t scalar_bytes) {
  struct cb_frame_set set;
  assert_int_equal(cb_frame_set_create(kind, scalar_bytes, SEED, &set), CB_OK);
  return set;
}

static quad skew(const quad *R) {
  quad worst = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      quad dot = -(i == j);
      for (int k = 0; k < 3; k++) dot += R[3 * k + i] * R[3 * k + j];
      worst = larger(worst, magnitude(dot));
    }
  return worst;
}

static quad determinant(const quad *A) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* Rotations to quad's rounding, of any rank; R^T F is symmetric (polar) or triangular (qr), which
 * are the conditions that define them, but for the signs. */
static void exact_answers_are_exact(void **state) {
  (void)state;
  const quad limit = 1e-31Q; /* 2^-113 is 1e-34; rows of F up to 50 times its scale */
  for (int kind = 0; kind < 2; kind++)
    for (size_t bytes = 4; bytes <= 8; bytes += 4) {
      struct cb_frame_set set = make((enum cb_frame_kind)kind, bytes);
      for (size_t n = 0; n < set.count; n++) {
        const struct cb_frame_input *in = &set.input[n];
        quad T[9] = {0}, size = 0;
        for (int i = 0; i < 9; i++) size = larger(size, magnitude(in->F[i]));
        for (int i = 0; i < 9; i++)
          for (int k = 0; k < 3; k++) T[i] += in->exact.R[3 * k + i / 3] * in->F[3 * k + i % 3];
        assert_true(skew(in->exact.R) <= limit);
        assert_true(magnitude(determinant(in->exact.R) - 1) <= limit);
        assert_true(magnitude(T[3] - (kind == CB_FRAME_QR ? 0 : T[1])) <= limit * size);
        assert_true(magnitude(T[6] - (kind == CB_FRAME_QR ? 0 : T[2])) <= limit * size);
        assert_true(magnitude(T[7] - (kind == CB_FRAME_QR ? 0 : T[5])) <= limit * size);
        if (kind == CB_FRAME_QR) assert_true(T[0] >= 0 && T[4] >= -limit * size);
      }
      cb_frame_set_free(&set);
    }
}

/* No rotation near by nor far off is nearer: sum R_ij F_ij is s1 + s2 + s3 and the most. */
static void no_rotation_is_nearer(void **state) {
  (void)state;
  struct cb_frame_set set = make(CB_FRAME_POLAR, sizeof(double));
  for (size_t n = 0; n < set.count; n++) {
    const struct cb_frame_input *in = &set.input[n], *other = &set.input[(n + 77) % set.count];
    const quad *s = in->exact.s, largest = s[0] + s[1] + s[2];
    quad own = 0, foreign = 0;
    for (int i = 0; i < 9; i++) own += in->exact.R[i] * in->F[i];
    for (int i = 0; i < 9; i++) foreign += other->exact.R[i] * in->F[i];
    assert_true(magnitude(own - largest) <= 1e-31Q * s[0]);
    assert_true(foreign <= own + 1e-31Q * s[0]);
    assert_true(s[0] - s[1] >= -1e-31Q * s[0] && s[1] - magnitude(s[2]) >= -1e-31Q * s[0]);
  }
  cb_frame_set_free(&set);
}

/* GSL's decomposition, of which no line is shared, agrees to its own rounding. */
static void the_oracle_agrees(void **state) {
  (void)state;
  struct cb_frame_set set = make(CB_FRAME_POLAR, sizeof(double));
  size_t compared = 0;
  for (size_t n = 0; n < set.count; n++) {
    const struct cb_frame_input *in = &set.input[n];
    double R[9], far = 0;
    if (!in->unique || cb_oracle_polar(in->F, R) != CB_OK) continue;
    for (int i = 0; i < 9; i++) far = fmax(far, fabs(R[i] - (double)in->exact.R[i]));
    if (!(far <= 100 * 0x1p-53 * in->exact.condition))
      fail_msg("input %zu: %g, condition %g", n, far, in->exact.condition);
    compared++;
  }
  assert_true(compared > set.count / 2);
  cb_frame_set_free(&set);
}

/* Each group is what its name says; inputs are numbers of their precision. */
static void groups_are_what_they_say(void **state) {
  (void)state;
  for (size_t bytes = 4; bytes <= 8; bytes += 4) {
    struct cb_frame_set set = make(CB_FRAME_POLAR, bytes);
    for (size_t g = 0; g < CB_FRAME_GROUPS; g++) {
      const struct cb_frame_group *group = &set.group[g];
      size_t unique = 0;
      for (size_t n = group->first; n < group->first + group->count; n++) {
        const struct cb_frame_input *in = &set.input[n];
        const double s3 = (double)in->exact.s[2];
        unique += in->unique;
        for (int i = 0; i < 9 && bytes == 4; i++) assert_true((float)in->F[i] == in->F[i]);
        if (strcmp(group->name, "inverted") == 0) assert_true(s3 < 0 && in->unique);
        if (strcmp(group->name, "mirrored") == 0) assert_true(s3 < 0);
        if (strcmp(group->name, "needles") == 0) assert_true(s3 > 0);
        if (strcmp(group->name, "point") == 0) assert_true(in->exact.s[0] == 0);
        if (strcmp(group->name, "rotations") == 0) assert_true(fabs(s3 - 1) <= 4 * set.roundoff);
      }
      const bool none = strcmp(group->name, "mirrored") == 0 || strcmp(group->name, "point") == 0;
      assert_true(none ? unique == 0 : unique > 0);
    }
    cb_frame_set_free(&set);
  }
}

/* ---- a routine --------------------------------------------------------------------------------
 */

struct answer {
  const struct cb_frame_set *set;
  double turn; /* rad about z, away from the exact answer */
};

static void answer(const void *context, size_t count, const void *F, void *R) {
  const struct answer *a = context;
  const double c = cos(a->turn), s = sin(a->turn), *from = F;
  double *to = R;
  for (size_t n = 0; n < count; n++) {
    const struct cb_frame_input *in = a->set->input;
    while (memcmp(in->F, from + 9 * n, sizeof in->F) != 0) in++;
    for (int i = 0; i < 3; i++) {
      to[9 * n + (size_t)i] = c * (double)in->exact.R[i] - s * (double)in->exact.R[3 + i];
      to[9 * n + 3 + (size_t)i] = s * (double)in->exact.R[i] + c * (double)in->exact.R[3 + i];
      to[9 * n + 6 + (size_t)i] = (double)in->exact.R[6 + i];
    }
  }
}

/* The error is the angle, over roundoff and condition, and so is the verdict. */
static void a_turned_answer_is_found(void **state) {
  (void)state;
  struct cb_frame_set set = make(CB_FRAME_POLAR, sizeof(double));
  const struct {
    double turn;
    const char *verdict;
  } cases[] = {{0, "right"}, {1e-8, "inaccurate"}, {0.5, "WRONG"}};
  for (size_t i = 0; i < 3; i++) {
    const struct answer a = {&set, cases[i].turn};
    struct cb_frame_result r;
    assert_int_equal(
        cb_frame_measure(&(struct cb_frame_routine){answer, &a}, &set, &set.group[0], NULL, &r),
        CB_OK);
    assert_string_equal(cb_frame_verdict(&r, &set), cases[i].verdict);
    assert_true(fabs(r.degrees * M_PI / 180 - cases[i].turn) <= 1e-15 + 1e-6 * cases[i].turn);
    assert_int_equal(r.unique, r.inputs);
    assert_true(r.ns > 0);
  }
  cb_frame_set_free(&set);
}

/* Where no answer is the only one, what is not nearest is found by its excess. */
static void a_turned_answer_is_found_where_many_are_right(void **state) {
  (void)state;
  struct cb_frame_set set = make(CB_FRAME_POLAR, sizeof(double));
  for (size_t g = 0; g < CB_FRAME_GROUPS; g++) {
    const struct answer right = {&set, 0}, a = {&set, 0.5};
    struct cb_frame_result r;
    if (strcmp(set.group[g].name, "mirrored") != 0) continue;
    assert_int_equal(
        cb_frame_measure(&(struct cb_frame_routine){answer, &right}, &set, &set.group[g], NULL, &r),
        CB_OK);
    assert_string_equal(cb_frame_verdict(&r, &set), "right");
    assert_int_equal(
        cb_frame_measure(&(struct cb_frame_routine){answer, &a}, &set, &set.group[g], NULL, &r),
        CB_OK);
    assert_string_equal(cb_frame_verdict(&r, &set), "NOT NEAREST");
  }
  cb_frame_set_free(&set);
}

/* ---- libraries
 * ----------------------------------------------------------------------------------- */

#define CHECK(...) run_words(NULL, (const char *const[]){"frames", __VA_ARGS__, NULL})

/* The line of a CSV table that has `group` in its third column, or fails. */
static void line_of(const char *csv, const char *arithmetic, const char *group, char line[512]) {
  char key[64];
  snprintf(key, sizeof key, ",%s,%s,", arithmetic, group);
  const char *at = strstr(csv, key);
  if (!at) {
    fail_msg("%s is not in:\n%s", key, csv);
    return;
  }
  snprintf(line, 512, "%.*s", (int)strcspn(at, "\n"), at);
}

/* The verdict is the twelfth column, the ninth after the group. */
static void assert_verdict(const struct process *p, const char *arithmetic, const char *group,
                           const char *verdict) {
  char line[512];
  line_of(p->out, arithmetic, group, line);
  const char *cell = line + 1;
  for (int i = 0; i < 10; i++) cell = strchr(cell, ',') + 1;
  if (strncmp(cell, verdict, strlen(verdict)) != 0) fail_msg("no %s in: %s", verdict, line);
}

static void a_right_library_passes(void **state) {
  (void)state;
  struct process p = CHECK("--check", library("right"), "--format", "csv");
  assert_int_equal(p.exit_status, 0);
  assert_int_equal(lines(p.out), 1 + 2 * CB_FRAME_GROUPS);
  assert_verdict(&p, "f32", "line", "right");
  process_free(&p);
  p = CHECK("--kind", "qr", "--check", library("gram_schmidt"));
  assert_int_equal(p.exit_status, 0);
  assert_int_equal(lines(p.out), 4 + CB_FRAME_GROUPS);
  process_free(&p);
}

static void what_is_wrong_is_named(void **state) {
  (void)state;
  const struct {
    const char *library, *arithmetic, *group, *verdict, *fine;
  } cases[] = {{"reflects", "f64", "inverted", "REFLECTION", "needles"},
               {"nan_line", "f64", "line", "NOT FINITE", "flat"},
               {"nan_line", "f64", "point", "NOT FINITE", "ties"},
               {"angle", "f32", "near-identity", "inaccurate", "point"},
               {"angle", "f32", "rotations", "REFLECTION", "line"},
               {"gram_schmidt", "f64", "random", "WRONG", "rotations"}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    struct process p = CHECK("--check", library(cases[i].library), "--format", "csv");
    char line[512];
    assert_int_equal(p.exit_status, 1);
    assert_non_null(strstr(p.err, "is not right in "));
    assert_verdict(&p, cases[i].arithmetic, cases[i].group, cases[i].verdict);
    line_of(p.out, cases[i].arithmetic, cases[i].fine, line);
    process_free(&p);
  }
}

static void a_crash_leaves_the_table(void **state) {
  (void)state;
  struct process p = CHECK("--check", library("crashes"), "--format", "csv");
  assert_one_sentence(&p, "corobench_frame crashed (Segmentation fault) on input ");
  assert_verdict(&p, "f64", "inverted", "CRASHES");
  assert_verdict(&p, "f64", "rotations", "right");
  assert_int_equal(lines(p.out), 1 + CB_FRAME_GROUPS);
  process_free(&p);
}

static void a_hang_leaves_the_table(void **state) {
  (void)state;
  struct process p = CHECK("--check", library("hangs"), "--format", "csv");
  assert_one_sentence(&p, "did not come back within 3 s on input 1 of group point");
  assert_verdict(&p, "f64", "line", "right");
  assert_verdict(&p, "f64", "point", "HANGS");
  process_free(&p);
}

/* What it prints is not in the table. */
static void leaving_is_not_an_answer(void **state) {
  (void)state;
  struct process p = CHECK("--check", library("leaves"), "--format", "csv");
  assert_int_equal(p.exit_status, 2);
  assert_non_null(strstr(p.err, "ended the program (status 3) on input 1 of group near-identity"));
  assert_null(strstr(p.out, "no licence"));
  assert_verdict(&p, "f64", "scales", "EXITS");
  process_free(&p);
}

static void what_cannot_be_checked_is_refused(void **state) {
  (void)state;
  FILE *f = fopen(temporary_path("text.so"), "w");
  fputs("not a library\n", f);
  fclose(f);
  assert_refused(CHECK("--check", "no/such.so"), "cannot load 'no/such.so': No such file");
  assert_refused(CHECK("--check", temporary_path("text.so")), "cannot load the library");
  assert_refused(CHECK("--check", library("nothing")), "has neither corobench_frame nor");
  assert_refused(CHECK("--kind", "svd"), "--kind needs polar or qr, not 'svd'");
  assert_refused(CHECK("--check", library("right"), "--write", "/tmp"), "--write measures nothing");
  assert_refused(CHECK("--check", library("right"), "--variant", "qr-*"),
                 "--variant selects no polar frame in f64");
  assert_refused(CHECK("--variant", "linear"), "has no frame that runs here");
}

/* ---- ours, and the set as files
 * ------------------------------------------------------------------ */

static void ours_are_listed_once(void **state) {
  (void)state; /* all models of a family have the same */
  struct process p =
      CHECK("--variant", "svd-*/*/f64", "--variant", "svd-*/*/f32", "--format", "csv");
  assert_done(&p);
  assert_int_equal(lines(p.out), 1 + 2 * CB_FRAME_GROUPS);
  assert_verdict(&p, "f64", "inverted", "right");
  process_free(&p);
}

/* The inputs, read back, are the same to the last bit. */
static void the_set_is_written(void **state) {
  (void)state;
  struct cb_frame_set set = make(CB_FRAME_POLAR, sizeof(float));
  struct process p = CHECK("--write", temporary_path("set"));
  char path[300];
  assert_done(&p);
  process_free(&p);
  snprintf(path, sizeof path, "%s/frames-polar-f32.csv", temporary_path("set"));
  char *csv = read_text(path);
  const char *at = csv + strcspn(csv, "\n") + 1;
  assert_int_equal(lines(csv), 1 + set.count);
  for (size_t n = 0; n < set.count; n++) {
    const char *cell = at;
    for (int i = 0; i < 4; i++) cell = strchr(cell, ',') + 1;
    for (int i = 0; i < 9; i++, cell = strchr(cell, ',') + 1)
      assert_true(strtod(cell, NULL) == set.input[n].F[i]);
    if (set.input[n].unique) assert_true(strtod(cell, NULL) == (double)set.input[n].exact.R[0]);
    at = strchr(at, '\n') + 1;
  }
  free(csv);
  cb_frame_set_free(&set);
}

int main(int argc, char **argv) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exact_answers_are_exact),
      cmocka_unit_test(no_rotation_is_nearer),
      cmocka_unit_test(the_oracle_agrees),
      cmocka_unit_test(groups_are_what_they_say),
      cmocka_unit_test(a_turned_answer_is_found),
      cmocka_unit_test(a_turned_answer_is_found_where_many_are_right),
      cmocka_unit_test(a_right_library_passes),
      cmocka_unit_test(what_is_wrong_is_named),
      cmocka_unit_test(a_crash_leaves_the_table),
      cmocka_unit_test(a_hang_leaves_the_table),
      cmocka_unit_test(leaving_is_not_an_answer),
      cmocka_unit_test(what_cannot_be_checked_is_refused),
      cmocka_unit_test(ours_are_listed_once),
      cmocka_unit_test(the_set_is_written),
  };
  (void)argc;
  find_program(argv[0]);
  const char *slash = strrchr(argv[0], '/');
  snprintf(libraries, sizeof libraries, "%.*sframes/", slash ? (int)(slash + 1 - argv[0]) : 0,
           argv[0]);
  return cmocka_run_group_tests(tests, temporary_make, temporary_remove);
}
