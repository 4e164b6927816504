/* paths.c - see paths.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/paths.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/cases.h"

enum { POINTS = CB_PATHS * (CB_PATH_STEPS + 1) };

const char *const cb_path_name[CB_PATHS] = {"vertex a", "vertex b", "vertex c",
                                            "vertex d", "edge ab",  "edge ac",
                                            "edge ad",  "centre",   "vertex d straight"};

/* Where the moving vertices, shares of all four, come from and go to. Not the middles: there
 * singular values are the same. */
static const struct {
  bool moves[4];
  double from[4], to[4];
} motion[CB_PATH_CENTRE] = {
    {{1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0.5, 0.3, 0.2}},
    {{0, 1, 0, 0}, {0, 1, 0, 0}, {0.5, 0, 0.3, 0.2}},
    {{0, 0, 1, 0}, {0, 0, 1, 0}, {0.5, 0.3, 0, 0.2}},
    {{0, 0, 0, 1}, {0, 0, 0, 1}, {0.5, 0.3, 0.2, 0}},
    {{1, 1, 0, 0}, {0.55, 0.45, 0, 0}, {0, 0, 0.4, 0.6}},
    {{1, 0, 1, 0}, {0.55, 0, 0.45, 0}, {0, 0.4, 0, 0.6}},
    {{1, 0, 0, 1}, {0.55, 0, 0, 0.45}, {0, 0.4, 0.6, 0}},
};

void cb_path_gradient(size_t path, double t, double F[9]) {
  static const double strain[9] = {0.3, 0.1, -0.05, 0, -0.2, 0.15, 0.1, 0, 0.1};
  const double along = 3 * t, straight[3] = {1.2, 0.9, 1 - along};
  for (int i = 0; i < 9; i++) {
    const double unit = i % 4 == 0;
    const int row = i / 3, vertex = 1 + i % 3; /* rest: vertex n is unit vector n */
    if (path == CB_PATH_CENTRE)
      F[i] = (1 - along) * (unit + t * strain[i]);
    else if (path > CB_PATH_CENTRE)
      F[i] = unit * straight[row];
    else
      F[i] = unit + along * (motion[path].to[1 + row] - motion[path].from[1 + row]) *
                        (motion[path].moves[vertex] - motion[path].moves[0]);
  }
}

double cb_frames_angle(const double *Q, const double *R) {
  double square = 0;
  for (int i = 0; i < 9; i++) square += (Q[i] - R[i]) * (Q[i] - R[i]);
  /* |Q - R| = sqrt(8) sin(angle / 2) of two rotations; fmin would hide a NaN */
  const double sine = sqrt(square / 8);
  return 360 / M_PI * asin(sine > 1 ? 1 : sine);
}

static void know_frames(const struct cb_variant *v, const struct cb_cases *c, struct cb_walk *w) {
  const bool single = v->arithmetic->scalar_bytes == sizeof(float);
  for (size_t n = 0; n < POINTS; n++) {
    double F[9], condition = HUGE_VAL, *R = w->exact + 9 * n;
    for (int i = 0; i < 9; i++) {
      F[i] = c->x[12 * n + 3 + (size_t)(i % 3 * 3 + i / 3)];
      if (single) F[i] = (float)F[i];
    }
    if (w->definition != CB_UNDEFINED) cb_frame_exact(w->definition, F, R, &condition);
    if (!(condition * v->arithmetic->roundoff < cb_well_conditioned))
      for (int i = 0; i < 9; i++) R[i] = NAN;
  }
}

/* All paths side by side, so that frames that remember come from the step before. */
static enum cb_status walk_forces(const struct cb_variant *v, const struct cb_cases *c, double *f) {
  struct cb_cases at;
  struct cb_probe probe = {0};
  double out[12 * CB_PATHS];
  enum cb_status status = cb_cases_create(CB_PATHS, true, &at);
  if (!status) status = cb_cases_open(v, &at, &probe);
  for (size_t k = 0; !status && k <= CB_PATH_STEPS; k++) {
    for (size_t p = 0; p < CB_PATHS; p++)
      memcpy(at.x + 12 * p, c->x + 12 * cb_walk_index(p, k), 12 * sizeof *at.x);
    cb_probe_force(&probe, at.x, out);
    for (size_t p = 0; p < CB_PATHS; p++)
      for (size_t i = 0; i < 12; i++) f[12 * cb_walk_index(p, k) + i] = out[12 * p + i] / c->young;
  }
  cb_probe_close(&probe);
  cb_cases_free(&at);
  return status;
}

enum cb_status cb_walk_along(const struct cb_variant *v, const struct cb_walk *known,
                             struct cb_walk *w) {
  struct cb_cases c;
  struct cb_walk made = {.definition = cb_frame_definition(v->model),
                         .framed = v->model->frame != NULL,
                         .R = calloc(POINTS, 30 * sizeof *made.R)};
  enum cb_status status = made.R ? CB_OK : cb_fail_memory("the paths");
  if (!status) status = cb_cases_create(POINTS, true, &c);
  if (status) goto done;
  made.f = made.R + 9 * POINTS, made.exact = made.f + 12 * POINTS;
  for (size_t p = 0; p < CB_PATHS; p++)
    for (size_t k = 0; k <= CB_PATH_STEPS; k++) {
      double F[9], *x = c.x + 12 * cb_walk_index(p, k);
      cb_path_gradient(p, (double)k / CB_PATH_STEPS, F);
      for (int i = 0; i < 9; i++) x[3 + i % 3 * 3 + i / 3] = F[i];
    }
  if (known)
    memcpy(made.exact, known->exact, 9 * POINTS * sizeof *made.exact);
  else
    know_frames(v, &c, &made);
  if (made.framed) status = cb_cases_frames(v, &c, made.R);
  if (!status) status = walk_forces(v, &c, made.f);
  cb_cases_free(&c);
done:
  if (status)
    cb_walk_free(&made);
  else
    *w = made;
  return status;
}

void cb_walk_free(struct cb_walk *w) {
  free(w->R);
  *w = (struct cb_walk){0};
}
