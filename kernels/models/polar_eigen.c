/* polar_eigen.c - nearest rotation from the eigenvalues of F^T F.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_eigen.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_eigen(F, R)
#include "kernels/models/corotated.h"

COROTATED_FAMILY(polar_eigen, "polar-eigen", "polar frame by eigenvalues",
                 "Etzmuss et al. 2003; Hauth & Strasser 2004", AXES_WORLD, 0,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER, LAWS_ELEMENT | LAWS_ORDER,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
