/* Parts of a run, done or found in the journal of one that was ended.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/bench/bench.h"
#include "harness/files/journal.h"
#include "harness/measure/results_slices.h"

enum cb_status cb_bench_part(struct cb_bench *b, const char *key, cb_bench_work *work,
                             void *context) {
  size_t session = 0;
  if (!b->journal) return work(b, context);
  const json_t *finished = cb_journal_row(b->journal, key, &session);
  if (finished) return cb_results_restore(&b->results, finished, session);
  const struct cb_mark mark = cb_results_mark(&b->results);
  const enum cb_status status = work(b, context);
  return status ? status : cb_journal_add(b->journal, key, cb_results_since(&b->results, &mark));
}
