/* truth.c - see truth.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/truth/truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"

static const struct {
  const char *name;
  cb_truth_fn *run;
  double share; /* of the time */
} cases[] = {
    {"patch test", cb_truth_patch, 1},          {"manufactured solution", cb_truth_manufactured, 8},
    {"uniaxial stretch", cb_truth_uniaxial, 1}, {"torsion", cb_truth_torsion, 10},
    {"free vibration", cb_truth_vibration, 8},  {"spinning body", cb_truth_spin, 10},
    {"cantilever", cb_truth_cantilever, 25},    {"Newton's order", cb_truth_newton, 4}};
enum { CASES = sizeof cases / sizeof *cases };

enum cb_status cb_truth_add(struct cb_truth *t, const struct cb_truth_row *row) {
  struct cb_truth_row *more = realloc(t->rows, (t->count + 1) * sizeof *more);
  if (!more) return cb_fail_memory("the table of truth");
  t->rows = more;
  t->rows[t->count++] = *row;
  return CB_OK;
}

struct cb_truth_row cb_truth_row(const char *name, const char *model, const char *source) {
  struct cb_truth_row row = {.exact = NAN,
                             .coarse = NAN,
                             .medium = NAN,
                             .fine = NAN,
                             .order = NAN,
                             .judged = NAN,
                             .low = NAN,
                             .high = NAN};
  snprintf(row.name, sizeof row.name, "%s", name);
  snprintf(row.model, sizeof row.model, "%s", model);
  snprintf(row.source, sizeof row.source, "%s", source);
  return row;
}

bool cb_truth_within(const struct cb_truth_row *row) {
  return isnan(row->low) || (row->judged >= row->low && row->judged <= row->high);
}

double cb_truth_order(double exact, double coarse, double fine, double ratio) {
  return log(fabs(coarse - exact) / fabs(fine - exact)) / log(ratio);
}

bool cb_truth_asked(const struct cb_truth *t, const char *model) {
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    if (v->arithmetic == cb_arithmetics[0] && strcmp(v->model->name, model) == 0 &&
        cb_options_selects(t->options, v))
      return true;
  return false;
}

enum cb_status cb_truth_run(const struct cb_options *options, struct cb_truth *truth) {
  struct cb_truth made = {.options = options};
  enum cb_status status = CB_OK;
  double total = 0, done = 0;
  for (size_t i = 0; i < CASES; i++) total += cases[i].share;
  cb_progress_begin("truth", total);
  for (size_t i = 0; !status && i < CASES; i++) {
    cb_progress(done, cases[i].name);
    status = cases[i].run(&made);
    done += cases[i].share;
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  cb_progress_end();
  if (status)
    cb_truth_free(&made);
  else
    *truth = made;
  return status;
}

void cb_truth_free(struct cb_truth *truth) {
  free(truth->rows);
  *truth = (struct cb_truth){0};
}

static void number(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

struct cb_table *cb_truth_table(const struct cb_truth *truth) {
  struct cb_table *t =
      cb_table_create("case,model,source,exact,coarse,medium,fine,order,judged,low,high,within");
  for (size_t i = 0; t && i < truth->count; i++) {
    const struct cb_truth_row *r = &truth->rows[i];
    cb_table_text(t, r->name);
    cb_table_text(t, r->model);
    cb_table_text(t, r->source);
    const double numbers[] = {r->exact, r->coarse, r->medium, r->fine,
                              r->order, r->judged, r->low,    r->high};
    for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++) number(t, numbers[n]);
    cb_table_text(t, isnan(r->low) ? "shown" : cb_truth_within(r) ? "yes" : "NO");
  }
  return t;
}
