/* verb_recovery.c - `corobench recovery`: which models come back from inverted and collapsed
 * shapes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/environment.h"
#include "harness/recovery/recovery.h"

static const char doc[] =
    "Let go of one tetrahedron, inverted through each vertex, each pair of opposite edges and the "
    "centre, and of a block of 270 tetrahedra that is mirrored, collapsed to a plane, a line and a "
    "point, or has its nodes at random places; step until it is still. Every model in ebe, f64, or "
    "what --variant selects. With --output, write recovery.csv, recovery.json and "
    "recovery-time.csv."
    "\vA cell of the table: the simulated time after which all elements are at rest (|F'F - I| at "
    "most 0.1) and right-handed; or the share of the elements that are; mirrored: at least half "
    "are at rest but left-handed; exploded: more than ten sizes from the rest shape; NaN: a "
    "position is not finite. CSV and JSON have a row for "
    "each "
    "start and model, with the distance from the rest shape after the best rigid motion, root mean "
    "square of the body's size, and the turn of that motion.";

static enum cb_status write_files(const char *directory, const struct cb_table *rows,
                                  const struct cb_recoveries *all) {
  struct cb_table *times = cb_recovery_times(all);
  enum cb_status status = times ? CB_OK : cb_fail_memory("the table of recovery");
  if (!status) status = cb_output_directory(directory);
  if (!status) status = cb_output_table(directory, "recovery.csv", rows, CB_CSV);
  if (!status) status = cb_output_table(directory, "recovery.json", rows, CB_JSON);
  if (!status) status = cb_output_table(directory, "recovery-time.csv", times, CB_CSV);
  if (!status) status = cb_environment_footer(directory, "recovery-footer.txt");
  cb_table_free(times);
  return status;
}

static enum cb_status print(const struct cb_options *o, const struct cb_recoveries *all,
                            const struct cb_table *rows) {
  if (o->format != CB_TABLE) return cb_table_print(rows, o->format, stdout);
  const struct cb_step_parameters *p = &cb_recovery_step;
  printf("Steps of %g ms, %zu iterations, mass damping %g/s, %g s at most; E = 10 kPa, nu = 0.3, "
         "1000 kg/m^3\n\n",
         1e3 * p->h, p->iterations, p->beta, CB_RECOVERY_STEPS * p->h);
  struct cb_table *t = cb_recovery_matrix(all);
  enum cb_status status =
      t ? cb_table_print(t, o->format, stdout) : cb_fail_memory("the table of recovery");
  cb_table_free(t);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  struct cb_recoveries all = {0};
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED,
                       doc, NULL, NULL, NULL, &o);
  if (!status) status = cb_recovery_survey(&o, &all);
  if (status) return status;
  struct cb_table *rows = cb_recovery_table(&all);
  if (!rows) status = cb_fail_memory("the table of recovery");
  if (!status) status = print(&o, &all, rows);
  if (!status && o.output) status = write_files(o.output, rows, &all);
  cb_table_free(rows);
  cb_recoveries_free(&all);
  return status;
}

const struct cb_verb cb_verb_recovery = {
    "recovery", "which models come back from inverted and collapsed shapes", run};
