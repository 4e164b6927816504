/* drivers.c - the loops over packs of many elements, one copy an arithmetic.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#define CB_DEFINE_DRIVERS
#include "kernels/storage/blocks.h"
