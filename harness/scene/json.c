/* json.c - see json.h. Jansson reads the file and knows the lines of syntax errors; those of
 * values are found by lines.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/json.h"

#include <errno.h>
#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/nearest.h"

enum cb_status cb_json_fail(const struct cb_json *json, const char *format, ...) {
  char sentence[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  return cb_fail(CB_INPUT, "%s:%zu: %s", json->path, cb_json_line(json->text, json->place),
                 sentence);
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

/* json->text has been read. */
static enum cb_status load(struct cb_json *json) {
  json_error_t error;
  errno = 0;
  json->root = json_loads(json->text, JSON_REJECT_DUPLICATES, &error);
  /* Jansson would call it a syntax error. */
  if (!json->root && errno == ENOMEM) return cb_fail_memory("the scene file");
  if (!json->root)
    return cb_fail(CB_INPUT, "%s:%d: %s; a scene is a JSON object", json->path, error.line,
                   error.text);
  if (!json_is_object(json->root)) return cb_json_fail(json, "a scene must be a JSON object");
  return CB_OK;
}

enum cb_status cb_json_open(const char *path, struct cb_json *json) {
  *json = (struct cb_json){.path = path};
  enum cb_status status = read_text(path, &json->text);
  return status ? status : load(json);
}

enum cb_status cb_json_parse(const char *path, const char *text, struct cb_json *json) {
  *json = (struct cb_json){.path = path, .text = strdup(text)};
  return json->text ? load(json) : cb_fail_memory("the scene");
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

/* What stands there: "'force_n' is a list of 2". */
static enum cb_status refuse(const struct cb_json *json, const struct cb_field *f,
                             const json_t *value, const char *expected) {
  char found[64] = "null";
  if (json_is_number(value)) snprintf(found, sizeof found, "%g", json_number_value(value));
  if (json_is_string(value)) snprintf(found, sizeof found, "a text");
  if (json_is_object(value)) snprintf(found, sizeof found, "an object");
  if (json_is_boolean(value)) snprintf(found, sizeof found, json_is_true(value) ? "true" : "false");
  if (json_is_array(value)) snprintf(found, sizeof found, "a list of %zu", json_array_size(value));
  return cb_json_fail(json, "'%s' is %s; it must be %s", f->key, found, expected);
}

static enum cb_status take_number(const struct cb_json *json, const struct cb_field *f,
                                  const json_t *value, double *number) {
  char range[64];
  if (!json_is_number(value)) return refuse(json, f, value, "a number");
  const double n = json_number_value(value);
  if (n >= f->low && n <= f->high) {
    *number = n;
    return CB_OK;
  }
  if (f->high < DBL_MAX)
    snprintf(range, sizeof range, "from %g to %g", f->low, f->high);
  else if (f->low == DBL_MIN)
    snprintf(range, sizeof range, "above 0");
  else
    snprintf(range, sizeof range, "at least %g", f->low);
  return refuse(json, f, value, range);
}

static enum cb_status take_count(const struct cb_json *json, const struct cb_field *f,
                                 const json_t *value, size_t *count) {
  if (!json_is_integer(value)) return refuse(json, f, value, "a whole number");
  double number = 0;
  enum cb_status status = take_number(json, f, value, &number);
  if (!status) *count = (size_t)number;
  return status;
}

static enum cb_status take_three(const struct cb_json *json, const struct cb_field *f,
                                 const json_t *value) {
  if (!json_is_array(value) || json_array_size(value) != 3)
    return refuse(json, f, value, "three numbers in brackets");
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
  static const char *const EXPECTED = "a list of objects in brackets";
  if (!json_is_array(value)) return refuse(json, f, value, EXPECTED);
  for (size_t i = 0; i < json_array_size(value); i++)
    if (!json_is_object(json_array_get(value, i)))
      return cb_json_fail(json, "entry %zu of '%s' is no object; '%s' must be %s", i + 1, f->key,
                          f->key, EXPECTED);
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
    if (!json_is_boolean(value)) return refuse(json, f, value, "true or false");
    *(bool *)f->value = json_is_true(value);
    return CB_OK;
  case CB_FIELD_TEXT:
    if (!json_is_string(value)) return refuse(json, f, value, "a text");
    *(const char **)f->value = json_string_value(value);
    return CB_OK;
  case CB_FIELD_OBJECT:
    if (!json_is_object(value)) return refuse(json, f, value, "an object in braces");
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

enum cb_status cb_json_member(struct cb_json *json, const char *key, const json_t *object,
                              const struct cb_field *fields, size_t count) {
  cb_json_enter(json, key, 0);
  enum cb_status status = cb_json_object(json, object, fields, count);
  if (!status) cb_json_leave(json);
  return status;
}
