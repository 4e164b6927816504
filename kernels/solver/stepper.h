/* stepper.h - what an implicit step keeps; vectors are node vectors of the
 * operator's arithmetic.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STEPPER_H
#define CB_STEPPER_H

#include "kernels/kernel.h"

enum { STEPPER_B, STEPPER_DV, STEPPER_R, STEPPER_P, STEPPER_Y, STEPPER_VECTORS };

struct cb_stepper {
  struct cb_operator *op; /* not owned */
  struct cb_step_parameters parameters;
  size_t nodes, bytes;
  void *vector[STEPPER_VECTORS];
  void *mass;     /* [nodes] scalars, kg */
  uint8_t *fixed; /* [nodes] */
};

#endif
