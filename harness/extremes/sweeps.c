/* sweeps.c - every sweep, in the order of the tables: a new one is a file and a line.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/extremes.h"

#define SWEEPS(X)                                                                                  \
  X(regular)                                                                                       \
  X(inverted)                                                                                      \
  X(flat)                                                                                          \
  X(collapsed)                                                                                     \
  X(turned)                                                                                        \
  X(near)                                                                                          \
  X(inversion)                                                                                     \
  X(jumps)                                                                                         \
  X(sliver)                                                                                        \
  X(aspect)                                                                                        \
  X(offset)                                                                                        \
  X(units)                                                                                         \
  X(materials)                                                                                     \
  X(contrast)                                                                                      \
  X(steps)                                                                                         \
  X(breakdown)                                                                                     \
  X(inputs)

#define DECLARE(name) extern const struct cb_sweep cb_sweep_##name;
#define LIST(name) &cb_sweep_##name,
SWEEPS(DECLARE)
const struct cb_sweep *const cb_sweeps[] = {SWEEPS(LIST) NULL};
