/* results_slices.h - what was added to a run since some moment, as JSON, and back: a finished
 * part of bench, for its journal.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_RESULTS_SLICES_H
#define CB_RESULTS_SLICES_H

#include "harness/measure/results.h"

enum { CB_RESULT_LISTS = 9 };
/* Lengths of the lists of a run at some moment. */
struct cb_mark {
  size_t count[CB_RESULT_LISTS];
};
struct cb_mark cb_results_mark(const struct cb_results *r);

/* All that was added since. New reference, NULL when out of memory. */
json_t *cb_results_since(const struct cb_results *r, const struct cb_mark *mark);
/* Add it again. The slice is kept: string constants of the new rows are its texts. CB_INPUT,
 * recorded, for what cb_results_since has not made; CB_MEMORY. */
enum cb_status cb_results_restore(struct cb_results *r, const json_t *slice, size_t session);

#endif
