/* The JSON files of a run.
 * Source: Google Benchmark's JSON reporter (context, benchmarks); host_name and
 * executable are left out on purpose.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/results.h"

/* Write the object and let go of it; NULL: out of memory. */
static enum cb_status dump(json_t *object, size_t flags, FILE *stream) {
  if (!object) return cb_fail_memory("the JSON results");
  const int failed = json_dumpf(object, stream, flags);
  json_decref(object);
  /* A full disk is reported when the output is committed. */
  return failed && !ferror(stream) ? cb_fail_memory("the JSON results") : CB_OK;
}

/* null for what was not measured; jansson refuses NaN. */
static json_t *nanoseconds(double seconds) {
  return isfinite(seconds) ? json_real(1e9 * seconds) : json_null();
}

/* What a sample and a median have in common; suffix is that of the name. There
 * are thousands of samples: no member that is the same in all of them. */
static json_t *benchmark_json(const struct cb_row *row, const char *suffix, const char *type,
                              double real_s, double cpu_s, size_t repeats) {
  char name[256], threads[32] = "";
  if (row->threads > 1) snprintf(threads, sizeof threads, "/threads:%zu", row->threads);
  snprintf(name, sizeof name, "figure%s/%s/%zu/%zu%s%s", row->figure, row->variant, row->tetrahedra,
           row->iterations, threads, suffix);
  return json_pack("{s:s, s:s, s:I, s:o, s:o, s:s}", "name", name, "run_type", type, "iterations",
                   (json_int_t)repeats, "real_time", nanoseconds(real_s), "cpu_time",
                   nanoseconds(cpu_s), "time_unit", "ns");
}

static json_t *sample_json(const struct cb_results *r, const struct cb_sample *s) {
  return benchmark_json(&r->rows[s->row], "", "iteration", s->step_s, s->cpu_s, s->repeats);
}

static json_t *median_json(const struct cb_results *r, size_t row, double cpu_s) {
  const struct cb_row *measured = &r->rows[row];
  json_t *o = benchmark_json(measured, "_median", "aggregate", measured->step.value, cpu_s,
                             measured->epochs);
  json_t *more = json_pack("{s:I, s:I, s:s, s:s}", "repetitions", (json_int_t)measured->epochs,
                           "threads", (json_int_t)measured->threads, "aggregate_name", "median",
                           "aggregate_unit", "time");
  const int failed = !o || !more || json_object_update(o, more) != 0;
  json_decref(more);
  if (!failed) return o;
  json_decref(o);
  return NULL;
}

/* Median processor time of the samples [begin, end). */
static enum cb_status cpu_median(const struct cb_results *r, size_t begin, size_t end,
                                 double *median) {
  struct cb_interval interval;
  double *cpu_s = malloc((end - begin) * sizeof *cpu_s);
  if (!cpu_s) return cb_fail_memory("the statistics");
  for (size_t i = begin; i < end; i++) cpu_s[i - begin] = r->samples[i].cpu_s;
  const enum cb_status status = cb_median_interval(end - begin, cpu_s, &interval, NULL);
  if (!status) *median = interval.value;
  free(cpu_s);
  return status;
}

/* One benchmark a line, so that results can be compared by diff and grep. */
static enum cb_status dump_benchmarks(const struct cb_results *r, FILE *stream) {
  const size_t flags = JSON_COMPACT | JSON_REAL_PRECISION(8);
  enum cb_status status = CB_OK;
  for (size_t i = 0, end; !status && i < r->sample_count; i = end) {
    const size_t row = r->samples[i].row;
    double cpu_s = NAN;
    for (end = i; !status && end < r->sample_count && r->samples[end].row == row; end++) {
      fprintf(stream, "%s\n", end ? "," : "");
      status = dump(sample_json(r, &r->samples[end]), flags, stream);
    }
    if (!status) status = cpu_median(r, i, end, &cpu_s);
    fprintf(stream, ",\n");
    if (!status) status = dump(median_json(r, row, cpu_s), flags, stream);
  }
  return status;
}

enum cb_status cb_results_write_json(const struct cb_results *r, const char *name,
                                     bool benchmarks) {
  struct cb_output output;
  enum cb_status status = cb_output_open(&output, r->directory, name);
  if (status) return status;
  json_t *context = cb_environment_json(&r->environment);
  if (context &&
      (json_object_set_new(context, "quick", json_boolean(r->quick)) != 0 ||
       json_object_set_new(context, "sessions", json_integer((json_int_t)r->session)) != 0)) {
    json_decref(context);
    context = NULL;
  }
  if (benchmarks) fprintf(output.stream, "{\"context\": ");
  status = dump(context, JSON_INDENT(1), output.stream);
  if (benchmarks) {
    fprintf(output.stream, ",\n\"benchmarks\": [");
    if (!status) status = dump_benchmarks(r, output.stream);
    fprintf(output.stream, "]}");
  }
  fprintf(output.stream, "\n");
  if (!status) return cb_output_commit(&output);
  cb_output_abandon(&output);
  return status;
}
