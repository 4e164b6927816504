/* report.h - what the rows of `corobench extremes` say together: a state for each, the
 * worst and the first of each model, arithmetic and sweep.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EXTREMES_REPORT_H
#define CB_EXTREMES_REPORT_H

#include "harness/extremes/extremes.h"
#include "harness/files/table.h"

/* From good to bad, the order of the map. */
enum cb_extreme_state {
  CB_NOT_JUDGED, /* there is nothing to hold it against: the note says why */
  CB_RIGHT,
  CB_BY_METHOD,  /* not finite, a law or an error, but the method's: the note says why */
  CB_INACCURATE, /* keeps its laws, an error is above the limit */
  CB_BREAKS,     /* a law that the model claims */
  CB_NOT_FINITE,
  CB_EXTREME_STATES
};
extern const char *const cb_extreme_state_name[CB_EXTREME_STATES];
enum cb_extreme_state cb_extreme_state(const struct cb_extreme *row);

/* More than so many times what rounding and the condition explain is inaccurate: in frame,
 * force, product; in the orthogonality, so many roundings. */
extern const double cb_extreme_limit;

/* A row that says nothing yet: finite, every figure NaN, no law, no note. */
struct cb_extreme cb_extreme_blank(const char *sweep, const struct cb_variant *variant);
/* *all := the worse of both in each figure; law and note of the one in the worse state. */
void cb_extreme_fold(struct cb_extreme *all, const struct cb_extreme *one);

/* CB_INPUT, recorded: there is no sweep of that name (NULL: all). */
enum cb_status cb_extremes_check(const char *sweep);
/* The sweep of that name alone, or all (NULL). CB_INPUT: there is none; CB_MEMORY,
 * CB_INTERRUPTED. On failure *all is empty. */
enum cb_status cb_extremes_run(const char *sweep, struct cb_extremes *all);
void cb_extremes_free(struct cb_extremes *all);

/* All rows; one row for each model, arithmetic and sweep with its worst state, where it was
 * met first, how many rows are in each state; models by sweeps in words. NULL: out of
 * memory. */
struct cb_table *cb_extremes_rows(const struct cb_extremes *all);
struct cb_table *cb_extremes_map(const struct cb_extremes *all);
struct cb_table *cb_extremes_words(const struct cb_extremes *all);
/* What the sweep of steps says in columns of its own. NULL: out of memory. */
struct cb_table *cb_extremes_steps(const struct cb_extremes *all);

/* CB_BROKEN, recorded, if a row is not finite or breaks a law. */
enum cb_status cb_extremes_judge(const struct cb_extremes *all);

#endif
