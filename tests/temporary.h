/* temporary.h - a directory of its own for each test program.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TEMPORARY_H
#define CB_TEMPORARY_H

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char temporary[] = "/tmp/corobench-XXXXXX";

/* For cmocka_run_group_tests; 0 on success. */
static int temporary_make(void **state) {
  (void)state;
  return mkdtemp(temporary) ? 0 : -1;
}

static int temporary_remove_one(const char *path, const struct stat *s, int kind, struct FTW *f) {
  (void)s, (void)kind, (void)f;
  return remove(path);
}

static int temporary_remove(void **state) {
  (void)state;
  return nftw(temporary, temporary_remove_one, 8, FTW_DEPTH | FTW_PHYS);
}

/* The path of a name in the directory; valid until the fourth call after. */
static const char *temporary_path(const char *name) {
  static char paths[4][256];
  static size_t next;
  char *path = paths[next++ % 4];
  snprintf(path, sizeof paths[0], "%s/%s", temporary, name);
  return path;
}

#endif
