/* svd.c - nearest rotation from the singular values, the robust and dear one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/svd.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_svd(F, R)
#if CB_LANES > 1
#define FRAMES_AT_ONCE SVD_AT_ONCE
#define FRAME_ROTATIONS(count, F, R) (frames_svd(count, F, R), true)
#endif
#include "kernels/models/corotated.h"

COROTATED_FAMILY(svd, "svd", "SVD frame", "Irving, Teran, Fedkiw 2004", AXES_WORLD, 0,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER, LAWS_ELEMENT | LAWS_ORDER,
                 LAWS_ELEMENT | LAWS_EULER | LAWS_ORDER)
