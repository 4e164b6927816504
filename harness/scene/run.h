/* run.h - a scene simulated by one variant with some settings, and how far the
 * result is from the truth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_RUN_H
#define CB_RUN_H

#include "harness/scene/body.h"

/* With what a body is simulated. */
struct cb_trial {
  const struct cb_variant *variant;
  size_t threads;
  size_t iterations;       /* of conjugate gradients; 0: solved directly (bcsr/f64 only) */
  double step;             /* s; made shorter where it does not divide a tenth of the duration */
  struct cb_tuning tuning; /* all zero: the model's own */
};

enum { CB_SAMPLES = 10 }; /* looks at the body, at every tenth of the duration */

struct cb_outcome {
  bool finite;                             /* to the end; else what follows is NaN */
  double point[CB_SAMPLES][3 * CB_POINTS]; /* m */
  double energy[CB_SAMPLES];               /* kinetic and cb_elastic_energy, J */
  double torque, net_force;                /* of the elastic forces: largest |sum x x f| over
                                              largest sum |x - c||f|; |sum f| over sum |f| */
  size_t inverted;                         /* elements in the end ... */
  size_t most_inverted;                    /* ... and at the look with the most */
  double distance, most_distance;          /* cb_body_distance, likewise, 1 */
  size_t indefinite;                       /* steps whose conjugate gradients found the operator
                                              not positive definite (cb_stepper_ended) */
  size_t steps;
  double step_s;  /* median time of a step; handles, changes and looks are not in it */
  double seconds; /* of step_s, for a simulated second */
};

/* Who sees the body at its start, after every so many steps and in the end: positions x[3*nodes] at
 * time t, s. What it returns ends the run unless it is CB_OK. */
struct cb_watch {
  size_t every;
  enum cb_status (*see)(void *context, double t, const double *x);
  void *context;
};

/* Step the body from its start to the end. A trial that breaks down is no failure:
 * outcome->finite says so. CB_INPUT if the variant does not take the material; CB_NUMERIC
 * when a direct solution fails; CB_MEMORY, CB_INTERRUPTED; all recorded. */
enum cb_status cb_body_run(const struct cb_body *body, const struct cb_trial *trial,
                           struct cb_outcome *outcome);
/* The same, watched. */
enum cb_status cb_body_show(const struct cb_body *body, const struct cb_trial *trial,
                            const struct cb_watch *watch, struct cb_outcome *outcome);

/* The scene's truth: polar-exact, which has an energy, no torque and no order, solved
 * directly at a tenth of the step. */
enum cb_status cb_body_truth(const struct cb_body *body, struct cb_outcome *truth);
/* The same where direct solutions would take too long: 200 iterations in double, on all
 * those threads. */
enum cb_status cb_body_truth_iterated(const struct cb_body *body, size_t threads,
                                      struct cb_outcome *truth);

/* Largest distance of a point from its true place at any look, of the body's size;
 * and largest difference of the energies, of the largest true one. NaN where the outcome is
 * not finite. */
double cb_outcome_error(const struct cb_outcome *outcome, const struct cb_outcome *truth,
                        double size);
double cb_outcome_energy_error(const struct cb_outcome *outcome, const struct cb_outcome *truth);
/* Does the body end upright, as near to its rest shape as is needed? */
bool cb_outcome_recovers(const struct cb_outcome *outcome, const struct cb_needs *needs);

#endif
