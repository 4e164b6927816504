/* stepper.h - what an implicit step keeps; vectors are node vectors of the
 * operator's arithmetic, padded with zeros to whole blocks (vectors.h).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STEPPER_H
#define CB_STEPPER_H

#include "kernels/kernel.h"

enum {
  STEPPER_B,
  STEPPER_DV,
  STEPPER_R,
  STEPPER_P,
  STEPPER_Y,
  STEPPER_MASS, /* (1 + h beta) m, kg, for each coordinate */
  STEPPER_VECTORS
};

struct cb_stepper {
  struct cb_operator *op; /* not owned */
  struct cb_step_parameters parameters;
  size_t nodes, threads, bytes;
  void *vector[STEPPER_VECTORS];
  uint32_t *fixed; /* [fixed_count] node numbers, ascending */
  size_t fixed_count;
  struct cb_ended ended; /* thread 0 writes it */
};

#endif
