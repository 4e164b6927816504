/* body.h - a plain body for tests to give their own loads, and a trial of it. Include cmocka.h
 * first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_BODY_H
#define CB_TESTS_BODY_H

#include <math.h>
#include <stdio.h>

#include "harness/scene/run.h"

/* Of 0.1 x 0.1 x 0.15 m; free, at rest, nothing pulls, nothing is needed; 100 steps of 1 ms. */
static inline struct cb_scene plain(void) {
  struct cb_scene s = {.cells = {2, 2, 3},
                       .cell = 0.05,
                       .stretch = {1, 1, 1},
                       .step = 1e-3,
                       .duration = 0.1,
                       .needs = {.displacement = INFINITY, .torque = INFINITY, .energy = INFINITY}};
  snprintf(s.name, sizeof s.name, "plain");
  assert_int_equal(cb_material_isotropic(1e5, 0.3, 1000, &s.material), CB_OK);
  return s;
}

static inline struct cb_trial trial(const char *variant, size_t iterations) {
  return (struct cb_trial){
      .variant = cb_variant_find(variant), .threads = 1, .iterations = iterations, .step = 1e-3};
}

#endif
