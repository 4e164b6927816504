/* energy.h - the elastic energy that polar models are the gradient of, at a shape.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ENERGY_H
#define CB_ENERGY_H

#include "kernels/kernel.h"

/* Sum over the elements of W = |V0| share (mu sum (s_i - 1)^2 + lambda/2 (sum s_i - 3)^2),
 * J, s_i: singular values of F, the smallest with the sign of det F. Source: Irving,
 * Teran & Fedkiw 2004; Chao, Pinkall, Sanan & Schroeder 2010. Isotropic materials.
 * in   x[3*nodes] m, finite
 * out  *inverted (may be NULL): elements with det F < 0 */
double cb_elastic_energy(const struct cb_mesh *mesh, const struct cb_material *material,
                         const double *x, size_t *inverted);

#endif
