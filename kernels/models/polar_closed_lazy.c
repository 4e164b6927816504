/* polar_closed_lazy.c - polar-closed-updated, with B kept in the frame until the stretch
 * has moved by more than cb_operator_tune says.
 * Trade:  saves the classic B of ebe-paper; with an isotropic material a stale B of a
 *         polar frame makes no ghost torque only while it is that of the rest shape.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_closed.h"

#define SPARSE 0
#define NO_FRAME 0
#define LAZY
#define FRAME_ROTATION(e, F, memory, R) frame_polar_closed(F, R)
#include "kernels/models/corotated.h"

COROTATED_TUNED(polar_closed_lazy, "polar-closed-lazy",
                "polar frame by invariants, B updated when the shape has moved",
                "Hoger & Carlson 1984; lazy: this project", POLICY_LAZY, LAZY_NUMBERS, CB_KNOB_LAZY,
                LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
