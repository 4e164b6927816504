/* A run of bench: which variants, and whether they may be timed.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/bench/bench.h"

#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/measure/crew.h"
#include "harness/progress.h"
#include "harness/verify/gate.h"

const struct cb_step_parameters cb_bench_step = {.h = 4e-4, .iterations = 5};

struct cb_gate_result {
  bool known;
  char reason[160];
};

struct cb_threads cb_bench_threads(void) {
  return (struct cb_threads){cb_crew_limit() > 1 ? 2 : 1, {1, 2}};
}

enum cb_status cb_bench_create(const struct cb_options *options, bool quick, double seconds,
                               struct cb_bench *b) {
  size_t variants;
  cb_variants(&variants);
  struct cb_bench made = {.options = options, .seconds = seconds};
  made.gates = calloc(variants + 1, sizeof *made.gates);
  if (!made.gates) return cb_fail_memory("the list of variants");
  made.paper_threads = made.threads = options->threads;
  if (options->threads.count == 0) {
    made.paper_threads = (struct cb_threads){1, {1}};
    made.threads = cb_bench_threads();
  }
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

const struct cb_arithmetic *cb_bench_lanes(size_t scalar_bytes) {
  const struct cb_arithmetic *best = NULL;
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
    if ((*a)->scalar_bytes == scalar_bytes && cb_arithmetic_runs(*a) &&
        (!best || (*a)->lanes > best->lanes))
      best = *a;
  return best;
}

enum cb_status cb_bench_select(const struct cb_bench *b, bool (*wanted)(const struct cb_variant *v),
                               struct cb_entry **list, size_t *count) {
  size_t all, chosen = 0;
  const struct cb_variant *v = cb_variants(&all);
  struct cb_entry *made = malloc((all * b->threads.count + 1) * sizeof *made);
  if (!made) return cb_fail_memory("the list of variants");
  for (; v->model; v++) {
    const bool named = b->options->glob_count > 0;
    const bool selected = named ? cb_options_selects(b->options, v) : wanted(v);
    if (!selected || strcmp(v->arithmetic->name, "counted") == 0) continue;
    const struct cb_threads *threads =
        named || v->arithmetic != cb_arithmetics[0] ? &b->threads : &b->paper_threads;
    for (size_t i = 0; i < threads->count; i++)
      made[chosen++] = (struct cb_entry){v, threads->of[i]};
  }
  *list = made;
  *count = chosen;
  return CB_OK;
}

size_t cb_bench_group(size_t first, size_t count, const struct cb_entry *entries,
                      bool (*alike)(const struct cb_entry *e, const struct cb_entry *f),
                      struct cb_entry *list) {
  size_t chosen = 0;
  for (size_t i = 0; i < first; i++)
    if (alike(&entries[i], &entries[first])) return 0;
  for (size_t i = first; i < count; i++)
    if (alike(&entries[i], &entries[first])) list[chosen++] = entries[i];
  return chosen;
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
