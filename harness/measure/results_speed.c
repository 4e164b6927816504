/* The CSV files of the figures of speed: roofline, speed, scaling, frame.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "harness/measure/results_cells.h"

struct cb_table *cb_results_roofline_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create(
      "work,variant,mesh,tetrahedra,threads,flops_per_tetrahedron,bytes_per_tetrahedron,"
      "time_s_median,time_s_low,time_s_high,flops_per_byte,gflops,gb_per_s,level,peak_gflops,"
      "level_gb_per_s,attainable_gflops,percent_of_peak,percent_of_attainable,"
      "node_visits_per_tetrahedron,quick");
  for (size_t i = 0; t && i < r->roofline_count; i++) {
    const struct cb_roofline *p = &r->rooflines[i];
    const double rate = p->flops * (double)p->tetrahedra / p->time.value;
    cb_table_text(t, p->work);
    cb_table_text(t, p->variant);
    cb_table_text(t, p->mesh);
    count_cell(t, p->tetrahedra);
    count_cell(t, p->threads);
    cell(t, p->flops);
    cell(t, p->bytes);
    interval_cells(t, p->time);
    cell(t, p->flops / p->bytes);
    cell(t, 1e-9 * rate);
    cell(t, 1e-9 * p->bytes * (double)p->tetrahedra / p->time.value);
    cb_table_text(t, p->level);
    cell(t, 1e-9 * p->peak);
    cell(t, 1e-9 * p->bandwidth);
    cell(t, 1e-9 * p->attainable);
    cell(t, 100 * rate / p->peak);
    cell(t, 100 * rate / p->attainable);
    cell(t, p->visits);
    cb_table_integer(t, r->quick);
  }
  return t;
}

struct cb_table *cb_results_speed_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create(
      "variant,mesh,tetrahedra,threads,step_s_median,step_s_low,step_s_high,times_faster,"
      "times_faster_low,times_faster_high,bytes_per_tetrahedron,force_error,position_error,quick");
  for (size_t i = 0; t && i < r->speed_count; i++) {
    const struct cb_speed *s = &r->speeds[i];
    cb_table_text(t, s->variant);
    cb_table_text(t, s->mesh);
    count_cell(t, s->tetrahedra);
    count_cell(t, s->threads);
    interval_cells(t, s->step);
    interval_cells(t, s->faster);
    cell(t, s->bytes_per_tetrahedron);
    cell(t, s->force_error);
    cell(t, s->position_error);
    cb_table_integer(t, r->quick);
  }
  return t;
}

/* Time on one thread by that of the row, from the same rounds. */
static struct cb_interval speedup(const struct cb_results *r, const struct cb_row *row) {
  for (size_t i = 0; i < r->ratio_count; i++) {
    const struct cb_ratio *c = &r->ratios[i];
    if (strcmp(c->figure, row->figure) == 0 && strcmp(c->denominator, row->variant) == 0 &&
        strcmp(c->numerator, row->variant) == 0 && c->tetrahedra == row->tetrahedra &&
        c->iterations == row->iterations && c->threads == 1 &&
        c->denominator_threads == row->threads)
      return c->ratio;
  }
  return (struct cb_interval){NAN, NAN, NAN};
}

struct cb_table *cb_results_scaling_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create(
      "variant,tetrahedra,iterations,threads,step_s_median,step_s_low,step_s_high,"
      "ns_per_tetrahedron,speedup,speedup_low,speedup_high,bytes_per_tetrahedron,setup_s,status,"
      "quick");
  for (size_t i = 0; t && i < r->row_count; i++) {
    const struct cb_row *row = &r->rows[i];
    if (strcmp(row->figure, "scaling") != 0) continue;
    cb_table_text(t, row->variant);
    count_cell(t, row->tetrahedra);
    count_cell(t, row->iterations);
    count_cell(t, row->threads);
    interval_cells(t, row->step);
    cell(t, 1e9 * row->step.value / (double)row->tetrahedra);
    interval_cells(t, speedup(r, row));
    cell(t, row->bytes_per_tetrahedron);
    cell(t, row->setup_s);
    cb_table_text(t, row->status);
    cb_table_integer(t, r->quick);
  }
  return t;
}

static void size_cells(struct cb_table *t, const struct cb_frame_size *size) {
  if (size->cells == 0) {
    for (int i = 0; i < 6; i++) cb_table_missing(t);
    return;
  }
  count_cell(t, size->cells);
  count_cell(t, size->tetrahedra);
  interval_cells(t, size->step);
  cell(t, size->bytes);
}

struct cb_table *cb_results_frame_table(const struct cb_results *r) {
  struct cb_table *t = cb_table_create(
      "variant,mesh,threads,iterations,limit_s,cells,tetrahedra,step_s_median,step_s_low,"
      "step_s_high,bytes,exceeding_cells,exceeding_tetrahedra,exceeding_step_s_median,"
      "exceeding_step_s_low,exceeding_step_s_high,exceeding_bytes,measurements,quick");
  for (size_t i = 0; t && i < r->frame_count; i++) {
    const struct cb_frame *f = &r->frames[i];
    cb_table_text(t, f->variant);
    cb_table_text(t, f->mesh);
    count_cell(t, f->threads);
    count_cell(t, f->iterations);
    cell(t, f->limit_s);
    size_cells(t, &f->fits);
    size_cells(t, &f->exceeds);
    count_cell(t, f->measurements);
    cb_table_integer(t, r->quick);
  }
  return t;
}
