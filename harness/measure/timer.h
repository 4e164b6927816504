/* timer.h - time several things against each other: calibrated, jittered
 * epochs, interleaved in balanced random order.
 *
 * A round times one epoch of every subject. The order of a round is shuffled,
 * the next round runs it backwards, so that everybody comes as often before as
 * after everybody else, and a machine that slows down slows all of them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TIMER_H
#define CB_TIMER_H

#include "kernels/kernel.h"

struct cb_subject {
  const char *name;
  void (*prepare)(void *context);             /* before each epoch, untimed; NULL: nothing */
  void (*run)(void *context, size_t repeats); /* timed: the same work, repeats times */
  void *context;
};

struct cb_timing {
  double epoch_s;                /* an epoch lasts at least this, or is one repeat */
  double budget_s;               /* no new round after this, but min_rounds are run */
  size_t min_rounds, max_rounds; /* 1 <= min <= max */
  unsigned long seed;
  double (*now)(void); /* s, from any origin; NULL: CLOCK_MONOTONIC */
  /* After each epoch, NULL: nothing; share: fraction of the work done, 0 to 1. */
  void (*progress)(void *context, double share, const char *subject);
  void *progress_context;
};

/* Raw samples; of subject s in round r: [s * stride + r]. */
struct cb_samples {
  size_t subjects, rounds, stride;
  double *step_s;  /* wall time of one repeat, s */
  double *cpu_s;   /* processor time of one repeat, s */
  size_t *repeats; /* in that epoch */
};

/* Warm up, calibrate and time subjects[count], count > 0. CB_MEMORY;
 * CB_INTERRUPTED when cb_interrupted(). Free *samples with cb_samples_free. */
enum cb_status cb_timer_run(size_t count, const struct cb_subject *subjects,
                            const struct cb_timing *timing, struct cb_samples *samples);
void cb_samples_free(struct cb_samples *samples); /* and zero it; zeroed is allowed */

/* CLOCK_MONOTONIC, s. */
double cb_timer_now(void);

#endif
