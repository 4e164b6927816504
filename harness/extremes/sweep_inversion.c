/* sweep_inversion.c - shapes on the way to being inside out, each by itself; and the way,
 * step by step: frame and force may jump where the method's definition does, and nowhere
 * else.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"
#include "harness/extremes/paths.h"
#include "harness/extremes/report.h"
#include "harness/progress.h"

/* ---- shapes ------------------------------------------------------------------------- */

enum { STOPS = 31 }; /* flat at the eleventh */

static void name(const void *context, size_t n, struct cb_extreme *row) {
  (void)context;
  row->value = (double)n;
  snprintf(row->parameter, sizeof row->parameter, "through %s", cb_path_name[n]);
}

static enum cb_status run_shapes(struct cb_extremes *all) {
  struct cb_cases c;
  enum cb_status status = cb_cases_create(CB_PATHS * STOPS, true, &c);
  if (status) return status;
  for (size_t n = 0; n < c.count; n++) {
    double F[9];
    /* the centre is passed by: that point is one of the collapsed shapes */
    const double beside = n / STOPS == CB_PATH_CENTRE ? 0.5 : 0;
    cb_path_gradient(n / STOPS, ((double)(n % STOPS) + beside) / (STOPS - 1), F);
    for (int i = 0; i < 9; i++) c.x[12 * n + 3 + (size_t)(i % 3 * 3 + i / 3)] = F[i];
  }
  status = cb_cases_sweep("inversion", &c, STOPS, name, NULL, all);
  cb_cases_free(&c);
  return status;
}

/* ---- jumps -------------------------------------------------------------------------- */

/* A hundredth of a turn beyond what the exact frame does in that step. */
static const double frame_jump = 3.6;
/* A step of a smooth force is like the steps beside it. */
static const double force_jump = 8, force_least = 0.02;

struct jumps {
  double frame, frame_at, force, force_at; /* largest of all, degrees and of the force */
  double unexplained_at;                   /* the first, NaN: none */
};

static double norm12(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < 12; i++) sum = hypot(sum, a[i] - (b ? b[i] : 0));
  return sum;
}

static double force_step(const struct cb_walk *w, size_t path, size_t k) {
  return norm12(w->f + 12 * cb_walk_index(path, k + 1), w->f + 12 * cb_walk_index(path, k));
}

/* Share of the force that step k changes it by, if it is none of a smooth force, else 0. */
static double force_jumps(const struct cb_walk *w, size_t path, size_t k) {
  const double step = force_step(w, path, k);
  const double before = k > 0 ? force_step(w, path, k - 1) : 0;
  const double after = k + 1 < CB_PATH_STEPS ? force_step(w, path, k + 1) : 0;
  const double size = norm12(w->f + 12 * cb_walk_index(path, k), NULL) +
                      norm12(w->f + 12 * cb_walk_index(path, k + 1), NULL);
  return step > force_jump * fmax(before, after) && step > force_least * size ? step / size : 0;
}

static struct jumps find_jumps(const struct cb_walk *w, size_t path, bool judge_force) {
  struct jumps j = {.unexplained_at = NAN};
  for (size_t k = 0; k < CB_PATH_STEPS; k++) {
    const size_t n = cb_walk_index(path, k);
    const double t = (k + 0.5) / CB_PATH_STEPS;
    /* NaN: the definition has no frame here, or none that can be told */
    double exact = cb_frames_angle(w->exact + 9 * n, w->exact + 9 * n + 9);
    if (w->definition == CB_UNDEFINED) exact = 0;
    const double frame = w->framed ? cb_frames_angle(w->R + 9 * n, w->R + 9 * n + 9) : 0;
    const double force = force_jumps(w, path, k);
    if (frame > j.frame) j.frame = frame, j.frame_at = t;
    if (force > j.force) j.force = force, j.force_at = t;
    const bool unexplained = (w->framed && fabs(frame - exact) > frame_jump) ||
                             (judge_force && force > 0 && exact < frame_jump);
    if (unexplained && isnan(j.unexplained_at)) j.unexplained_at = t;
  }
  return j;
}

/* Finite all the way, but for where shapes alone are judged: collapsed to a point, flat
 * where B is divided by the volume. */
static bool finite_way(const struct cb_walk *w, size_t path, bool over_volume) {
  for (size_t k = 0; k <= CB_PATH_STEPS; k++) {
    const size_t n = cb_walk_index(path, k);
    const bool flat = 3 * k == CB_PATH_STEPS;
    double sum = 0;
    if (flat && path == CB_PATH_CENTRE) continue;
    for (size_t i = 0; i < 9; i++) sum += w->R[9 * n + i];
    for (size_t i = 0; i < 12 && !(over_volume && flat); i++) sum += w->f[12 * n + i];
    if (!isfinite(sum)) return false;
  }
  return true;
}

/* The first walk of each definition and precision: what its frames are is known then. */
struct walks {
  struct cb_walk of[CB_GRAM_SCHMIDT + 1][2];
};

static enum cb_status add_variant(struct cb_extremes *all, const struct cb_variant *v,
                                  struct walks *first) {
  struct cb_walk w,
      *known =
          &first->of[cb_frame_definition(v->model)][v->arithmetic->scalar_bytes == sizeof(float)];
  const char *model = v->model->name;
  const bool warm = strncmp(model, "polar-quaternion", 16) == 0;
  enum cb_status status = cb_walk_along(v, known->R ? known : NULL, &w);
  if (status) return status;
  for (size_t p = 0; !status && p < CB_PATHS; p++) {
    struct cb_extreme row = cb_extreme_blank("jumps", v);
    const struct jumps j = find_jumps(&w, p, !warm);
    name(NULL, p, &row);
    row.finite = finite_way(&w, p, cb_divides_by_volume(v->model));
    row.law = isnan(j.unexplained_at) ? "" : "continuity";
    row.value = isnan(j.unexplained_at) ? j.frame_at : j.unexplained_at;
    if (j.frame > frame_jump || j.force > 0)
      snprintf(row.note, sizeof row.note, "%sframe by %.0f deg at %.3f; force by %.2g at %.3f",
               warm ? "warm: " : "", j.frame, j.frame_at, j.force, j.force_at);
    status = cb_extremes_add(all, &row);
  }
  if (known->R)
    cb_walk_free(&w);
  else
    *known = w;
  return status;
}

static enum cb_status run_jumps(struct cb_extremes *all) {
  enum cb_status status = CB_OK;
  struct walks first = {0};
  size_t variants = 0;
  while (all->variants[variants]) variants++;
  cb_progress_begin("jumps", (double)variants);
  for (size_t v = 0; !status && v < variants; v++) {
    cb_progress((double)v, all->variants[v]->model->name);
    status = add_variant(all, all->variants[v], &first);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  cb_progress_end();
  for (size_t d = 0; d <= CB_GRAM_SCHMIDT; d++)
    for (size_t p = 0; p < 2; p++) cb_walk_free(&first.of[d][p]);
  return status;
}

const struct cb_sweep cb_sweep_inversion = {
    "inversion", "turned inside out through vertices, edges, the centre", run_shapes};
const struct cb_sweep cb_sweep_jumps = {
    "jumps", "on that way: where frame and force jump, and the definition does not", run_jumps};
