/* machine.h - what this machine can do at most: arithmetic in registers, bandwidth
 * of each level of memory, and the roofline over both; and how long threads take to
 * meet.
 *
 * Source: roofline, Williams, Waterman & Patterson 2009; triad, McCalpin 1995.
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_MACHINE_H
#define CB_MACHINE_H

#include "harness/files/table.h"
#include "harness/measure/environment.h"
#include "harness/measure/loops.h"
#include "harness/measure/statistics.h"

enum cb_level { CB_L1, CB_L2, CB_L3, CB_DRAM, CB_LEVELS };
extern const char *const cb_level_name[CB_LEVELS];
extern const char *const cb_scalar_name[CB_SCALARS];

/* On one thread, and on one for each processor that the process may use (the same
 * measurement when that is one). */
enum cb_crew { CB_ONE, CB_ALL, CB_CREWS };

/* NaN: an instruction set or cache, or a second processor, that is not there. */
struct cb_machine {
  size_t threads[CB_CREWS];
  struct cb_interval peak[CB_LOOP_SETS][CB_SCALARS][CB_CREWS]; /* flop/s; FMA = 2 flops */
  struct cb_interval read[CB_LEVELS][CB_CREWS];                /* B/s read */
  struct cb_interval triad[CB_LEVELS][CB_CREWS];               /* B/s read and written */
  struct cb_interval barrier;              /* s, of threads[CB_ALL], at most CB_TEAM_MOST */
  size_t bytes[CB_LEVELS][CB_CREWS];       /* working set of all threads together; 0: not there */
  size_t measurements, unstable;           /* how many, and of these by cb_scatter_stable */
  const char *vectors;                     /* instruction set of read and triad */
  double peak_flops[CB_SCALARS][CB_CREWS]; /* flop/s of the best instruction set */
  double bandwidth[CB_LEVELS][CB_CREWS];   /* B/s, the better of read and triad */
};

/* Measure, in about 5 s; progress (may be NULL) is told the share that is done. DRAM is measured on
 * up to 512 MB, a quarter of the memory at most; where the last cache is larger than that, its
 * figure is partly that cache's. CB_MEMORY, CB_INTERRUPTED; recorded. */
enum cb_status cb_machine_measure(void (*progress)(void *context, double share, const char *what),
                                  void *context, struct cb_machine *m);
/* Every rate as a row, Gflop/s and GB/s, and the barrier, ns, with these columns. NULL: out of
 * memory. */
#define CB_MACHINE_COLUMNS "quantity,instruction_set,threads,value,low,high,unit,working_set_bytes"
struct cb_table *cb_machine_table(const struct cb_machine *m);

/* Where a working set of that many bytes, shared out among so many threads on cores
 * of their own, is kept: the smallest cache that holds it. */
enum cb_level cb_machine_level(const struct cb_environment *e, double bytes, size_t threads);

/* flop/s that work of so many flops and bytes, the bytes coming from that level,
 * can reach: the peak or bandwidth times flops / bytes, whichever is less. */
double cb_machine_attainable(const struct cb_machine *m, double flops, double bytes,
                             enum cb_level level, enum cb_crew crew, enum cb_scalar scalar);

#endif
