/* extremes_part.c - parts of a run, done or found in the journal of one that was ended.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>

#include "harness/error.h"
#include "harness/extremes/extremes.h"
#include "harness/files/journal.h"

/* ---- a row: its texts, then its numbers ----------------------------------------------------- */

enum { ROW_TEXTS = 5, ROW_NUMBERS = 7, STEP_TEXTS = 3, STEP_NUMBERS = 5 };

static json_t *row_to_json(const struct cb_extreme *r) {
  char variant[96];
  cb_variant_name(r->variant, variant);
  return json_pack("[s, s, s, s, s, o, o, o, o, o, o, o, b, i]", r->sweep, r->parameter, variant,
                   r->law, r->note, cb_journal_number(r->value), cb_journal_number(r->frame_error),
                   cb_journal_number(r->force_error), cb_journal_number(r->product_error),
                   cb_journal_number(r->orthogonality), cb_journal_number(r->determinant),
                   cb_journal_number(r->torque), (int)r->finite, (int)r->why);
}

static json_t *step_to_json(const struct cb_extreme_step *s) {
  char variant[96];
  cb_variant_name(s->variant, variant);
  return json_pack("[s, s, s, o, o, o, o, o, b, I]", variant, s->integrator, s->what,
                   cb_journal_number(s->h), cb_journal_number(s->most),
                   cb_journal_number(s->energy), cb_journal_number(s->momentum),
                   cb_journal_number(s->angular), (int)s->finite, (json_int_t)s->steps);
}

/* All there, and of their kind? */
static bool take(const json_t *json, size_t texts, const char **text, size_t numbers,
                 double *const *number) {
  for (size_t i = 0; i < texts; i++)
    if (!(text[i] = json_string_value(json_array_get(json, i)))) return false;
  for (size_t i = 0; i < numbers; i++)
    if (!cb_journal_to_number(json_array_get(json, texts + i), number[i])) return false;
  return json_is_boolean(json_array_get(json, texts + numbers)) &&
         json_is_integer(json_array_get(json, texts + numbers + 1));
}

static bool row_of_json(const json_t *json, struct cb_extreme *r) {
  const char *text[ROW_TEXTS];
  double *const number[] = {&r->value,         &r->frame_error, &r->force_error, &r->product_error,
                            &r->orthogonality, &r->determinant, &r->torque};
  if (!take(json, ROW_TEXTS, text, ROW_NUMBERS, number)) return false;
  const json_int_t why = json_integer_value(json_array_get(json, ROW_TEXTS + ROW_NUMBERS + 1));
  r->sweep = text[0];
  snprintf(r->parameter, sizeof r->parameter, "%s", text[1]);
  r->variant = cb_variant_find(text[2]);
  r->law = text[3];
  snprintf(r->note, sizeof r->note, "%s", text[4]);
  r->finite = json_is_true(json_array_get(json, ROW_TEXTS + ROW_NUMBERS));
  r->why = (enum cb_why)why;
  return r->variant && why >= CB_WHY_MODEL && why <= CB_WHY_METHOD;
}

static bool step_of_json(const json_t *json, struct cb_extreme_step *s) {
  const char *text[STEP_TEXTS];
  double *const number[] = {&s->h, &s->most, &s->energy, &s->momentum, &s->angular};
  if (!take(json, STEP_TEXTS, text, STEP_NUMBERS, number)) return false;
  s->variant = cb_variant_find(text[0]);
  s->integrator = text[1], s->what = text[2];
  s->finite = json_is_true(json_array_get(json, STEP_TEXTS + STEP_NUMBERS));
  s->steps = (size_t)json_integer_value(json_array_get(json, STEP_TEXTS + STEP_NUMBERS + 1));
  return s->variant != NULL;
}

/* ---- a part: [rows, steps] ------------------------------------------------------------------ */

/* NULL when out of memory. */
static json_t *added_since(const struct cb_extremes *all, size_t row, size_t step) {
  json_t *rows = json_array(), *steps = json_array();
  int failed = 0;
  for (size_t i = row; i < all->count; i++)
    failed |= json_array_append_new(rows, row_to_json(&all->row[i]));
  for (size_t i = step; i < all->step_count; i++)
    failed |= json_array_append_new(steps, step_to_json(&all->step[i]));
  json_t *part = json_pack("[o, o]", rows, steps);
  if (!failed) return part;
  json_decref(part);
  return NULL;
}

static enum cb_status restore(struct cb_extremes *all, const json_t *part) {
  const json_t *rows = json_array_get(part, 0), *steps = json_array_get(part, 1);
  enum cb_status status = CB_OK;
  bool right = json_is_array(rows) && json_is_array(steps);
  for (size_t i = 0; !status && right && i < json_array_size(rows); i++) {
    struct cb_extreme row;
    right = row_of_json(json_array_get(rows, i), &row);
    if (right) status = cb_extremes_add(all, &row);
  }
  for (size_t i = 0; !status && right && i < json_array_size(steps); i++) {
    struct cb_extreme_step step;
    right = step_of_json(json_array_get(steps, i), &step);
    if (right) status = cb_extremes_add_step(all, &step);
  }
  if (right) return status;
  return cb_fail(CB_INPUT, "the journal of the earlier run holds what is no row of the extremes; "
                           "start anew without --resume");
}

enum cb_status cb_extremes_part(struct cb_extremes *all, const char *key, cb_extremes_work_fn *work,
                                const void *context) {
  const size_t row = all->count, step = all->step_count, parts = all->parts++;
  if (!all->journal) return work(all, context);
  const json_t *finished = cb_journal_row(all->journal, key, NULL);
  if (finished) return restore(all, finished);
  const enum cb_status status = work(all, context);
  if (status || all->parts > parts + 1) return status;
  return cb_journal_add(all->journal, key, added_since(all, row, step));
}
