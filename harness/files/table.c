/* table.c - see table.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/table.h"

#include <assert.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"

enum kind { TEXT, INTEGER, NUMBER, MISSING };

struct cell {
  enum kind kind;
  union {
    char *text;
    long long integer;
    double number;
  };
};

struct cb_table {
  char *names; /* the columns' names, each NUL-terminated, and where each begins */
  const char **name;
  size_t columns, count, capacity; /* count: cells */
  struct cell *cell;
  bool lost; /* a cell, for want of memory */
};

struct cb_table *cb_table_create(const char *columns) {
  struct cb_table *t = calloc(1, sizeof *t);
  if (!t) return NULL;
  t->columns = 1;
  for (const char *p = columns; *p; p++) t->columns += *p == ',';
  t->names = strdup(columns);
  t->name = calloc(t->columns, sizeof *t->name);
  if (!t->names || !t->name) {
    cb_table_free(t);
    return NULL;
  }
  char *rest = t->names;
  for (size_t i = 0; i < t->columns; i++) t->name[i] = strsep(&rest, ",");
  return t;
}

void cb_table_free(struct cb_table *t) {
  if (!t) return;
  for (size_t i = 0; i < t->count; i++)
    if (t->cell[i].kind == TEXT) free(t->cell[i].text);
  free(t->cell);
  free(t->name);
  free(t->names);
  free(t);
}

static void append(struct cb_table *t, struct cell cell) {
  if (t->count == t->capacity) {
    size_t capacity = t->capacity ? 2 * t->capacity : 64;
    struct cell *larger = reallocarray(t->cell, capacity, sizeof *larger);
    if (!larger) {
      t->lost = true;
      if (cell.kind == TEXT) free(cell.text);
      return;
    }
    t->cell = larger;
    t->capacity = capacity;
  }
  t->cell[t->count++] = cell;
}

void cb_table_text(struct cb_table *t, const char *text) {
  char *copy = strdup(text);
  if (copy)
    append(t, (struct cell){.kind = TEXT, .text = copy});
  else
    t->lost = true;
}

void cb_table_integer(struct cb_table *t, long long value) {
  append(t, (struct cell){.kind = INTEGER, .integer = value});
}

void cb_table_number(struct cb_table *t, double value) {
  append(t, (struct cell){.kind = NUMBER, .number = value});
}

void cb_table_missing(struct cb_table *t) { append(t, (struct cell){.kind = MISSING}); }

size_t cb_table_rows(const struct cb_table *t) { return t->count / t->columns; }

bool cb_table_is_empty(const struct cb_table *t) { return t->count == 0 && !t->lost; }

/* The cell as written: its own text, or made in buffer. */
static const char *cell_text(const struct cell *cell, int digits, const char *missing,
                             char buffer[32]) {
  switch (cell->kind) {
  case TEXT: return cell->text;
  case MISSING: return missing;
  case INTEGER: snprintf(buffer, 32, "%lld", cell->integer); break;
  case NUMBER:
    if (isnan(cell->number)) return "nan"; /* printf may show its sign */
    snprintf(buffer, 32, "%.*g", digits, cell->number);
  }
  return buffer;
}

/* ---- aligned text ---------------------------------------------------------- */

/* Columns taken on a terminal by UTF-8 text. */
static size_t text_width(const char *text) {
  size_t width = 0;
  for (; *text; text++) width += (*text & 0xC0) != 0x80;
  return width;
}

static void put_repeated(char c, size_t count, FILE *stream) {
  while (count-- > 0) putc(c, stream);
}

static void put_aligned(const char *text, size_t width, bool right, bool last, FILE *stream) {
  size_t blanks = width - text_width(text);
  if (right) put_repeated(' ', blanks, stream);
  fputs(text, stream);
  if (!right && !last) put_repeated(' ', blanks, stream);
  fputs(last ? "\n" : "  ", stream);
}

static enum cb_status print_aligned(const struct cb_table *t, FILE *stream) {
  char buffer[32];
  size_t *width = calloc(t->columns, sizeof *width);
  bool *right = calloc(t->columns, sizeof *right); /* a column without text */
  if (!width || !right) {
    free(width);
    free(right);
    return cb_fail_memory("the table");
  }
  for (size_t i = 0; i < t->columns; i++) {
    width[i] = text_width(t->name[i]);
    right[i] = true;
  }
  for (size_t i = 0; i < t->count; i++) {
    size_t w = text_width(cell_text(t->cell + i, 4, "-", buffer)), c = i % t->columns;
    if (w > width[c]) width[c] = w;
    if (t->cell[i].kind == TEXT) right[c] = false;
  }

  for (size_t i = 0; i < t->columns; i++)
    put_aligned(t->name[i], width[i], right[i], i + 1 == t->columns, stream);
  for (size_t i = 0; i < t->columns; i++) {
    put_repeated('-', width[i], stream);
    fputs(i + 1 == t->columns ? "\n" : "  ", stream);
  }
  for (size_t i = 0; i < t->count; i++) {
    size_t c = i % t->columns;
    put_aligned(cell_text(t->cell + i, 4, "-", buffer), width[c], right[c], c + 1 == t->columns,
                stream);
  }
  free(width);
  free(right);
  return CB_OK;
}

/* ---- CSV ------------------------------------------------------------------- */

static void put_csv(const char *text, bool last, FILE *stream) {
  if (strpbrk(text, ",\"\r\n")) {
    putc('"', stream);
    for (; *text; text++) {
      if (*text == '"') putc('"', stream);
      putc(*text, stream);
    }
    putc('"', stream);
  } else {
    fputs(text, stream);
  }
  putc(last ? '\n' : ',', stream);
}

static void print_csv(const struct cb_table *t, FILE *stream) {
  char buffer[32];
  for (size_t i = 0; i < t->columns; i++) put_csv(t->name[i], i + 1 == t->columns, stream);
  for (size_t i = 0; i < t->count; i++)
    put_csv(cell_text(t->cell + i, 17, "", buffer), (i + 1) % t->columns == 0, stream);
}

/* ---- JSON ------------------------------------------------------------------ */

/* NULL when out of memory or when the text is not UTF-8. */
static json_t *cell_json(const struct cell *cell) {
  switch (cell->kind) {
  case TEXT: return json_string(cell->text);
  case INTEGER: return json_integer(cell->integer);
  case NUMBER: return isfinite(cell->number) ? json_real(cell->number) : json_null();
  case MISSING: break;
  }
  return json_null();
}

/* Write one row. jansson says that it failed, and errno of what: a full disk is found when the
 * stream is flushed. */
static enum cb_status print_row(const struct cb_table *t, size_t row, FILE *stream) {
  errno = 0;
  json_t *object = json_object();
  bool made = object != NULL;
  for (size_t c = 0; made && c < t->columns; c++)
    made = json_object_set_new(object, t->name[c], cell_json(t->cell + row * t->columns + c)) == 0;
  const bool starved = !made && errno == ENOMEM;
  const size_t flags = JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(17);
  const bool lost = made && json_dumpf(object, stream, flags) != 0 && !ferror(stream);
  json_decref(object);
  if (starved || lost) return cb_fail_memory("the table");
  if (made) return CB_OK;
  return cb_fail(CB_INPUT,
                 "row %zu of the table cannot be written as JSON, its text is not UTF-8; "
                 "choose --format csv",
                 row + 1);
}

/* Row by row, so that a long table is not held twice. */
static enum cb_status print_json(const struct cb_table *t, FILE *stream) {
  enum cb_status status = CB_OK;
  fputs("[", stream);
  for (size_t row = 0; !status && row < cb_table_rows(t); row++) {
    fputs(row ? ",\n " : "\n ", stream);
    status = print_row(t, row, stream);
  }
  fputs("\n]\n", stream);
  return status;
}

enum cb_status cb_table_print(const struct cb_table *t, enum cb_format format, FILE *stream) {
  if (t->lost) return cb_fail_memory("the table");
  assert(t->count % t->columns == 0);
  enum cb_status status = CB_OK;
  errno = 0;
  switch (format) {
  case CB_TABLE: status = print_aligned(t, stream); break;
  case CB_CSV: print_csv(t, stream); break;
  case CB_JSON: status = print_json(t, stream); break;
  }
  if (status != CB_OK) return status;
  if (fflush(stream) != 0 || ferror(stream))
    return cb_fail(CB_IO, "cannot write the table: %s; free some space or choose another --output",
                   errno ? strerror(errno) : "an earlier write failed");
  return CB_OK;
}
