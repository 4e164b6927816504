/* recovery.c - see recovery.h.
 * Source: the best rigid motion: Kabsch 1976, the nearest rotation by GSL's SVD.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/recovery/recovery.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "reference/oracles.h"

/* The block's slowest wave takes about 0.2 s and dies away to a third in 0.04 s. */
const struct cb_step_parameters cb_recovery_step = {.h = 2e-3, .beta = 50, .iterations = 20};

/* Of the size, in CB_RECOVERY_EVERY steps: what moves less will not arrive anywhere else. */
static const double STILL = 1e-7;

struct way {
  const struct cb_recovery_body *body;
  struct cb_job job;
  double *x, *before; /* [3*nodes], m */
};

static double determinant(const double *A) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* How many elements are at rest, right-handed and left-handed. */
static void count_elements(const struct way *w, size_t *back, size_t *mirrored) {
  const struct cb_mesh *mesh = &w->body->at.mesh;
  *back = *mirrored = 0;
  for (size_t e = 0; e < mesh->tets; e++) {
    const uint32_t *t = mesh->tet + 4 * e;
    const double *G = w->body->inverse + 9 * e;
    double F[9], strain = 0;
    for (int i = 0; i < 9; i++) {
      F[i] = 0;
      for (int k = 0; k < 3; k++)
        F[i] += (w->x[3 * t[k + 1] + (size_t)i / 3] - w->x[3 * t[0] + (size_t)i / 3]) *
                G[3 * k + i % 3];
    }
    for (int i = 0; i < 9; i++) {
      const double C =
          F[i / 3] * F[i % 3] + F[3 + i / 3] * F[3 + i % 3] + F[6 + i / 3] * F[6 + i % 3];
      strain += (C - (i % 4 == 0)) * (C - (i % 4 == 0));
    }
    if (!(sqrt(strain) <= CB_RECOVERY_STRAIN)) continue;
    *(determinant(F) > 0 ? back : mirrored) += 1;
  }
}

/* r->distance, r->turn := after the rigid motion x = R (X - C) + c that is nearest. */
static void look_at_shape(const struct way *w, struct cb_recovery *r) {
  const struct cb_bench_scene *at = &w->body->at;
  double c[3] = {0}, C[3] = {0}, H[9] = {0}, R[9], all = 0, sum = 0;
  for (size_t i = 0; i < 3 * at->mesh.nodes; i++) {
    c[i % 3] += at->mass[i / 3] * w->x[i];
    C[i % 3] += at->mass[i / 3] * at->mesh.X[i];
    all += at->mass[i / 3] / 3;
  }
  for (size_t n = 0; n < at->mesh.nodes; n++)
    for (size_t i = 0; i < 9; i++)
      H[i] += at->mass[n] * (w->x[3 * n + i / 3] - c[i / 3] / all) *
              (at->mesh.X[3 * n + i % 3] - C[i % 3] / all);
  r->distance = r->turn = NAN;
  if (cb_oracle_polar(H, R) != CB_OK) return;
  for (size_t n = 0; n < at->mesh.nodes; n++)
    for (size_t i = 0; i < 3; i++) {
      double d = w->x[3 * n + i] - c[i] / all;
      for (size_t k = 0; k < 3; k++) d -= R[3 * i + k] * (at->mesh.X[3 * n + k] - C[k] / all);
      sum += at->mass[n] * d * d;
    }
  r->distance = sqrt(sum / all) / w->body->size;
  r->turn = cb_rotation_angle(R);
}

static bool all_finite(const struct way *w) {
  for (size_t i = 0; i < 3 * w->body->at.mesh.nodes; i++)
    if (!isfinite(w->x[i])) return false;
  return true;
}

static bool still(struct way *w) {
  const size_t count = 3 * w->body->at.mesh.nodes;
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(w->x[i] - w->before[i]));
  memcpy(w->before, w->x, count * sizeof *w->before);
  return most <= STILL * w->body->size;
}

static void let_go(struct way *w, struct cb_recovery *r) {
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  const double h = cb_recovery_step.h;
  size_t back, mirrored, n = 0, look = 0, away = 0; /* last step with an element not back */
  for (; n <= CB_RECOVERY_STEPS && !cb_interrupted(); n++) {
    a->to_double(w->body->at.mesh.nodes, w->job.x, w->x);
    if (!all_finite(w)) {
      r->lost = (double)n * h;
      break;
    }
    count_elements(w, &back, &mirrored);
    r->back = (double)back / (double)r->elements;
    r->mirrored = (double)mirrored / (double)r->elements;
    if (back < r->elements) away = n;
    if (n % CB_RECOVERY_EVERY == 0) {
      r->share[look++] = r->back;
      look_at_shape(w, r);
      if ((n > 0 && still(w)) || !(r->distance <= CB_RECOVERY_FAR)) break;
    }
    cb_stepper_step(w->job.stepper, w->job.x, w->job.v, NULL);
    if (cb_stepper_ended(w->job.stepper).why == CB_ENDED_OVERFLOW) {
      r->lost = (double)(n + 1) * h; /* kept out of the body, which would only seem to stay */
      break;
    }
  }
  if (!isnan(r->lost)) r->back = r->mirrored = 0, r->distance = r->turn = NAN;
  if (r->back == 1) r->time = (double)(away + 1) * h;
  while (look < CB_RECOVERY_LOOKS) r->share[look++] = r->back; /* as it stays */
  if (isnan(r->lost)) look_at_shape(w, r);
}

enum cb_status cb_recovery_run(const struct cb_recovery_body *body,
                               const struct cb_variant *variant, struct cb_recovery *r) {
  const size_t bytes = 3 * body->at.mesh.nodes * sizeof(double);
  struct way w = {.body = body, .x = malloc(bytes), .before = malloc(bytes)};
  struct cb_recovery made = {.start = body->start,
                             .variant = variant,
                             .elements = body->at.mesh.tets,
                             .lost = NAN,
                             .distance = NAN,
                             .turn = NAN,
                             .time = NAN};
  enum cb_status status = w.x && w.before ? CB_OK : cb_fail_memory("the body on its way");
  if (!status) status = cb_job_create(variant, 1, &body->at, &cb_recovery_step, &w.job);
  if (!status) {
    memcpy(w.before, body->at.x, bytes);
    let_go(&w, &made);
    if (cb_interrupted())
      status = cb_fail(CB_INTERRUPTED, "interrupted while a body came back");
    else
      *r = made;
  }
  cb_job_free(&w.job);
  free(w.x);
  free(w.before);
  return status;
}

const char *cb_recovery_outcome(const struct cb_recovery *r) {
  if (!isnan(r->lost)) return "NaN";
  if (r->back == 1) return "recovered";
  if (!(r->distance <= CB_RECOVERY_FAR)) return "exploded";
  return r->mirrored >= 0.5 ? "mirrored" : "stuck";
}
