/* A run of bench: which variants, and whether they may be timed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/bench/bench.h"

#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/verify/gate.h"

const struct cb_step_parameters cb_bench_step = {.h = 4e-4, .iterations = 5};

struct cb_gate_result {
  bool known;
  char reason[160];
};

enum cb_status cb_bench_create(const struct cb_options *options, bool quick, double seconds,
                               struct cb_bench *b) {
  size_t variants;
  cb_variants(&variants);
  struct cb_bench made = {.options = options, .seconds = seconds};
  made.gates = calloc(variants + 1, sizeof *made.gates);
  if (!made.gates) return cb_fail_memory("the list of variants");
  const char *directory = options->output ? options->output : "results/latest";
  const enum cb_status status = cb_results_create(directory, quick, &made.results);
  if (status)
    free(made.gates);
  else
    *b = made;
  return status;
}

void cb_bench_free(struct cb_bench *b) {
  cb_results_free(&b->results);
  free(b->gates);
  *b = (struct cb_bench){0};
}

enum cb_status cb_bench_select(const struct cb_bench *b, bool (*wanted)(const struct cb_variant *v),
                               const struct cb_variant ***list, size_t *count) {
  size_t all, chosen = 0;
  const struct cb_variant *v = cb_variants(&all), **made = malloc((all + 1) * sizeof *made);
  if (!made) return cb_fail_memory("the list of variants");
  for (; v->model; v++) {
    const bool selected = b->options->glob_count
                              ? cb_options_selects(b->options, v)
                              : v->arithmetic == cb_arithmetics[0] && (!wanted || wanted(v));
    if (selected && strcmp(v->arithmetic->name, "counted") != 0) made[chosen++] = v;
  }
  *list = made;
  *count = chosen;
  return CB_OK;
}

enum cb_status cb_bench_gate(struct cb_bench *b, const struct cb_variant *v, const char **reason) {
  struct cb_gate_result *result = &b->gates[v - cb_variants(NULL)];
  if (!result->known) {
    char text[sizeof result->reason] = "no reason given", name[CB_NAME];
    cb_variant_name(v, name);
    cb_progress(b->done_s, name);
    const enum cb_status status = cb_gate(v, text);
    if (status && status != CB_BROKEN) return status;
    if (status) memcpy(result->reason, text, sizeof text);
    result->known = true;
  }
  *reason = result->reason;
  return CB_OK;
}
