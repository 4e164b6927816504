/* polar_quaternion.c - rotation by a few turns of last step's quaternion.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_quaternion.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_quaternion(F, memory, R)
#include "kernels/models/corotated.h"

/* A finite number of turns does not reach the frame of a shape that has moved:
 * a rigid motion leaves ghost forces, though small ones. */
#define LAWS_QUATERNION                                                                            \
  (CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) | CB_KEEPS(CB_LAW_SEMIDEFINITE) |          \
   LAWS_ORDER)

COROTATED_FAMILY(polar_quaternion, "polar-quaternion", "warm-started quaternion",
                 "Mueller, Bender, Chentanez, Macklin 2016", AXES_WORLD, 4, LAWS_QUATERNION,
                 LAWS_QUATERNION, LAWS_QUATERNION | LAWS_EULER)
