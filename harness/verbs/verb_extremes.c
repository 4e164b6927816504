/* verb_extremes.c - `corobench extremes`: what breaks, and where.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/paths.h"
#include "harness/extremes/report.h"
#include "harness/files/journal.h"
#include "harness/files/output.h"
#include "harness/measure/environment.h"
#include "harness/verbs/verbs.h"

static const char doc[] =
    "Drive each model to the extremes and say where it is finite, right and keeps the laws that it "
    "claims, against quad precision. Without --variant: every model by ebe in f64 and f32, scalar "
    "and in the widest lanes of this processor. Exit status 1 when a row is not finite or breaks a "
    "law. With --output, write extremes.csv and extremes.json (all rows), extremes-map.csv (the "
    "worst of each model, arithmetic and sweep, and where it was met first), extremes-paths.csv "
    "(frames and forces of elements that are turned inside out) and extremes-steps.csv (the "
    "largest stable steps, a million steps); what is finished is kept in DIR/extremes.unfinished "
    "until all is: --resume goes on with a run that was ended."
    "\vAn error is in roundings of the arithmetic times the condition of the exact answer; above "
    "1000 it is inaccurate. Not judged: the exact answer is no number of the arithmetic. By "
    "method: every kernel of that method fails there, and the note says why.";

enum { KEY_SWEEP = 0x4000, KEY_RESUME };
static const struct argp_option own_options[] = {
    {"sweep", KEY_SWEEP, "NAME", 0, "That sweep alone", 0},
    {"resume", KEY_RESUME, NULL, 0,
     "Go on with the run that was ended in the directory of --output, if there is one", 0},
    {0}};

struct request {
  const char *sweep; /* NULL: all */
  bool resume;
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *request = state->input;
  switch (key) {
  case KEY_SWEEP: request->sweep = text; return 0;
  case KEY_RESUME: request->resume = true; return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* Of those that run here, the most lanes of that scalar. */
static bool widest(const struct cb_arithmetic *a) {
  for (size_t i = 0; cb_arithmetics[i]; i++) {
    const struct cb_arithmetic *other = cb_arithmetics[i];
    if (other->scalar_bytes == a->scalar_bytes && other->lanes > a->lanes &&
        cb_arithmetic_runs(other))
      return false;
  }
  return true;
}

static bool asked(const struct cb_options *o, const struct cb_variant *v) {
  const struct cb_arithmetic *a = v->arithmetic;
  if (!cb_arithmetic_runs(a) || a->scalar_bytes > sizeof(double)) return false;
  if (o->glob_count) return cb_options_selects(o, v);
  return v->storage == CB_EBE && (a->lanes == 1 || widest(a));
}

/* All that shapes the rows, for the journal. */
static enum cb_status describe(const struct cb_options *o, const char *sweep, char **text) {
  size_t size;
  *text = NULL;
  FILE *stream = open_memstream(text, &size);
  if (!stream) return cb_fail_memory("the options");
  fprintf(stream, "sweep %s, seed %lu", sweep ? sweep : "all", o->seed);
  for (size_t i = 0; i < o->glob_count; i++) fprintf(stream, ", variant %s", o->globs[i]);
  return fclose(stream) == 0 ? CB_OK : cb_fail_memory("the options");
}

/* None without --output. */
static enum cb_status open_journal(const struct cb_options *o, const struct request *request,
                                   struct cb_journal **journal) {
  char *text;
  if (!o->output && request->resume)
    return cb_fail(CB_INPUT, "--resume needs the --output directory of the run that was ended");
  if (!o->output) return CB_OK;
  enum cb_status status = describe(o, request->sweep, &text);
  if (!status) status = cb_output_directory(o->output);
  if (!status) status = cb_journal_open(o->output, "extremes", text, request->resume, journal);
  free(text);
  return status;
}

static enum cb_status write_files(const struct cb_extremes *all, const char *directory) {
  struct cb_table *rows = cb_extremes_rows(all), *map = cb_extremes_map(all);
  struct cb_table *steps = cb_extremes_steps(all), *paths = NULL;
  enum cb_status status =
      rows && map && steps ? CB_OK : cb_fail_memory("the tables of the extremes");
  if (!status) status = cb_paths_table(all, &paths);
  if (!status) status = cb_output_table(directory, "extremes.csv", rows, CB_CSV);
  if (!status) status = cb_output_table(directory, "extremes.json", rows, CB_JSON);
  if (!status) status = cb_output_table(directory, "extremes-map.csv", map, CB_CSV);
  if (!status && all->step_count)
    status = cb_output_table(directory, "extremes-steps.csv", steps, CB_CSV);
  if (!status) status = cb_output_table(directory, "extremes-paths.csv", paths, CB_CSV);
  if (!status) status = cb_environment_footer(directory, "extremes-footer.txt");
  cb_table_free(rows);
  cb_table_free(map);
  cb_table_free(steps);
  cb_table_free(paths);
  return status;
}

static enum cb_status sweep(const struct cb_options *o, const struct request *request,
                            struct cb_extremes *all) {
  enum cb_status status = cb_extremes_run(request->sweep, all);
  if (!status) {
    struct cb_table *t = cb_extremes_words(all);
    status = t ? cb_table_print(t, o->format, stdout) : cb_fail_memory("the map");
    cb_table_free(t);
  }
  if (!status && o->output) status = write_files(all, o->output);
  if (!status && all->journal) cb_journal_done(all->journal);
  return status ? status : cb_extremes_judge(all);
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  struct request request = {0};
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED,
                       doc, own_options, parse, &request, &o);
  if (status) return status;
  size_t count, chosen = 0;
  const struct cb_variant *v = cb_variants(&count);
  const struct cb_variant **variants = calloc(count + 1, sizeof *variants);
  if (!variants) return cb_fail_memory("the list of variants");
  for (size_t i = 0; i < count; i++)
    if (asked(&o, &v[i])) variants[chosen++] = &v[i];
  struct cb_extremes all = {.seed = o.seed, .variants = variants};
  status = chosen ? cb_extremes_check(request.sweep)
                  : cb_fail(CB_INPUT, "--variant selects nothing that can be judged: 'counted' is "
                                      "what the others are held against, lanes must run on this "
                                      "processor");
  if (!status) status = open_journal(&o, &request, &all.journal);
  if (!status) status = sweep(&o, &request, &all);
  status = cb_journal_close(all.journal, status);
  cb_extremes_free(&all);
  free(variants);
  return status;
}

const struct cb_verb cb_verb_extremes = {"extremes",
                                         "what breaks, and where: shapes, inputs, steps", run};
