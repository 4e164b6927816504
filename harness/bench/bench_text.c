/* Cells and titles of the tables that bench prints.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/bench/bench.h"

void cb_bench_print(FILE *stream, const char *title, struct cb_table *t) {
  if (t && !cb_table_is_empty(t)) {
    fprintf(stream, "\n%s\n", title);
    cb_table_print(t, CB_TABLE, stream);
  }
  cb_table_free(t);
}

void cb_bench_step_cell(struct cb_table *t, const struct cb_row *row, double scale) {
  char text[48] = "-";
  if (row && isfinite(row->step.value))
    snprintf(text, sizeof text, "%.4g%s", row->step.value * scale,
             strcmp(row->status, "ok") == 0 ? "" : "*");
  else if (row && strncmp(row->status, "failed", 6) == 0)
    snprintf(text, sizeof text, "failed");
  cb_table_text(t, text);
}

void cb_bench_number_cell(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

/* Three digits or more; at least two behind the point below ten. */
static void print_number(double value, size_t size, char *text) {
  if (isinf(value))
    snprintf(text, size, "never");
  else
    snprintf(text, size, "%.*f", fabs(value) < 10 ? 2 : fabs(value) < 100 ? 1 : 0, value);
}

void cb_bench_interval_cell(struct cb_table *t, struct cb_interval interval) {
  char text[120], value[32], low[32], high[32];
  print_number(interval.value, sizeof value, value);
  print_number(interval.low, sizeof low, low);
  print_number(interval.high, sizeof high, high);
  if (isnan(interval.value))
    snprintf(text, sizeof text, "-");
  else if (isinf(interval.low))
    snprintf(text, sizeof text, "never");
  else
    snprintf(text, sizeof text, "%s [%s, %s]", value, low, high);
  cb_table_text(t, text);
}

const struct cb_row *cb_bench_row(const struct cb_results *r, const struct cb_row *like,
                                  size_t tetrahedra, size_t iterations) {
  for (size_t i = 0; i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (strcmp(row->figure, like->figure) == 0 && strcmp(row->variant, like->variant) == 0 &&
        row->threads == like->threads && row->tetrahedra == tetrahedra &&
        row->iterations == iterations)
      return row;
  }
  return NULL;
}
