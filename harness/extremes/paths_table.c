/* paths_table.c - what the paths look like, for the figure.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/paths.h"

static void number(struct cb_table *t, double value) {
  if (isfinite(value))
    cb_table_number(t, round(value * 1e6) / 1e6);
  else
    cb_table_missing(t);
}

static double change(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < 12; i++) sum = hypot(sum, a[i] - b[i]);
  return sum;
}

static void add_path(struct cb_table *t, const char *model, size_t path, const struct cb_walk *w) {
  static const double rest[12] = {0};
  for (size_t k = 0; k <= CB_PATH_STEPS; k++) {
    const size_t now = cb_walk_index(path, k), last = cb_walk_index(path, k ? k - 1 : 0);
    const double *start = w->R + 9 * cb_walk_index(path, 0);
    cb_table_text(t, cb_path_name[path]);
    cb_table_number(t, (double)k / CB_PATH_STEPS);
    cb_table_text(t, model);
    number(t, w->framed ? cb_frames_angle(w->R + 9 * now, start) : NAN);
    number(t, w->framed ? cb_frames_angle(w->R + 9 * now, w->R + 9 * last) : NAN);
    number(t, cb_frames_angle(w->exact + 9 * now, w->exact + 9 * last));
    number(t, change(w->f + 12 * now, rest));
    number(t, change(w->f + 12 * now, w->f + 12 * last));
  }
}

static const struct cb_variant *scalar_f64(const struct cb_extremes *all, const char *model) {
  for (size_t v = 0; all->variants[v]; v++)
    if (strcmp(all->variants[v]->model->name, model) == 0 &&
        all->variants[v]->arithmetic == cb_arithmetics[0])
      return all->variants[v];
  return NULL;
}

enum cb_status cb_paths_table(const struct cb_extremes *all, struct cb_table **table) {
  static const char *const models[] = {"linear",
                                       "green",
                                       "qr-updated",
                                       "qr-exact",
                                       "svd-updated",
                                       "polar-closed-precomputed",
                                       "polar-quaternion-updated",
                                       "polar-reflected-updated"};
  struct cb_table *t = cb_table_create("path,t,model,frame_turned_deg,frame_step_deg,exact_step_"
                                       "deg,force_per_EL2,force_step_per_EL2");
  enum cb_status status = t ? CB_OK : cb_fail_memory("the table of the paths");
  for (size_t m = 0; !status && m < sizeof models / sizeof *models; m++) {
    struct cb_walk w;
    const struct cb_variant *v = scalar_f64(all, models[m]);
    if (!v) continue;
    status = cb_walk_along(v, NULL, &w);
    for (size_t p = 0; !status && p < CB_PATHS; p++) add_path(t, models[m], p, &w);
    if (!status) cb_walk_free(&w);
  }
  if (status)
    cb_table_free(t);
  else
    *table = t;
  return status;
}
