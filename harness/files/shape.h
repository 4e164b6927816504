/* shape.h - bodies with an implicit surface, length about 1 along x, z up.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SHAPE_H
#define CB_SHAPE_H

#include <stdbool.h>

struct cb_shape;
const struct cb_shape *cb_shape_find(const char *name); /* NULL: there is none */
/* A box with some room around it. */
void cb_shape_bounds(const struct cb_shape *shape, double low[3], double high[3]);

/* About the distance of p[3] to the surface, negative inside. */
double cb_shape_value(const struct cb_shape *shape, const double *p);
/* One step of Newton's method for p[3] to the surface, of at most `reach`; false, p untouched:
 * it is not within reach. */
bool cb_shape_approach(const struct cb_shape *shape, double reach, double *p);

#endif
