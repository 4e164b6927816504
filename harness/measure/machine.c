/* machine.c - see machine.h. Each measurement: a few epochs, their median and its
 * interval.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/machine.h"

#include <math.h>
#include <stdlib.h>
#include <sys/mman.h>

#include "harness/error.h"
#include "harness/measure/crew.h"
#include "harness/measure/environment.h"
#include "harness/measure/timer.h"
#include "kernels/team.h"

const char *const cb_level_name[CB_LEVELS] = {"L1", "L2", "L3", "DRAM"};
const char *const cb_scalar_name[CB_SCALARS] = {"f32", "f64"};

/* Epochs are shorter than the time slice of a busy system, which a thread that was
 * just woken has to itself. One pass over DRAM is longer in any case. */
enum { EPOCHS = 25, DRAM_EPOCHS = 7 };
enum { PAGE = 2 << 20 /* B, a large page */, BATCH = 1000 /* multiply-adds of a repeat */ };
enum { BARRIERS = 10000 /* of an epoch */ };
static const double EPOCH_S = 2e-3;
static const double DRAM_LEAST = 256e6, DRAM_MOST = 512e6; /* B */

static const struct cb_interval NOT_MEASURED = {NAN, NAN, NAN};

/* One kind of work, on all threads of a crew. */
struct job {
  const struct cb_loops *loops;
  enum cb_scalar scalar;
  double *numbers; /* thread i has those from i * slice on */
  size_t slice;
  size_t length; /* how many of its slice a thread uses; a multiple of 3 units */
  size_t epochs;
};

struct session {
  struct cb_machine m;
  struct cb_environment environment;
  const struct cb_loops *widest;
  size_t done, total; /* measurements */
  void (*progress)(void *context, double share, const char *what);
  void *context;
};

/* ---- the work of one thread ------------------------------------------------ */

/* The chains end at addend / (1 - factor): neither too large nor denormal. */
static void run_multiply_add(void *context, size_t thread, size_t repeats) {
  const struct job *j = context;
  (void)thread;
  /* A call by pointer: the result need not be used for the work to be done. */
  j->loops->multiply_add[j->scalar](BATCH * repeats, 0.999, 0.001);
}

static void run_read(void *context, size_t thread, size_t repeats) {
  const struct job *j = context;
  j->loops->read(repeats, j->length, j->numbers + thread * j->slice);
}

static void run_triad(void *context, size_t thread, size_t repeats) {
  const struct job *j = context;
  const size_t n = j->length / 3;
  double *a = j->numbers + thread * j->slice;
  j->loops->triad(repeats, n, 0.5, a + n, a + 2 * n, a);
}

/* By the thread that will use them, so that they are in memory near to it. */
static void run_fill(void *context, size_t thread, size_t repeats) {
  const struct job *j = context;
  (void)repeats;
  for (size_t i = 0; i < j->slice; i++) j->numbers[thread * j->slice + i] = 1;
}

/* ---- measurements ---------------------------------------------------------- */

static void show(const struct session *s, const char *what) {
  if (s->progress) s->progress(s->context, (double)s->done / (double)s->total, what);
}

/* *rate := amount per second, amount being what one repeat of the work is. */
static enum cb_status measure(struct session *s, enum cb_crew crew, cb_crew_work *work,
                              struct job *job, double amount, const char *what,
                              struct cb_interval *rate) {
  double samples[EPOCHS], scatter;
  show(s, what);
  enum cb_status status =
      cb_crew_time(s->m.threads[crew], work, job, EPOCH_S, job->epochs, samples);
  if (status) return status;
  for (size_t e = 0; e < job->epochs; e++) samples[e] = amount / samples[e];
  status = cb_median_interval(job->epochs, samples, rate, &scatter);
  s->done++;
  s->m.unstable += !cb_scatter_stable(scatter);
  return status;
}

static enum cb_status measure_peaks(struct session *s, enum cb_crew crew) {
  enum cb_status status = CB_OK;
  for (size_t set = 0; cb_loops[set].name && !status; set++) {
    if (!cb_loops[set].runs()) continue;
    for (enum cb_scalar scalar = 0; scalar < CB_SCALARS && !status; scalar++) {
      struct job job = {.loops = &cb_loops[set], .scalar = scalar, .epochs = EPOCHS};
      const size_t size = scalar == CB_F32 ? sizeof(float) : sizeof(double);
      const double flops = 2.0 * CB_LOOP_CHAINS * BATCH * (double)(cb_loops[set].bytes / size);
      status = measure(s, crew, run_multiply_add, &job, flops * (double)s->m.threads[crew],
                       cb_loops[set].name, &s->m.peak[set][scalar][crew]);
    }
  }
  return status;
}

static enum cb_status measure_level(struct session *s, enum cb_crew crew, enum cb_level level,
                                    struct job *job) {
  const double bytes = (double)s->m.bytes[level][crew];
  job->epochs = level == CB_DRAM ? DRAM_EPOCHS : EPOCHS;
  job->length = s->m.bytes[level][crew] / s->m.threads[crew] / sizeof(double);
  enum cb_status status =
      measure(s, crew, run_read, job, bytes, cb_level_name[level], &s->m.read[level][crew]);
  if (status) return status;
  return measure(s, crew, run_triad, job, bytes, cb_level_name[level], &s->m.triad[level][crew]);
}

static enum cb_status measure_levels(struct session *s, enum cb_crew crew) {
  const size_t bytes = s->m.bytes[CB_DRAM][crew]; /* the most that any level uses */
  struct job job = {.loops = s->widest,
                    .slice = bytes / s->m.threads[crew] / sizeof *job.numbers,
                    .numbers = aligned_alloc(PAGE, (bytes + PAGE - 1) / PAGE * PAGE)};
  if (!job.numbers) return cb_fail_memory("the bandwidth of the memory");
  madvise(job.numbers, bytes, MADV_HUGEPAGE); /* where refused: with small pages */
  show(s, "filling memory");
  enum cb_status status = cb_crew_time(s->m.threads[crew], run_fill, &job, 0, 0, NULL);
  for (enum cb_level level = 0; level < CB_LEVELS && !status; level++)
    if (s->m.bytes[level][crew] > 0) status = measure_level(s, crew, level, &job);
  free(job.numbers);
  return status;
}

static void run_barriers(void *context, size_t thread) {
  for (size_t i = 0; i < BARRIERS; i++) cb_team_barrier(context, thread);
}

/* The barrier of the kernels' own threads: a step has about four an iteration. */
static enum cb_status measure_barrier(struct session *s) {
  double samples[EPOCHS], scatter;
  const size_t threads = s->m.threads[CB_ALL];
  struct cb_team *team;
  show(s, "barrier");
  if (cb_team_create(threads < CB_TEAM_MOST ? threads : CB_TEAM_MOST, &team))
    return cb_fail_memory("the threads");
  for (size_t e = 0; e < EPOCHS; e++) {
    const double begun = cb_timer_now();
    cb_team_run(team, run_barriers, team);
    samples[e] = (cb_timer_now() - begun) / BARRIERS;
  }
  cb_team_free(team);
  s->done++;
  const enum cb_status status = cb_median_interval(EPOCHS, samples, &s->m.barrier, &scatter);
  s->m.unstable += !cb_scatter_stable(scatter);
  return status;
}

/* ---- what to measure ------------------------------------------------------- */

/* A thread's part of that cache, B; 0: there is none. */
static double cache_share(const struct cb_environment *e, unsigned level, size_t threads) {
  for (size_t i = 0; i < e->cache_count; i++) {
    const struct cb_cache *c = &e->caches[i];
    if (c->level != level || c->type[0] == 'I') continue;
    return c->bytes / fmax(fmin(c->sharing, (double)threads), 1);
  }
  return 0;
}

/* So much that caches hold little of it, and the machine is not filled. */
static double dram_bytes(const struct cb_environment *e) {
  const double last = fmax(cache_share(e, 2, 1), cache_share(e, 3, 1));
  const double bytes = fmin(fmax(4 * last, DRAM_LEAST), DRAM_MOST);
  return e->memory > 0 ? fmin(bytes, e->memory / 4) : bytes;
}

/* Half of L1 and L2; for L3 the geometric mean of it and L2, far from both. */
static double thread_bytes(const struct cb_environment *e, enum cb_level level, size_t threads) {
  const double dram = dram_bytes(e) / (double)threads;
  const double l2 = cache_share(e, 2, threads), l3 = cache_share(e, 3, threads);
  if (level == CB_L1) return fmin(cache_share(e, 1, threads) / 2, dram);
  if (level == CB_L2) return fmin(l2 / 2, dram);
  if (level == CB_L3) return fmin(l2 > 0 ? fmin(sqrt(l2 * l3), l3 / 2) : l3 / 2, dram);
  return dram;
}

static void choose(struct session *s) {
  const size_t unit = 3 * CB_LOOP_UNIT * sizeof(double); /* three equal arrays */
  cb_environment_read(&s->environment);
  s->m.threads[CB_ONE] = 1;
  s->m.threads[CB_ALL] = cb_crew_limit();
  size_t sets = 0, levels = 0;
  for (size_t set = 0; cb_loops[set].name; set++) {
    if (!cb_loops[set].runs()) continue;
    s->widest = &cb_loops[set];
    sets++;
  }
  s->m.vectors = s->widest->name;
  for (enum cb_crew crew = 0; crew < CB_CREWS; crew++) {
    const size_t threads = s->m.threads[crew];
    for (enum cb_level level = 0; level < CB_LEVELS; level++) {
      const size_t units = (size_t)(thread_bytes(&s->environment, level, threads) / (double)unit);
      s->m.bytes[level][crew] = units * unit * threads;
      s->m.read[level][crew] = s->m.triad[level][crew] = NOT_MEASURED;
      levels += crew == CB_ONE && units > 0;
    }
    for (size_t set = 0; set < CB_LOOP_SETS; set++)
      s->m.peak[set][CB_F32][crew] = s->m.peak[set][CB_F64][crew] = NOT_MEASURED;
  }
  const bool several = s->m.threads[CB_ALL] > 1;
  s->m.barrier = NOT_MEASURED;
  s->total = (several ? 2 : 1) * (sets * CB_SCALARS + 2 * levels) + several;
}

static void copy_crew(struct cb_machine *m) {
  for (size_t set = 0; set < CB_LOOP_SETS; set++)
    for (enum cb_scalar scalar = 0; scalar < CB_SCALARS; scalar++)
      m->peak[set][scalar][CB_ALL] = m->peak[set][scalar][CB_ONE];
  for (enum cb_level level = 0; level < CB_LEVELS; level++) {
    m->read[level][CB_ALL] = m->read[level][CB_ONE];
    m->triad[level][CB_ALL] = m->triad[level][CB_ONE];
  }
}

/* The best of each; fmax passes over what is not there. */
static void summarize(struct cb_machine *m) {
  for (enum cb_crew crew = 0; crew < CB_CREWS; crew++) {
    for (enum cb_scalar scalar = 0; scalar < CB_SCALARS; scalar++) {
      m->peak_flops[scalar][crew] = NAN;
      for (size_t set = 0; set < CB_LOOP_SETS; set++)
        m->peak_flops[scalar][crew] =
            fmax(m->peak_flops[scalar][crew], m->peak[set][scalar][crew].value);
    }
    for (enum cb_level level = 0; level < CB_LEVELS; level++)
      m->bandwidth[level][crew] = fmax(m->read[level][crew].value, m->triad[level][crew].value);
  }
}

enum cb_status cb_machine_measure(void (*progress)(void *context, double share, const char *what),
                                  void *context, struct cb_machine *m) {
  struct session s = {.progress = progress, .context = context};
  enum cb_status status = CB_OK;
  choose(&s);
  for (enum cb_crew crew = 0; crew < CB_CREWS && !status; crew++) {
    if (crew == CB_ALL && s.m.threads[crew] == 1) {
      copy_crew(&s.m);
      break;
    }
    status = measure_peaks(&s, crew);
    if (!status) status = measure_levels(&s, crew);
    if (!status && crew == CB_ALL) status = measure_barrier(&s);
  }
  if (status) return status;
  s.m.measurements = s.total;
  summarize(&s.m);
  *m = s.m;
  return CB_OK;
}

enum cb_level cb_machine_level(const struct cb_environment *e, double bytes, size_t threads) {
  for (enum cb_level level = CB_L1; level < CB_DRAM; level++)
    if (bytes <= (double)threads * cache_share(e, level + 1, threads)) return level;
  return CB_DRAM;
}

double cb_machine_attainable(const struct cb_machine *m, double flops, double bytes,
                             enum cb_level level, enum cb_crew crew, enum cb_scalar scalar) {
  const double peak = m->peak_flops[scalar][crew];
  const double fed = m->bandwidth[level][crew] * flops / bytes;
  return fed < peak || isnan(fed) ? fed : peak;
}
