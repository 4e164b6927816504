/* ranking.c - what does is timed against each other, in the same rounds.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>

#include "harness/advise/explorer.h"
#include "harness/measure/timer.h"
#include "harness/progress.h"

enum { ROUNDS = 21 }; /* the median's interval is then from the 6th to the 16th sample */

static int by_step(const void *a, const void *b) {
  const struct cb_candidate *c = a, *d = b;
  return (c->step_s > d->step_s) - (c->step_s < d->step_s);
}

static void show(void *context, double share, const char *subject) {
  struct explorer *e = context;
  cb_progress(e->done + share * e->timing_s, subject);
}

/* Median, interval and ties, the cheapest first. */
static enum cb_status rank(struct cb_advice *a, const struct cb_samples *samples) {
  for (size_t i = 0; i < a->ranked_count; i++) {
    struct cb_candidate *c = &a->ranked[i];
    enum cb_status status =
        cb_median_interval(samples->rounds, samples->step_s + i * samples->stride, &c->step, NULL);
    if (status) return status;
    c->step_s = c->step.value;
    c->unmet = cb_needs_unmet(a, c);
  }
  qsort(a->ranked, a->ranked_count, sizeof *a->ranked, by_step);
  size_t kept = 0; /* the interleaved time decides about frames */
  for (size_t i = 0; i < a->ranked_count; i++)
    if (!a->ranked[i].unmet) a->ranked[kept++] = a->ranked[i];
  a->ranked_count = kept;
  for (size_t i = 0; i < kept; i++)
    a->ranked[i].tie = a->ranked[i].step.low <= a->ranked[0].step.high;
  return CB_OK;
}

enum cb_status cb_explorer_rank(struct explorer *e, struct cb_advice *a) {
  struct cb_job jobs[CB_ADVISE_TIMED] = {0};
  struct cb_subject subjects[CB_ADVISE_TIMED];
  struct cb_samples samples = {0};
  const double budget_s = e->timing_s;
  const size_t count = a->ranked_count;
  enum cb_status status = CB_OK;
  for (size_t i = 0; !status && i < count; i++) {
    const struct cb_scene *s = e->body->scene;
    const struct cb_candidate *c = &a->ranked[i];
    const struct cb_step_parameters step = {c->trial.step, s->alpha, s->beta, c->trial.iterations};
    status = cb_job_create(c->trial.variant, c->trial.threads, &e->body->at, &step, &jobs[i]);
    subjects[i] = (struct cb_subject){c->name, cb_job_restore, cb_job_steps, &jobs[i]};
  }
  const struct cb_timing timing = {.epoch_s = fmax(2e-3, 0.8 * budget_s / (double)(count * ROUNDS)),
                                   .budget_s = budget_s,
                                   .min_rounds = 6,
                                   .max_rounds = ROUNDS,
                                   .seed = e->request->options->seed,
                                   .progress = show,
                                   .progress_context = e};
  if (!status) status = cb_timer_run(count, subjects, &timing, &samples);
  if (!status) status = rank(a, &samples);
  cb_samples_free(&samples);
  for (size_t i = 0; i < count; i++) cb_job_free(&jobs[i]);
  return status;
}
