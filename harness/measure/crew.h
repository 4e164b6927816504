/* crew.h - the same work on several threads at once, each on a processor of its
 * own, timed by the slowest.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CREW_H
#define CB_CREW_H

#include "kernels/kernel.h"

/* Processors that this process may use, at least 1. */
size_t cb_crew_limit(void);

/* Do thread's part (0-based) of the work, repeats times. */
typedef void cb_crew_work(void *context, size_t thread, size_t repeats);

/* seconds[epochs] := wall time of one repeat of the work on the slowest thread;
 * each epoch repeats it until epoch_s (s) is filled, at least once; the trials
 * that find how often are the warm-up. 1 <= threads <= cb_crew_limit(). Thread i
 * runs on the i-th allowed processor only; the caller's own affinity is kept.
 * CB_MEMORY when the threads cannot be started, CB_INTERRUPTED; recorded. */
enum cb_status cb_crew_time(size_t threads, cb_crew_work *work, void *context, double epoch_s,
                            size_t epochs, double *seconds);

#endif
