/* vtk.h - a body over time for ParaView: one .vtu file a moment, and a .pvd that lists
 * them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_VTK_H
#define CB_VTK_H

#include "kernels/kernel.h"

/* directory/name.vtu := the tetrahedra at x[3*nodes], m, and of each its volume by that at rest
 * (negative: inverted). Whole or absent. CB_IO, recorded. */
enum cb_status cb_vtk_write(const char *directory, const char *name, const struct cb_mesh *mesh,
                            const double *x);
/* directory/name.pvd := name-0000.vtu to name-(count-1).vtu at times[count], s. */
enum cb_status cb_vtk_series(const char *directory, const char *name, size_t count,
                             const double *times);
/* name-0012 into text[128]. */
void cb_vtk_name(const char *name, size_t number, char text[128]);

#endif
