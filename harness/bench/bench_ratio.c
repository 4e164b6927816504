/* Which variants are held against each other, and the ratios of their times.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/bench/bench.h"

static const double PAPER_POLAR_TO_QR = 1.3; /* section 4.2: about 30 % */

static bool starts_with(const char *text, const char *start) {
  return strncmp(text, start, strlen(start)) == 0;
}

/* The strain-displacement policy of a QR model, "updated" of "qr-updated"; NULL
 * for the other models. */
static const char *qr_policy(const struct cb_variant *v) {
  return starts_with(v->model->name, "qr-") ? v->model->name + strlen("qr-") : NULL;
}

static bool ends_with_policy(const char *name, const char *policy) {
  const size_t length = strlen(name), tail = strlen(policy);
  return length > tail && name[length - tail - 1] == '-' && !strcmp(name + length - tail, policy);
}

/* Is `base`, of QR, what v is to be held against? */
static bool is_base(const struct cb_variant *v, const struct cb_variant *base) {
  const char *policy = qr_policy(base);
  if (!policy || v->storage != base->storage || v->arithmetic != base->arithmetic) return false;
  if (qr_policy(v)) return v != base && strcmp(policy, "updated") == 0;
  return ends_with_policy(v->model->name, policy);
}

enum cb_status cb_block_ratio(struct cb_bench *b, const struct cb_block *block, size_t job,
                              size_t base, size_t count, double paper) {
  const struct cb_job *upper = &block->jobs[job], *lower = &block->jobs[base];
  struct cb_ratio ratio = {.figure = block->plan->figure,
                           .tetrahedra = block->plan->scene->mesh.tets,
                           .iterations = block->plan->iterations[count],
                           .threads = upper->threads,
                           .denominator_threads = lower->threads,
                           .paper = paper};
  snprintf(ratio.numerator, CB_NAME, "%s", upper->name);
  snprintf(ratio.denominator, CB_NAME, "%s", lower->name);
  const enum cb_status status =
      cb_ratio_interval(block->samples.rounds, cb_block_step_s(block, job, count),
                        cb_block_step_s(block, base, count), &ratio.ratio);
  return status ? status : cb_results_add_ratio(&b->results, &ratio);
}

static double paper_ratio(const struct cb_job *job, const struct cb_job *base) {
  const bool in_paper = starts_with(job->variant->model->name, "polar-") &&
                        strcmp(base->variant->model->name, "qr-updated") == 0;
  return in_paper ? PAPER_POLAR_TO_QR : NAN;
}

enum cb_status cb_block_ratios(struct cb_bench *b, const struct cb_block *block) {
  enum cb_status status = CB_OK;
  for (size_t v = 0; v < block->job_count; v++)
    for (size_t base = 0; base < block->job_count; base++) {
      const struct cb_job *upper = &block->jobs[v], *lower = &block->jobs[base];
      if (upper->lost || lower->lost || upper->threads != lower->threads) continue;
      if (!is_base(upper->variant, lower->variant)) continue;
      for (size_t c = 0; !status && c < block->plan->count_count; c++)
        status = cb_block_ratio(b, block, v, base, c, paper_ratio(upper, lower));
    }
  return status;
}
