/* extremes.c - rows, their states, and the sweeps one after the other.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/extremes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/report.h"
#include "harness/nearest.h"
#include "harness/progress.h"

const char *const cb_extreme_state_name[CB_EXTREME_STATES] = {
    "not judged", "right", "by method", "inaccurate", "breaks a law", "not finite"};

/* A hundred times what svd's frame needs here on every shape of full rank (10 in f64); a
 * frame that is wrong has a million in f32 where it is well-conditioned. */
const double cb_extreme_limit = 1e3;

/* Room for one more: they are full when their number is a power of two, or 0. NULL: none. */
static void *with_room(void *rows, size_t count, size_t size) {
  return count & (count - 1) ? rows : realloc(rows, (2 * count + !count) * size);
}

enum cb_status cb_extremes_add(struct cb_extremes *all, const struct cb_extreme *row) {
  struct cb_extreme *more = with_room(all->row, all->count, sizeof *more);
  if (!more) return cb_fail_memory("the rows of the extremes");
  all->row = more;
  all->row[all->count++] = *row;
  return CB_OK;
}

enum cb_status cb_extremes_add_step(struct cb_extremes *all, const struct cb_extreme_step *step) {
  struct cb_extreme_step *more = with_room(all->step, all->step_count, sizeof *more);
  if (!more) return cb_fail_memory("the rows of the steps");
  all->step = more;
  all->step[all->step_count++] = *step;
  return CB_OK;
}

void cb_extremes_free(struct cb_extremes *all) {
  free(all->row);
  free(all->step);
  all->row = NULL, all->count = 0;
  all->step = NULL, all->step_count = all->parts = 0;
}

struct cb_extreme cb_extreme_blank(const char *sweep, const struct cb_variant *variant) {
  return (struct cb_extreme){.sweep = sweep,
                             .value = NAN,
                             .variant = variant,
                             .finite = true,
                             .frame_error = NAN,
                             .force_error = NAN,
                             .product_error = NAN,
                             .orthogonality = NAN,
                             .determinant = NAN,
                             .torque = NAN,
                             .law = ""};
}

/* NaN: not measured, by the contract of struct cb_extreme; what is not a number in a
 * kernel is said by `finite`. */
static bool above(double error) { return !isnan(error) && !(error <= cb_extreme_limit); }

enum cb_extreme_state cb_extreme_state(const struct cb_extreme *row) {
  if (row->why != CB_WHY_MODEL) return row->why == CB_WHY_METHOD ? CB_BY_METHOD : CB_NOT_JUDGED;
  if (!row->finite) return CB_NOT_FINITE;
  if (row->law[0]) return CB_BREAKS;
  if (above(row->frame_error) || above(row->force_error) || above(row->product_error) ||
      above(row->orthogonality))
    return CB_INACCURATE;
  return CB_RIGHT;
}

void cb_extreme_fold(struct cb_extreme *all, const struct cb_extreme *one) {
  const bool worse = cb_extreme_state(one) > cb_extreme_state(all);
  all->frame_error = fmax(all->frame_error, one->frame_error); /* fmax: NaN is missing */
  all->force_error = fmax(all->force_error, one->force_error);
  all->product_error = fmax(all->product_error, one->product_error);
  all->orthogonality = fmax(all->orthogonality, one->orthogonality);
  all->torque = fmax(all->torque, one->torque);
  if (isnan(all->determinant) || fabs(one->determinant - 1) > fabs(all->determinant - 1))
    all->determinant = one->determinant;
  if (!worse) return;
  all->finite = one->finite;
  all->law = one->law;
  all->why = one->why;
  memcpy(all->note, one->note, sizeof all->note);
}

enum cb_status cb_extremes_check(const char *sweep) {
  struct cb_nearest nearest = {.text = sweep};
  for (size_t s = 0; cb_sweeps[s]; s++) {
    if (!sweep || strcmp(sweep, cb_sweeps[s]->name) == 0) return CB_OK;
    cb_nearest_offer(&nearest, cb_sweeps[s]->name);
  }
  return cb_fail(CB_INPUT, "there is no sweep '%s' (nearest: %s); see 'corobench extremes --help'",
                 sweep, nearest.names);
}

static enum cb_status run_whole(struct cb_extremes *all, const void *context) {
  const struct cb_sweep *const *sweep = context;
  return (*sweep)->run(all);
}

enum cb_status cb_extremes_run(const char *sweep, struct cb_extremes *all) {
  enum cb_status status = cb_extremes_check(sweep);
  for (size_t s = 0; !status && cb_sweeps[s]; s++) {
    if (sweep && strcmp(sweep, cb_sweeps[s]->name) != 0) continue;
    status = cb_extremes_part(all, cb_sweeps[s]->name, run_whole, &cb_sweeps[s]);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  if (status) cb_extremes_free(all);
  return status;
}

enum cb_status cb_extremes_judge(const struct cb_extremes *all) {
  size_t bad = 0;
  const struct cb_extreme *first = NULL;
  for (size_t i = 0; i < all->count; i++)
    if (cb_extreme_state(&all->row[i]) >= CB_BREAKS && !bad++) first = &all->row[i];
  if (!bad) return CB_OK;
  char name[96];
  cb_variant_name(first->variant, name);
  return cb_fail(CB_BROKEN,
                 "%zu of %zu rows are not finite or break a law, the first: %s, %s, %s: %s", bad,
                 all->count, first->sweep, first->parameter, name,
                 first->finite ? first->law : cb_extreme_state_name[CB_NOT_FINITE]);
}
