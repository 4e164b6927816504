/* cases_measure.c - a variant on the elements: errors, and the laws that it claims.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/extremes/exact.h"
#include "harness/extremes/report.h"
#include "harness/verify/laws.h"
#include "reference/oracles.h"

enum { DOFS = 12 };

/* What came out of one variant, all cases. */
struct outcome {
  double *R;          /* [9*count]; NULL: has no frame, or is not asked for it */
  double *f, *turned; /* [12*count]; turned: of x y z -> y z x */
  double *y;          /* [12*count] */
  double *K;          /* [144*count], column j of case n at 144 n + 12 j */
};

static bool all_finite(size_t n, const double *a) {
  for (size_t i = 0; i < n; i++)
    if (!isfinite(a[i])) return false;
  return true;
}

static double norm(size_t n, const double *a) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum = hypot(sum, a[i]);
  return sum;
}

static double distance(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum = hypot(sum, a[i] - b[i]);
  return sum;
}

/* ---- running it -------------------------------------------------------------------- */

enum cb_status cb_cases_frames(const struct cb_variant *v, const struct cb_cases *c, double *R) {
  const size_t bytes = v->arithmetic->scalar_bytes, numbers = 9 * c->count;
  void *vectors = calloc(2 * numbers, bytes);
  if (!vectors) return cb_fail_memory("the frames of a sweep");
  double *d = vectors;
  float *s = vectors;
  __float128 *q = vectors;
  for (size_t i = 0; i < numbers; i++) {
    const double F = c->x[12 * (i / 9) + 3 + i % 3 * 3 + i % 9 / 3];
    if (bytes == sizeof *s)
      s[i] = (float)F;
    else if (bytes == sizeof *d)
      d[i] = F;
    else
      q[i] = F;
  }
  v->model->frame(c->count, vectors, (char *)vectors + numbers * bytes);
  for (size_t i = 0; i < numbers; i++)
    R[i] = bytes == sizeof *s   ? (double)s[numbers + i]
           : bytes == sizeof *d ? d[numbers + i]
                                : (double)q[numbers + i];
  free(vectors);
  return CB_OK;
}

static enum cb_status run_operator(const struct cb_variant *v, const struct cb_reference *r,
                                   struct outcome *o) {
  const struct cb_cases *c = &r->cases;
  const size_t length = DOFS * c->count;
  double *work = malloc(length * sizeof *work);
  struct cb_probe probe = {0};
  enum cb_status status = work ? CB_OK : cb_fail_memory("the operators of a sweep");
  if (!status) status = cb_cases_open(v, c, &probe);
  if (status) goto done;
  for (size_t i = 0; i < length; i++) work[i] = c->x[i / 3 * 3 + (i + 1) % 3];
  cb_probe_force(&probe, work, o->turned);
  cb_probe_reset(&probe);
  cb_probe_force(&probe, c->x, o->f);
  cb_probe_product(&probe, r->u, o->y);
  for (size_t j = 0; j < DOFS; j++) {
    for (size_t i = 0; i < length; i++) work[i] = i % DOFS == j;
    cb_probe_product(&probe, work, work);
    for (size_t i = 0; i < length; i++) o->K[i / DOFS * 144 + j * DOFS + i % DOFS] = work[i];
  }
done:
  cb_probe_close(&probe);
  free(work);
  return status;
}

/* ---- judging one case ---------------------------------------------------------------- */

struct judge {
  const struct cb_variant *v;
  const struct cb_reference *r;
  const struct cb_known *k;
  const double *x, *R, *f, *turned, *y, *K;
  struct cb_extreme *row;
};

/* A law is broken by what is beyond a thousand times what rounding explains, and by more
 * than `verify` calls a broken one; NaN breaks it. value: in units of the first, of scale. */
static void breaks(const struct judge *j, const char *law, double value, double unit,
                   double scale) {
  const double significant = cb_law_limit(j->v->arithmetic);
  if (!j->row->law[0] && !(value <= cb_extreme_limit * unit) && !(value <= significant * scale))
    j->row->law = law;
}

static void claims(const struct judge *j, enum cb_law law, double value, double unit,
                   double scale) {
  if (j->v->model->laws[0] & CB_KEEPS(law)) breaks(j, cb_law_name[law], value, unit, scale);
}

/* Where the answer is finite but its exact value is no number of this arithmetic, or has
 * no value by the method itself, nothing can be judged. */
static void judge_finite(const struct judge *j) {
  const struct cb_known *k = j->k;
  struct cb_extreme *row = j->row;
  const bool f = all_finite(12, j->f), y = all_finite(12, j->y) && all_finite(144, j->K);
  row->finite = (!j->R || all_finite(9, j->R)) && f && y;
  if (row->finite || (j->R && !all_finite(9, j->R))) return;
  if (k->flat && cb_divides_by_volume(j->v->model)) {
    row->why = CB_WHY_METHOD;
    snprintf(row->note, sizeof row->note, "by method: B is divided by a volume of about 0");
  } else if ((!f && norm(12, k->f) > j->r->most) || (f && !y && norm(12, k->y) > j->r->most)) {
    row->why = CB_WHY_UNJUDGED;
    snprintf(row->note, sizeof row->note, "not judged: the exact %s is no number of %s",
             f ? "product" : "force", j->v->arithmetic->name);
  }
}

static void judge_frame(const struct judge *j) {
  const struct cb_known *k = j->k;
  struct cb_extreme *row = j->row;
  if (!j->R || !k->framed) return;
  const double u = j->r->roundoff, *R = j->R;
  double RR = 0, det[2];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++)
      RR = hypot(RR, R[a] * R[b] + R[3 + a] * R[3 + b] + R[6 + a] * R[6 + b] - (a == b));
  for (int n = 0; n < 2; n++) {
    const double *A = n ? k->R : R;
    det[n] = A[0] * (A[4] * A[8] - A[5] * A[7]) + A[1] * (A[5] * A[6] - A[3] * A[8]) +
             A[2] * (A[3] * A[7] - A[4] * A[6]);
  }
  row->frame_error = distance(9, R, k->R) / (u * k->condition);
  row->orthogonality = RR / u;
  row->determinant = det[0];
  breaks(j, "orthogonal", RR, u * k->condition, 1);
  if (!(det[0] * det[1] > 0)) row->law = "handedness";
}

static void judge_force(const struct judge *j) {
  const struct cb_known *k = j->k;
  const double *f = j->f;
  double sum[3] = {0}, torque[3] = {0}, arm = 0;
  for (int i = 0; i < 12; i += 3) {
    const double a[3] = {j->x[i] - j->x[0], j->x[i + 1] - j->x[1], j->x[i + 2] - j->x[2]};
    arm = fmax(arm, norm(3, a));
    for (int n = 0; n < 3; n++) {
      const int p = (n + 1) % 3, q = (n + 2) % 3;
      sum[n] += f[i + n];
      torque[n] += a[p] * f[i + q] - a[q] * f[i + p];
    }
  }
  j->row->force_error = distance(12, f, k->f) / k->f_unit;
  /* a flattened point has no arm: nothing turns it */
  j->row->torque = arm > 0 ? norm(3, torque) / (arm * k->f_unit) : 0;
  const double size = norm(12, f);
  claims(j, CB_LAW_NEWTON, norm(3, sum), k->f_unit, size);
  claims(j, CB_LAW_EULER, norm(3, torque), arm * k->f_unit, arm * size);
}

/* The last of all: a row that names it breaks no other. By how much, in units. */
static double judge_rotation(const struct judge *j) {
  double back[12];
  for (int i = 0; i < 12; i++) back[i / 3 * 3 + (i + 1) % 3] = j->turned[i];
  const double apart = distance(12, j->f, back), unit = j->k->f_unit;
  claims(j, CB_LAW_ROTATION, apart, unit, norm(12, j->f));
  return isnan(apart) ? HUGE_VAL : apart / unit;
}

static enum cb_status judge_operator(const struct judge *j) {
  double A[144], skew = 0, eigen[DOFS];
  for (int p = 0; p < DOFS; p++)
    for (int q = 0; q < DOFS; q++) {
      const double there = j->K[DOFS * p + q], back = j->K[DOFS * q + p];
      skew = hypot(skew, there - back);
      A[DOFS * p + q] = (there + back) / 2;
    }
  const double unit = j->k->y_unit, size = norm(144, j->K);
  j->row->product_error = distance(12, j->y, j->k->y) / unit;
  claims(j, CB_LAW_SYMMETRIC, skew, unit, size);
  enum cb_status status = cb_oracle_eigenvalues(DOFS, A, eigen);
  if (status == CB_MEMORY) return status;
  claims(j, CB_LAW_SEMIDEFINITE, status ? NAN : -eigen[0], unit, size);
  return CB_OK;
}

static enum cb_status judge_case(const struct judge *j) {
  const struct cb_known *k = j->k;
  if (k->lost) {
    j->row->why = CB_WHY_UNJUDGED;
    snprintf(j->row->note, sizeof j->row->note, "not judged: no volume at rest is left in %s",
             j->v->arithmetic->name);
    return CB_OK;
  }
  judge_finite(j);
  if (!j->row->finite) return CB_OK;
  judge_frame(j);
  const bool forced = !k->jumps && isfinite(k->f_unit);
  if (forced) judge_force(j);
  enum cb_status status = !k->jumps && isfinite(k->y_unit) ? judge_operator(j) : CB_OK;
  const double turned = forced ? judge_rotation(j) : NAN;
  cb_method_judge(j->v, j->r, k, turned, j->row);
  return status;
}

enum cb_status cb_cases_measure(const struct cb_variant *v, const struct cb_reference *r,
                                struct cb_extreme *row) {
  const struct cb_cases *c = &r->cases;
  const size_t count = c->count;
  struct outcome o = {.f = malloc((9 + 3 * 12 + 144) * count * sizeof *o.f)};
  if (!o.f) return cb_fail_memory("what a variant makes of a sweep");
  o.turned = o.f + 12 * count, o.y = o.turned + 12 * count, o.K = o.y + 12 * count;
  if (c->unit && v->model->frame) o.R = o.K + 144 * count;
  enum cb_status status = o.R ? cb_cases_frames(v, c, o.R) : CB_OK;
  if (!status) status = run_operator(v, r, &o);
  for (size_t n = 0; !status && n < count; n++) {
    const struct judge j = {v,
                            r,
                            &r->known[n],
                            c->x + 12 * n,
                            o.R ? o.R + 9 * n : NULL,
                            o.f + 12 * n,
                            o.turned + 12 * n,
                            o.y + 12 * n,
                            o.K + 144 * n,
                            &row[n]};
    status = judge_case(&j);
  }
  free(o.f);
  return status;
}
