/* How far from what the machine allows: products and steps under the roofline that
 * is measured in the same run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/cost.h"
#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/measure/machine.h"
#include "harness/progress.h"

/* The paper's block, and a mesh beyond the second cache. */
enum { MESHES = 2 };
static const struct place {
  const char *name;
  enum cb_status (*make)(const size_t cells[3], unsigned long seed, struct cb_bench_scene *scene);
  size_t cells[3], quick_cells[3];
  size_t counted_cells[3]; /* of a smaller mesh of this kind, for counting */
} PLACES[MESHES] = {{"grid", cb_bench_scene_grid, {7, 7, 7}, {7, 7, 7}, {5, 5, 5}},
                    {"irregular", cb_bench_scene_irregular, {26, 26, 26}, {18, 18, 18}, {6, 6, 6}}};

enum { ROUNDS = 15, MIN_ROUNDS = 6, WORKS = 2 };
static const char *const WORK_NAME[WORKS] = {"product", "step"};
static const double MACHINE_S = 5, MIN_EPOCH = 2e-3; /* s */

/* One product where all frames share it, and whole steps of the frames. */
static bool wanted(const struct cb_variant *v) {
  const struct cb_arithmetic *a = v->arithmetic, *f32 = cb_bench_lanes(sizeof(float));
  const char *name = v->model->name;
  if (a != cb_arithmetics[0] && a != f32 && a != cb_bench_lanes(sizeof(double))) return false;
  if (strcmp(name, "qr-updated") == 0)
    return v->storage != CB_EBE_PAPER && v->storage != CB_EBE_MATRIX && v->storage != CB_CSR;
  return a == f32 && v->storage == CB_EBE_CLUSTER &&
         (strcmp(name, "qr-exact") == 0 || strcmp(name, "polar-closed-updated") == 0 ||
          strcmp(name, "svd-updated") == 0);
}

/* A job with its counts. */
struct point {
  struct cb_job job;
  double flops[WORKS]; /* per tetrahedron */
};

struct session {
  struct cb_bench *b;
  const struct cb_machine *machine;
  const struct place *place;
  const struct cb_bench_scene *scene, *counted;
  size_t count;
  struct point *points;
  double first_s, budget_s; /* of the planned time */
};

static void show(void *context, double share, const char *what) {
  const struct session *s = context;
  char text[CB_NAME + 32];
  snprintf(text, sizeof text, "roofline: %s", what);
  cb_progress(s->b->done_s + s->first_s + share * s->budget_s, text);
}

static enum cb_status refuse(struct session *s, struct cb_entry entry, const char *reason) {
  char name[CB_NAME];
  cb_variant_name(entry.variant, name);
  struct cb_row row = cb_row_unmeasured("roofline", name, &s->scene->mesh);
  row.threads = entry.threads;
  snprintf(row.status, sizeof row.status, "failed: %s", reason);
  return cb_results_add_row(&s->b->results, &row);
}

/* Counts do not depend on the arithmetic, nor those of elements on the size of the
 * mesh; a matrix has more blocks a tetrahedron the more surface there is. */
static enum cb_status count_flops(struct session *s, struct point *p) {
  for (const struct point *q = s->points; q < p; q++)
    if (q->job.variant->storage == p->job.variant->storage &&
        strcmp(q->job.variant->model->name, p->job.variant->model->name) == 0) {
      memcpy(p->flops, q->flops, sizeof p->flops);
      return CB_OK;
    }
  const struct cb_variant *v = p->job.variant;
  const struct cb_bench_scene *scene = cb_cost_assembled(v) ? s->scene : s->counted;
  enum cb_status status = cb_cost_product(v, scene, &p->flops[0]);
  if (!status) status = cb_cost_step(v, s->counted, &p->flops[1]);
  return status;
}

static enum cb_status admit(struct session *s, struct cb_entry entry) {
  const char *reason;
  struct point *p = &s->points[s->count];
  enum cb_status status = cb_bench_gate(s->b, entry.variant, &reason);
  if (status) return status;
  if (cb_interrupted()) return cb_fail(CB_INTERRUPTED, "interrupted before a measurement");
  if (reason[0]) return refuse(s, entry, reason);
  status = cb_job_create(entry.variant, entry.threads, s->scene, &cb_bench_step, &p->job);
  if (status) return status;
  s->count++;
  show(s, 0, p->job.name);
  cb_stepper_right_side(p->job.stepper, p->job.x, p->job.v, NULL); /* a state for the product */
  return count_flops(s, p);
}

static void restore(void *context) {
  struct cb_job *job = context;
  memcpy(job->x, job->start_x, job->vector_bytes);
  memcpy(job->v, job->start_v, job->vector_bytes);
}

static void run_product(void *context, size_t repeats) {
  struct cb_job *job = context;
  for (size_t i = 0; i < repeats; i++) cb_operator_product(job->op, job->start_v, job->v);
}

static void run_steps(void *context, size_t repeats) {
  struct cb_job *job = context;
  for (size_t i = 0; i < repeats; i++) cb_stepper_step(job->stepper, job->x, job->v, NULL);
}

static enum cb_crew crew_of(const struct cb_machine *m, size_t threads) {
  return threads == m->threads[CB_ONE] ? CB_ONE : threads == m->threads[CB_ALL] ? CB_ALL : CB_CREWS;
}

/* What the machine allows; NaN for numbers of threads that it was not asked for. Of a
 * step, bytes are not counted: only the peak. */
static void add_bounds(const struct session *s, bool product, const struct cb_job *job,
                       struct cb_roofline *r) {
  const struct cb_machine *m = s->machine;
  const enum cb_crew crew = crew_of(m, job->threads);
  const enum cb_scalar scalar =
      job->variant->arithmetic->scalar_bytes == sizeof(float) ? CB_F32 : CB_F64;
  r->peak = crew < CB_CREWS ? m->peak_flops[scalar][crew] : NAN;
  r->level = "";
  r->bytes = r->bandwidth = r->attainable = NAN;
  if (!product) return;
  r->bytes = cb_cost_bytes(job->op, &s->scene->mesh);
  const enum cb_level level =
      cb_machine_level(&s->b->results.environment, r->bytes * (double)r->tetrahedra, job->threads);
  r->level = cb_level_name[level];
  if (crew == CB_CREWS) return;
  r->bandwidth = m->bandwidth[level][crew];
  r->attainable = cb_machine_attainable(m, r->flops, r->bytes, level, crew, scalar);
}

static enum cb_status add_point(const struct session *s, const struct cb_samples *samples,
                                size_t subject) {
  const struct point *p = &s->points[subject / WORKS];
  const size_t work = subject % WORKS;
  struct cb_roofline r = {.work = WORK_NAME[work],
                          .mesh = s->place->name,
                          .tetrahedra = s->scene->mesh.tets,
                          .threads = p->job.threads,
                          .flops = p->flops[work],
                          .visits = cb_operator_visits(p->job.op)};
  snprintf(r.variant, sizeof r.variant, "%s", p->job.name);
  enum cb_status status = cb_median_interval(
      samples->rounds, samples->step_s + subject * samples->stride, &r.time, NULL);
  if (status) return status;
  add_bounds(s, work == 0, &p->job, &r);
  return cb_results_add_roofline(&s->b->results, &r);
}

static enum cb_status time_points(struct session *s) {
  const size_t count = WORKS * s->count;
  struct cb_subject *subjects = malloc((count + 1) * sizeof *subjects);
  struct cb_samples samples = {0};
  if (!subjects) return cb_fail_memory("the measurement");
  for (size_t i = 0; i < count; i++) {
    struct cb_job *job = &s->points[i / WORKS].job;
    subjects[i] = (struct cb_subject){job->name, restore, i % WORKS ? run_steps : run_product, job};
  }
  const double epoch = 0.8 * s->budget_s / (double)(count * ROUNDS);
  const struct cb_timing timing = {.epoch_s = fmax(epoch, MIN_EPOCH),
                                   .budget_s = s->budget_s,
                                   .min_rounds = MIN_ROUNDS,
                                   .max_rounds = ROUNDS,
                                   .seed = s->b->options->seed,
                                   .progress = show,
                                   .progress_context = s};
  enum cb_status status = cb_timer_run(count, subjects, &timing, &samples);
  for (size_t i = 0; !status && i < count; i++) status = add_point(s, &samples, i);
  cb_samples_free(&samples);
  free(subjects);
  return status;
}

static bool same_threads(const struct cb_entry *e, const struct cb_entry *f) {
  return e->threads == f->threads;
}

/* The entries of as many threads as entries[first]; their share of the budget. */
static enum cb_status run_group(struct session *s, size_t first, size_t count,
                                const struct cb_entry *entries, double budget_s) {
  struct cb_entry *list = malloc((count + 1) * sizeof *list);
  s->points = calloc(count + 1, sizeof *s->points);
  s->count = 0;
  enum cb_status status = list && s->points ? CB_OK : cb_fail_memory("the list of variants");
  const size_t chosen = status ? 0 : cb_bench_group(first, count, entries, same_threads, list);
  s->budget_s = budget_s * (double)chosen / (double)count;
  for (size_t i = 0; !status && i < chosen; i++) status = admit(s, list[i]);
  if (!status && s->count > 0) status = time_points(s);
  s->first_s += s->budget_s;
  for (size_t i = 0; s->points && i < s->count; i++) cb_job_free(&s->points[i].job);
  free(s->points);
  free(list);
  return status;
}

static enum cb_status run_place(struct session *s, size_t count, const struct cb_entry *entries,
                                double budget_s) {
  const unsigned long seed = s->b->options->seed;
  struct cb_bench_scene scene = {0}, counted = {0};
  const size_t *cells = s->b->results.quick ? s->place->quick_cells : s->place->cells;
  enum cb_status status = s->place->make(cells, seed, &scene);
  if (!status) status = s->place->make(s->place->counted_cells, seed, &counted);
  s->scene = &scene;
  s->counted = &counted;
  for (size_t i = 0; !status && i < count; i++) status = run_group(s, i, count, entries, budget_s);
  cb_bench_scene_free(&scene);
  cb_bench_scene_free(&counted);
  return status;
}

static enum cb_status write_machine(const struct cb_bench *b, const struct cb_machine *m) {
  struct cb_table *t = cb_machine_table(m);
  const enum cb_status status = t ? cb_output_table(b->results.directory, "machine.csv", t, CB_CSV)
                                  : cb_fail_memory("the table of the machine");
  cb_table_free(t);
  return status;
}

static enum cb_status run(struct cb_bench *b, double budget_s) {
  struct cb_machine machine;
  struct cb_entry *entries = NULL;
  size_t count = 0;
  struct session s = {.b = b, .machine = &machine, .budget_s = MACHINE_S};
  enum cb_status status = cb_bench_select(b, wanted, &entries, &count);
  if (!status) status = cb_machine_measure(show, &s, &machine);
  if (!status) status = write_machine(b, &machine);
  s.first_s = MACHINE_S;
  for (size_t i = 0; !status && i < MESHES; i++) {
    s.place = &PLACES[i];
    status = run_place(&s, count, entries, fmax(budget_s - MACHINE_S, 1) / MESHES);
  }
  free(entries);
  return status;
}

static double rate_of(const struct cb_roofline *p) {
  return p->flops * (double)p->tetrahedra / p->time.value;
}

static void print_work(const struct cb_results *r, size_t work, const char *columns,
                       const char *title, FILE *stream) {
  struct cb_table *t = cb_table_create(columns);
  for (size_t i = 0; t && i < r->roofline_count; i++) {
    const struct cb_roofline *p = &r->rooflines[i];
    if (strcmp(p->work, WORK_NAME[work]) != 0) continue;
    cb_table_text(t, p->variant);
    cb_table_text(t, p->mesh);
    cb_table_integer(t, (long long)p->tetrahedra);
    cb_table_integer(t, (long long)p->threads);
    cb_bench_number_cell(t, 1e6 * p->time.value);
    cb_bench_number_cell(t, p->flops);
    cb_bench_number_cell(t, 1e-9 * rate_of(p));
    cb_bench_number_cell(t, 100 * rate_of(p) / p->peak);
    if (work > 0) continue;
    cb_bench_number_cell(t, 100 * rate_of(p) / p->attainable);
    cb_bench_number_cell(t, p->bytes);
    cb_bench_number_cell(t, 1e-9 * p->bytes * (double)p->tetrahedra / p->time.value);
    cb_table_text(t, p->level);
  }
  cb_bench_print(stream, title, t);
}

/* The product of the same model, mesh, threads and arithmetic in clusters; NULL: not timed. */
static const struct cb_roofline *in_clusters(const struct cb_results *r,
                                             const struct cb_roofline *single) {
  char name[CB_NAME];
  struct cb_variant v = *cb_variant_find(single->variant);
  v.storage = CB_EBE_CLUSTER;
  cb_variant_name(&v, name);
  for (const struct cb_roofline *p = r->rooflines; p < r->rooflines + r->roofline_count; p++)
    if (strcmp(p->variant, name) == 0 && strcmp(p->work, single->work) == 0 &&
        strcmp(p->mesh, single->mesh) == 0 && p->threads == single->threads)
      return p;
  return NULL;
}

/* Single elements and clusters do the same arithmetic with other numbers of visits. */
static void print_split(const struct cb_results *r, FILE *stream) {
  struct cb_table *t = cb_table_create("variant,mesh,threads,ns_a_visit,ns_the_rest,"
                                       "peak_%_of_the_rest,visits,at_best_peak_%,"
                                       "visits_in_clusters,at_best_in_clusters_peak_%");
  for (size_t i = 0; t && i < r->roofline_count; i++) {
    const struct cb_roofline *p = &r->rooflines[i], *c;
    const struct cb_variant *v = cb_variant_find(p->variant);
    if (strcmp(p->work, WORK_NAME[0]) != 0 || !v || v->storage != CB_EBE) continue;
    if (v->arithmetic->lanes == 1 || !(c = in_clusters(r, p))) continue; /* one lane, one node */
    const double tets = (double)p->tetrahedra, single = p->time.value / tets;
    const double visit = (single - c->time.value / tets) / (p->visits - c->visits);
    const double rest = single - visit * p->visits, at_peak = p->flops / p->peak;
    cb_table_text(t, p->variant);
    cb_table_text(t, p->mesh);
    cb_table_integer(t, (long long)p->threads);
    cb_bench_number_cell(t, 1e9 * visit);
    cb_bench_number_cell(t, 1e9 * rest);
    cb_bench_number_cell(t, 100 * at_peak / rest);
    cb_bench_number_cell(t, p->visits);
    cb_bench_number_cell(t, 100 * at_peak / (at_peak + visit * p->visits));
    cb_bench_number_cell(t, c->visits);
    cb_bench_number_cell(t, 100 * at_peak / (at_peak + visit * c->visits));
  }
  cb_bench_print(stream,
                 "What binds a product: its time per tetrahedron, in single elements and in "
                 "clusters, as a visit of a node\n(gather, transpose, scatter) times visits, and "
                 "the rest; at best: if the rest ran at the peak",
                 t);
}

static void print(const struct cb_results *r, FILE *stream) {
  print_work(
      r, 0, "variant,mesh,tetrahedra,threads,us,flops,gflop_s,peak_%,attainable_%,bytes,gb_s,level",
      "Roofline, one product: flops (counted) and bytes per tetrahedron. Bytes: what it reads "
      "of the operator\nand two node vectors (recompute: three), each moved once; level: the "
      "cache that holds them all.\nPeak: multiply-adds of that scalar on as many threads; "
      "attainable: that, or the level's bandwidth times flops / bytes",
      stream);
  print_work(r, 1, "variant,mesh,tetrahedra,threads,us,flops,gflop_s,peak_%",
             "A whole step, 5 iterations: flops (counted) per tetrahedron against the peak",
             stream);
  print_split(r, stream);
}

/* Whole: its points stand beside bounds of the machine measured just before. */
const struct cb_bench_figure cb_bench_roofline = {"roofline", 0.06, true, run, print};
