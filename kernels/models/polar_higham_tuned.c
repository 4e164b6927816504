/* polar_higham_tuned.c - Newton's iteration, as often as cb_operator_tune says: what an
 * iteration of the frame is worth. Torque-free however early it ends.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_higham.h"

enum { HIGHAM_DEFAULT = 6 };

INLINE void higham_tuned(size_t iterations, T tolerance, const T *F, T *R) {
  T Q[9], sign;
  CHOICE usual;
  sign = higham_factor_tuned(F, iterations ? iterations : HIGHAM_DEFAULT, tolerance, Q, &usual);
  rotation_of_orthogonal(F, Q, sign, usual, R);
}

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) higham_tuned(E->frame_iterations, E->frame_tolerance, F, R)
#include "kernels/models/corotated.h"

/* A truncated iterate is no rotation, but R g(S): neither does it turn the element, nor
 * does it depend on the order of vertices. */
COROTATED_TUNED(polar_higham_tuned, "polar-higham-tuned",
                "polar-higham-precomputed, iterations set at run time", "Higham 1986",
                POLICY_PRECOMPUTED, 0, CB_KNOB_FRAME,
                CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) |
                    CB_KEEPS(CB_LAW_SEMIDEFINITE) | LAWS_EULER | LAWS_ORDER)
