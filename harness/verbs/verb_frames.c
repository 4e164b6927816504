/* verb_frames.c - `corobench frames`: how right, robust and fast rotation extraction is, here
 * and in somebody else's library.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/frames/frames.h"
#include "harness/verbs/verbs.h"

static const char doc[] =
    "Find the rotations of a set of 3x3 matrices with exact answers, in named groups, and say how "
    "right, how robust and how fast the frames of the models are, each in one row (csv, json: in "
    "every group); or, with --check, a routine of your own beside ours. That is a shared library "
    "with one or both of\n"
    "  void corobench_frame(const double F[9], double R[9]);\n"
    "  void corobench_frame_f32(const float F[9], float R[9]);\n"
    "F and R row-major, R not overlapping F. Exit status 1 when it is not right in every group, 2 "
    "when it cannot be loaded, crashes or hangs."
    "\verror, orthogonality |R'R - I|, determinant |det R - 1| and excess are the worst of the "
    "group in units of roundoff: error times the condition s1/(s2 + s3), for singular values s1 >= "
    "s2 >= s3 (s3 < 0 where det F < 0), where the answer is unique to three digits; degrees: the "
    "same as an angle. excess: what sum R_ij F_ij misses of its largest value s1 + s2 + s3, over "
    "s1 (a nearest rotation reaches it even where it is not unique). Of 'qr', F = R T, T upper "
    "triangular with T11, T22 >= 0: condition 1 + |f2|/|f2 across f1|, excess: how far R'F is from "
    "such a T. right: all finite and each at most 1000 roundoffs; inaccurate: less than a degree "
    "off. In one row: in how many groups it is right; the worst group, by verdict, then by error; "
    "the "
    "worst error and orthogonality of all groups; answers with det R < 0 (flipped) and with NaN or "
    "infinity; ns a call in the fastest and in the slowest group. Frames that are made for lanes "
    "are called for a whole group at once.";

enum { KEY_CHECK = 1, KEY_GROUPS, KEY_KIND, KEY_WRITE };
static const struct argp_option own_options[] = {
    {"check", KEY_CHECK, "LIB.so", 0, "Check this library's routine", 0},
    {"groups", KEY_GROUPS, NULL, 0, "A row for each group", 0},
    {"kind", KEY_KIND, "KIND", 0,
     "What it is meant to find: polar (default), the nearest rotation, or qr, Gram-Schmidt on the "
     "columns",
     0},
    {"write", KEY_WRITE, "DIR", 0,
     "Write the set itself, inputs and exact answers, to DIR/frames-KIND-f64.csv and -f32.csv; "
     "measure nothing",
     0},
    {0}};

struct request {
  const char *check, *write;
  enum cb_frame_kind kind;
  bool kind_given, groups;
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  switch (key) {
  case KEY_CHECK: r->check = text; return 0;
  case KEY_GROUPS: r->groups = true; return 0;
  case KEY_WRITE: r->write = text; return 0;
  case KEY_KIND:
    r->kind_given = true;
    for (int i = 0; i < 2; i++)
      if (strcmp(text, cb_frame_kind_name[i]) == 0) {
        r->kind = (enum cb_frame_kind)i;
        return 0;
      }
    cb_fail(CB_INPUT, "--kind needs polar or qr, not '%s'", text);
    return EINVAL;
  default: return ARGP_ERR_UNKNOWN;
  }
}

static enum cb_status write_set(const struct cb_options *o, const struct request *r) {
  enum cb_status status = cb_output_directory(r->write);
  for (int f32 = 0; f32 < 2 && !status; f32++) {
    struct cb_frame_set set = {.count = 0};
    struct cb_table *t = NULL;
    char name[64];
    snprintf(name, sizeof name, "frames-%s-%s.csv", cb_frame_kind_name[r->kind],
             f32 ? "f32" : "f64");
    status = cb_frame_set_create(r->kind, f32 ? sizeof(float) : sizeof(double), o->seed, &set);
    if (!status && !(t = cb_frame_set_table(&set))) status = cb_fail_memory("the conformance set");
    if (!status) status = cb_output_table(r->write, name, t, CB_CSV);
    if (!status) printf("%s/%s: %zu inputs\n", r->write, name, set.count);
    cb_table_free(t);
    cb_frame_set_free(&set);
  }
  return status;
}

static enum cb_status print_ours(const struct cb_options *o, const struct request *r) {
  struct cb_frame_survey survey = {.table = NULL};
  enum cb_status status = cb_frame_survey_ours(o, r->kind_given ? &r->kind : NULL, &survey);
  const bool all = r->groups || o->format != CB_TABLE;
  if (!status) status = cb_table_print(all ? survey.table : survey.summary, o->format, stdout);
  if (!status && !all)
    puts("\nright: groups without a wrong answer; worst: the group; then the worst of all groups, "
         "in "
         "roundoffs;\nns: in the fastest and the slowest group. Group by group: --groups");
  cb_table_free(survey.table);
  cb_table_free(survey.summary);
  return status;
}

static enum cb_status check(const struct cb_options *o, const struct request *r) {
  struct cb_outside library;
  struct cb_frame_survey survey = {.table = NULL};
  enum cb_status status = cb_outside_open(r->check, &library);
  if (!status) status = cb_frame_survey_library(o, r->kind, &library, &survey);
  if (!status && o->format == CB_TABLE)
    printf("%s as a %s frame; our_: %s in the same precision\n\n", r->check,
           cb_frame_kind_name[r->kind],
           o->glob_count            ? "the frame that --variant selects"
           : r->kind == CB_FRAME_QR ? "qr"
                                    : "polar-closed");
  if (!status) status = cb_table_print(survey.table, o->format, stdout);
  cb_table_free(survey.table);
  if (status) return status;
  if (survey.crash[0]) return cb_fail(CB_INPUT, "%s: %s", r->check, survey.crash);
  if (!survey.wrong) return CB_OK;
  return cb_fail(CB_BROKEN, "%s is not right in %zu of %zu groups, the first: %s", r->check,
                 survey.wrong, survey.rows, survey.first_wrong);
}

static enum cb_status run(int argc, char **argv) {
  struct request r = {.kind = CB_FRAME_POLAR};
  struct cb_options o;
  enum cb_status status = cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_SEED,
                                           doc, own_options, parse, &r, &o);
  if (status) return status;
  if (r.check && r.write)
    return cb_fail(CB_INPUT, "--write measures nothing: give it without --check");
  return r.write ? write_set(&o, &r) : r.check ? check(&o, &r) : print_ours(&o, &r);
}

const struct cb_verb cb_verb_frames = {
    "frames", "rotation extraction: accuracy, robustness, speed; of your own routine, too", run};
