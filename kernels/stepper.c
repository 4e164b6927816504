/* stepper.c - the implicit step behind one plain C interface; the arithmetic is
 * in kernels/solver/step.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/solver/stepper.h"

#include "kernels/arithmetics.h"
#include "kernels/team.h"

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

/* What the team is to do: the parts of a step that are asked for. */
struct work {
  struct cb_stepper *s;
  bool right_side, solve, advance;
  const void *f_ext;
  const void *x, *v;
  void *next_x, *next_v; /* may be x and v */
};

static void run_part(void *context, size_t thread) {
  const struct work *w = context;
  const struct cb_step_functions *step = functions(w->s);
  if (w->right_side) step->right_side(w->s, thread, w->x, w->v, w->f_ext);
  if (w->solve) step->solve(w->s, thread);
  if (w->advance) step->advance(w->s, thread, w->next_x, w->next_v);
}

static void run(struct work work) { cb_team_run(cb_operator_team(work.s->op), run_part, &work); }

void cb_stepper_step(struct cb_stepper *s, void *x, void *v, const void *f_ext) {
  run((struct work){s, true, true, true, f_ext, x, v, x, v});
}

void cb_stepper_right_side(struct cb_stepper *s, const void *x, const void *v, const void *f_ext) {
  run((struct work){.s = s, .right_side = true, .f_ext = f_ext, .x = x, .v = v});
}

void cb_stepper_solve(struct cb_stepper *s) { run((struct work){.s = s, .solve = true}); }

void cb_stepper_advance(struct cb_stepper *s, void *x, void *v) {
  run((struct work){.s = s, .advance = true, .next_x = x, .next_v = v});
}

struct cb_ended cb_stepper_ended(const struct cb_stepper *s) {
  return s->ended;
}

const void *cb_stepper_b(const struct cb_stepper *s) { return s->vector[STEPPER_B]; }

const void *cb_stepper_dv(const struct cb_stepper *s) { return s->vector[STEPPER_DV]; }

size_t cb_stepper_bytes(const struct cb_stepper *s) { return s->bytes; }
