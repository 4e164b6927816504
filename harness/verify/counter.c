/* counter.c - see counter.h. Quad operations are calls into the compiler's
 * runtime: __addtf3, __subtf3, __multf3, __divtf3, and sqrtq.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/counter.h"

#include <string.h>

typedef __float128 quad;

static _Thread_local struct cb_counts total[STAGES];
static _Thread_local int current = STAGE_SCATTER;

#define COUNTED(result, name, arguments, call, field)                                              \
  result __real_##name arguments;                                                                  \
  result __wrap_##name arguments;                                                                  \
  result __wrap_##name arguments {                                                                 \
    total[current].field++;                                                                        \
    return __real_##name call;                                                                     \
  }
COUNTED(quad, __addtf3, (quad a, quad b), (a, b), add)
COUNTED(quad, __subtf3, (quad a, quad b), (a, b), add)
COUNTED(quad, __multf3, (quad a, quad b), (a, b), mul)
COUNTED(quad, __divtf3, (quad a, quad b), (a, b), div)
COUNTED(quad, sqrtq, (quad a), (a), sqrt)

void cb_counter_stage(int stage) { current = stage; }

void cb_counter_reset(void) { memset(total, 0, sizeof total); }

void cb_counter_read(struct cb_counts *counts) { memcpy(counts, total, sizeof total); }

bool cb_counter_works(void) {
  volatile quad a = 2, b = 3;
  struct cb_counts before = total[current];
  a = a * b + b / a - b;
  __asm__ volatile("" ::: "memory"); /* the compiler does not know that it called us */
  struct cb_counts now = total[current];
  total[current] = before;
  return now.mul == before.mul + 1 && now.add == before.add + 2 && now.div == before.div + 1;
}
