/* figure3.h - the paper's figure 3: an equilateral tetrahedron, pulled by forces
 * of null net torque, that starts to rotate when B is stale.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FIGURE3_H
#define CB_FIGURE3_H

#include "harness/files/table.h"

/* A free tetrahedron is pulled apart at two vertices along the line
 * through them, at every time. Columns: model, time_s, angle_rad (rotation of
 * the best fitting frame since the start), torque (of the elastic forces,
 * relative as in laws.h), spin_rad_s (angular momentum over the moment of
 * inertia). One row every millisecond for models with stale, updated and exact
 * B. *table to be freed. CB_MEMORY, CB_NUMERIC, CB_INTERRUPTED. */
enum cb_status cb_figure3_run(struct cb_table **table);
/* The angle that the model has turned by at the end, rad; NaN on failure. */
enum cb_status cb_figure3_angle(const char *model, double *angle_rad);

#endif
