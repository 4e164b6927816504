/* json.c - see json.h. Jansson reads the file; it knows lines of syntax errors
 * only, so the line of a value is found by walking the text once more.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/json.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/nearest.h"

/* ---- lines ------------------------------------------------------------------ */

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

/* Line of the deepest part of the place that is in the text. */
static size_t line_of(const struct cb_json *json) {
  const char *at = skip_space(json->text), *value = at;
  for (const char *name = json->place; *name && (*value == '{' || *value == '[');) {
    const size_t length = strcspn(name, "/");
    const char *found = find_member(value, name, length, false);
    if (!found) break;
    at = found;
    value = find_member(value, name, length, true);
    name += length + (name[length] == '/');
  }
  size_t line = 1;
  for (const char *t = json->text; t < at; t++) line += *t == '\n';
  return line;
}

enum cb_status cb_json_fail(const struct cb_json *json, const char *format, ...) {
  char sentence[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  return cb_fail(CB_INPUT, "%s:%zu: %s", json->path, line_of(json), sentence);
}

void cb_json_enter(struct cb_json *json, const char *key, size_t index) {
  const size_t used = strlen(json->place), room = sizeof json->place - used;
  if (key)
    snprintf(json->place + used, room, "%s%s", used ? "/" : "", key);
  else
    snprintf(json->place + used, room, "%s%zu", used ? "/" : "", index);
}

void cb_json_leave(struct cb_json *json) {
  char *slash = strrchr(json->place, '/');
  *(slash ? slash : json->place) = '\0';
}

/* ---- the file ---------------------------------------------------------------- */

static enum cb_status read_text(const char *path, char **text) {
  size_t room = 0;
  FILE *file = fopen(path, "r");
  if (!file) return cb_fail(CB_IO, "cannot read %s: %s", path, strerror(errno));
  errno = 0;
  const ssize_t length = getdelim(text, &room, '\0', file);
  const int error = errno;
  fclose(file);
  if (length >= 0) return CB_OK;
  if (error == ENOMEM) return cb_fail_memory("the scene file");
  if (error) return cb_fail(CB_IO, "cannot read %s: %s", path, strerror(error));
  return cb_fail(CB_INPUT, "%s:1: the file is empty; a scene is a JSON object", path);
}

enum cb_status cb_json_open(const char *path, struct cb_json *json) {
  json_error_t error;
  *json = (struct cb_json){.path = path};
  enum cb_status status = read_text(path, &json->text);
  if (status) return status;
  json->root = json_loads(json->text, JSON_REJECT_DUPLICATES, &error);
  if (!json->root)
    return cb_fail(CB_INPUT, "%s:%d: %s; a scene is a JSON object", path, error.line, error.text);
  if (!json_is_object(json->root)) return cb_json_fail(json, "a scene must be a JSON object");
  return CB_OK;
}

void cb_json_close(struct cb_json *json) {
  json_decref(json->root);
  free(json->text);
  *json = (struct cb_json){0};
}

/* ---- fields ------------------------------------------------------------------ */

static enum cb_status unknown_key(struct cb_json *json, const char *key,
                                  const struct cb_field *fields, size_t count) {
  struct cb_nearest nearest = {.text = key};
  cb_json_enter(json, key, 0);
  for (size_t i = 0; i < count; i++) {
    const size_t length = strlen(key);
    if (strncmp(fields[i].key, key, length) == 0 && fields[i].key[length] == '_')
      return cb_json_fail(json, "'%s' has no unit; write '%s'", key, fields[i].key);
    cb_nearest_offer(&nearest, fields[i].key);
  }
  return cb_json_fail(json, "unknown key '%s' (nearest: %s)", key, nearest.names);
}

static enum cb_status take_number(const struct cb_json *json, const struct cb_field *f,
                                  const json_t *value, double *number) {
  if (!json_is_number(value)) return cb_json_fail(json, "'%s' must be a number", f->key);
  const double n = json_number_value(value);
  if (!(n >= f->low && n <= f->high))
    return cb_json_fail(json, "'%s' is %g; it must be from %g to %g", f->key, n, f->low, f->high);
  *number = n;
  return CB_OK;
}

static enum cb_status take_count(const struct cb_json *json, const struct cb_field *f,
                                 const json_t *value, size_t *count) {
  if (!json_is_integer(value)) return cb_json_fail(json, "'%s' must be a whole number", f->key);
  double number = 0;
  enum cb_status status = take_number(json, f, value, &number);
  if (!status) *count = (size_t)number;
  return status;
}

static enum cb_status take_three(const struct cb_json *json, const struct cb_field *f,
                                 const json_t *value) {
  if (!json_is_array(value) || json_array_size(value) != 3)
    return cb_json_fail(json, "'%s' must be three numbers in brackets", f->key);
  enum cb_status status = CB_OK;
  double numbers[3];
  size_t counts[3];
  for (size_t i = 0; !status && i < 3; i++)
    status = f->kind == CB_FIELD_VECTOR
                 ? take_number(json, f, json_array_get(value, i), &numbers[i])
                 : take_count(json, f, json_array_get(value, i), &counts[i]);
  if (status) return status;
  if (f->kind == CB_FIELD_VECTOR)
    memcpy(f->value, numbers, sizeof numbers);
  else
    memcpy(f->value, counts, sizeof counts);
  return CB_OK;
}

static enum cb_status take_list(const struct cb_json *json, const struct cb_field *f,
                                json_t *value) {
  bool good = json_is_array(value);
  for (size_t i = 0; good && i < json_array_size(value); i++)
    good = json_is_object(json_array_get(value, i));
  if (!good) return cb_json_fail(json, "'%s' must be a list of objects in brackets", f->key);
  *(json_t **)f->value = value;
  return CB_OK;
}

static enum cb_status take(const struct cb_json *json, const struct cb_field *f, json_t *value) {
  switch (f->kind) {
  case CB_FIELD_NUMBER: return take_number(json, f, value, f->value);
  case CB_FIELD_COUNT: return take_count(json, f, value, f->value);
  case CB_FIELD_VECTOR:
  case CB_FIELD_COUNTS: return take_three(json, f, value);
  case CB_FIELD_LIST: return take_list(json, f, value);
  case CB_FIELD_FLAG:
    if (!json_is_boolean(value)) return cb_json_fail(json, "'%s' must be true or false", f->key);
    *(bool *)f->value = json_is_true(value);
    return CB_OK;
  case CB_FIELD_TEXT:
    if (!json_is_string(value)) return cb_json_fail(json, "'%s' must be a text", f->key);
    *(const char **)f->value = json_string_value(value);
    return CB_OK;
  case CB_FIELD_OBJECT:
    if (!json_is_object(value))
      return cb_json_fail(json, "'%s' must be an object in braces", f->key);
    *(json_t **)f->value = value;
    return CB_OK;
  }
  return CB_OK;
}

enum cb_status cb_json_object(struct cb_json *json, const json_t *object,
                              const struct cb_field *fields, size_t count) {
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)object, key, value) {
    size_t i = 0;
    while (i < count && strcmp(fields[i].key, key) != 0) i++;
    if (i == count) return unknown_key(json, key, fields, count);
    cb_json_enter(json, key, 0);
    enum cb_status status = take(json, &fields[i], value);
    if (status) return status;
    cb_json_leave(json);
  }
  for (size_t i = 0; i < count; i++)
    if (fields[i].required && !json_object_get(object, fields[i].key))
      return cb_json_fail(json, "'%s' is missing", fields[i].key);
  return CB_OK;
}
