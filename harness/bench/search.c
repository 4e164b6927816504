/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/bench/search.h"

#include <math.h>

static bool ended(const struct cb_search *s) {
  if (s->fits == s->high || s->exceeds == s->low) return true;
  if (s->fits == 0 || s->exceeds == 0) return false;
  const size_t apart = s->exceeds - s->fits;
  return apart == 1 || (double)apart <= s->resolution * (double)s->fits;
}

/* A size that was not measured, inside what is known. Every fourth one halves the
 * interval, in case the cost does not rise as expected. */
static size_t next_size(const struct cb_search *s, size_t size, double cost) {
  const size_t least = s->fits ? s->fits + 1 : s->low;
  const size_t most = s->exceeds ? s->exceeds - 1 : s->high;
  double next = (double)size * cbrt(s->limit / cost);
  if (s->fits && s->exceeds) {
    const double low = pow((double)s->fits, 3), high = pow((double)s->exceeds, 3);
    const double share = (s->limit - s->fits_cost) / (s->exceeds_cost - s->fits_cost);
    next = s->measurements % 4 == 0 ? (double)(s->fits + s->exceeds) / 2
                                    : cbrt(low + share * (high - low));
  }
  if (!(next > (double)least)) return least; /* a NaN as well */
  return next < (double)most ? (size_t)next : most;
}

enum cb_status cb_search_run(struct cb_search *s) {
  size_t size = s->first;
  s->fits = s->exceeds = s->measurements = 0;
  while (!ended(s)) {
    double cost;
    const enum cb_status status = s->measure(s->context, size, &cost);
    if (status) return status;
    s->measurements++;
    if (cost <= s->limit) {
      s->fits = size;
      s->fits_cost = cost;
    } else {
      s->exceeds = size;
      s->exceeds_cost = cost;
    }
    size = next_size(s, size, cost);
  }
  return CB_OK;
}
