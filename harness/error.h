/* error.h - one sentence per failure: recorded once where it happens, printed
 * only by main.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ERROR_H
#define CB_ERROR_H

#include "kernels/kernel.h"

/* Record "what, where, remedy" (printf-like) and return status, so that a
 * failing function ends with `return cb_fail(CB_INPUT, ...)`. A later call
 * replaces the message. Control characters become '?': the sentence is one line.
 * status must not be CB_OK. */
enum cb_status cb_fail(enum cb_status status, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* cb_fail(CB_MEMORY, ...) in the usual words; what: "the mesh", "the samples". */
enum cb_status cb_fail_memory(const char *what);

/* The last recorded sentence, without a newline; "" if none. */
const char *cb_error_message(void);

/* What main exits with: 0 for CB_OK, 1 for CB_BROKEN, 3 for CB_UNMET, 130 for
 * CB_INTERRUPTED, otherwise 2. */
int cb_exit_status(enum cb_status status);

#endif
