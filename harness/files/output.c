/* output.c - see output.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/files/output.h"

#include <errno.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "harness/error.h"

/* Parts to remove when the program ends before its time. Copies of the names,
 * since a signal may come while a struct cb_output goes out of scope. */
static struct {
  volatile sig_atomic_t open;
  char name[sizeof((struct cb_output *)0)->part];
} parts[16];
enum { PARTS = sizeof parts / sizeof *parts };

void cb_output_remove_parts(void) {
  for (size_t i = 0; i < PARTS; i++)
    if (parts[i].open) unlink(parts[i].name);
}

/* false: all places are taken. */
static bool remember_part(const char *name) {
  static bool registered;
  if (!registered) registered = atexit(cb_output_remove_parts) == 0;
  for (size_t i = 0; i < PARTS; i++)
    if (!parts[i].open) {
      strcpy(parts[i].name, name);
      atomic_signal_fence(memory_order_release); /* the name is there first */
      parts[i].open = 1;
      return true;
    }
  return false;
}

static void forget_part(const char *name) {
  for (size_t i = 0; i < PARTS; i++)
    if (parts[i].open && strcmp(parts[i].name, name) == 0) parts[i].open = 0;
}

static enum cb_status fail_write(const char *path, int reason) {
  return cb_fail(CB_IO, "cannot write %s: %s; free some space or choose another --output", path,
                 reason ? strerror(reason) : "an earlier write failed");
}

enum cb_status cb_output_directory(const char *path) {
  char partial[sizeof((struct cb_output *)0)->path];
  size_t length = strlen(path);
  if (length == 0 || length >= sizeof partial)
    return cb_fail(CB_IO,
                   "a directory name of %zu characters cannot be used; choose another --output",
                   length);
  strcpy(partial, path);
  int reason = 0;
  for (size_t i = 1; i <= length; i++) {
    if (path[i] != '/' && path[i] != '\0') continue;
    partial[i] = '\0';
    if (mkdir(partial, 0777) != 0 && errno != EEXIST && !reason) reason = errno;
    partial[i] = path[i];
  }
  /* What counts is the result: parents may exist where nothing can be made, and
   * the last name may be a file. */
  struct stat found;
  if (stat(path, &found) == 0) reason = S_ISDIR(found.st_mode) ? 0 : ENOTDIR;
  if (reason)
    return cb_fail(CB_IO, "cannot make the directory %s: %s; choose another --output", path,
                   strerror(reason));
  return CB_OK;
}

enum cb_status cb_output_open(struct cb_output *o, const char *directory, const char *name) {
  struct cb_output made;
  int length = directory ? snprintf(made.path, sizeof made.path, "%s/%s", directory, name)
                         : snprintf(made.path, sizeof made.path, "%s", name);
  if (length < 0 || (size_t)length >= sizeof made.path)
    return cb_fail(CB_IO,
                   "the name of the output is longer than %zu characters; choose a shorter "
                   "--output",
                   sizeof made.path - 1);
  snprintf(made.part, sizeof made.part, "%s.part", made.path);
  if (!remember_part(made.part))
    return cb_fail(CB_IO,
                   "cannot write %s: %d outputs are open already; write them one after "
                   "the other",
                   made.path, PARTS);
  made.stream = fopen(made.part, "w");
  if (!made.stream) {
    int reason = errno;
    forget_part(made.part);
    return fail_write(made.path, reason);
  }
  *o = made;
  return CB_OK;
}

enum cb_status cb_output_commit(struct cb_output *o) {
  errno = 0;
  bool good = fflush(o->stream) == 0 && !ferror(o->stream);
  /* A file system that cannot synchronise says EINVAL; that is no loss. */
  good = good && (fsync(fileno(o->stream)) == 0 || errno == EINVAL);
  int reason = errno;
  if (fclose(o->stream) != 0 && good) {
    good = false;
    reason = errno;
  }
  o->stream = NULL;
  if (good && rename(o->part, o->path) != 0) {
    good = false;
    reason = errno;
  }
  if (!good) unlink(o->part);
  forget_part(o->part);
  return good ? CB_OK : fail_write(o->path, reason);
}

void cb_output_abandon(struct cb_output *o) {
  if (!o->stream) return;
  fclose(o->stream);
  o->stream = NULL;
  unlink(o->part);
  forget_part(o->part);
}

enum cb_status cb_output_table(const char *directory, const char *name, const struct cb_table *t,
                               enum cb_format format) {
  struct cb_output o;
  enum cb_status status = cb_output_open(&o, directory, name);
  if (status != CB_OK) return status;
  status = cb_table_print(t, format, o.stream);
  if (status == CB_OK) return cb_output_commit(&o);

  char reason[512];
  snprintf(reason, sizeof reason, "%s", cb_error_message());
  cb_output_abandon(&o);
  return cb_fail(status, "%s: %s", o.path, reason);
}
