/* polar_closed.c - nearest rotation from the invariants of the stretch.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_closed.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_closed(F, R)
#if CB_LANES > 1
#define FRAMES_AT_ONCE CLOSED_AT_ONCE
#define FRAME_ROTATIONS(count, F, R) frames_polar_closed(count, F, R)
#endif
#include "kernels/models/corotated.h"

COROTATED_FAMILY(polar_closed, "polar-closed", "polar frame by invariants", "Hoger & Carlson 1984",
                 AXES_WORLD, 0, LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER,
                 LAWS_ELEMENT | LAWS_ORDER, LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
