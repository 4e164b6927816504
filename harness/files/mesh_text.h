/* mesh_text.h - a text file read whole and walked line by line; for the mesh
 * and position readers only.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_MESH_TEXT_H
#define CB_MESH_TEXT_H

#include "kernels/kernel.h"

struct cb_text {
  const char *path;         /* as given to cb_text_open, not copied */
  size_t line;              /* number of the current line, 1-based; 0 before the first */
  char *at;                 /* what is not yet read of the current line, NUL-terminated */
  char *start, *next, *end; /* the current line, the one after, the end of the file */
  char *buffer;
};

/* Read the file at path into memory; a zeroed text may be closed. CB_IO when it
 * cannot be read, CB_MEMORY, recorded. */
enum cb_status cb_text_open(const char *path, struct cb_text *t);
void cb_text_close(struct cb_text *t);

/* Go to the next line that is not blank, cut at the character `comment` (0: no
 * comments). false at the end of the file. LF and CR LF both end a line. */
bool cb_text_line(struct cb_text *t, char comment);

/* Read the next number of the line; false, *value untouched, when something
 * else stands there, or nothing, or a number out of range or not finite. */
bool cb_text_integer(struct cb_text *t, long long *value);
bool cb_text_real(struct cb_text *t, double *value);
/* Three of them. */
bool cb_text_point(struct cb_text *t, double xyz[3]);
/* Read a comma; is nothing left on the line? */
bool cb_text_comma(struct cb_text *t);
bool cb_text_ended(struct cb_text *t);

/* Read a header's count of `what` ("nodes"), each of which takes `bytes` bytes
 * of the rest of the file at least. CB_INPUT, recorded, for a count that is not
 * one, that does not fit in the file, or above UINT32_MAX - 1. */
enum cb_status cb_text_count(struct cb_text *t, const char *what, size_t bytes, size_t *count);

/* CB_INPUT with "FILE, line N: expected (printf-like), found ...". */
enum cb_status cb_text_expected(const struct cb_text *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* CB_INPUT with "FILE, line N: (printf-like)". */
enum cb_status cb_text_refuse(const struct cb_text *t, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

#endif
