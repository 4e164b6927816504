/* progress.h - how far long work is, and whether the user wants it to end.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PROGRESS_H
#define CB_PROGRESS_H

#include "kernels/kernel.h"

/* From here on Ctrl-C (SIGINT) and SIGTERM set a flag instead of ending the
 * program; a second Ctrl-C ends it at once. */
void cb_interrupt_install(void);
bool cb_interrupted(void);

/* A bar on stderr with percent done, elapsed and remaining time, redrawn at
 * most ten times a second; plain lines, every few seconds, when stderr is not a
 * terminal. One at a time. total: units of work, any scale (e.g. seconds). */
void cb_progress_begin(const char *title, double total);
/* done: units finished so far; what: a few words on the current work. */
void cb_progress(double done, const char *what);
void cb_progress_end(void);

#endif
