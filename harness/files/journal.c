/* journal.c - see journal.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/journal.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

#include "harness/error.h"
#include "harness/measure/environment.h"

struct cb_journal {
  char path[4096];
  int fd;
  off_t end; /* of the last whole line */
  size_t session, added;
  bool done;
  json_t *found; /* key to {"key", "session", "row"} of earlier sessions */
  json_t *keys;  /* added in this one: a set */
};

static enum cb_status fail_io(const struct cb_journal *j, const char *what) {
  return cb_fail(CB_IO, "cannot %s %s: %s; free some space or choose another --output", what,
                 j->path, strerror(errno));
}

/* ---- lines ------------------------------------------------------------------------------- */

/* One write(2), or none of it. */
static enum cb_status write_line(struct cb_journal *j, json_t *object) {
  errno = 0;
  char *text = object ? json_dumps(object, JSON_COMPACT | JSON_REAL_PRECISION(17)) : NULL;
  json_decref(object);
  const size_t length = text ? strlen(text) : 0;
  char *line = text ? realloc(text, length + 2) : NULL;
  if (!line) {
    free(text);
    return cb_fail_memory("a finished row");
  }
  memcpy(line + length, "\n", 2);
  const ssize_t written = pwrite(j->fd, line, length + 1, j->end);
  free(line);
  if (written == (ssize_t)length + 1) {
    j->end += written;
    return CB_OK;
  }
  if (written >= 0) errno = ENOSPC;
  const enum cb_status status = fail_io(j, "write");
  if (ftruncate(j->fd, j->end) != 0) return status; /* half a line is no row, either */
  return status;
}

/* Whose the rows are. JSON has no place for the bytes that a file's name may have. */
static json_t *header(const char *name, const char *options) {
  struct cb_environment e;
  char machine[256], compiler[512], plain[4096];
  snprintf(plain, sizeof plain, "%s", options);
  for (char *c = plain; *c; c++)
    if ((unsigned char)*c < ' ' || (unsigned char)*c > '~') *c = '?';
  cb_environment_read(&e);
  snprintf(machine, sizeof machine, "%s, %zu cores, %s", e.cpu, e.cores, e.kernel);
  snprintf(compiler, sizeof compiler, "%s %s", e.compiler, e.flags);
  return json_pack("{s:s, s:s, s:s, s:s, s:s}", "journal", name, "commit", e.commit, "compiler",
                   compiler, "machine", machine, "options", plain);
}

static enum cb_status refuse_line(const struct cb_journal *j, size_t line) {
  return cb_fail(CB_INPUT,
                 "%s, line %zu: this is no line of a journal; start anew without --resume", j->path,
                 line);
}

static enum cb_status compare_headers(const struct cb_journal *j, const json_t *theirs,
                                      const json_t *ours) {
  const char *key;
  json_t *value;
  json_object_foreach((json_t *)ours, key, value) {
    const char *own = json_string_value(value);
    const char *other = json_string_value(json_object_get(theirs, key));
    if (!other) return refuse_line(j, 1);
    if (strcmp(own, other) != 0)
      return cb_fail(CB_INPUT,
                     "the rows in %s have another %s, '%.200s' and not '%.200s', and cannot be "
                     "joined; go on with that, or start anew without --resume",
                     j->path, key, other, own);
  }
  return CB_OK;
}

/* One row of an earlier session. */
static enum cb_status keep_row(struct cb_journal *j, json_t *object, size_t line) {
  const char *key = json_string_value(json_object_get(object, "key"));
  const json_t *session = json_object_get(object, "session");
  const json_int_t n = json_integer_value(session);
  if (!key || n < 1 || n > 1000000 || !json_object_get(object, "row") ||
      json_object_get(j->found, key))
    return refuse_line(j, line);
  if ((size_t)n >= j->session) j->session = (size_t)n + 1;
  return json_object_set(j->found, key, object) == 0 ? CB_OK : cb_fail_memory("the finished rows");
}

/* A whole line, without its line feed. */
static enum cb_status take_line(struct cb_journal *j, const char *text, size_t length, size_t line,
                                const json_t *ours) {
  errno = 0;
  json_t *object = json_loadb(text, length, JSON_REJECT_DUPLICATES, NULL);
  const bool starved = !object && errno == ENOMEM;
  enum cb_status status = starved     ? cb_fail_memory("the finished rows")
                          : !object   ? refuse_line(j, line)
                          : line == 1 ? compare_headers(j, object, ours)
                                      : keep_row(j, object, line);
  json_decref(object);
  return status;
}

static enum cb_status read_lines(struct cb_journal *j, const json_t *ours) {
  char *text = NULL;
  size_t room = 0;
  const int copy = dup(j->fd);
  FILE *stream = copy < 0 ? NULL : fdopen(copy, "r");
  if (!stream) {
    if (copy >= 0) close(copy);
    return fail_io(j, "read");
  }
  enum cb_status status = CB_OK;
  ssize_t length = 0;
  errno = 0;
  for (size_t line = 1; !status && (length = getline(&text, &room, stream)) > 0; line++) {
    if (text[length - 1] != '\n') break; /* it was killed in the midst of it */
    status = take_line(j, text, (size_t)length - 1, line, ours);
    j->end += length;
    errno = 0;
  }
  if (!status && length < 0 && (errno || ferror(stream))) status = fail_io(j, "read");
  free(text);
  fclose(stream);
  return status;
}

/* ---- the whole ------------------------------------------------------------------------------ */

/* Nobody else writes there as long as it is open. */
static enum cb_status open_file(struct cb_journal *j, const char *directory, const char *name) {
  const int length = snprintf(j->path, sizeof j->path, "%s/%s.unfinished", directory, name);
  if (length < 0 || (size_t)length >= sizeof j->path)
    return cb_fail(CB_IO, "the name of the output is too long; choose a shorter --output");
  j->fd = open(j->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (j->fd < 0) return fail_io(j, "write");
  if (flock(j->fd, LOCK_EX | LOCK_NB) == 0) return CB_OK;
  return cb_fail(CB_INPUT, "another run is writing %s; wait for it or choose another --output",
                 j->path);
}

static enum cb_status begin(struct cb_journal *j, json_t *ours, bool resume) {
  enum cb_status status = resume ? read_lines(j, ours) : CB_OK;
  if (status) return status;
  if (ftruncate(j->fd, j->end) != 0) return fail_io(j, "write");
  return j->end > 0 ? CB_OK : write_line(j, json_incref(ours));
}

static void free_journal(struct cb_journal *j) {
  if (j->fd >= 0) close(j->fd);
  json_decref(j->found);
  json_decref(j->keys);
  free(j);
}

enum cb_status cb_journal_open(const char *directory, const char *name, const char *options,
                               bool resume, struct cb_journal **out) {
  struct cb_journal *j = calloc(1, sizeof *j);
  if (!j) return cb_fail_memory("the finished rows");
  j->fd = -1;
  j->session = 1;
  j->found = json_object();
  j->keys = json_object();
  json_t *ours = header(name, options);
  enum cb_status status = j->found && j->keys && ours ? CB_OK : cb_fail_memory("the finished rows");
  if (!status) status = open_file(j, directory, name);
  if (!status) status = begin(j, ours, resume);
  json_decref(ours);
  if (status)
    free_journal(j);
  else
    *out = j;
  return status;
}

size_t cb_journal_session(const struct cb_journal *j) { return j->session; }

const json_t *cb_journal_row(const struct cb_journal *j, const char *key, size_t *session) {
  const json_t *line = json_object_get(j->found, key);
  if (line && session) *session = (size_t)json_integer_value(json_object_get(line, "session"));
  return json_object_get(line, "row");
}

enum cb_status cb_journal_add(struct cb_journal *j, const char *key, json_t *row) {
  if (!row) return cb_fail_memory("a finished row");
  if (json_object_get(j->found, key) || json_object_get(j->keys, key)) {
    json_decref(row);
    return cb_fail(CB_BROKEN, "two finished rows are called '%s'", key);
  }
  if (json_object_set_new(j->keys, key, json_true()) != 0) {
    json_decref(row);
    return cb_fail_memory("a finished row");
  }
  const enum cb_status status = write_line(
      j, json_pack("{s:s, s:I, s:o}", "key", key, "session", (json_int_t)j->session, "row", row));
  j->added += !status;
  return status;
}

void cb_journal_done(struct cb_journal *j) {
  j->done = true;
  unlink(j->path);
}

enum cb_status cb_journal_close(struct cb_journal *j, enum cb_status status) {
  if (!j) return status;
  const size_t rows = json_object_size(j->found) + j->added;
  if (!j->done && rows == 0) unlink(j->path);
  if (!j->done && rows > 0 && status) {
    char reason[512];
    snprintf(reason, sizeof reason, "%s", cb_error_message());
    cb_fail(status, "%s; %zu finished part%s %s kept in %s: the same command with --resume goes on",
            reason, rows, rows == 1 ? "" : "s", rows == 1 ? "is" : "are", j->path);
  }
  free_journal(j);
  return status;
}

/* ---- helpers ----------------------------------------------------------------------------------
 */

json_t *cb_journal_number(double value) {
  if (isnan(value)) return json_null();
  return isinf(value) ? json_string(value > 0 ? "inf" : "-inf") : json_real(value);
}

bool cb_journal_to_number(const json_t *json, double *value) {
  if (json_is_number(json))
    *value = json_number_value(json);
  else if (json_is_null(json))
    *value = NAN;
  else if (json_is_string(json))
    *value = json_string_value(json)[0] == '-' ? -INFINITY : INFINITY;
  else
    return false;
  return true;
}

/* Fowler, Noll, Vo: FNV-1a. */
uint64_t cb_journal_digest(const char *path) {
  FILE *file = fopen(path, "rb");
  uint64_t digest = UINT64_C(14695981039346656037);
  if (!file) return 0;
  for (int c; (c = getc(file)) != EOF;) digest = (digest ^ (unsigned)c) * UINT64_C(1099511628211);
  fclose(file);
  return digest;
}
