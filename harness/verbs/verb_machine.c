/* verb_machine.c - `corobench machine`: what this machine can do at most, and what
 * it allows to work of given flops and bytes.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/machine.h"
#include "harness/progress.h"
#include "harness/verbs/verbs.h"

static const char doc[] =
    "Measure, in about five seconds, the multiply-adds in registers of each instruction set of "
    "this processor and the bandwidth of each level of memory, on one thread and on all, and how "
    "long the threads take to meet.\v"
    "A multiply-add counts as 2 flops, fused or not. 'read' sums numbers; 'triad' is a = b + s c, "
    "whose bytes are those of the three arrays; 'barrier' is how long all threads take to wait for "
    "each other, of which a step has about four an iteration. Values are medians with their 95 % "
    "intervals, "
    "Gflop/s and GB/s are decimal. With --flops and --bytes, 'attainable' is the roofline: the "
    "best peak or the better bandwidth times flops / bytes, whichever is less.";

struct request {
  double flops, bytes; /* NaN: not given */
};

static const struct argp_option own_options[] = {
    {"flops", 'f', "N", 0, "Flops of the work whose attainable rate is wanted (with --bytes)", 0},
    {"bytes", 'b', "N", 0, "Bytes that the same work moves (with --flops)", 0},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  if (key == 'f') return cb_parse_number("--flops", text, 1e-9, 1e30, &r->flops) ? EINVAL : 0;
  if (key == 'b') return cb_parse_number("--bytes", text, 1e-9, 1e30, &r->bytes) ? EINVAL : 0;
  return ARGP_ERR_UNKNOWN;
}

/* A bound, not a measurement: no interval, and of the best instruction set. */
static void add_attainable(struct cb_table *t, const struct cb_machine *m, enum cb_crew crew,
                           const struct request *r) {
  for (enum cb_scalar scalar = 0; scalar < CB_SCALARS; scalar++)
    for (enum cb_level level = 0; level < CB_LEVELS; level++) {
      if (m->bytes[level][crew] == 0) continue;
      char quantity[48];
      snprintf(quantity, sizeof quantity, "attainable-%s-%s", cb_scalar_name[scalar],
               cb_level_name[level]);
      cb_table_text(t, quantity);
      cb_table_text(t, "best");
      cb_table_integer(t, (long long)m->threads[crew]);
      cb_table_number(t, 1e-9 * cb_machine_attainable(m, r->flops, r->bytes, level, crew, scalar));
      cb_table_missing(t);
      cb_table_missing(t);
      cb_table_text(t, "Gflop/s");
      cb_table_missing(t);
    }
}

static struct cb_table *build_table(const struct cb_machine *m, const struct request *r) {
  struct cb_table *t = cb_machine_table(m);
  const enum cb_crew crews = m->threads[CB_ALL] > 1 ? CB_CREWS : CB_ALL;
  if (t && !isnan(r->flops))
    for (enum cb_crew crew = 0; crew < crews; crew++) add_attainable(t, m, crew, r);
  return t;
}

static void show(void *context, double share, const char *what) {
  (void)context;
  cb_progress(share, what);
}

static enum cb_status run(int argc, char **argv) {
  struct request r = {NAN, NAN};
  struct cb_options o;
  struct cb_machine m;
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_FORMAT | CB_OPT_OUTPUT, doc, own_options, parse, &r, &o);
  if (status) return status;
  if (isnan(r.flops) != isnan(r.bytes))
    return cb_fail(CB_INPUT, "--flops and --bytes say what one and the same work does: give both");
  if (o.output && (status = cb_output_directory(o.output)) != CB_OK) return status;
  cb_progress_begin("machine", 1);
  status = cb_machine_measure(show, NULL, &m);
  cb_progress_end();
  if (status) return status;
  struct cb_table *table = build_table(&m, &r);
  if (!table) return cb_fail_memory("the table of the machine");
  if (o.output) status = cb_output_table(o.output, "machine.csv", table, CB_CSV);
  if (!status) status = cb_table_print(table, o.format, stdout);
  if (!status && o.format == CB_TABLE && m.unstable > 0)
    printf("\n* %zu of %zu figures scatter by more than %g %%: close other programs, fix the CPU "
           "frequency, and measure again\n",
           m.unstable, m.measurements, 100 * CB_SCATTER_LIMIT);
  cb_table_free(table);
  return status;
}

const struct cb_verb cb_verb_machine = {"machine", "peak arithmetic and bandwidth of this machine",
                                        run};
