/* counter.h - counts the operations that the counted arithmetic executes: the
 * linker sends each quad-precision call through harness/verify/counter.c (--wrap).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_COUNTER_H
#define CB_COUNTER_H

#include <stdbool.h>

#include "kernels/stages.h"

struct cb_counts {
  unsigned long mul, add, div, sqrt; /* a subtraction counts as an addition */
};

/* From here on this thread's operations belong to that stage (kernels mark it). */
void cb_counter_stage(int stage);
void cb_counter_reset(void);
/* counts[STAGES] since the last reset. */
void cb_counter_read(struct cb_counts *counts);
/* Are executed operations seen at all? False when linked without --wrap. Leaves
 * the counts as they are. */
bool cb_counter_works(void);

#endif
