/* fuzz.h - what the fuzz targets share: the bytes as a file, and what a reader owes.
 *
 * A target defines LLVMFuzzerTestOneInput and is linked with -fsanitize=fuzzer; a crash,
 * a leak, a report of a sanitizer or a broken promise ends it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FUZZ_H
#define CB_FUZZ_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "harness/error.h"
#include "harness/measure/environment.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Stands for the function without the prefix (Makefile): the machine need not be asked for its
 * properties a thousand times a second. */
void __wrap_cb_environment_read(struct cb_environment *e);
void __wrap_cb_environment_read(struct cb_environment *e) {
  *e = (struct cb_environment){.cpu = "fuzzed", .cores = 1};
}

static inline void fuzz_require(int kept, const char *promise) {
  if (kept) return;
  fprintf(stderr, "fuzz: %s; the reader says: %s\n", promise, cb_error_message());
  abort();
}

/* A file that lives in memory, under a path with the ending that a reader goes by. */
struct fuzz_file {
  int fd;
  char path[64];
};

static inline void fuzz_open(struct fuzz_file *f, const char *folder, const char *name) {
  char target[32];
  f->fd = memfd_create(name, 0);
  snprintf(target, sizeof target, "/proc/self/fd/%d", f->fd);
  snprintf(f->path, sizeof f->path, "%s/%s", folder, name);
  fuzz_require(f->fd >= 0 && symlink(target, f->path) == 0, "no file can be made");
}

static inline void fuzz_write(const struct fuzz_file *f, const uint8_t *data, size_t size) {
  fuzz_require(ftruncate(f->fd, 0) == 0 && pwrite(f->fd, data, size, 0) == (ssize_t)size,
               "the input cannot be written");
}

/* A folder for the links, emptied when the program ends as it should. */
static char fuzz_folder_path[] = "/tmp/fuzz-XXXXXX";
static const char *fuzz_names[4];

static void fuzz_clean(void) {
  char path[64];
  for (size_t i = 0; i < 4 && fuzz_names[i]; i++) {
    snprintf(path, sizeof path, "%s/%s", fuzz_folder_path, fuzz_names[i]);
    unlink(path);
  }
  rmdir(fuzz_folder_path);
}

/* files[i] := a file of names[i], at most 4 of them; once a program. */
static inline void fuzz_files(size_t count, const char *const *names, struct fuzz_file *files) {
  fuzz_require(mkdtemp(fuzz_folder_path) != NULL, "no folder can be made");
  for (size_t i = 0; i < count; i++) {
    fuzz_names[i] = names[i];
    fuzz_open(&files[i], fuzz_folder_path, names[i]);
  }
  atexit(fuzz_clean);
}

/* What every reader owes: success, or a recorded sentence that names the file. */
static inline void fuzz_check(enum cb_status status, const char *folder_or_path) {
  if (status == CB_OK) return;
  fuzz_require(status == CB_INPUT || status == CB_MEMORY, "an input is unusable, not a failure");
  fuzz_require(cb_error_message()[0] != '\0', "a refusal has a sentence");
  fuzz_require(status == CB_MEMORY || strstr(cb_error_message(), folder_or_path) != NULL,
               "the sentence names the file");
  fuzz_require(strchr(cb_error_message(), '\n') == NULL, "the sentence is one line");
}

#endif
