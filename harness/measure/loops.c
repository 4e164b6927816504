/* Vectors are the compilers' own (GNU C), so that every architecture has the
 * generic ones. Here, and only here, a * b + c may be fused: a processor's peak
 * is that of its fused instruction.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifdef __clang__
#pragma clang fp contract(fast)
#else
#pragma GCC optimize("fp-contract=fast")
#endif

#include "harness/measure/loops.h"

/* 12 chains: latency times issue width, 4 cycles x 2 a cycle, needs 8, slower units
 * more; with the two constants and a product they fit 16 registers. */
_Static_assert(CB_LOOP_CHAINS + 3 <= 16, "the chains stay in registers");
/* What is in memory may have changed: a loop over it is not done already. */
#define BARRIER __asm__ volatile("" ::: "memory")

#define NAME(x) x##_generic
#define TARGET
#define BYTES 16
#include "harness/measure/loops_body.h"
#undef NAME
#undef TARGET
#undef BYTES

static bool always(void) { return true; }

#define LOOPS(set, test, width)                                                                    \
  {                                                                                                \
    .name = #set, .runs = test, .bytes = width,                                                    \
    .multiply_add = {multiply_add_f32_##set, multiply_add_f64_##set}, .read = read_##set,          \
    .triad = triad_##set                                                                           \
  }

#ifdef __x86_64__

#define NAME(x) x##_avx2
#define TARGET __attribute__((target("avx2,fma")))
#define BYTES 32
#include "harness/measure/loops_body.h"
#undef NAME
#undef TARGET
#undef BYTES

#define NAME(x) x##_avx512
#define TARGET __attribute__((target("avx512f")))
#define BYTES 64
#include "harness/measure/loops_body.h"

static bool has_avx2(void) {
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
}
static bool has_avx512(void) { return __builtin_cpu_supports("avx512f"); }

const struct cb_loops cb_loops[CB_LOOP_SETS + 1] = {
    LOOPS(generic, always, 16), LOOPS(avx2, has_avx2, 32), LOOPS(avx512, has_avx512, 64), {0}};
#else
const struct cb_loops cb_loops[CB_LOOP_SETS + 1] = {LOOPS(generic, always, 16)};
#endif
