/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/error.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char message[1024];

enum cb_status cb_fail(enum cb_status status, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  /* Names out of somebody's file may hold anything, line feeds and escapes to a terminal. */
  for (char *c = message; *c; c++)
    if ((unsigned char)*c < ' ' || *c == '\x7f') *c = '?';
  return status;
}

enum cb_status cb_fail_memory(const char *what) {
  return cb_fail(CB_MEMORY, "not enough memory for %s; use a smaller mesh or free some memory",
                 what);
}

const char *cb_error_message(void) { return message; }

int cb_exit_status(enum cb_status status) {
  switch (status) {
  case CB_OK: return 0;
  case CB_BROKEN: return 1;
  case CB_UNMET: return 3;
  case CB_INTERRUPTED: return 130;
  default: return 2;
  }
}
