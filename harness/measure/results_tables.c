/* The CSV files of a run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/results_cells.h"

struct cb_table *cb_results_bench_table(const struct cb_results *r) {
  struct cb_table *t =
      cb_table_create("figure,variant,tetrahedra,nodes,iterations,threads,step_s_median,step_s_low,"
                      "step_s_high,bytes_per_tetrahedron,status,setup_s,update_s,solve_s,product_s,"
                      "scatter,epochs,quick,session");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    cb_table_text(t, row->figure);
    cb_table_text(t, row->variant);
    count_cell(t, row->tetrahedra);
    count_cell(t, row->nodes);
    count_cell(t, row->iterations);
    count_cell(t, row->threads);
    interval_cells(t, row->step);
    cell(t, row->bytes_per_tetrahedron);
    cb_table_text(t, row->status);
    cell(t, row->setup_s);
    cell(t, row->update_s);
    cell(t, row->solve_s);
    cell(t, row->product_s);
    cell(t, row->scatter);
    count_cell(t, row->epochs);
    cb_table_integer(t, r->quick);
    count_cell(t, row->session);
  }
  return t;
}

/* As many digits as the clock has; 17 would double the file. */
static void clock_cell(struct cb_table *t, double seconds) {
  char text[32];
  snprintf(text, sizeof text, "%.9g", seconds);
  cb_table_text(t, text);
}

static struct cb_table *samples_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create(
      "figure,variant,tetrahedra,iterations,threads,round,steps,step_s,cpu_s,quick");
  for (size_t i = 0; t && i < r->sample_count; i++) {
    const struct cb_sample *sample = &r->samples[i];
    const struct cb_row *row = &r->rows[sample->row];
    cb_table_text(t, row->figure);
    cb_table_text(t, row->variant);
    count_cell(t, row->tetrahedra);
    count_cell(t, row->iterations);
    count_cell(t, row->threads);
    count_cell(t, sample->round);
    count_cell(t, sample->repeats);
    clock_cell(t, sample->step_s);
    clock_cell(t, sample->cpu_s);
    cb_table_integer(t, r->quick);
  }
  return t;
}

static struct cb_table *ratios_table(const struct cb_results *r) {
  struct cb_table *t =
      cb_table_create("figure,numerator,denominator,tetrahedra,iterations,threads,"
                      "denominator_threads,ratio_median,ratio_low,ratio_high,paper,quick");
  for (size_t i = 0; t && i < r->ratio_count; i++) {
    const struct cb_ratio *ratio = &r->ratios[i];
    cb_table_text(t, ratio->figure);
    cb_table_text(t, ratio->numerator);
    cb_table_text(t, ratio->denominator);
    count_cell(t, ratio->tetrahedra);
    count_cell(t, ratio->iterations);
    count_cell(t, ratio->threads);
    count_cell(t, ratio->denominator_threads);
    interval_cells(t, ratio->ratio);
    cell(t, ratio->paper);
    cb_table_integer(t, r->quick);
  }
  return t;
}

static struct cb_table *fits_table(const struct cb_results *r) {
  struct cb_table *t =
      cb_table_create("variant,tetrahedra,threads,fixed_s,fixed_s_low,fixed_s_high,"
                      "iteration_s,iteration_s_low,iteration_s_high,quick");
  for (size_t i = 0; t && i < r->fit_count; i++) {
    const struct cb_fit *fit = &r->fits[i];
    cb_table_text(t, fit->variant);
    count_cell(t, fit->tetrahedra);
    count_cell(t, fit->threads);
    interval_cells(t, fit->fixed);
    interval_cells(t, fit->iteration);
    cb_table_integer(t, r->quick);
  }
  return t;
}

static struct cb_table *crossings_table(const struct cb_results *r) {
  struct cb_table *t =
      cb_table_create("assembled,unassembled,tetrahedra,threads,iterations,iterations_low,"
                      "iterations_high,paper,status,quick");
  for (size_t i = 0; t && i < r->crossing_count; i++) {
    const struct cb_crossing *c = &r->crossings[i];
    cb_table_text(t, c->assembled);
    cb_table_text(t, c->unassembled);
    count_cell(t, c->tetrahedra);
    count_cell(t, c->threads);
    interval_cells(t, c->iterations);
    cell(t, c->paper);
    cb_table_text(t, isinf(c->iterations.value) ? "never" : "ok");
    cb_table_integer(t, r->quick);
  }
  return t;
}

static struct cb_table *convergence_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create("variant,tetrahedra,h_s,iterations,error,quick");
  for (size_t i = 0; t && i < r->convergence_count; i++) {
    const struct cb_convergence *c = &r->convergences[i];
    cb_table_text(t, c->variant);
    count_cell(t, c->tetrahedra);
    cell(t, c->h);
    count_cell(t, c->iterations);
    cell(t, c->error);
    cb_table_integer(t, r->quick);
  }
  return t;
}

enum cb_status cb_results_write_tables(const struct cb_results *r) {
  static const struct {
    const char *name;
    struct cb_table *(*make)(const struct cb_results *r);
  } files[] = {{"bench.csv", cb_results_bench_table},
               {"samples.csv", samples_table},
               {"ratios.csv", ratios_table},
               {"fits.csv", fits_table},
               {"crossings.csv", crossings_table},
               {"convergence.csv", convergence_table},
               {"roofline.csv", cb_results_roofline_table},
               {"speed.csv", cb_results_speed_table},
               {"scaling.csv", cb_results_scaling_table},
               {"frame33.csv", cb_results_frame_table}};
  enum cb_status status = CB_OK;
  for (size_t i = 0; !status && i < sizeof files / sizeof *files; i++) {
    struct cb_table *t = files[i].make(r);
    status = t ? cb_output_table(r->directory, files[i].name, t, CB_CSV)
               : cb_fail_memory("a table of results");
    cb_table_free(t);
  }
  return status;
}
