/* verb_trade.c - `corobench trade`: error against time on a scene.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/files/journal.h"
#include "harness/files/output.h"
#include "harness/trade/trade.h"

static const char doc[] =
    "Run a scene with many settings - model, storage, arithmetic, iterations, step, resolution, "
    "iterations and tolerance of the frame, lazy updates of B - and hold error, ghost torque and "
    "energy against time. Writes trade.csv and trade.json to DIR (default results/latest), prints "
    "the front and what is never on it. What is finished is kept in DIR/trade.unfinished until all "
    "is: --resume goes on with a run that was ended.";

enum { KEY_QUICK = 0x4000, KEY_RESUME };
static const struct argp_option own_options[] = {
    {"quick", KEY_QUICK, NULL, 0, "Fewer settings", 0},
    {"resume", KEY_RESUME, NULL, 0, "Go on with the run that was ended in DIR, if there is one", 0},
    {0}};

struct request {
  bool quick, resume;
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *request = state->input;
  (void)text;
  switch (key) {
  case KEY_QUICK: request->quick = true; return 0;
  case KEY_RESUME: request->resume = true; return 0;
  default: return ARGP_ERR_UNKNOWN;
  }
}

/* All that shapes the rows, for the journal. */
static enum cb_status describe(const struct cb_scene *scene, const struct cb_options *o, bool quick,
                               char **text) {
  size_t size;
  *text = NULL;
  FILE *stream = open_memstream(text, &size);
  if (!stream) return cb_fail_memory("the options");
  fprintf(stream, "%sscene %s %016llx", quick ? "quick, " : "", scene->name,
          (unsigned long long)cb_journal_digest(scene->path));
  if (scene->mesh_path[0])
    fprintf(stream, ", mesh %016llx", (unsigned long long)cb_journal_digest(scene->mesh_path));
  fprintf(stream, ", threads %zu", o->threads.count ? o->threads.of[0] : 1);
  for (size_t i = 0; i < o->glob_count; i++) fprintf(stream, ", variant %s", o->globs[i]);
  return fclose(stream) == 0 ? CB_OK : cb_fail_memory("the options");
}

static enum cb_status write_files(const struct cb_trade *trade, const char *directory) {
  struct cb_table *t = cb_trade_table(trade);
  enum cb_status status = t ? CB_OK : cb_fail_memory("the table of the trade");
  if (!status) status = cb_output_table(directory, "trade.csv", t, CB_CSV);
  if (!status) status = cb_output_table(directory, "trade.json", t, CB_JSON);
  if (!status) status = cb_environment_footer(directory, "trade-footer.txt");
  cb_table_free(t);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct request request = {0};
  struct cb_options o;
  struct cb_scene scene;
  struct cb_journal *journal = NULL;
  char *text = NULL;
  struct cb_trade trade = {0};
  enum cb_status status = cb_options_parse(
      argc, argv, CB_OPT_SCENE | CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_THREADS,
      doc, own_options, parse, &request, &o);
  const char *directory = !status && o.output ? o.output : "results/latest";
  if (!status) status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_output_directory(directory);
  if (!status) status = describe(&scene, &o, request.quick, &text);
  if (!status) status = cb_journal_open(directory, "trade", text, request.resume, &journal);
  if (!status) status = cb_trade_run(&scene, &o, request.quick, journal, &trade);
  if (!status) status = write_files(&trade, directory);
  if (!status) cb_journal_done(journal);
  if (!status && o.format == CB_TABLE) status = cb_trade_print(&trade, stdout);
  if (!status && o.format != CB_TABLE) {
    struct cb_table *t = cb_trade_table(&trade);
    status = t ? cb_table_print(t, o.format, stdout) : cb_fail_memory("the table of the trade");
    cb_table_free(t);
  }
  cb_trade_free(&trade);
  free(text);
  return cb_journal_close(journal, status);
}

const struct cb_verb cb_verb_trade = {"trade",
                                      "error against time on a scene: what each setting "
                                      "costs and loses",
                                      run};
