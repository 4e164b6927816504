/* The arrays of a run; results_tables.c and results_json.c write them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/results.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/output.h"

enum cb_status cb_results_create(const char *directory, bool quick, struct cb_results *r) {
  struct cb_results empty = {.directory = directory, .quick = quick, .session = 1};
  cb_environment_read(&empty.environment);
  struct cb_output probe;
  enum cb_status status = cb_output_directory(directory);
  if (!status) status = cb_output_open(&probe, directory, "bench.csv");
  if (status) return status;
  cb_output_abandon(&probe);
  *r = empty;
  return CB_OK;
}

void cb_results_free(struct cb_results *r) {
  free(r->rows);
  free(r->samples);
  free(r->ratios);
  free(r->fits);
  free(r->crossings);
  free(r->convergences);
  free(r->rooflines);
  free(r->speeds);
  free(r->frames);
  *r = (struct cb_results){0};
}

struct cb_row cb_row_unmeasured(const char *figure, const char *variant,
                                const struct cb_mesh *mesh) {
  struct cb_row row = {.figure = figure,
                       .tetrahedra = mesh->tets,
                       .nodes = mesh->nodes,
                       .threads = 1,
                       .step = {NAN, NAN, NAN},
                       .bytes_per_tetrahedron = NAN,
                       .setup_s = NAN,
                       .update_s = NAN,
                       .solve_s = NAN,
                       .product_s = NAN,
                       .scatter = NAN};
  snprintf(row.variant, sizeof row.variant, "%s", variant);
  return row;
}

void *cb_results_grown(void *list, size_t count, size_t size) {
  if (count & (count - 1)) return list;
  return realloc(list, (count ? 2 * count : 1) * size);
}

#define APPEND(array, count, item)                                                                 \
  do {                                                                                             \
    void *const larger = cb_results_grown(array, count, sizeof *(item));                           \
    if (!larger) return cb_fail_memory("the results");                                             \
    (array) = larger;                                                                              \
    (array)[(count)++] = *(item);                                                                  \
    return CB_OK;                                                                                  \
  } while (0)

enum cb_status cb_results_add_row(struct cb_results *r, const struct cb_row *row) {
  struct cb_row own = *row;
  own.session = r->session;
  APPEND(r->rows, r->row_count, &own);
}

static enum cb_status add_sample(struct cb_results *r, const struct cb_sample *sample) {
  APPEND(r->samples, r->sample_count, sample);
}

enum cb_status cb_results_add_ratio(struct cb_results *r, const struct cb_ratio *ratio) {
  APPEND(r->ratios, r->ratio_count, ratio);
}

enum cb_status cb_results_add_fit(struct cb_results *r, const struct cb_fit *fit) {
  APPEND(r->fits, r->fit_count, fit);
}

enum cb_status cb_results_add_crossing(struct cb_results *r, const struct cb_crossing *crossing) {
  APPEND(r->crossings, r->crossing_count, crossing);
}

enum cb_status cb_results_add_convergence(struct cb_results *r,
                                          const struct cb_convergence *convergence) {
  APPEND(r->convergences, r->convergence_count, convergence);
}

enum cb_status cb_results_add_roofline(struct cb_results *r, const struct cb_roofline *roofline) {
  APPEND(r->rooflines, r->roofline_count, roofline);
}

enum cb_status cb_results_add_speed(struct cb_results *r, const struct cb_speed *speed) {
  APPEND(r->speeds, r->speed_count, speed);
}

enum cb_status cb_results_add_frame(struct cb_results *r, const struct cb_frame *frame) {
  APPEND(r->frames, r->frame_count, frame);
}

enum cb_status cb_results_add_measured(struct cb_results *r, const struct cb_row *row,
                                       const struct cb_samples *samples, size_t subject) {
  struct cb_row filled = *row;
  const size_t first = subject * samples->stride;
  filled.epochs = samples->rounds;
  enum cb_status status =
      cb_median_interval(samples->rounds, samples->step_s + first, &filled.step, &filled.scatter);
  if (!filled.status[0])
    snprintf(filled.status, sizeof filled.status, "%s",
             cb_scatter_stable(filled.scatter) ? "ok" : "unstable");
  if (!status) status = cb_results_add_row(r, &filled);
  for (size_t i = 0; !status && i < samples->rounds; i++)
    status = add_sample(r, &(struct cb_sample){.row = r->row_count - 1,
                                               .round = i,
                                               .repeats = samples->repeats[first + i],
                                               .step_s = samples->step_s[first + i],
                                               .cpu_s = samples->cpu_s[first + i]});
  return status;
}

static enum cb_status write_footer(const struct cb_results *r) {
  struct cb_output output;
  const enum cb_status status = cb_output_open(&output, r->directory, "footer.txt");
  if (status) return status;
  char line[512];
  cb_environment_line(&r->environment, sizeof line, line);
  fprintf(output.stream, "%s%s", line, r->quick ? " | QUICK RUN, few samples" : "");
  if (r->session > 1) fprintf(output.stream, " | resumed, %zu sessions", r->session);
  fprintf(output.stream, "\n");
  return cb_output_commit(&output);
}

enum cb_status cb_results_write(const struct cb_results *r) {
  enum cb_status status = cb_results_write_tables(r);
  if (!status) status = cb_results_write_json(r, "bench.json", true);
  if (!status) status = cb_results_write_json(r, "environment.json", false);
  if (!status) status = write_footer(r);
  return status;
}
