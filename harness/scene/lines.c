/* lines.c - on which line of a JSON text a value stands.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "harness/scene/json.h"

/* The text is valid JSON: what follows only has to find its way. */
static const char *skip_space(const char *t) {
  while (isspace((unsigned char)*t)) t++;
  return t;
}

static const char *skip_text(const char *t) { /* from the opening quote */
  for (t++; *t != '"'; t++)
    if (*t == '\\') t++;
  return t + 1;
}

/* Past the value at t: to the comma or bracket that ends it. */
static const char *skip_value(const char *t) {
  int depth = 0;
  for (; *t; t++) {
    if (*t == '"') {
      t = skip_text(t) - 1;
      continue;
    }
    if (depth == 0 && strchr(",]}", *t)) break;
    depth += *t == '{' || *t == '[';
    depth -= *t == '}' || *t == ']';
  }
  return t;
}

static bool is_key(const char *quoted, const char *name, size_t length) {
  return strncmp(quoted + 1, name, length) == 0 && quoted[1 + length] == '"';
}

/* The member `name` of the object or array at t, from its key on; NULL: none. */
static const char *find_member(const char *t, const char *name, size_t length, bool to_value) {
  const bool object = *t == '{';
  unsigned long index = strtoul(name, NULL, 10);
  for (t = skip_space(t + 1); *t && *t != '}' && *t != ']'; t = skip_space(t + (*t == ','))) {
    const char *begin = t;
    if (object) t = skip_space(skip_space(skip_text(t)) + 1); /* the colon */
    if (object ? is_key(begin, name, length) : index-- == 0) return to_value ? t : begin;
    t = skip_value(t);
  }
  return NULL;
}

size_t cb_json_line(const char *text, const char *place) {
  const char *at = skip_space(text), *value = at;
  for (const char *name = place; *name && (*value == '{' || *value == '[');) {
    const size_t length = strcspn(name, "/");
    const char *found = find_member(value, name, length, false);
    if (!found) break;
    at = found;
    value = find_member(value, name, length, true);
    name += length + (name[length] == '/');
  }
  size_t line = 1;
  for (const char *t = text; t < at; t++) line += *t == '\n';
  return line;
}
