/* survey.c - the frames of the models on every group of the set, and a library's beside them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/frames/frames.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"

const char *const cb_frame_kind_name[2] = {"polar", "qr"};

/* ---- ours ------------------------------------------------------------------------------- */

static enum cb_frame_kind kind_of(const struct cb_model *m) {
  return strncmp(m->name, "qr", 2) == 0 ? CB_FRAME_QR : CB_FRAME_POLAR;
}

/* The frame's name: that of the model without how it makes B. */
static void frame_name(const struct cb_variant *v, char name[96]) {
  const char *policy = strstr(v->model->name, "-precomputed");
  snprintf(name, 96, "%.*s",
           (int)(policy ? (size_t)(policy - v->model->name) : strlen(v->model->name)),
           v->model->name);
}

static bool family_head(const struct cb_variant *v) {
  return strstr(v->model->name, "-precomputed") != NULL;
}

/* list[] := each frame once: without --variant those of every family in f64 and f32. */
static size_t select_ours(const struct cb_options *o, const enum cb_frame_kind *kind,
                          const struct cb_variant **list) {
  size_t count = 0;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    const bool scalar = v->arithmetic->lanes == 1 && v->arithmetic->scalar_bytes <= sizeof(double);
    if (v->storage != CB_EBE || !v->model->frame || !cb_options_selects(o, v)) continue;
    if (v->arithmetic->scalar_bytes > sizeof(double) || !cb_arithmetic_runs(v->arithmetic))
      continue;
    if (!o->glob_count && (!scalar || !family_head(v))) continue;
    if (kind && kind_of(v->model) != *kind) continue;
    size_t i = 0;
    while (i < count && list[i]->model->frame != v->model->frame) i++;
    if (i == count) list[count++] = v;
  }
  return count;
}

static void run_ours(const void *context, size_t count, const void *F, void *R) {
  const struct cb_model *model = context;
  model->frame(count, F, R);
}

/* ---- the table ---------------------------------------------------------------------------- */

/* Sets are made when they are first needed. */
struct work {
  const struct cb_options *options;
  struct cb_frame_set set[2][2]; /* [kind][0: double, 1: float] */
  struct cb_frame_survey *survey;
};

static void close_work(struct work *w) {
  for (int i = 0; i < 4; i++) cb_frame_set_free(&w->set[i / 2][i % 2]);
}

static enum cb_status the_set(struct work *w, enum cb_frame_kind kind, bool f32,
                              const struct cb_frame_set **set) {
  struct cb_frame_set *s = &w->set[kind][f32];
  *set = s;
  return s->count
             ? CB_OK
             : cb_frame_set_create(kind, f32 ? sizeof(float) : sizeof(double), w->options->seed, s);
}

#define COLUMNS                                                                                    \
  "arithmetic,group,inputs,error,degrees,orthogonality,determinant,excess,not_finite,ns,verdict"

static void number(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

static void result_cells(struct work *w, const char *name, const char *arithmetic,
                         const char *group, const struct cb_frame_result *r, const char *verdict) {
  cb_table_text(w->survey->table, name);
  cb_table_text(w->survey->table, arithmetic);
  cb_table_text(w->survey->table, group);
  cb_table_integer(w->survey->table, (long long)r->inputs);
  const double numbers[] = {r->error, r->degrees, r->orthogonality, r->determinant, r->excess};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
    number(w->survey->table, numbers[i]);
  cb_table_integer(w->survey->table, (long long)r->not_finite);
  number(w->survey->table, r->ns);
  cb_table_text(w->survey->table, verdict);
}

static enum cb_status measure_variant(struct work *w, const struct cb_variant *v, size_t g,
                                      const struct cb_frame_set **set, struct cb_frame_result *r) {
  const struct cb_frame_routine routine = {run_ours, v->model};
  enum cb_status status =
      the_set(w, kind_of(v->model), v->arithmetic->scalar_bytes == sizeof(float), set);
  return status ? status : cb_frame_measure(&routine, *set, &(*set)->group[g], NULL, r);
}

/* Its rows of both tables. */
static enum cb_status survey_frame(struct work *w, const struct cb_variant *v, double progress) {
  struct cb_frame_summary summary = {.groups = 0};
  const char *arithmetic = v->arithmetic->name;
  char name[96];
  frame_name(v, name);
  for (size_t g = 0; g < CB_FRAME_GROUPS; g++) {
    const struct cb_frame_set *set;
    struct cb_frame_result r;
    cb_progress(progress + (double)g, name);
    const enum cb_status status = measure_variant(w, v, g, &set, &r);
    if (status) return status;
    result_cells(w, name, arithmetic, set->group[g].name, &r, cb_frame_verdict(&r, set));
    cb_table_integer(w->survey->table, (long long)r.flipped);
    cb_frame_summary_add(&summary, &r, set, &set->group[g]);
  }
  cb_frame_summary_row(name, arithmetic, &summary, w->survey->summary);
  return CB_OK;
}

enum cb_status cb_frame_survey_ours(const struct cb_options *options,
                                    const enum cb_frame_kind *kind,
                                    struct cb_frame_survey *survey) {
  struct work w = {.options = options, .survey = survey};
  size_t most;
  cb_variants(&most);
  const struct cb_variant **list = calloc(most, sizeof *list);
  survey->table = cb_table_create("frame," COLUMNS ",flipped");
  survey->summary = cb_table_create(CB_FRAME_SUMMARY_COLUMNS);
  enum cb_status status =
      list && survey->table && survey->summary ? CB_OK : cb_fail_memory("the table of frames");
  const size_t count = status ? 0 : select_ours(options, kind, list);
  if (!status && !count)
    status = cb_fail(CB_INPUT, "what is selected has no frame that runs here; 'corobench list' "
                               "shows all models");
  cb_progress_begin("frames", (double)(count * CB_FRAME_GROUPS));
  for (size_t i = 0; i < count && !status; i++)
    status = survey_frame(&w, list[i], (double)(i * CB_FRAME_GROUPS));
  cb_progress_end();
  free(list);
  close_work(&w);
  return status;
}

/* ---- theirs, beside ours -------------------------------------------------------------------- */

/* The frame that stands beside: the first that --variant selects, else the default one. */
static enum cb_status beside(const struct cb_options *o, enum cb_frame_kind kind, bool f32,
                             const struct cb_variant **chosen) {
  const char *usual = kind == CB_FRAME_QR ? "qr-precomputed" : "polar-closed-precomputed";
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (v->arithmetic->lanes != 1 || v->storage != CB_EBE || !v->model->frame) continue;
    if (v->arithmetic->scalar_bytes != (f32 ? sizeof(float) : sizeof(double))) continue;
    if (kind_of(v->model) != kind || !cb_options_selects(o, v)) continue;
    if (!o->glob_count && strcmp(v->model->name, usual) != 0) continue;
    *chosen = v;
    return CB_OK;
  }
  return cb_fail(CB_INPUT, "--variant selects no %s frame in %s to stand beside the library",
                 cb_frame_kind_name[kind], f32 ? "f32" : "f64");
}

static enum cb_status check_group(struct work *w, const struct cb_outside *library,
                                  const struct cb_variant *ours, const char *name, size_t g,
                                  struct cb_outside_end *end) {
  static const char *const verdicts[] = {
      [CB_OUTSIDE_CRASHED] = "CRASHES", [CB_OUTSIDE_LEFT] = "EXITS", [CB_OUTSIDE_HUNG] = "HANGS"};
  const struct cb_frame_set *set;
  struct cb_frame_result r, our;
  struct cb_frame_survey *survey = w->survey;
  enum cb_status status = measure_variant(w, ours, g, &set, &our);
  if (!status) status = cb_outside_measure(library, set, &set->group[g], &r, end);
  if (status) return status;
  const bool done = end->how == CB_OUTSIDE_DONE, right = done && cb_frame_severity(&r, set) == 0;
  const char *verdict = done ? cb_frame_verdict(&r, set) : verdicts[end->how];
  result_cells(w, name, ours->arithmetic->name, set->group[g].name, &r, verdict);
  number(survey->table, our.error);
  cb_table_integer(survey->table, (long long)our.not_finite);
  number(survey->table, our.ns);
  survey->rows++;
  if (!right && !survey->wrong++)
    snprintf(survey->first_wrong, sizeof survey->first_wrong, "%s in %s: %s", set->group[g].name,
             ours->arithmetic->name, verdict);
  return CB_OK;
}

/* Every group in each precision; after a hang, which costs seconds, no more. */
enum cb_status cb_frame_survey_library(const struct cb_options *options, enum cb_frame_kind kind,
                                       const struct cb_outside *library,
                                       struct cb_frame_survey *survey) {
  struct work w = {.options = options, .survey = survey};
  const char *slash = strrchr(library->path, '/'), *name = slash ? slash + 1 : library->path;
  struct cb_outside_end end = {.how = CB_OUTSIDE_DONE};
  survey->table = cb_table_create("routine," COLUMNS ",our_error,our_not_finite,our_ns");
  enum cb_status status = survey->table ? CB_OK : cb_fail_memory("the table of frames");
  cb_progress_begin("frames", CB_FRAME_GROUPS * (library->has[0] + library->has[1]));
  for (int f32 = 0, n = 0; f32 < 2 && !status; f32++) {
    const struct cb_variant *ours = NULL;
    if (!library->has[f32]) continue;
    status = beside(options, kind, f32, &ours);
    for (size_t g = 0; g < CB_FRAME_GROUPS && !status && end.how != CB_OUTSIDE_HUNG; g++) {
      cb_progress(n++, name);
      status = check_group(&w, library, ours, name, g, &end);
      if (!status && end.how != CB_OUTSIDE_DONE && !survey->crash[0])
        snprintf(survey->crash, sizeof survey->crash, "%s", end.sentence);
    }
  }
  cb_progress_end();
  close_work(&w);
  return status;
}
