/* Threads wait for each other in barriers of the operating system: spinning ones
 * take the processor from whom they wait for when the machine is busy.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/crew.h"

#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/measure/timer.h"
#include "harness/progress.h"

struct crew {
  size_t threads, started;
  cb_crew_work *work;
  void *context;
  size_t repeats;            /* of the next epoch; 0: the end */
  pthread_mutex_t gate;      /* held until all have started, or one could not */
  pthread_barrier_t barrier; /* all threads and the caller, before and after an epoch */
  struct member {
    struct crew *crew;
    pthread_t thread;
    double seconds; /* that its last epoch took */
  } * members;
};

static void *member_main(void *argument) {
  struct member *m = argument;
  struct crew *c = m->crew;
  pthread_mutex_lock(&c->gate);
  const bool complete = c->started == c->threads;
  pthread_mutex_unlock(&c->gate);
  while (complete) {
    pthread_barrier_wait(&c->barrier);
    if (c->repeats == 0) break;
    const double began = cb_timer_now();
    c->work(c->context, (size_t)(m - c->members), c->repeats);
    m->seconds = cb_timer_now() - began;
    pthread_barrier_wait(&c->barrier);
  }
  return NULL;
}

/* The n-th processor of the set. */
static int processor(const cpu_set_t *allowed, size_t n) {
  int cpu = 0;
  while (cpu < CPU_SETSIZE && (!CPU_ISSET(cpu, allowed) || n-- > 0)) cpu++;
  return cpu;
}

static bool start_member(struct crew *c, size_t i, const cpu_set_t *allowed) {
  pthread_attr_t attributes;
  cpu_set_t own;
  CPU_ZERO(&own);
  if (pthread_attr_init(&attributes) != 0) return false;
  const int cpu = processor(allowed, i);
  if (cpu < CPU_SETSIZE) {
    CPU_SET(cpu, &own);
    pthread_attr_setaffinity_np(&attributes, sizeof own, &own);
  }
  c->members[i].crew = c;
  const bool started =
      pthread_create(&c->members[i].thread, &attributes, member_main, &c->members[i]) == 0;
  pthread_attr_destroy(&attributes);
  return started;
}

/* Start all of them or, on failure, none that goes on. */
static enum cb_status crew_start(struct crew *c) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) CPU_ZERO(&allowed);
  pthread_mutex_lock(&c->gate);
  while (c->started < c->threads && start_member(c, c->started, &allowed)) c->started++;
  pthread_mutex_unlock(&c->gate);
  if (c->started == c->threads) return CB_OK;
  return cb_fail(CB_MEMORY,
                 "only %zu of %zu threads could be started; allow more processes or "
                 "memory",
                 c->started, c->threads);
}

static void crew_end(struct crew *c) {
  c->repeats = 0;
  if (c->started == c->threads) pthread_barrier_wait(&c->barrier);
  for (size_t i = 0; i < c->started; i++) pthread_join(c->members[i].thread, NULL);
}

/* Seconds that the slowest thread needed. Threads begin some 50 us apart, as they
 * are woken, which therefore does not count. */
static double crew_epoch(struct crew *c, size_t repeats) {
  double slowest = 0;
  c->repeats = repeats;
  pthread_barrier_wait(&c->barrier);
  pthread_barrier_wait(&c->barrier);
  for (size_t i = 0; i < c->threads; i++) slowest = fmax(slowest, c->members[i].seconds);
  return slowest;
}

/* Repeats that fill an epoch. */
static size_t calibrate(struct crew *c, double epoch_s) {
  size_t repeats = 1;
  while (!cb_interrupted()) {
    const double lasted = crew_epoch(c, repeats);
    if (!(lasted < epoch_s) || repeats > SIZE_MAX / 64) break;
    const double growth = lasted > 0 ? fmin(1.1 * epoch_s / lasted, 10) : 10;
    repeats = (size_t)ceil((double)repeats * growth);
  }
  return repeats;
}

size_t cb_crew_limit(void) {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return 1;
  return (size_t)CPU_COUNT(&allowed);
}

enum cb_status cb_crew_time(size_t threads, cb_crew_work *work, void *context, double epoch_s,
                            size_t epochs, double *seconds) {
  struct crew c = {.threads = threads, .work = work, .context = context};
  c.members = calloc(threads, sizeof *c.members);
  if (!c.members || pthread_barrier_init(&c.barrier, NULL, (unsigned)threads + 1) != 0) {
    free(c.members);
    return cb_fail_memory("the threads");
  }
  pthread_mutex_init(&c.gate, NULL); /* cannot fail on Linux */
  enum cb_status status = crew_start(&c);
  if (!status) {
    const size_t repeats = calibrate(&c, epoch_s);
    for (size_t e = 0; e < epochs && !cb_interrupted(); e++)
      seconds[e] = crew_epoch(&c, repeats) / (double)repeats;
    if (cb_interrupted())
      status = cb_fail(CB_INTERRUPTED, "interrupted while measuring the machine");
  }
  crew_end(&c);
  pthread_mutex_destroy(&c.gate);
  pthread_barrier_destroy(&c.barrier);
  free(c.members);
  return status;
}
