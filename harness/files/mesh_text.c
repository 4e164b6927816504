/* mesh_text.c - see mesh_text.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/mesh_text.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"

#define BLANKS " \t\r\v\f"

/* *buffer[*size] := the rest of the stream, with one byte to spare. */
static enum cb_status read_whole(FILE *stream, const char *path, char **buffer, size_t *size) {
  size_t capacity = 0;
  for (;;) {
    if (capacity - *size < 2) {
      capacity = capacity ? 2 * capacity : 1 << 16;
      char *larger = realloc(*buffer, capacity);
      if (!larger) return cb_fail_memory(path);
      *buffer = larger;
    }
    size_t got = fread(*buffer + *size, 1, capacity - *size - 1, stream);
    if (ferror(stream)) return cb_fail(CB_IO, "cannot read %s: %s", path, strerror(errno));
    if (got == 0) return CB_OK;
    *size += got;
  }
}

enum cb_status cb_text_open(const char *path, struct cb_text *t) {
  char *buffer = NULL;
  size_t size = 0;
  FILE *stream = fopen(path, "rb");
  if (!stream)
    return cb_fail(CB_IO, "cannot open %s: %s; check the name and the permissions", path,
                   strerror(errno));
  enum cb_status status = read_whole(stream, path, &buffer, &size);
  fclose(stream);
  if (status != CB_OK) {
    free(buffer);
    return status;
  }
  buffer[size] = '\0';
  /* Spreadsheets put a byte order mark first. */
  char *first = buffer + (strncmp(buffer, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0);
  *t = (struct cb_text){.path = path,
                        .at = first,
                        .start = first,
                        .next = first,
                        .end = buffer + size,
                        .buffer = buffer};
  return CB_OK;
}

void cb_text_close(struct cb_text *t) {
  free(t->buffer);
  *t = (struct cb_text){0};
}

bool cb_text_line(struct cb_text *t, char comment) {
  while (t->next < t->end) {
    char *stop = memchr(t->next, '\n', (size_t)(t->end - t->next));
    t->start = t->next;
    t->next = stop ? stop + 1 : t->end;
    t->line++;
    if (!stop) stop = t->end;
    if (comment) {
      char *cut = memchr(t->start, comment, (size_t)(stop - t->start));
      if (cut) stop = cut;
    }
    *stop = '\0';
    t->at = t->start + strspn(t->start, BLANKS);
    if (*t->at) return true;
  }
  t->start = t->at = t->end;
  return false;
}

static bool ends_number(const char *p) { return strchr(BLANKS ",", *p) != NULL; }

bool cb_text_integer(struct cb_text *t, long long *value) {
  char *stop;
  errno = 0;
  long long number = strtoll(t->at, &stop, 10);
  if (stop == t->at || errno || !ends_number(stop)) return false;
  t->at = stop;
  *value = number;
  return true;
}

bool cb_text_real(struct cb_text *t, double *value) {
  char *stop;
  double number = strtod(t->at, &stop);
  if (stop == t->at || !isfinite(number) || !ends_number(stop)) return false;
  t->at = stop;
  *value = number;
  return true;
}

bool cb_text_point(struct cb_text *t, double xyz[3]) {
  return cb_text_real(t, xyz) && cb_text_real(t, xyz + 1) && cb_text_real(t, xyz + 2);
}

bool cb_text_comma(struct cb_text *t) {
  t->at += strspn(t->at, BLANKS);
  if (*t->at != ',') return false;
  t->at++;
  return true;
}

bool cb_text_ended(struct cb_text *t) {
  t->at += strspn(t->at, BLANKS);
  return *t->at == '\0';
}

enum cb_status cb_text_count(struct cb_text *t, const char *what, size_t bytes, size_t *count) {
  long long number;
  if (!cb_text_integer(t, &number) || number < 0)
    return cb_text_expected(t, "the number of %s", what);
  if (number > (long long)UINT32_MAX - 1)
    return cb_text_refuse(t,
                          "%lld %s are more than the %u that can be numbered; use a smaller mesh",
                          number, what, UINT32_MAX - 1);
  /* The last line may do without its line feed. */
  if ((size_t)number > ((size_t)(t->end - t->next) + 1) / bytes)
    return cb_text_refuse(t,
                          "%lld %s are announced, more than the rest of the file can hold; "
                          "it may be truncated: write it again",
                          number, what);
  *count = (size_t)number;
  return CB_OK;
}

/* The line for a message: its first characters, printable. */
static void excerpt(const struct cb_text *t, char text[48]) {
  snprintf(text, 48, "%s", t->start);
  for (size_t n = strlen(text); n > 0 && isspace((unsigned char)text[n - 1]);) text[--n] = '\0';
  for (char *p = text; *p; p++)
    if (!isprint((unsigned char)*p)) *p = '?';
}

enum cb_status cb_text_expected(const struct cb_text *t, const char *format, ...) {
  char expected[256], found[48];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(expected, sizeof expected, format, arguments);
  va_end(arguments);
  if (t->start == t->end)
    return cb_fail(CB_INPUT,
                   "%s, line %zu: expected %s, but the file ends; it may be truncated: write it "
                   "again",
                   t->path, t->line, expected);
  excerpt(t, found);
  return cb_fail(CB_INPUT, "%s, line %zu: expected %s, found \"%s\"; correct the line", t->path,
                 t->line, expected, found);
}

enum cb_status cb_text_refuse(const struct cb_text *t, const char *format, ...) {
  char sentence[512];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(sentence, sizeof sentence, format, arguments);
  va_end(arguments);
  return cb_fail(CB_INPUT, "%s, line %zu: %s", t->path, t->line, sentence);
}
