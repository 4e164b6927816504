/* json.h - objects of a JSON file read strictly, field by field: an unknown key,
 * a missing one, a value of another type or out of range becomes one sentence
 * with file and line.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SCENE_JSON_H
#define CB_SCENE_JSON_H

#include <jansson.h>

#include "kernels/kernel.h"

/* A file being read, and where in it: "loads/1/force_n". */
struct cb_json {
  const char *path;
  char *text;
  json_t *root;
  char place[256];
};

/* CB_INPUT for a syntax error, a repeated key, a file that is no object; CB_IO,
 * CB_MEMORY. Close with cb_json_close, after a failure as well. */
enum cb_status cb_json_open(const char *path, struct cb_json *json);
/* The same of a text, which is copied; path: its name in messages. */
enum cb_status cb_json_parse(const char *path, const char *text, struct cb_json *json);
void cb_json_close(struct cb_json *json);

enum cb_field_kind {
  CB_FIELD_NUMBER, /* double */
  CB_FIELD_VECTOR, /* double[3] */
  CB_FIELD_COUNT,  /* size_t */
  CB_FIELD_COUNTS, /* size_t[3] */
  CB_FIELD_FLAG,   /* bool */
  CB_FIELD_TEXT,   /* const char *, valid while the file is open */
  CB_FIELD_OBJECT, /* json_t *, not owned */
  CB_FIELD_LIST    /* json_t *, an array of objects, not owned */
};
struct cb_field {
  const char *key;
  enum cb_field_kind kind;
  void *value;      /* untouched if the key is absent */
  double low, high; /* of every number; both included; DBL_MIN: above 0 */
  bool required;
};
/* Every key of the object must be among the fields. */
enum cb_status cb_json_object(struct cb_json *json, const json_t *object,
                              const struct cb_field *fields, size_t count);
/* The same of an object that is the member `key` of where the reader is. */
enum cb_status cb_json_member(struct cb_json *json, const char *key, const json_t *object,
                              const struct cb_field *fields, size_t count);
/* Go into a member (key, or with key NULL the index) of where the reader is, and
 * out again: for the place that is named in messages. */
void cb_json_enter(struct cb_json *json, const char *key, size_t index);
void cb_json_leave(struct cb_json *json);
/* Record "path:line: <sentence>", line of where the reader is; CB_INPUT. */
enum cb_status cb_json_fail(const struct cb_json *json, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Line, from 1, of the deepest part of the place ("loads/1/force_n") that is in the text,
 * which is valid JSON: jansson keeps no lines of values. A key is found as it is spelt. */
size_t cb_json_line(const char *text, const char *place);

#endif
