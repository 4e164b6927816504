/* verb_trade.c - `corobench trade`: error against time on a scene.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/trade/trade.h"

static const char doc[] =
    "Run a scene with many settings - model, storage, arithmetic, iterations, step, resolution, "
    "iterations and tolerance of the frame, lazy updates of B - and hold error, ghost torque and "
    "energy against time. Writes trade.csv and trade.json to DIR (default results/latest), prints "
    "the front and what is never on it.";

enum { KEY_QUICK = 0x4000 };
static const struct argp_option own_options[] = {{"quick", KEY_QUICK, NULL, 0, "Fewer settings", 0},
                                                 {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  (void)text;
  if (key != KEY_QUICK) return ARGP_ERR_UNKNOWN;
  *(bool *)state->input = true;
  return 0;
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
  bool quick = false;
  struct cb_options o;
  struct cb_scene scene;
  struct cb_trade trade = {0};
  enum cb_status status = cb_options_parse(
      argc, argv, CB_OPT_SCENE | CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_OUTPUT | CB_OPT_THREADS,
      doc, own_options, parse, &quick, &o);
  const char *directory = !status && o.output ? o.output : "results/latest";
  if (!status) status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_output_directory(directory);
  if (!status) status = cb_trade_run(&scene, &o, quick, &trade);
  if (!status) status = write_files(&trade, directory);
  if (!status && o.format == CB_TABLE) status = cb_trade_print(&trade, stdout);
  if (!status && o.format != CB_TABLE) {
    struct cb_table *t = cb_trade_table(&trade);
    status = t ? cb_table_print(t, o.format, stdout) : cb_fail_memory("the table of the trade");
    cb_table_free(t);
  }
  cb_trade_free(&trade);
  return status;
}

const struct cb_verb cb_verb_trade = {"trade",
                                      "error against time on a scene: what each setting "
                                      "costs and loses",
                                      run};
