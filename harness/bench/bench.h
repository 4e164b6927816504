/* bench.h - what the figures of bench share: the scene, variants that are ready
 * to step on it, and blocks of them timed in the same rounds.
 *
 * Each figure is one file, harness/bench_NAME.c, that measures and prints it.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_BENCH_H
#define CB_BENCH_H

#include "harness/measure/results.h"
#include "harness/verbs/verbs.h"

/* ---- scene ---------------------------------------------------------------- */

/* A block, or a mesh scaled to the block's height, of 0.1 m; its lowest nodes
 * are fixed; it starts twisted and slightly shaken. E = 1e5 Pa, nu = 0.4,
 * 1000 kg/m^3. */
struct cb_bench_scene {
  struct cb_mesh mesh;
  struct cb_material material;
  double *mass;   /* [nodes], kg */
  uint8_t *fixed; /* [nodes] */
  double *x, *v;  /* [3*nodes] at the start, m, m/s */
};
/* nx*ny*nz cells of ten tetrahedra. CB_MEMORY. */
enum cb_status cb_bench_scene_grid(const size_t cells[3], unsigned long seed,
                                   struct cb_bench_scene *scene);
/* The same block as a mesh without any regularity, its numbers shuffled
 * (cb_mesh_irregular), then in the program's own order. CB_MEMORY. */
enum cb_status cb_bench_scene_irregular(const size_t cells[3], unsigned long seed,
                                        struct cb_bench_scene *scene);
/* See cb_mesh_read; CB_INPUT also for a mesh without height. Nodes and tetrahedra
 * come in the program's own order (cb_order_create), not in the file's. */
enum cb_status cb_bench_scene_mesh(const char *path, unsigned long seed,
                                   struct cb_bench_scene *scene);
void cb_bench_scene_free(struct cb_bench_scene *scene); /* zeroed is allowed */

/* The paper's step: h = 0.4 ms, 5 iterations; undamped. */
extern const struct cb_step_parameters cb_bench_step;
/* The paper's mesh: 512 nodes, 3430 tetrahedra. */
extern const size_t cb_bench_paper_cells[3];

/* ---- a run of bench -------------------------------------------------------- */

struct cb_gate_result;
struct cb_journal;

struct cb_bench {
  const struct cb_options *options;
  double seconds; /* of all figures */
  double done_s;  /* of the time planned for the figures that are asked for */
  /* As asked for; else 1 and, where there are two processors, 2; and 1 alone for the
   * paper's own arithmetic. */
  struct cb_threads threads, paper_threads;
  struct cb_results results;
  struct cb_gate_result *gates; /* [variants]: what has been verified so far */
  struct cb_journal *journal;   /* finished parts, not owned; NULL: none are kept */
};

struct cb_bench_figure {
  const char *name;
  double share; /* of the seconds */
  bool whole;   /* one part; the others are made of parts (cb_bench_part) */
  enum cb_status (*run)(struct cb_bench *b, double budget_s);
  void (*print)(const struct cb_results *r, FILE *stream); /* nothing if nothing was measured */
};
extern const struct cb_bench_figure cb_bench_figure4, cb_bench_figure7, cb_bench_convergence,
    cb_bench_memory, cb_bench_ancestors, cb_bench_mesh, cb_bench_roofline, cb_bench_speed,
    cb_bench_scaling;

/* An empty run into options->output, or results/latest. options is kept. CB_IO,
 * CB_MEMORY. */
enum cb_status cb_bench_create(const struct cb_options *options, bool quick, double seconds,
                               struct cb_bench *b);
void cb_bench_free(struct cb_bench *b);

/* A part of a run that is finished or not: what is timed in the same rounds, so that nothing
 * is ever compared across two sessions. If the journal has the part, its results are added
 * from there and nothing is done; else `work` is, and what it has added goes to the journal. */
typedef enum cb_status cb_bench_work(struct cb_bench *b, void *context);
enum cb_status cb_bench_part(struct cb_bench *b, const char *key, cb_bench_work *work,
                             void *context);

/* What is timed without --threads: 1 and, where there are two processors, 2. */
struct cb_threads cb_bench_threads(void);
/* What is timed. */
struct cb_entry {
  const struct cb_variant *variant;
  size_t threads;
};
/* The arithmetic with the most lanes of scalars of that size that runs here. */
const struct cb_arithmetic *cb_bench_lanes(size_t scalar_bytes);
/* *list := what is to be timed, *count of them, to be freed: the variants that
 * --variant selects, or without it those that are `wanted`, each with every number of
 * threads. `counted` is never timed. CB_MEMORY. */
enum cb_status cb_bench_select(const struct cb_bench *b, bool (*wanted)(const struct cb_variant *v),
                               struct cb_entry **list, size_t *count);
/* The entries that are alike to entries[first], itself included, into list[count];
 * returns how many: none if an earlier one is alike, so that every group comes up
 * once. */
size_t cb_bench_group(size_t first, size_t count, const struct cb_entry *entries,
                      bool (*alike)(const struct cb_entry *e, const struct cb_entry *f),
                      struct cb_entry *list);
/* *reason := why the variant may not be timed, "" if it may; valid as long as b.
 * Verifies each variant once. CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_bench_gate(struct cb_bench *b, const struct cb_variant *v, const char **reason);

/* ---- blocks ----------------------------------------------------------------- */

/* Record a sentence for what kernels or reference returned, as they record none,
 * and return it; what: the name of what failed. CB_OK is passed on. */
enum cb_status cb_bench_explain(enum cb_status status, const char *what);

/* A variant on the scene, ready to step. */
struct cb_job {
  const struct cb_variant *variant;
  size_t threads;
  char name[CB_NAME];
  struct cb_operator *op;
  struct cb_stepper *stepper;
  size_t vector_bytes;
  void *start_x, *start_v, *x, *v; /* node vectors of the arithmetic */
  double setup_s;
  bool lost; /* a position was not finite after the steps, or the conjugate gradients of
                one ended before their iterations: no time counts */
};
/* CB_MEMORY. */
enum cb_status cb_job_create(const struct cb_variant *v, size_t threads,
                             const struct cb_bench_scene *scene,
                             const struct cb_step_parameters *step, struct cb_job *job);
void cb_job_free(struct cb_job *job); /* zeroed is allowed */
/* What a timer prepares and runs (cb_subject): back to the start; so many steps, which set
 * `lost`. */
void cb_job_restore(void *job);
void cb_job_steps(void *job, size_t repeats);
/* Is a node vector of the job finite? work[3*nodes]. */
bool cb_job_finite(const struct cb_job *job, const void *vector, double *work);

struct cb_block;

/* Variants times iteration counts on one scene, all to be timed in the same
 * rounds. Nothing is owned. */
struct cb_block_plan {
  const char *figure; /* string constant */
  const struct cb_bench_scene *scene;
  size_t entry_count, count_count;
  const struct cb_entry *entries;
  const size_t *iterations; /* [count_count] */
  bool parts;               /* time update, solve and product as well; for one count */
  double budget_s;
  /* Called with what was timed; NULL: nothing. */
  enum cb_status (*after)(struct cb_bench *b, const struct cb_block *block);
  void *context; /* of the caller, for `after` */
};
struct cb_block {
  const struct cb_block_plan *plan;
  size_t job_count; /* of the entries whose variants passed the gate */
  struct cb_job *jobs;
  struct cb_samples samples; /* of subject job * count_count + count */
};
/* Time the entries whose variants pass the gate for about budget_s and give every
 * entry its rows: one part of the run. No two blocks of a figure may have the same mesh,
 * iterations, first and last entry and number of entries. */
enum cb_status cb_bench_block(struct cb_bench *b, const struct cb_block_plan *plan);
/* The samples of one job at one iteration count, [samples.rounds], s. */
const double *cb_block_step_s(const struct cb_block *block, size_t job, size_t count);
/* Add the ratio of two jobs' times; paper: what the paper says, or NaN. */
enum cb_status cb_block_ratio(struct cb_bench *b, const struct cb_block *block, size_t job,
                              size_t base, size_t count, double paper);
/* Add the ratios of all jobs that the rule pairs: each frame by QR with the same
 * strain-displacement policy, each other policy of QR by qr-updated; same
 * storage, arithmetic and threads. */
enum cb_status cb_block_ratios(struct cb_bench *b, const struct cb_block *block);

/* ---- text ------------------------------------------------------------------- */

/* Print title and table and free it; NULL: nothing. */
void cb_bench_print(FILE *stream, const char *title, struct cb_table *t);
/* A cell "12.3" of value * scale; "*" behind it marks an unstable row, "-" stands
 * for nothing measured, "failed" for a variant that failed verification. */
void cb_bench_step_cell(struct cb_table *t, const struct cb_row *row, double scale);
/* A number, or "-" for NaN. */
void cb_bench_number_cell(struct cb_table *t, double value);
/* A cell "1.30 [1.28, 1.33]"; "never" stands for infinity, "-" for NaN. */
void cb_bench_interval_cell(struct cb_table *t, struct cb_interval interval);
/* The row of the same figure, variant and threads, of that size and iteration
 * count, or NULL. */
const struct cb_row *cb_bench_row(const struct cb_results *r, const struct cb_row *like,
                                  size_t tetrahedra, size_t iterations);

#endif
