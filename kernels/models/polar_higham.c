/* polar_higham.c - nearest rotation by Newton's iteration.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_higham.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_higham(F, R)
#if CB_LANES > 1
#define FRAMES_AT_ONCE HIGHAM_AT_ONCE
#define FRAME_ROTATIONS(count, F, R) frames_polar_higham(count, F, R)
#endif
#include "kernels/models/corotated.h"

COROTATED_FAMILY(polar_higham, "polar-higham", "polar frame by Newton-Higham", "Higham 1986",
                 AXES_WORLD, 0, LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER,
                 LAWS_ELEMENT | LAWS_ORDER, LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
