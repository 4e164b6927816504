/* exact.h - what a model is by its method: its frame in quad precision
 * (reference/exact_frames.h), which shares no line with kernels/; and what else
 * it computes with.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EXACT_H
#define CB_EXACT_H

#include "kernels/kernel.h"

enum cb_definition {
  CB_UNDEFINED,          /* no frame, or a model that is not known here */
  CB_NEAREST_ROTATION,   /* polar, svd; of node-warp's nodes */
  CB_NEAREST_ORTHOGONAL, /* polar-reflected: a reflection where det F < 0 */
  CB_GRAM_SCHMIDT        /* qr: of the columns of F */
};
/* Of a model whose elements have the unit vectors as edges at rest, by its name; for frames
 * of nodes, each element having its nodes to itself. */
enum cb_definition cb_frame_definition(const struct cb_model *model);
/* Does it divide B by the current volume? Then a flat element has no force by the method. */
bool cb_divides_by_volume(const struct cb_model *model);
/* Is its frame that of F^T F, whose condition is the square of that of F? */
bool cb_squares_condition(const struct cb_model *model);

/* condition: an error of a rounding in F moves the frame by at most about so many;
 * infinite where the frame jumps or is not defined (R is then not touched):
 *   nearest rotation    s1 / (s2 + s3), s3 with the sign of det F
 *   nearest orthogonal  s1 / |s3|: where det F changes its sign it jumps
 *   Gram-Schmidt        1 + |second column| / its distance from the first
 * in F[9] finite, row-major. definition is not CB_UNDEFINED. */
void cb_frame_exact(enum cb_definition definition, const double F[9], double R[9],
                    double *condition);

#endif
