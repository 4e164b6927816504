/* verb_bench.c - `corobench bench`: the figures, measured on this machine.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/files/journal.h"
#include "harness/progress.h"

static const char doc[] =
    "Measure on this machine: the paper's figures, time of a step against iterations (4) and "
    "tetrahedra (7), convergence, memory and the linear ancestors; and how fast it can go: speed "
    "against the paper's method beside the error, the roofline, scaling with size and threads. "
    "With --mesh, measure the variants on that mesh instead. What is finished is kept in "
    "DIR/bench.unfinished until all is: --resume goes on with a run that was ended.";

static const struct cb_bench_figure *const figures[] = {
    &cb_bench_memory,    &cb_bench_convergence, &cb_bench_figure4,  &cb_bench_figure7,
    &cb_bench_ancestors, &cb_bench_speed,       &cb_bench_roofline, &cb_bench_scaling};
enum { FIGURES = sizeof figures / sizeof *figures };
static const double FULL = 220, QUICK = 30; /* s; without --seconds */

enum { KEY_FIGURE = 0x2000, KEY_QUICK, KEY_SECONDS, KEY_RESUME };
static const struct argp_option own_options[] = {
    {"figure", KEY_FIGURE, "NAME", 0,
     "4, 7, convergence, memory, ancestors, speed, roofline or scaling; may be repeated (default: "
     "all)",
     0},
    {"quick", KEY_QUICK, NULL, 0, "Few samples; the results are marked as such", 0},
    {"seconds", KEY_SECONDS, "S", 0,
     "Time for measuring all figures (default 220, with --quick 30); more makes every sample "
     "steadier",
     0},
    {"resume", KEY_RESUME, NULL, 0, "Go on with the run that was ended in DIR, if there is one", 0},
    {0}};

struct request {
  bool asked[FIGURES], any, quick, resume;
  double seconds; /* 0: not given */
};

static enum cb_status ask(struct request *request, const char *name) {
  for (size_t i = 0; i < FIGURES; i++)
    if (strcmp(figures[i]->name, name) == 0) {
      request->asked[i] = request->any = true;
      return CB_OK;
    }
  return cb_fail(CB_INPUT,
                 "--figure needs 4, 7, convergence, memory, ancestors, speed, roofline or scaling, "
                 "not '%s'; the other figures are drawn from what verify writes",
                 name);
}

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *request = state->input;
  enum cb_status status = CB_OK;
  switch (key) {
  case KEY_FIGURE: status = ask(request, text); break;
  case KEY_QUICK: request->quick = true; break;
  case KEY_RESUME: request->resume = true; break;
  case KEY_SECONDS: status = cb_parse_number("--seconds", text, 1, 86400, &request->seconds); break;
  default: return ARGP_ERR_UNKNOWN;
  }
  return status ? EINVAL : 0;
}

/* The figures that are asked for, in order, into chosen; returns how many. */
static size_t choose(const struct request *request, const struct cb_options *options,
                     const struct cb_bench_figure *chosen[FIGURES]) {
  size_t count = 0;
  if (options->mesh_path) {
    chosen[0] = &cb_bench_mesh;
    return 1;
  }
  for (size_t i = 0; i < FIGURES; i++) {
    /* the ancestors are no variants: whoever selects some does not mean them */
    bool meant = options->glob_count == 0 || figures[i] != &cb_bench_ancestors;
    if (request->any ? request->asked[i] : meant) chosen[count++] = figures[i];
  }
  return count;
}

static enum cb_status check_timeable(const struct cb_options *options) {
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    if (strcmp(v->arithmetic->name, "counted") != 0 && cb_options_selects(options, v)) return CB_OK;
  return cb_fail(CB_INPUT,
                 "'%s' selects nothing that can be timed: counted is for counting; "
                 "name another arithmetic, e.g. 'qr-*/ebe/f64'",
                 options->globs[0]);
}

static enum cb_status run_whole(struct cb_bench *b, void *context) {
  const struct cb_bench_figure *figure = context;
  return figure->run(b, figure->share * b->seconds);
}

static enum cb_status measure(struct cb_bench *b, size_t count,
                              const struct cb_bench_figure *const *chosen) {
  double planned_s = 0;
  for (size_t i = 0; i < count; i++) planned_s += chosen[i]->share * b->seconds;
  enum cb_status status = CB_OK;
  cb_progress_begin(b->results.quick ? "bench (quick)" : "bench", planned_s);
  planned_s = 0;
  for (size_t i = 0; !status && i < count; i++) {
    b->done_s = planned_s;
    cb_progress(b->done_s, chosen[i]->name);
    status = chosen[i]->whole ? cb_bench_part(b, chosen[i]->name, run_whole, (void *)chosen[i])
                              : chosen[i]->run(b, chosen[i]->share * b->seconds);
    planned_s += chosen[i]->share * b->seconds;
  }
  if (!status) cb_progress(planned_s, "done");
  cb_progress_end();
  return status;
}

static void print_refused(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("variant,figure,status");
  for (size_t i = 0; t && i < r->row_count; i++) {
    if (strncmp(r->rows[i].status, "failed", 6) != 0) continue;
    cb_table_text(t, r->rows[i].variant);
    cb_table_text(t, r->rows[i].figure);
    cb_table_text(t, r->rows[i].status);
  }
  cb_bench_print(stream, "Not timed", t);
}

static void print_end(const struct cb_results *r, FILE *stream) {
  char line[512];
  size_t unstable = 0;
  for (size_t i = 0; i < r->row_count; i++) unstable += strcmp(r->rows[i].status, "unstable") == 0;
  if (unstable > 0)
    fprintf(stream, "\n* %zu of %zu rows are unstable, they scatter by more than %g %%: %s\n",
            unstable, r->row_count, 100 * CB_SCATTER_LIMIT, CB_SCATTER_REMEDY);
  cb_environment_line(&r->environment, sizeof line, line);
  fprintf(stream, "\nMeasured on %s%s\n", line,
          r->quick ? "\nQUICK RUN, few samples: run without --quick before you quote a number"
                   : "");
  fprintf(
      stream,
      "Files in %s: bench.csv and bench.json (medians), samples.csv (raw), ratios.csv, fits.csv, "
      "crossings.csv, convergence.csv, speed.csv, roofline.csv, scaling.csv, frame33.csv, "
      "environment.json; 'make plots' draws them there\n",
      r->directory);
}

static enum cb_status print(const struct cb_bench *b, enum cb_format format, size_t count,
                            const struct cb_bench_figure *const *chosen) {
  if (format != CB_TABLE) {
    struct cb_table *t = cb_results_bench_table(&b->results);
    const enum cb_status status =
        t ? cb_table_print(t, format, stdout) : cb_fail_memory("the table of results");
    cb_table_free(t);
    return status;
  }
  for (size_t i = 0; i < count; i++) chosen[i]->print(&b->results, stdout);
  print_refused(&b->results, stdout);
  print_end(&b->results, stdout);
  return CB_OK;
}

/* All that shapes the rows, for the journal. */
static enum cb_status describe(const struct cb_bench *b, size_t count,
                               const struct cb_bench_figure *const *chosen, char **text) {
  const struct cb_options *o = b->options;
  size_t size;
  *text = NULL;
  FILE *stream = open_memstream(text, &size);
  if (!stream) return cb_fail_memory("the options");
  fprintf(stream, "%sfigures", b->results.quick ? "quick, " : "");
  for (size_t i = 0; i < count; i++) fprintf(stream, " %s", chosen[i]->name);
  fprintf(stream, ", %g s, seed %lu, threads", b->seconds, o->seed);
  for (size_t i = 0; i < b->threads.count; i++) fprintf(stream, " %zu", b->threads.of[i]);
  for (size_t i = 0; i < o->glob_count; i++) fprintf(stream, ", variant %s", o->globs[i]);
  if (o->mesh_path)
    fprintf(stream, ", mesh %s %016llx", o->mesh_path,
            (unsigned long long)cb_journal_digest(o->mesh_path));
  return fclose(stream) == 0 ? CB_OK : cb_fail_memory("the options");
}

/* What is not finished already. */
static enum cb_status measure_rest(struct cb_bench *b, bool resume, size_t count,
                                   const struct cb_bench_figure *const *chosen) {
  char *text;
  enum cb_status status = describe(b, count, chosen, &text);
  if (!status) status = cb_journal_open(b->results.directory, "bench", text, resume, &b->journal);
  free(text);
  if (status) return status;
  b->results.session = cb_journal_session(b->journal);
  status = measure(b, count, chosen);
  if (!status) status = cb_results_write(&b->results);
  if (!status) cb_journal_done(b->journal);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct request request = {0};
  struct cb_options options;
  struct cb_bench b;
  const struct cb_bench_figure *chosen[FIGURES];
  const unsigned mask =
      CB_OPT_VARIANT | CB_OPT_MESH | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_SEED | CB_OPT_THREADS;
  enum cb_status status =
      cb_options_parse(argc, argv, mask, doc, own_options, parse, &request, &options);
  if (status) return status;
  if (options.mesh_path && request.any)
    return cb_fail(CB_INPUT, "--mesh and --figure exclude each other: the figures have meshes of "
                             "their own; leave one out");
  status = check_timeable(&options);
  if (status) return status;
  const double seconds = request.seconds > 0 ? request.seconds : request.quick ? QUICK : FULL;
  const size_t count = choose(&request, &options, chosen);
  status = cb_bench_create(&options, request.quick, seconds, &b);
  if (status) return status;
  status = measure_rest(&b, request.resume, count, chosen);
  if (!status) status = print(&b, options.format, count, chosen);
  status = cb_journal_close(b.journal, status);
  cb_bench_free(&b);
  return status;
}

const struct cb_verb cb_verb_bench = {"bench", "the paper's figures, measured on this machine",
                                      run};
