/* spin.h - one turn of waiting for another thread: a pause at first, the processor
 * given away after some microseconds, so that waiting ends on a busy machine too.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SPIN_H
#define CB_SPIN_H

#include <sched.h>
#include <stddef.h>

static inline void cb_spin(size_t turns) {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
  if (turns > 500) sched_yield();
}

#endif
