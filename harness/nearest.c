/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/nearest.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 95, MOST = 3 };

static size_t min(size_t a, size_t b) { return a < b ? a : b; }

/* Row by row over the text: row[j] = distance of its beginning to name[0..j). */
static size_t edit_distance(const char *text, const char *name) {
  size_t length = min(strlen(name), LONGEST), row[LONGEST + 1];
  for (size_t j = 0; j <= length; j++) row[j] = j;
  for (; *text; text++) {
    size_t diagonal = row[0], insert = *text == '*' ? 0 : 1;
    row[0] += insert;
    for (size_t j = 1; j <= length; j++) {
      size_t replace = diagonal + (*text != name[j - 1] && *text != '?' && *text != '*');
      diagonal = row[j];
      row[j] = min(replace, min(row[j] + insert, row[j - 1] + insert));
    }
  }
  return row[length];
}

void cb_nearest_offer(struct cb_nearest *nearest, const char *name) {
  char quoted[LONGEST + 3];
  size_t distance = edit_distance(nearest->text, name);
  bool first = nearest->count == 0 || distance < nearest->distance;
  snprintf(quoted, sizeof quoted, "'%.*s'", LONGEST, name);
  if (first) {
    nearest->distance = distance;
    nearest->count = 0;
    nearest->names[0] = '\0';
  } else if (distance > nearest->distance || nearest->count == MOST ||
             strstr(nearest->names, quoted)) {
    return;
  }
  size_t used = strlen(nearest->names);
  snprintf(nearest->names + used, sizeof nearest->names - used, "%s%s", first ? "" : ", ", quoted);
  nearest->count++;
}
