/* output.h - files that are either whole or absent: written beside their final
 * name, renamed when complete.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_OUTPUT_H
#define CB_OUTPUT_H

#include <stdio.h>

#include "harness/files/table.h"

struct cb_output {
  FILE *stream;    /* write here */
  char path[4096]; /* final name */
  char part[4112]; /* name until committed */
};

/* Make the directory (and its parents) if it is not there. CB_IO, recorded. */
enum cb_status cb_output_directory(const char *path);
/* Open directory/name for writing; directory NULL: name is a path. The directory
 * must exist; 16 outputs may be open at once. Not for several threads. CB_IO. */
enum cb_status cb_output_open(struct cb_output *o, const char *directory, const char *name);
/* Flush, check (disk full is found here), close and rename; on failure the part
 * is removed, the final name untouched, CB_IO recorded. o->stream is NULL after
 * it, in any case. */
enum cb_status cb_output_commit(struct cb_output *o);
/* Close and remove the part; nothing when o->stream is NULL. Also done for every
 * open output when the program exits. */
void cb_output_abandon(struct cb_output *o);
/* Remove the part of every open output, from a signal handler that then ends the
 * program. Async-signal-safe. */
void cb_output_remove_parts(void);
/* directory/name := the table, whole or absent. */
enum cb_status cb_output_table(const char *directory, const char *name, const struct cb_table *t,
                               enum cb_format format);

#endif
