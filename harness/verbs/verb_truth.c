/* verb_truth.c - `corobench truth`: the models against what is known without them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/environment.h"
#include "harness/truth/truth.h"

static const char doc[] =
    "Hold the models against closed forms and conservation: patch test, manufactured solution, "
    "stretched, twisted, vibrating and bent bars, a body in free flight, Newton's method. Exit "
    "status 1 when a row is out of its band. With --output, write truth.csv, and tangent.csv: how "
    "far each operator is from the derivative of the force, against strain."
    "\vThe column 'judged' is what is held against 'low' and 'high'; rows without them are shown "
    "only.";

static enum cb_status write_files(const struct cb_options *o, const struct cb_table *truth) {
  struct cb_table *tangent = NULL;
  enum cb_status status = cb_output_directory(o->output);
  if (!status) status = cb_output_table(o->output, "truth.csv", truth, CB_CSV);
  if (!status) status = cb_tangent_sweep(o, &tangent);
  if (!status) status = cb_output_table(o->output, "tangent.csv", tangent, CB_CSV);
  if (!status) status = cb_environment_footer(o->output, "truth-footer.txt");
  cb_table_free(tangent);
  return status;
}

static enum cb_status judge(const struct cb_truth *truth) {
  size_t judged = 0, out = 0;
  const struct cb_truth_row *first = NULL;
  for (size_t i = 0; i < truth->count; i++) {
    const struct cb_truth_row *r = &truth->rows[i];
    judged += r->low <= r->high;
    if (cb_truth_within(r)) continue;
    if (!out++) first = r;
  }
  if (first)
    return cb_fail(CB_BROKEN,
                   "%zu of %zu rows are out of their bands, the first: %s, %s: %g is not "
                   "in [%g, %g]",
                   out, judged, first->name, first->model, first->judged, first->low, first->high);
  return CB_OK;
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  struct cb_truth truth = {0};
  struct cb_table *t = NULL;
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED,
                       doc, NULL, NULL, NULL, &o);
  if (!status) status = cb_truth_run(&o, &truth);
  if (!status) {
    t = cb_truth_table(&truth);
    status = t ? cb_table_print(t, o.format, stdout) : cb_fail_memory("the table of truth");
  }
  if (!status && o.output) status = write_files(&o, t);
  if (!status) status = judge(&truth);
  cb_table_free(t);
  cb_truth_free(&truth);
  return status;
}

const struct cb_verb cb_verb_truth = {"truth", "the models against closed forms and conservation",
                                      run};
