/* Source: the protocol follows Chen & Revels, Robust benchmarking in noisy
 * environments, 2016 (epochs, medians) and Kalibera & Jones 2013 (interleaving).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/timer.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <time.h>

#include "harness/error.h"
#include "harness/progress.h"

/* An epoch is lengthened by up to this fraction, so that it never beats in time
 * with something periodic in the machine. */
static const double JITTER = 0.25;

static double seconds_of(clockid_t clock) {
  struct timespec t;
  clock_gettime(clock, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

double cb_timer_now(void) { return seconds_of(CLOCK_MONOTONIC); }

struct epoch {
  double wall, cpu; /* s, the whole epoch */
};

static struct epoch run_epoch(const struct cb_subject *s, size_t repeats, double (*now)(void)) {
  if (s->prepare) s->prepare(s->context);
  const double cpu = seconds_of(CLOCK_PROCESS_CPUTIME_ID), wall = now();
  s->run(s->context, repeats);
  const double end = now();
  return (struct epoch){end - wall, seconds_of(CLOCK_PROCESS_CPUTIME_ID) - cpu};
}

/* Repeats that fill an epoch; the trials are the warm-up. */
static size_t calibrate(const struct cb_subject *s, double epoch_s, double (*now)(void)) {
  size_t repeats = 1;
  if (run_epoch(s, repeats, now).wall > 2 * epoch_s) return repeats; /* warmer, still 1 */
  while (!cb_interrupted()) {
    const double lasted = run_epoch(s, repeats, now).wall;
    if (!(lasted < epoch_s) || repeats > SIZE_MAX / 64) break;
    /* A short trial is a poor clock: grow tenfold at most, and a little further
     * than needed, so that the next trial is the last. */
    const double growth = lasted > 0 ? fmin(1.1 * epoch_s / lasted, 10) : 10;
    repeats = (size_t)ceil((double)repeats * growth);
  }
  return repeats;
}

static enum cb_status allocate(size_t subjects, size_t rounds, struct cb_samples *samples) {
  const size_t count = subjects * rounds;
  *samples = (struct cb_samples){.subjects = subjects,
                                 .stride = rounds,
                                 .step_s = calloc(count, sizeof(double)),
                                 .cpu_s = calloc(count, sizeof(double)),
                                 .repeats = calloc(count, sizeof(size_t))};
  if (samples->step_s && samples->cpu_s && samples->repeats) return CB_OK;
  cb_samples_free(samples);
  return cb_fail_memory("the samples");
}

void cb_samples_free(struct cb_samples *samples) {
  free(samples->step_s);
  free(samples->cpu_s);
  free(samples->repeats);
  *samples = (struct cb_samples){0};
}

struct schedule {
  size_t *order, *repeats; /* [subjects] */
  gsl_rng *rng;
};

static void schedule_free(struct schedule *plan) {
  free(plan->order);
  free(plan->repeats);
  if (plan->rng) gsl_rng_free(plan->rng);
}

static enum cb_status schedule_create(size_t count, unsigned long seed, struct schedule *plan) {
  plan->order = malloc(count * sizeof *plan->order);
  plan->repeats = malloc(count * sizeof *plan->repeats);
  plan->rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!plan->order || !plan->repeats || !plan->rng) {
    schedule_free(plan);
    return cb_fail_memory("the order of the measurements");
  }
  gsl_rng_set(plan->rng, seed);
  for (size_t i = 0; i < count; i++) plan->order[i] = i;
  return CB_OK;
}

static void next_order(struct schedule *plan, size_t round, size_t count) {
  if (round % 2 == 0) {
    gsl_ran_shuffle(plan->rng, plan->order, count, sizeof *plan->order);
    return;
  }
  for (size_t i = 0; i < count / 2; i++) {
    const size_t kept = plan->order[i];
    plan->order[i] = plan->order[count - 1 - i];
    plan->order[count - 1 - i] = kept;
  }
}

/* Time and rounds both end the work, whichever is first; min_rounds are run even
 * when the time is over. */
static void report(const struct cb_timing *timing, double elapsed, double rounds,
                   const char *subject) {
  if (!timing->progress) return;
  const double by_time = fmin(elapsed / timing->budget_s, rounds / (double)timing->min_rounds);
  const double share = fmax(by_time, rounds / (double)timing->max_rounds);
  timing->progress(timing->progress_context, fmin(share, 1), subject);
}

static void run_round(const struct cb_subject *subjects, const struct cb_timing *timing,
                      double (*now)(void), double begin, struct schedule *plan,
                      struct cb_samples *out) {
  next_order(plan, out->rounds, out->subjects);
  for (size_t i = 0; i < out->subjects; i++) {
    if (cb_interrupted()) return;
    const size_t s = plan->order[i], at = s * out->stride + out->rounds;
    const double longer = JITTER * (double)plan->repeats[s] * gsl_rng_uniform(plan->rng);
    const size_t repeats = plan->repeats[s] + (size_t)longer;
    const struct epoch epoch = run_epoch(&subjects[s], repeats, now);
    out->repeats[at] = repeats;
    out->step_s[at] = epoch.wall / (double)repeats;
    out->cpu_s[at] = epoch.cpu / (double)repeats;
    const double rounds = (double)out->rounds + (double)(i + 1) / (double)out->subjects;
    report(timing, now() - begin, rounds, subjects[s].name);
  }
  out->rounds++;
}

enum cb_status cb_timer_run(size_t count, const struct cb_subject *subjects,
                            const struct cb_timing *timing, struct cb_samples *samples) {
  struct schedule plan = {0};
  struct cb_samples result = {0};
  double (*const now)(void) = timing->now ? timing->now : cb_timer_now;
  enum cb_status status = schedule_create(count, timing->seed, &plan);
  if (status) return status;
  status = allocate(count, timing->max_rounds, &result);
  if (status) goto done;
  const double begin = now();
  for (size_t s = 0; s < count && !cb_interrupted(); s++) {
    report(timing, now() - begin, 0, subjects[s].name);
    plan.repeats[s] = calibrate(&subjects[s], timing->epoch_s, now);
  }
  while (!cb_interrupted() && result.rounds < timing->max_rounds &&
         (result.rounds < timing->min_rounds || now() - begin < timing->budget_s))
    run_round(subjects, timing, now, begin, &plan, &result);
  if (cb_interrupted())
    status = cb_fail(CB_INTERRUPTED, "interrupted while measuring; what was measured before it "
                                     "is kept in the output directory");
done:
  schedule_free(&plan);
  if (status)
    cb_samples_free(&result);
  else
    *samples = result;
  return status;
}
