/* equilibrium.h - the shape at rest under loads, by Newton's method: the system of each
 * iteration is solved by sparse Cholesky.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EQUILIBRIUM_H
#define CB_EQUILIBRIUM_H

#include "kernels/kernel.h"

/* What Newton's matrix is. */
enum cb_newton_matrix {
  CB_NEWTON_USUAL, /* the model's operator */
  CB_NEWTON_TRUE   /* symmetric part of the true derivative, by differences */
};

enum { CB_NEWTON_MOST = 100 };
struct cb_newton {
  size_t iterations;
  double residual[CB_NEWTON_MOST + 1]; /* |f + external| over free nodes before each iteration,
                                          by |external|, or where nothing pushes by the forces
                                          that hold the fixed nodes at first */
  size_t shifts;                       /* matrices that had to be made positive definite */
  size_t halved;                       /* steps that the line search shortened */
};

/* x[3*nodes]: a first shape in, fixed nodes where they belong; the equilibrium out.
 * The step is halved until the residual along it falls. Solved when residual <= tolerance.
 * in   model  name of an element-wise model; external[3*nodes] N or NULL
 * CB_NUMERIC with x as far as it came: more than CB_NEWTON_MOST iterations, or no step helps.
 * CB_INPUT: no such model; CB_MEMORY. Nothing is recorded. */
enum cb_status cb_equilibrium_solve(const char *model, enum cb_newton_matrix matrix,
                                    const struct cb_mesh *mesh, const struct cb_material *material,
                                    const uint8_t *fixed, const double *external, double tolerance,
                                    double *x, struct cb_newton *newton);

#endif
