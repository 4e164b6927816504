/* results.h - one run of bench: what was measured, and the files it becomes.
 *
 * A directory holds one run: each write replaces all of its files, each of them
 * whole. In the files a NaN is an empty cell (JSON: null): not measured.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_RESULTS_H
#define CB_RESULTS_H

#include "harness/files/table.h"
#include "harness/measure/environment.h"
#include "harness/measure/statistics.h"
#include "harness/measure/timer.h"

enum { CB_NAME = 96, CB_STATUS_TEXT = 200 };

/* bench.csv: one variant at one size and iteration count. */
struct cb_row {
  const char *figure; /* string constant */
  char variant[CB_NAME];
  size_t tetrahedra, nodes, iterations, threads;
  struct cb_interval step; /* s */
  double bytes_per_tetrahedron;
  char status[CB_STATUS_TEXT];                  /* "ok", "unstable" or "failed: why" */
  double setup_s, update_s, solve_s, product_s; /* parts, timed apart */
  double scatter;
  size_t epochs;
  size_t session; /* that timed it, from 1: more than one if the run was resumed */
};
/* samples.csv: one epoch of a row. */
struct cb_sample {
  size_t row, round, repeats;
  double step_s, cpu_s;
};
/* ratios.csv: time of one variant by that of another, from the same rounds. */
struct cb_ratio {
  const char *figure;
  char numerator[CB_NAME], denominator[CB_NAME];
  size_t tetrahedra, iterations;
  size_t threads, denominator_threads;
  struct cb_interval ratio;
  double paper; /* NaN: the paper has none */
};
/* fits.csv: time of a step = fixed + iteration * iterations. */
struct cb_fit {
  char variant[CB_NAME];
  size_t tetrahedra, threads;
  struct cb_interval fixed, iteration; /* s */
};
/* crossings.csv: from so many iterations on, assembling is the cheaper; INFINITY
 * (an empty cell): never. */
struct cb_crossing {
  char assembled[CB_NAME], unassembled[CB_NAME];
  size_t tetrahedra, threads;
  struct cb_interval iterations;
  double paper;
};
/* convergence.csv: |dv - dv direct| / |dv direct| after so many iterations. */
struct cb_convergence {
  char variant[CB_NAME];
  size_t tetrahedra, iterations;
  double h, error; /* s, 1 */
};

/* roofline.csv: one product, or one whole step, against what the machine allows.
 * Flops and bytes are of one tetrahedron; NaN: not defined. */
struct cb_roofline {
  const char *work, *mesh, *level; /* string constants; level: "" for a step */
  char variant[CB_NAME];
  size_t tetrahedra, threads;
  double flops, bytes, visits;        /* per tetrahedron; visits: cb_operator_visits */
  struct cb_interval time;            /* s, of all tetrahedra */
  double peak, bandwidth, attainable; /* flop/s, B/s, flop/s */
};
/* speed.csv: how many times faster than the base, and how far from f64. */
struct cb_speed {
  const char *mesh;
  char variant[CB_NAME];
  size_t tetrahedra, threads;
  struct cb_interval step, faster; /* s, 1 */
  double bytes_per_tetrahedron;
  double force_error, position_error; /* relative, see bench_speed.c */
};
/* frame33.csv: the largest mesh whose step fits into the frame, and the smallest that
 * was found not to. */
struct cb_frame {
  const char *mesh;
  char variant[CB_NAME];
  size_t threads, iterations, measurements;
  double limit_s;
  struct cb_frame_size {
    size_t cells, tetrahedra; /* cells along each edge; 0: none was found */
    struct cb_interval step;  /* s */
    double bytes;             /* of operator, solver and node vectors */
  } fits, exceeds;
};

/* The arrays may be read, and grow by the functions below only. */
struct cb_results {
  const char *directory; /* not owned */
  bool quick;
  size_t session; /* of what is added; 1 unless the run is a resumed one */
  struct cb_environment environment;
  size_t row_count, sample_count, ratio_count, fit_count, crossing_count, convergence_count;
  size_t roofline_count, speed_count, frame_count;
  struct cb_row *rows;
  struct cb_sample *samples;
  struct cb_ratio *ratios;
  struct cb_fit *fits;
  struct cb_crossing *crossings;
  struct cb_convergence *convergences;
  struct cb_roofline *rooflines;
  struct cb_speed *speeds;
  struct cb_frame *frames;
};

/* An empty run; makes the directory and tries to write there, so that a place
 * that cannot be written is found before anything is measured. What an earlier
 * run left there stays until the first write. CB_IO. */
enum cb_status cb_results_create(const char *directory, bool quick, struct cb_results *r);
void cb_results_free(struct cb_results *r); /* zeroed is allowed */

/* A row of one thread whose every number is NaN, 0 or "" but for these. */
struct cb_row cb_row_unmeasured(const char *figure, const char *variant,
                                const struct cb_mesh *mesh);

/* Append a copy, of this session. CB_MEMORY. */
enum cb_status cb_results_add_row(struct cb_results *r, const struct cb_row *row);
/* The row and its samples: step, scatter, epochs and, unless it is a failure
 * already (not ""), status are filled in from them. */
enum cb_status cb_results_add_measured(struct cb_results *r, const struct cb_row *row,
                                       const struct cb_samples *samples, size_t subject);
enum cb_status cb_results_add_ratio(struct cb_results *r, const struct cb_ratio *ratio);
enum cb_status cb_results_add_fit(struct cb_results *r, const struct cb_fit *fit);
enum cb_status cb_results_add_crossing(struct cb_results *r, const struct cb_crossing *crossing);
enum cb_status cb_results_add_convergence(struct cb_results *r,
                                          const struct cb_convergence *convergence);
enum cb_status cb_results_add_roofline(struct cb_results *r, const struct cb_roofline *roofline);
enum cb_status cb_results_add_speed(struct cb_results *r, const struct cb_speed *speed);
enum cb_status cb_results_add_frame(struct cb_results *r, const struct cb_frame *frame);

/* A list with room for one more item of that size, or NULL with the list unharmed; its length
 * doubles at the powers of two. */
void *cb_results_grown(void *list, size_t count, size_t size);

/* Write bench.csv, samples.csv, bench.json (a subset of Google Benchmark's
 * schema), ratios.csv, fits.csv, crossings.csv, convergence.csv,
 * roofline.csv, speed.csv, scaling.csv (rows of that figure), frame33.csv,
 * environment.json and footer.txt (one line, for plots). CB_IO, CB_MEMORY. */
enum cb_status cb_results_write(const struct cb_results *r);
/* Its parts: the CSV files; one JSON file, with or without the benchmarks. */
enum cb_status cb_results_write_tables(const struct cb_results *r);
enum cb_status cb_results_write_json(const struct cb_results *r, const char *name, bool benchmarks);
/* What is in each file, for the tables of figures. NULL when out of memory. */
struct cb_table *cb_results_roofline_table(const struct cb_results *r);
struct cb_table *cb_results_speed_table(const struct cb_results *r);
struct cb_table *cb_results_scaling_table(const struct cb_results *r);
struct cb_table *cb_results_frame_table(const struct cb_results *r);
/* What is in bench.csv. NULL when out of memory. */
struct cb_table *cb_results_bench_table(const struct cb_results *r);

#endif
