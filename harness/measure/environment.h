/* environment.h - what a timing depends on besides the code. Neither the host's
 * name nor any path is ever recorded.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ENVIRONMENT_H
#define CB_ENVIRONMENT_H

#include <jansson.h>

#include "kernels/kernel.h"

struct cb_cache {
  unsigned level, sharing; /* sharing: how many cores have it in common */
  char type[16];           /* Data, Instruction, Unified */
  double bytes;
};

struct cb_environment {
  char cpu[128];     /* "unknown" where the system does not tell, here and below */
  size_t cores;      /* that this process may use */
  double mhz;        /* when asked; 0: unknown */
  double memory;     /* bytes in the machine */
  char governor[32]; /* CPU frequency policy */
  char kernel[64];   /* operating system and its version */
  char compiler[128], flags[256], commit[64];
  char date[32];  /* UTC, ISO 8601 */
  size_t threads; /* that the kernels use */
  size_t cache_count;
  struct cb_cache caches[8]; /* of the first core */
};

/* Cannot fail: what is not there is "unknown" or 0. */
void cb_environment_read(struct cb_environment *e);

/* Google Benchmark's "context" object without the host and the executable, and
 * with what that schema lacks. New reference, NULL when out of memory. */
json_t *cb_environment_json(const struct cb_environment *e);

/* "CPU, n cores | compiler flags | commit | date", for the foot of plots and
 * tables, cut to line[size]. */
void cb_environment_line(const struct cb_environment *e, size_t size, char *line);
/* directory/name := that line, of now. CB_IO, recorded. */
enum cb_status cb_environment_footer(const char *directory, const char *name);

#endif
