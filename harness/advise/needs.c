/* needs.c - what a scene needs, held against what was measured.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "harness/advise/advise.h"
#include "harness/verify/laws.h"

const char *const cb_need_name[CB_NEEDS] = {
    "rotation",           "newton", "euler",        "energy",    "order",         "finite",
    "displacement_error", "torque", "energy_error", "inversion", "rest_distance", "frame_s"};

bool cb_need_asked(const struct cb_advice *a, enum cb_need need) {
  if (need < CB_NEED_FINITE) return a->needs.laws & CB_KEEPS(need);
  switch (need) {
  case CB_NEED_DISPLACEMENT: return isfinite(a->needs.displacement);
  case CB_NEED_TORQUE: return isfinite(a->needs.torque);
  case CB_NEED_ENERGY: return isfinite(a->needs.energy);
  case CB_NEED_INVERSION: return a->needs.inversion;
  case CB_NEED_REST: return isfinite(a->needs.rest);
  case CB_NEED_FRAMES: return isfinite(a->frame_s);
  default: return true;
  }
}

double cb_need_limit(const struct cb_advice *a, enum cb_need need) {
  switch (need) {
  case CB_NEED_DISPLACEMENT: return a->needs.displacement;
  case CB_NEED_TORQUE: return a->needs.torque;
  case CB_NEED_ENERGY: return a->needs.energy;
  case CB_NEED_REST: return a->needs.rest;
  case CB_NEED_FRAMES: return a->frame_s;
  case CB_NEED_FINITE:
  case CB_NEED_INVERSION: return 0;
  default: return cb_law_limit(cb_arithmetics[0]); /* laws are measured in f64 */
  }
}

double cb_need_value(const struct cb_advice *a, const struct cb_candidate *c, enum cb_need need) {
  switch (need) {
  case CB_NEED_FINITE: return c->finite ? 0 : NAN;
  case CB_NEED_DISPLACEMENT: return c->error;
  case CB_NEED_TORQUE: return c->torque;
  case CB_NEED_ENERGY: return c->energy;
  case CB_NEED_INVERSION: return c->finite ? (double)c->inverted : NAN;
  case CB_NEED_REST: return c->rest;
  case CB_NEED_FRAMES: return c->step_s * a->steps_per_frame;
  default: return c->law[need];
  }
}

unsigned cb_needs_unmet(const struct cb_advice *a, const struct cb_candidate *c) {
  unsigned unmet = 0;
  for (int need = 0; need < CB_NEEDS; need++)
    if (cb_need_asked(a, need) && !(cb_need_value(a, c, need) <= cb_need_limit(a, need)))
      unmet |= 1u << need;
  return unmet;
}
