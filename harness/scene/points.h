/* points.h - points of a body at rest that are found again in any other mesh of it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_POINTS_H
#define CB_POINTS_H

#include "kernels/kernel.h"

enum { CB_POINTS = 64 };

/* Weights of the four nodes of a tetrahedron; their sum is 1. */
struct cb_point {
  uint32_t node[4];
  double weight[4];
};

/* P[3*CB_POINTS] := a regular set of 4 x 4 x 4 places in the bounding box at rest; one
 * that is not in the body goes to about the nearest point that is. The mesh has an
 * element of nonzero volume; this is not checked. */
void cb_points_choose(const struct cb_mesh *mesh, double *P);
/* point[CB_POINTS] := P in the nearest tetrahedra of the mesh. What lies outside of a
 * coarser or finer surface is not moved: its tetrahedron is continued, so that at rest
 * and in every affine motion each point is where P is. */
void cb_points_find(const struct cb_mesh *mesh, const double *P, struct cb_point *point);
/* p[3*CB_POINTS] := places of the points for node positions x[3*nodes]. */
void cb_points_place(const struct cb_point *point, const double *x, double *p);

#endif
