/* opcount.h - operations per tetrahedron of a variant, counted as executed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_OPCOUNT_H
#define CB_OPCOUNT_H

#include "harness/files/table.h"
#include "harness/verify/counter.h"
#include "kernels/kernel.h"

struct cb_operations {
  double mul, add, div, sqrt; /* per tetrahedron */
};

extern const char *const cb_stage_name[STAGES];

/* operations[STAGES] of one update (without velocities) and one product of the
 * variant, which must be of the counted arithmetic, on an upright shape with a
 * warm frame. Storages and models whose work is shared by elements (assembled,
 * node frames) are counted on the paper's block and divided; the others on one
 * element, where every number is whole. CB_MEMORY; CB_BROKEN when the program
 * was linked without the counter. */
enum cb_status cb_operations_count(const struct cb_variant *variant,
                                   struct cb_operations *operations);

/* The variant's counts as rows of a table with CB_OPS_COLUMNS, one a stage. */
#define CB_OPS_COLUMNS "model,storage,stage,mul,add,div,sqrt"
enum cb_status cb_operations_table(struct cb_table *table, const struct cb_variant *variant);

#endif
