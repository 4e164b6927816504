/* results_cells.h - cells that the CSV files of a run have in common.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_RESULTS_CELLS_H
#define CB_RESULTS_CELLS_H

#include <math.h>

#include "harness/measure/results.h"

/* Empty unless it is a finite number. */
static inline void cell(struct cb_table *t, double value) {
  if (isfinite(value))
    cb_table_number(t, value);
  else
    cb_table_missing(t);
}

static inline void interval_cells(struct cb_table *t, struct cb_interval interval) {
  cell(t, interval.value);
  cell(t, interval.low);
  cell(t, interval.high);
}

static inline void count_cell(struct cb_table *t, size_t count) {
  cb_table_integer(t, (long long)count);
}

#endif
