/* gate.h - no rating without passing verification.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_GATE_H
#define CB_GATE_H

#include "kernels/kernel.h"

/* Does the variant keep the laws that its model claims (isotropic, on a few
 * random elements), and give the forces and products of the same model in quad
 * precision? CB_OK; CB_BROKEN with the reason; CB_MEMORY, CB_INTERRUPTED
 * (recorded). */
enum cb_status cb_gate(const struct cb_variant *variant, char reason[160]);

#endif
