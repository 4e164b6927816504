/* polar_reflected.c - the orthogonal factor as it comes: a reflection on inverted
 * elements, which then come to rest mirrored. Kept to show section 4.1.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_higham.h"

#define SPARSE 0
#define NO_FRAME 0
#define REFLECTS
#define FRAME_ROTATION(e, F, memory, R) orthogonal_higham(F, R)
#include "kernels/models/corotated.h"

COROTATED_FAMILY(polar_reflected, "polar-reflected", "polar factor without sign handling",
                 "Nesme, Payan, Faure 2005, section 4.1", AXES_WORLD, 0,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER, LAWS_ELEMENT | LAWS_ORDER,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
