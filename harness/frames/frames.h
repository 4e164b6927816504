/* frames.h - a conformance set for routines that find the rotation of a 3x3 matrix:
 * named groups of inputs with exact answers, and how a routine does on them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAMES_H
#define CB_FRAMES_H

#include "kernels/kernel.h"
#include "reference/exact_frames.h"

/* ---- the set (set.c) ------------------------------------------------------------------ */

enum cb_frame_kind { CB_FRAME_POLAR, CB_FRAME_QR };

struct cb_frame_input {
  double F[9]; /* row-major; exactly a number of the set's precision */
  struct cb_exact_frame exact;
  bool unique; /* in the set's precision the answer is known to three digits at least */
};
struct cb_frame_group {
  const char *name, *about; /* static */
  size_t first, count;
};
enum { CB_FRAME_GROUPS = 12 };
struct cb_frame_set {
  enum cb_frame_kind kind;
  size_t scalar_bytes; /* 8: double, 4: float */
  double roundoff;
  struct cb_frame_group group[CB_FRAME_GROUPS];
  size_t count;
  struct cb_frame_input *input;
};

/* The same for the same seed. CB_MEMORY, recorded. */
enum cb_status cb_frame_set_create(enum cb_frame_kind kind, size_t scalar_bytes, unsigned long seed,
                                   struct cb_frame_set *set);
void cb_frame_set_free(struct cb_frame_set *set);                    /* zeroed is allowed */
struct cb_table *cb_frame_set_table(const struct cb_frame_set *set); /* NULL: out of memory */

/* ---- a routine on a group (judge.c) ---------------------------------------------------- */

/* R[9*count] := frames of F[9*count], both of the set's scalar. */
struct cb_frame_routine {
  void (*run)(const void *context, size_t count, const void *F, void *R);
  const void *context;
};

/* The worst of a group, of the answers that are finite; NaN: of nothing. In units of roundoff:
 * error of its condition as well, excess of the largest singular value. */
struct cb_frame_result {
  size_t inputs, unique, not_finite;
  size_t flipped;       /* det R < 0 */
  double error;         /* |R - exact|, unique answers only */
  double degrees;       /* the largest angle between the two, unique answers only */
  double orthogonality; /* |R^T R - I| */
  double determinant;   /* |det R - 1| */
  double excess;        /* polar: how much sum R_ij F_ij misses of the largest possible, which
                           is half of what |F - R|^2 has too much; qr: how far R^T F is from
                           upper triangular with a positive diagonal */
  double ns;            /* a call */
};
enum { CB_FRAME_LIMIT = 1000 }; /* of each, roundoffs */

/* All NaN but for the number of inputs. */
struct cb_frame_result cb_frame_unmeasured(const struct cb_frame_group *group);

/* *at (may be NULL) := number of the input that is worked on, counted within the group; behind
 * the last while the routine is timed. CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_frame_measure(const struct cb_frame_routine *routine,
                                const struct cb_frame_set *set, const struct cb_frame_group *group,
                                volatile size_t *at, struct cb_frame_result *result);
/* "right", or what is wrong in a word or two; static. */
const char *cb_frame_verdict(const struct cb_frame_result *result, const struct cb_frame_set *set);
/* The worse the verdict the larger; 0: right. */
int cb_frame_severity(const struct cb_frame_result *result, const struct cb_frame_set *set);

/* ---- a routine on all of them (summary.c) ---------------------------------------------- */

/* Zeroed before the first group is added. */
struct cb_frame_summary {
  struct cb_frame_result worst; /* of any group; counts: of all */
  size_t groups, right;
  const char *group; /* of the worst verdict, among those the first of the largest error */
  int severity;      /* there */
  double error;      /* there */
  double fastest_ns; /* of a group; worst.ns is the slowest's */
};
void cb_frame_summary_add(struct cb_frame_summary *summary, const struct cb_frame_result *result,
                          const struct cb_frame_set *set, const struct cb_frame_group *group);
#define CB_FRAME_SUMMARY_COLUMNS "frame,right,worst,error,orthogonality,flipped,not_finite,ns"
void cb_frame_summary_row(const char *name, const char *arithmetic,
                          const struct cb_frame_summary *summary, struct cb_table *table);

/* ---- somebody else's (outside.c) ------------------------------------------------------- */

/* A shared library with one or both of
 *   void corobench_frame(const double F[9], double R[9]);
 *   void corobench_frame_f32(const float F[9], float R[9]);
 * row-major. Only child processes load and call it. */
struct cb_outside {
  char path[4096];
  bool has[2]; /* in double, in float */
};
/* CB_INPUT: it cannot be loaded, or has neither. CB_IO: no child process. */
enum cb_status cb_outside_open(const char *path, struct cb_outside *library);

/* How the child came to its end; the sentence is of what is not CB_OUTSIDE_DONE. */
struct cb_outside_end {
  enum { CB_OUTSIDE_DONE, CB_OUTSIDE_CRASHED, CB_OUTSIDE_LEFT, CB_OUTSIDE_HUNG } how;
  char sentence[256];
};
/* cb_frame_measure in a child process. Where that crashes, leaves or hangs, *result is all NaN
 * and *end says so. CB_IO, CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_outside_measure(const struct cb_outside *library, const struct cb_frame_set *set,
                                  const struct cb_frame_group *group,
                                  struct cb_frame_result *result, struct cb_outside_end *end);

/* ---- tables (survey.c) ------------------------------------------------------------------- */

extern const char *const cb_frame_kind_name[2];

struct cb_options;
struct cb_frame_survey {
  struct cb_table *table;   /* one row a routine, precision and group */
  struct cb_table *summary; /* of ours: one row a routine and precision */
  char crash[256];          /* the first sentence of a library that did not come to an end */
  size_t rows, wrong;       /* of a library */
  char first_wrong[160];
};
/* The frames of the models that --variant selects; without it those of every family, in f64 and
 * f32; kind NULL: both. Shows progress. */
enum cb_status cb_frame_survey_ours(const struct cb_options *options,
                                    const enum cb_frame_kind *kind, struct cb_frame_survey *survey);
/* A library's routine, beside the first frame that --variant selects (polar-closed or qr). */
enum cb_status cb_frame_survey_library(const struct cb_options *options, enum cb_frame_kind kind,
                                       const struct cb_outside *library,
                                       struct cb_frame_survey *survey);

#endif
