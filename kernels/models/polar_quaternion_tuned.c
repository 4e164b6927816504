/* polar_quaternion_tuned.c - turns of last step's quaternion, as many as cb_operator_tune
 * says: what a turn is worth. Ended early, it makes a ghost torque.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_quaternion.h"

INLINE void quaternion_tuned(size_t turns, T tolerance, const T *F, T *q, T *R) {
  frame_polar_quaternion_tuned(F, turns ? turns : QUATERNION_TURNS, tolerance, q, R);
}

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R)                                                            \
  quaternion_tuned(E->frame_iterations, E->frame_tolerance, F, memory, R)
#include "kernels/models/corotated.h"

COROTATED_TUNED(polar_quaternion_tuned, "polar-quaternion-tuned",
                "polar-quaternion-precomputed, turns set at run time",
                "Mueller, Bender, Chentanez, Macklin 2016", POLICY_PRECOMPUTED, 4, CB_KNOB_FRAME,
                CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) |
                    CB_KEEPS(CB_LAW_SEMIDEFINITE) | LAWS_ORDER)
