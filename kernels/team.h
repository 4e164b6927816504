/* team.h - threads that work on one operator together: OpenMP's, each kept on a
 * processor of its own, with a barrier that spins for a moment, then yields.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TEAM_H
#define CB_TEAM_H

#include "kernels/kernel.h"

enum { CB_TEAM_MOST = 64 };

struct cb_team;
/* One thread's part of the work, 0 <= thread < threads. */
typedef void cb_team_work(void *context, size_t thread);

/* 1 <= threads <= CB_TEAM_MOST. More than one: while the team is there the caller
 * is kept on the first allowed processor, thread i on the i-th (modulo how many
 * there are). CB_INPUT: another number; CB_MEMORY: the threads cannot be had. */
enum cb_status cb_team_create(size_t threads, struct cb_team **out);
void cb_team_free(struct cb_team *team); /* NULL is allowed */
size_t cb_team_threads(const struct cb_team *team);
/* Run work on every thread, the caller being thread 0, and wait for all. Not to be
 * called by two threads at once. What the caller wrote before is seen by all. */
void cb_team_run(struct cb_team *team, cb_team_work *work, void *context);
/* Within work: wait for all threads of the team. */
void cb_team_barrier(struct cb_team *team, size_t thread);
/* The same, and everybody gets to know bytes <= CB_TEAM_WORDS of the thread; told: those of
 * `other`, until the thread waits again. */
enum { CB_TEAM_WORDS = 16 };
void cb_team_tell(struct cb_team *team, size_t thread, const void *words, size_t bytes);
const void *cb_team_told(const struct cb_team *team, size_t thread, size_t other);

/* Thread's share [first, last) of n things. */
static inline void cb_team_share(size_t n, size_t threads, size_t thread, size_t *first,
                                 size_t *last) {
  *first = n * thread / threads;
  *last = n * (thread + 1) / threads;
}

#endif
