/* team.c - see team.h. The barriers are ours and not OpenMP's: they cost a tenth of
 * a microsecond, and the thread sanitizer can see them. A thread writes how many it has
 * reached, and what it tells, to a cache line of its own, and waits for those of the others:
 * one line has to come from another core, and no line has two writers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/team.h"

#include <omp.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/spin.h"

struct cb_team {
  size_t threads;
  cb_team_work *work;
  void *context;
  struct member {
    _Alignas(64) atomic_size_t turn;          /* barriers reached */
    _Alignas(16) char told[2][CB_TEAM_WORDS]; /* in every second: some may still read the last */
  } member[];
};

/* The caller's processors before the first team of several threads, and how many
 * such teams there are. */
static cpu_set_t allowed;
static size_t pinned_teams;
static _Atomic(struct cb_team *) running;
/* Threads that have done their part. Not in the team: it may be freed right after. */
static atomic_size_t finished;

static void pin(size_t thread) {
  cpu_set_t own;
  size_t n = thread % (size_t)CPU_COUNT(&allowed);
  int cpu = 0;
  while (!CPU_ISSET(cpu, &allowed) || n-- > 0) cpu++;
  CPU_ZERO(&own);
  CPU_SET(cpu, &own);
  sched_setaffinity(0, sizeof own, &own); /* refused: slower, not wrong */
}

void cb_team_tell(struct cb_team *team, size_t thread, const void *words, size_t bytes) {
  struct member *own = &team->member[thread];
  const size_t turn = atomic_load_explicit(&own->turn, memory_order_relaxed) + 1;
  if (bytes) memcpy(own->told[turn % 2], words, bytes);
  atomic_store_explicit(&own->turn, turn, memory_order_release);
  for (size_t t = 0; t < team->threads; t++)
    for (size_t n = 0; atomic_load_explicit(&team->member[t].turn, memory_order_acquire) < turn;
         n++)
      cb_spin(n);
}

const void *cb_team_told(const struct cb_team *team, size_t thread, size_t other) {
  const size_t turn = atomic_load_explicit(&team->member[thread].turn, memory_order_relaxed);
  return team->member[other].told[turn % 2];
}

void cb_team_barrier(struct cb_team *team, size_t thread) { cb_team_tell(team, thread, NULL, 0); }

/* Threads of OpenMP come and go with the size of its teams: each pins itself once. */
static void take_part(void) {
  static _Thread_local bool pinned;
  struct cb_team *team = atomic_load_explicit(&running, memory_order_acquire);
  const size_t thread = (size_t)omp_get_thread_num();
  if (thread > 0 && !pinned) {
    pin(thread);
    pinned = true;
  }
  team->work(team->context, thread);
  if (thread > 0) {
    atomic_fetch_add_explicit(&finished, 1, memory_order_acq_rel);
    return;
  }
  const size_t others = team->threads - 1;
  for (size_t n = 0; atomic_load_explicit(&finished, memory_order_acquire) != others; n++)
    cb_spin(n);
  atomic_store_explicit(&finished, 0, memory_order_relaxed);
}

void cb_team_run(struct cb_team *team, cb_team_work *work, void *context) {
  if (team->threads == 1) {
    work(context, 0);
    return;
  }
  team->work = work;
  team->context = context;
  atomic_store_explicit(&running, team, memory_order_release);
#pragma omp parallel num_threads(team->threads)
  take_part();
}

/* How many threads does OpenMP really give? */
static size_t available(size_t threads) {
  int given = 0;
#pragma omp parallel num_threads(threads)
  if (omp_get_thread_num() == 0) given = omp_get_num_threads();
  return (size_t)given;
}

enum cb_status cb_team_create(size_t threads, struct cb_team **out) {
  if (threads < 1 || threads > CB_TEAM_MOST) return CB_INPUT;
  const size_t bytes = sizeof(struct cb_team) + threads * sizeof(struct member);
  struct cb_team *team = aligned_alloc(64, bytes);
  if (!team) return CB_MEMORY;
  memset(team, 0, bytes);
  team->threads = threads;
  if (threads > 1) {
    omp_set_dynamic(0);
    if (available(threads) != threads) {
      free(team);
      return CB_MEMORY;
    }
    if (pinned_teams++ == 0) {
      if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
        CPU_ZERO(&allowed);
        CPU_SET(0, &allowed);
      }
      pin(0);
    }
  }
  *out = team;
  return CB_OK;
}

void cb_team_free(struct cb_team *team) {
  if (!team) return;
  if (team->threads > 1 && --pinned_teams == 0) sched_setaffinity(0, sizeof allowed, &allowed);
  free(team);
}

size_t cb_team_threads(const struct cb_team *team) { return team->threads; }
