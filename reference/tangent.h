/* tangent.h - the true stiffness matrix of a model, by differences of its forces.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TANGENT_H
#define CB_TANGENT_H

#include "kernels/kernel.h"

struct cb_tangent;

/* For the model of that variant, which is evaluated in its own arithmetic, one element
 * at a time (stride 3: f64 or counted); element-wise models only. The mesh and the
 * material may go away. CB_INPUT: the variant is none of those, or does not take the
 * material; CB_MEMORY. */
enum cb_status cb_tangent_create(const struct cb_variant *variant, const struct cb_mesh *mesh,
                                 const struct cb_material *material, struct cb_tangent **out);
void cb_tangent_free(struct cb_tangent *t); /* NULL allowed */

/* blocks[9*count] := symmetric part of K = -df/dx at x[3*nodes] (m), N/m, in the block
 * pattern row_start, column (cb_operator_pattern); by central differences of second order
 * with steps of the cube root of the rounding. Returns |skew part| / |K|, Frobenius norms over the
 * elements: 0 for forces that are a gradient. */
double cb_tangent_blocks(struct cb_tangent *t, const double *x, const uint32_t *row_start,
                         const uint32_t *column, double *blocks);

#endif
