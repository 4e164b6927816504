/* way.h - private to a run: a body on its way, and what changes while it runs.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_WAY_H
#define CB_WAY_H

#include "harness/scene/run.h"
#include "reference/direct.h"

struct cb_way {
  const struct cb_body *body;
  const struct cb_trial *trial;
  struct cb_step_parameters step;
  size_t steps;
  struct cb_job job;
  struct cb_direct *direct; /* NULL: conjugate gradients */
  double *blocks, *diagonal;
  struct cb_material material; /* now */
  size_t stage;                /* how many of the scene's have begun */
  uint8_t *held;               /* [nodes] now */
  uint8_t *touching;           /* [nodes] 1: held by the ground; NULL: there is none */
  bool landed;                 /* some touch it that are not held yet */
  void *external;              /* node vectors of the arithmetic, or NULL */
  void *force;
  double *x, *v, *f; /* [3*nodes] */
  double *time;      /* [steps], s */
  double most_torque, most_lever, most_net, most_force;
};

/* Everything that the steps need, at the start. Close with cb_way_close, after a failure as
 * well. CB_INPUT, CB_MEMORY, recorded. */
enum cb_status cb_way_open(const struct cb_body *body, const struct cb_trial *trial,
                           struct cb_way *w);
void cb_way_close(struct cb_way *w);

/* Before step n: another stiffness where one is due, handles that let go, nodes that the
 * ground lets go because they are pulled up. Operator and stepper are made anew where
 * something has changed, and nothing is done where the scene names none of it. CB_MEMORY. */
enum cb_status cb_way_change(struct cb_way *w, size_t n);
/* After a step: nodes below the ground go onto it and stay, without velocity, until
 * cb_way_change lets them go: a rough ground that takes up every blow. */
void cb_way_land(struct cb_way *w);

/* One number of a node vector of the arithmetic. */
void cb_way_put(const struct cb_way *w, void *vector, size_t node, size_t axis, double value);

#endif
