/* verb_list.c - `corobench list`: the variants that can be named.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/error.h"
#include "harness/verbs/verbs.h"

static const char doc[] =
    "List the variants: model (frame and strain-displacement policy), storage (how the stiffness "
    "product is done) and arithmetic.";

/* The arithmetics that this processor cannot run, and why. */
static void print_absent(void) {
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
    if (!cb_arithmetic_runs(*a))
      printf("%s is not listed: it needs %s, which this processor does not have\n", (*a)->name,
             (*a)->needs);
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT, doc, NULL, NULL, NULL, &o);
  if (status != CB_OK) return status;
  struct cb_table *table = cb_table_create("model,storage,arithmetic,variant,summary,source");
  if (!table) return cb_fail_memory("the list");
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    if (!cb_options_selects(&o, v)) continue;
    char name[96];
    cb_variant_name(v, name);
    cb_table_text(table, v->model->name);
    cb_table_text(table, cb_storage_name[v->storage]);
    cb_table_text(table, v->arithmetic->name);
    cb_table_text(table, name);
    cb_table_text(table, v->model->summary);
    cb_table_text(table, v->model->source);
  }
  status = cb_table_print(table, o.format, stdout);
  if (o.format == CB_TABLE) print_absent();
  cb_table_free(table);
  return status;
}

const struct cb_verb cb_verb_list = {"list", "the variants that can be named", run};
