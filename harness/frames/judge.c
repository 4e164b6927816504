/* judge.c - how right, how robust and how fast a routine is on a group of the set.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/frames/frames.h"
#include "harness/measure/statistics.h"
#include "harness/measure/timer.h"

typedef __float128 Q;

static Q magnitude(Q a) { return a < 0 ? -a : a; }
static Q larger(Q a, Q b) { return a > b ? a : b; }

/* ---- one answer -------------------------------------------------------------------------- */

/* The larger; a NaN is the largest of all. */
static void most(double *worst, double value) {
  if (isnan(*worst)) *worst = value; /* nothing so far */
  if (!(value <= *worst)) *worst = value;
}

/* T := A^T B */
static void product_tn(const Q *A, const Q *B, Q *T) {
  for (int i = 0; i < 9; i++) {
    T[i] = 0;
    for (int k = 0; k < 3; k++) T[i] += A[3 * k + i / 3] * B[3 * k + i % 3];
  }
}

static Q determinant(const Q *A) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* Angle of the rotation E^T R, of |R - E| = 2 sqrt 2 sin(angle/2). */
static double degrees(double distance) {
  return 2 * asin(fmin(distance / (2 * M_SQRT2), 1)) * 180 / M_PI;
}

static double excess_polar(const struct cb_frame_input *input, const Q *R) {
  const Q *s = input->exact.s;
  Q sum = 0;
  for (int i = 0; i < 9; i++) sum += R[i] * input->F[i];
  return s[0] > 0 ? (double)((s[0] + s[1] + s[2] - sum) / s[0]) : 0;
}

static double excess_qr(const struct cb_frame_input *input, const Q *R) {
  const Q *column = input->exact.column;
  Q F[9], T[9], worst = 0;
  for (int i = 0; i < 9; i++) F[i] = input->F[i];
  product_tn(R, F, T);
  if (column[0] > 0) worst = larger(larger(magnitude(T[3]), magnitude(T[6])), -T[0]) / column[0];
  if (column[1] > 0) worst = larger(worst, larger(magnitude(T[7]), -T[4]) / column[1]);
  return (double)worst;
}

static void judge(const struct cb_frame_set *set, const struct cb_frame_input *input,
                  const double answer[9], struct cb_frame_result *r) {
  const struct cb_exact_frame *exact = &input->exact;
  const double u = set->roundoff;
  Q R[9], T[9], far = 0, skew = 0;
  for (int i = 0; i < 9; i++)
    if (!isfinite(answer[i])) {
      r->not_finite++;
      return;
    }
  for (int i = 0; i < 9; i++) R[i] = answer[i];
  product_tn(R, R, T);
  for (int i = 0; i < 9; i++) {
    skew += (T[i] - (i % 4 == 0)) * (T[i] - (i % 4 == 0));
    far += (R[i] - exact->R[i]) * (R[i] - exact->R[i]);
  }
  const Q det = determinant(R);
  r->flipped += det < 0;
  most(&r->orthogonality, sqrt((double)skew) / u);
  most(&r->determinant, (double)magnitude(det - 1) / u);
  most(&r->excess, (set->kind == CB_FRAME_QR ? excess_qr : excess_polar)(input, R) / u);
  if (!input->unique) return;
  most(&r->error, sqrt((double)far) / (u * exact->condition));
  most(&r->degrees, degrees(sqrt((double)far)));
}

/* ---- time ---------------------------------------------------------------------------------- */

struct race {
  const struct cb_frame_routine *routine;
  size_t count;
  const void *F;
  void *R;
};

static void run_race(void *context, size_t repeats) {
  const struct race *race = context;
  for (size_t i = 0; i < repeats; i++)
    race->routine->run(race->routine->context, race->count, race->F, race->R);
}

static enum cb_status measure_time(struct race *race, double *ns) {
  const struct cb_subject subject = {"frames", NULL, run_race, race};
  const struct cb_timing timing = {
      .epoch_s = 5e-4, .budget_s = 8e-3, .min_rounds = 7, .max_rounds = 31, .seed = 1};
  struct cb_samples samples = {0};
  struct cb_interval median;
  enum cb_status status = cb_timer_run(1, &subject, &timing, &samples);
  if (!status) status = cb_median_interval(samples.rounds, samples.step_s, &median, NULL);
  if (!status) *ns = 1e9 * median.value / (double)race->count;
  cb_samples_free(&samples);
  return status;
}

/* ---- a group -------------------------------------------------------------------------------- */

/* Numbers of the set's scalar. */
static double get(const struct cb_frame_set *set, const void *from, size_t i) {
  return set->scalar_bytes == sizeof(float) ? ((const float *)from)[i] : ((const double *)from)[i];
}
static void put(const struct cb_frame_set *set, void *to, size_t i, double value) {
  if (set->scalar_bytes == sizeof(float))
    ((float *)to)[i] = (float)value;
  else
    ((double *)to)[i] = value;
}

struct cb_frame_result cb_frame_unmeasured(const struct cb_frame_group *group) {
  return (struct cb_frame_result){.inputs = group->count,
                                  .error = NAN,
                                  .degrees = NAN,
                                  .orthogonality = NAN,
                                  .determinant = NAN,
                                  .excess = NAN,
                                  .ns = NAN};
}

enum cb_status cb_frame_measure(const struct cb_frame_routine *routine,
                                const struct cb_frame_set *set, const struct cb_frame_group *group,
                                volatile size_t *at, struct cb_frame_result *result) {
  struct cb_frame_result r = cb_frame_unmeasured(group);
  const struct cb_frame_input *input = set->input + group->first;
  const size_t bytes = 9 * set->scalar_bytes;
  char *F = malloc(group->count * bytes), *R = malloc(group->count * bytes);
  enum cb_status status = F && R ? CB_OK : cb_fail_memory("the frames of a group");
  for (size_t n = 0; !status && n < group->count; n++)
    for (size_t i = 0; i < 9; i++) {
      put(set, F, 9 * n + i, input[n].F[i]);
      put(set, R, 9 * n + i, NAN); /* what is not written is not finite */
    }
  for (size_t n = 0; !status && n < group->count; n++) {
    double answer[9];
    if (at) *at = n;
    routine->run(routine->context, 1, F + n * bytes, R + n * bytes);
    for (size_t i = 0; i < 9; i++) answer[i] = get(set, R, 9 * n + i);
    r.unique += input[n].unique;
    judge(set, &input[n], answer, &r);
  }
  if (at) *at = group->count;
  struct race race = {routine, group->count, F, R};
  if (!status) status = measure_time(&race, &r.ns);
  if (!status) *result = r;
  free(F);
  free(R);
  return status;
}

/* ---- verdicts -------------------------------------------------------------------------------- */

enum verdict { RIGHT, NOT_NEAREST, INACCURATE, WRONG, NOT_ORTHOGONAL, REFLECTION, NOT_FINITE };

static enum verdict verdict(const struct cb_frame_result *r, const struct cb_frame_set *set) {
  const double limit = CB_FRAME_LIMIT, reflection = 1.5 / set->roundoff; /* det R = -1 */
  if (r->not_finite > 0) return NOT_FINITE;
  if (!(r->determinant < reflection)) return REFLECTION;
  if (!(r->orthogonality <= limit && r->determinant <= limit)) return NOT_ORTHOGONAL;
  if (r->unique > 0 && !(r->error <= limit)) return r->degrees < 1 ? INACCURATE : WRONG;
  if (!(r->excess <= limit)) return NOT_NEAREST;
  return RIGHT;
}

int cb_frame_severity(const struct cb_frame_result *r, const struct cb_frame_set *set) {
  return (int)verdict(r, set);
}

const char *cb_frame_verdict(const struct cb_frame_result *r, const struct cb_frame_set *set) {
  switch (verdict(r, set)) {
  case RIGHT: return "right";
  case NOT_NEAREST: return set->kind == CB_FRAME_QR ? "NOT QR" : "NOT NEAREST";
  case INACCURATE: return "inaccurate";
  case WRONG: return "WRONG";
  case NOT_ORTHOGONAL: return "NOT ORTHOGONAL";
  case REFLECTION: return "REFLECTION";
  case NOT_FINITE: return "NOT FINITE";
  }
  return "";
}
