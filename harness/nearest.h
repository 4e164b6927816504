/* nearest.h - "did you mean": the names closest to one that does not exist.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_NEAREST_H
#define CB_NEAREST_H

#include <stddef.h>

/* Begin with {.text = what the user wrote}; it may be a glob. */
struct cb_nearest {
  const char *text;
  size_t distance, count; /* of the names kept; count 0: none offered yet */
  char names[320];        /* 'a', 'b': the closest, up to three at equal distance */
};

/* Offer a name; it is kept if no nearer one was offered. Distance: characters
 * inserted, deleted or replaced (Levenshtein 1966), where * and ? of the text
 * match freely. Names are cut at 95 characters. */
void cb_nearest_offer(struct cb_nearest *nearest, const char *name);

#endif
