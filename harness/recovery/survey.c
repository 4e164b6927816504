/* survey.c - every start with every model, and the tables of it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/recovery/recovery.h"

static size_t select_variants(const struct cb_options *o, const struct cb_variant **list) {
  size_t count = 0;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (!cb_options_selects(o, v) || !cb_arithmetic_runs(v->arithmetic)) continue;
    if (v->arithmetic->scalar_bytes > sizeof(double)) continue; /* counted: not in a lifetime */
    if (!o->glob_count && (v->storage != CB_EBE || v->arithmetic != cb_arithmetics[0])) continue;
    list[count++] = v;
  }
  return count;
}

enum cb_status cb_recovery_survey(const struct cb_options *options, struct cb_recoveries *all) {
  struct cb_recoveries made = {0};
  size_t most;
  cb_variants(&most);
  const struct cb_variant **list = calloc(most, sizeof *list);
  const size_t count = list ? select_variants(options, list) : 0;
  made.of = calloc(CB_RECOVERY_STARTS * (count + 1), sizeof *made.of);
  enum cb_status status = list && made.of ? CB_OK : cb_fail_memory("the recoveries");
  if (!status && !count) status = cb_fail(CB_INPUT, "nothing that is selected runs here");
  cb_progress_begin("recovery", (double)(CB_RECOVERY_STARTS * count));
  for (size_t s = 0; s < CB_RECOVERY_STARTS && !status; s++) {
    struct cb_recovery_body body = {0};
    status = cb_recovery_body_create(&cb_recovery_starts[s], NULL, options->seed, &body);
    for (size_t i = 0; i < count && !status; i++) {
      char name[96], what[160];
      cb_variant_name(list[i], name);
      snprintf(what, sizeof what, "%s, %s", cb_recovery_starts[s].name, name);
      cb_progress((double)made.count, what);
      status = cb_recovery_run(&body, list[i], &made.of[made.count]);
      made.count += !status;
    }
    cb_recovery_body_free(&body);
  }
  cb_progress_end();
  free(list);
  if (status)
    cb_recoveries_free(&made);
  else
    *all = made;
  return status;
}

void cb_recoveries_free(struct cb_recoveries *all) {
  free(all->of);
  *all = (struct cb_recoveries){0};
}

/* ---- tables ------------------------------------------------------------------------------- */

/* The model's name where only ebe/f64 is there to be had, else the variant's. */
static void row_name(const struct cb_variant *v, char name[96]) {
  if (v->storage == CB_EBE && v->arithmetic == cb_arithmetics[0])
    snprintf(name, 96, "%s", v->model->name);
  else
    cb_variant_name(v, name);
}

static void number(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

static void matrix_cell(struct cb_table *t, const struct cb_recovery *r) {
  const char *outcome = cb_recovery_outcome(r);
  char cell[32];
  if (strcmp(outcome, "recovered") == 0)
    snprintf(cell, sizeof cell, "%.2f s", r->time);
  else if (strcmp(outcome, "stuck") == 0)
    snprintf(cell, sizeof cell, "%.0f %%", floor(100 * r->back));
  else
    snprintf(cell, sizeof cell, "%s", outcome);
  cb_table_text(t, cell);
}

struct cb_table *cb_recovery_matrix(const struct cb_recoveries *all) {
  char columns[CB_RECOVERY_STARTS * 24 + 16] = "model";
  const size_t variants = all->count / CB_RECOVERY_STARTS;
  for (size_t s = 0; s < CB_RECOVERY_STARTS; s++) {
    const size_t used = strlen(columns);
    snprintf(columns + used, sizeof columns - used, ",%s", cb_recovery_starts[s].name);
  }
  struct cb_table *t = cb_table_create(columns);
  for (size_t i = 0; t && i < variants; i++) {
    char name[96];
    row_name(all->of[i].variant, name);
    cb_table_text(t, name);
    for (size_t s = 0; s < CB_RECOVERY_STARTS; s++) matrix_cell(t, &all->of[s * variants + i]);
  }
  return t;
}

struct cb_table *cb_recovery_table(const struct cb_recoveries *all) {
  struct cb_table *t = cb_table_create(
      "start,model,elements,outcome,back,mirrored,distance,turn_degrees,time_s,lost_s");
  for (size_t i = 0; t && i < all->count; i++) {
    const struct cb_recovery *r = &all->of[i];
    char name[96];
    row_name(r->variant, name);
    cb_table_text(t, r->start->name);
    cb_table_text(t, name);
    cb_table_integer(t, (long long)r->elements);
    cb_table_text(t, cb_recovery_outcome(r));
    const double numbers[] = {r->back, r->mirrored, r->distance, r->turn * 180 / M_PI,
                              r->time, r->lost};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) number(t, numbers[k]);
  }
  return t;
}

struct cb_table *cb_recovery_times(const struct cb_recoveries *all) {
  struct cb_table *t = cb_table_create("start,model,time_s,back");
  for (size_t i = 0; t && i < all->count; i++)
    for (size_t k = 0; k < CB_RECOVERY_LOOKS && all->of[i].start->block; k++) {
      char name[96];
      row_name(all->of[i].variant, name);
      cb_table_text(t, all->of[i].start->name);
      cb_table_text(t, name);
      cb_table_number(t, (double)(k * CB_RECOVERY_EVERY) * cb_recovery_step.h);
      cb_table_number(t, all->of[i].share[k]);
    }
  return t;
}
