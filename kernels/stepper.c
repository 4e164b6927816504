/* stepper.c - the implicit step behind one plain C interface; the arithmetic is
 * in kernels/solver/step.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/solver/stepper.h"

#include "kernels/arithmetics.h"

static const struct cb_step_functions *functions(const struct cb_stepper *s) {
  return cb_operator_variant(s->op)->arithmetic->step;
}

enum cb_status cb_stepper_create(struct cb_operator *op, const struct cb_step_parameters *p,
                                 const double *mass, const uint8_t *fixed,
                                 struct cb_stepper **out) {
  return cb_operator_variant(op)->arithmetic->step->create(op, p, mass, fixed,
                                                           cb_operator_nodes(op), out);
}

void cb_stepper_free(struct cb_stepper *s) {
  if (s) functions(s)->free(s);
}

void cb_stepper_set_iterations(struct cb_stepper *s, size_t iterations) {
  s->parameters.iterations = iterations;
}

void cb_stepper_step(struct cb_stepper *s, void *x, void *v, const void *f_ext) {
  const struct cb_step_functions *step = functions(s);
  step->right_side(s, x, v, f_ext);
  step->solve(s);
  step->advance(s, x, v);
}

void cb_stepper_right_side(struct cb_stepper *s, const void *x, const void *v, const void *f_ext) {
  functions(s)->right_side(s, x, v, f_ext);
}

void cb_stepper_solve(struct cb_stepper *s) { functions(s)->solve(s); }

void cb_stepper_advance(struct cb_stepper *s, void *x, void *v) { functions(s)->advance(s, x, v); }

const void *cb_stepper_b(const struct cb_stepper *s) { return s->vector[STEPPER_B]; }

const void *cb_stepper_dv(const struct cb_stepper *s) { return s->vector[STEPPER_DV]; }

size_t cb_stepper_bytes(const struct cb_stepper *s) { return s->bytes; }
