/* search.h - the largest size that is cheap enough, with few measurements.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SEARCH_H
#define CB_SEARCH_H

#include "kernels/kernel.h"

struct cb_search {
  size_t low, high;  /* sizes that may be measured, 1 <= low <= high */
  size_t first;      /* a guess, in [low, high] */
  double resolution; /* ends when two sizes, this or less of the lower apart or next to each
                        other, fit and do not; 0: next to each other */
  double limit;      /* cost <= limit fits; a NaN does not */
  /* *cost := cost of a size, which should rise about as its third power. */
  enum cb_status (*measure)(void *context, size_t size, double *cost);
  void *context;
  size_t fits, exceeds; /* results: the sizes found; 0: even low does not fit, even high does */
  double fits_cost, exceeds_cost;
  size_t measurements;
};

/* Search where the third power says, then between what is known, now and then in the
 * middle of it: a handful of measurements, none twice. What measure returns is passed on. */
enum cb_status cb_search_run(struct cb_search *s);

#endif
