/* cases_method.c - what a method loses, whoever writes it, told from what a kernel loses: by
 * bounds of rounding that are known before anything is run. What is beyond them stays the
 * kernel's, and so do laws that they say nothing of.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/extremes/cases.h"
#include "harness/extremes/exact.h"
#include "harness/extremes/report.h"
#include "harness/verify/laws.h"

/* So many of the row's units, each. */
struct loss {
  double frame, force, product;
};

static bool within(double error, double loss) {
  return isnan(error) || error <= cb_extreme_limit * fmax(loss, 1); /* NaN: not measured */
}

/* turned: the same force in other axes, each of both as wrong as it may be. */
static bool explains(const struct loss *l, const struct cb_extreme *row, double turned) {
  return within(row->frame_error, l->frame) && within(row->force_error, l->force) &&
         within(row->product_error, l->product) && within(turned, l->force) &&
         within(row->orthogonality, 1);
}

static double norm(const double a[12]) {
  double sum = 0;
  for (int i = 0; i < 12; i++) sum = hypot(sum, a[i]);
  return sum;
}

void cb_method_judge(const struct cb_variant *v, const struct cb_reference *r,
                     const struct cb_known *k, double turned, struct cb_extreme *row) {
  const enum cb_extreme_state state = cb_extreme_state(row);
  const bool law = state == CB_BREAKS && strcmp(row->law, cb_law_name[CB_LAW_ROTATION]) == 0;
  if (state != CB_INACCURATE && !law) return;
  /* Of B, and so twice of force and product; from a tenth on the volume may be rounded to 0. */
  const double volume = r->roundoff * k->triple, moved = volume < 0.1 ? volume : HUGE_VAL;
  const struct loss divided = {1, moved * norm(k->f) / k->f_unit, moved * norm(k->y) / k->y_unit};
  const struct loss squared = {k->condition, k->condition, k->condition};
  if (cb_divides_by_volume(v->model) && explains(&divided, row, turned))
    snprintf(row->note, sizeof row->note,
             "by method: B is divided by a volume that rounding moves by %.1g of itself", volume);
  else if (cb_squares_condition(v->model) && explains(&squared, row, turned))
    snprintf(row->note, sizeof row->note, "by method: F^T F squares the condition, %.1g",
             k->condition);
  else
    return;
  row->why = CB_WHY_METHOD;
}
