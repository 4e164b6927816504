/* gate.h - a variant that fails verification is not rated.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_GATE_H
#define CB_GATE_H

#include "kernels/kernel.h"

/* CB_OK: v may be timed. CB_BROKEN: it may not, and reason says why, in a few
 * words. CB_MEMORY. */
enum cb_status cb_gate(const struct cb_variant *v, char reason[160]);

#endif
