/* sweep_breakdown.c - one implicit step of a block on systems that conjugate gradients are
 * not made for: indefinite, singular, with numbers that are not finite. A row is finite when
 * the step is; and, where what goes in is finite and of ordinary size, when the solver had
 * not to keep out what the kernel made of it. It breaks a law when an operator that is
 * claimed to be positive semi-definite is found not to be, in spite of the mass that is
 * added to it, or when a fixed node moves.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/extremes/exact.h"
#include "harness/extremes/report.h"
#include "harness/progress.h"

enum { ITERATIONS = 20 };

/* ---- the systems: what is done to a block at rest, free, without velocity ---------------- */

static void scale(struct cb_bench_scene *s, double factor, int axes) {
  for (size_t i = 0; i < 3 * s->mesh.nodes; i++)
    if ((int)(i % 3) < axes) s->x[i] *= factor;
}

static void squeezed(struct cb_bench_scene *s) { scale(s, 0.3, 3); }
static void mirrored(struct cb_bench_scene *s) { scale(s, -1, 1); }
static void plane(struct cb_bench_scene *s) { scale(s, 0, 1); }
static void line(struct cb_bench_scene *s) { scale(s, 0, 2); }
static void point(struct cb_bench_scene *s) { scale(s, 0, 3); }
static void slack(struct cb_bench_scene *s) {
  (void)cb_material_isotropic(0, 0.4, 1000, &s->material);
}
static void nothing(struct cb_bench_scene *s) {
  slack(s);
  memset(s->mass, 0, s->mesh.nodes * sizeof *s->mass);
}
/* The last cell of ten tetrahedra goes, its nodes stay. */
static void isolated(struct cb_bench_scene *s) {
  s->mesh.tets -= 10;
  cb_mesh_mass(&s->mesh, s->material.density, s->mass);
}
static void held(struct cb_bench_scene *s) { memset(s->fixed, 1, s->mesh.nodes); }
static void stiff(struct cb_bench_scene *s) {
  (void)cb_material_isotropic(1e38, 0.4, 1000, &s->material);
}
static void not_a_number(struct cb_bench_scene *s) { s->x[3] = NAN; }
static void infinite(struct cb_bench_scene *s) { s->x[3] = INFINITY; }

struct system {
  const char *name;
  void (*make)(struct cb_bench_scene *s);
  bool sound;    /* finite numbers of ordinary size: so should be everything */
  bool definite; /* M is positive, x is finite: so is A if K is semi-definite */
};
static const struct system systems[] = {{"squeezed to 0.3", squeezed, true, true},
                                        {"mirrored", mirrored, true, true},
                                        {"flattened to a plane", plane, true, true},
                                        {"drawn to a line", line, true, true},
                                        {"collapsed to a point", point, true, true},
                                        {"no stiffness", slack, true, true},
                                        {"no stiffness, no mass", nothing, true, false},
                                        {"isolated nodes under load", isolated, true, false},
                                        {"everything fixed", held, true, true},
                                        {"Young's modulus 1e38", stiff, false, false},
                                        {"a position NaN", not_a_number, false, false},
                                        {"a position infinite", infinite, false, false}};
enum { SYSTEMS = sizeof systems / sizeof *systems };

static bool is_flat(const struct system *s) {
  return s->make == plane || s->make == line || s->make == point;
}

/* ---- one step --------------------------------------------------------------------------- */

static const char *const ending[] = {[CB_ENDED_ITERATIONS] = "all iterations",
                                     [CB_ENDED_SOLVED] = "solved",
                                     [CB_ENDED_INDEFINITE] = "not positive definite",
                                     [CB_ENDED_OVERFLOW] = "not finite"};

static double largest(size_t n, const double *a) {
  double most = 0;
  for (size_t i = 0; i < n; i++)
    if (!(fabs(a[i]) <= most)) most = fabs(a[i]);
  return most;
}

/* Long: mass does not hide what the stiffness is. Each node is pushed by 1 N. */
static enum cb_status step(const struct system *system, const struct cb_bench_scene *s,
                           struct cb_extreme *row) {
  static const struct cb_step_parameters one_second = {.h = 1, .iterations = ITERATIONS};
  const size_t nodes = s->mesh.nodes;
  struct cb_job job = {0};
  double *work = malloc(3 * nodes * sizeof *work);
  void *load = NULL;
  enum cb_status status = work ? CB_OK : cb_fail_memory("a step of the extremes");
  if (!status) status = cb_job_create(row->variant, 1, s, &one_second, &job);
  if (!status && !(load = aligned_alloc(64, job.vector_bytes)))
    status = cb_fail_memory("a step of the extremes");
  if (status) goto done;
  for (size_t i = 0; i < 3 * nodes; i++) work[i] = 1;
  row->variant->arithmetic->from_double(nodes, work, load);
  cb_stepper_step(job.stepper, job.x, job.v, load);
  const struct cb_ended ended = cb_stepper_ended(job.stepper);
  row->finite = cb_job_finite(&job, cb_stepper_dv(job.stepper), work) &&
                !(system->sound && ended.why == CB_ENDED_OVERFLOW);
  snprintf(row->note, sizeof row->note, "%s after %zu of %d, dv up to %.2g m/s", ending[ended.why],
           ended.iterations, ITERATIONS, largest(3 * nodes, work));
  if (!row->finite && is_flat(system) && cb_divides_by_volume(row->variant->model)) {
    row->why = CB_WHY_METHOD;
    snprintf(row->note, sizeof row->note, "by method: B is divided by a volume of 0; solver: %s",
             ending[ended.why]);
  }
  if (system->make == held && largest(3 * nodes, work) != 0) row->law = "fixed nodes stay";
  if (system->definite && ended.why == CB_ENDED_INDEFINITE &&
      row->variant->model->laws[0] & CB_KEEPS(CB_LAW_SEMIDEFINITE))
    row->law = cb_law_name[CB_LAW_SEMIDEFINITE];
done:
  cb_job_free(&job);
  free(load);
  free(work);
  return status;
}

static enum cb_status run_system(size_t n, struct cb_extremes *all) {
  static const size_t cells[3] = {2, 1, 1};
  struct cb_bench_scene s;
  enum cb_status status = cb_bench_scene_grid(cells, all->seed, &s);
  if (status) return status;
  memcpy(s.x, s.mesh.X, 3 * s.mesh.nodes * sizeof *s.x);
  memset(s.v, 0, 3 * s.mesh.nodes * sizeof *s.v);
  memset(s.fixed, 0, s.mesh.nodes);
  systems[n].make(&s);
  for (size_t v = 0; !status && all->variants[v]; v++) {
    struct cb_extreme row = cb_extreme_blank("breakdown", all->variants[v]);
    snprintf(row.parameter, sizeof row.parameter, "%s", systems[n].name);
    row.value = (double)n;
    status = step(&systems[n], &s, &row);
    if (!status) status = cb_extremes_add(all, &row);
  }
  cb_bench_scene_free(&s);
  return status;
}

static enum cb_status run(struct cb_extremes *all) {
  enum cb_status status = CB_OK;
  cb_progress_begin("breakdown", SYSTEMS);
  for (size_t n = 0; !status && n < SYSTEMS; n++) {
    cb_progress((double)n, systems[n].name);
    status =
        cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted; no table") : run_system(n, all);
  }
  cb_progress_end();
  return status;
}

const struct cb_sweep cb_sweep_breakdown = {
    "breakdown", "conjugate gradients on indefinite, singular and infinite systems", run};
