/* steps.h - how long a step a variant stands, and what a million steps do.
 *
 * A body of one cell, free, drawn out and shaken, swings. Its energy is the kinetic one and
 * that of the polar models (reference/energy.h): for other models a measure of how much it
 * moves, not their own energy.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STEPS_H
#define CB_STEPS_H

#include "harness/bench/bench.h"

enum cb_integrator {
  CB_IMPLICIT_ITERATED, /* the stepper, 5 iterations */
  CB_IMPLICIT_DIRECT,   /* the same system by CHOLMOD: bcsr/f64 only */
  CB_EXPLICIT,          /* symplectic Euler: v += h f / m, x += h v, in double */
  CB_INTEGRATORS
};
extern const char *const cb_integrator_name[CB_INTEGRATORS];

struct cb_swing {
  bool finite;
  double most;              /* largest energy met by that of the start; NaN: not finite */
  double energy;            /* in the end, by that of the start */
  double momentum, angular; /* what they changed by, of sum m |v| and sum m |r| |v| at the start */
};

/* The body. CB_MEMORY. Free with cb_bench_scene_free. */
enum cb_status cb_swing_body(unsigned long seed, struct cb_bench_scene *scene);
/* One tetrahedron that swings and spins. */
enum cb_status cb_swing_tetrahedron(unsigned long seed, struct cb_bench_scene *scene);
/* So many steps of h, the energy looked at `looks` times. CB_MEMORY, CB_INPUT (no such
 * variant by that integrator), CB_INTERRUPTED. */
enum cb_status cb_swing(const struct cb_variant *v, const struct cb_bench_scene *scene,
                        enum cb_integrator integrator, double h, size_t steps, size_t looks,
                        struct cb_swing *swing);

#endif
