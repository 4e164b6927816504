/* verb_ops.c - `corobench ops`: operations per tetrahedron of every model and
 * storage, counted as executed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"
#include "harness/verify/opcount.h"

static const char doc[] =
    "Count the operations that one update and one product execute, per tetrahedron and stage: the "
    "kernels run in quad precision, whose every operation is a counted call. A subtraction counts "
    "as an addition. Isotropic material."
    "\vAssembled storages and node-warp share work between elements: theirs are means over the "
    "paper's block of 3430 tetrahedra. A model counts once, whatever the arithmetic of the "
    "variant that --variant names.";

/* Is this model and storage selected, in whichever arithmetic? */
static bool selected(const struct cb_options *o, const struct cb_variant *counted) {
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    if (v->storage == counted->storage && strcmp(v->model->name, counted->model->name) == 0 &&
        cb_options_selects(o, v))
      return true;
  return false;
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT, doc, NULL, NULL, NULL, &o);
  if (status) return status;
  struct cb_table *table = cb_table_create(CB_OPS_COLUMNS);
  if (!table) return cb_fail_memory("the counts");
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (strcmp(v->arithmetic->name, "counted") != 0 || !selected(&o, v)) continue;
    status = cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted while counting")
                              : cb_operations_table(table, v);
  }
  if (!status) status = cb_table_print(table, o.format, stdout);
  cb_table_free(table);
  return status;
}

const struct cb_verb cb_verb_ops = {"ops", "operations per tetrahedron, counted as executed", run};
