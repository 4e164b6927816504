/* sweep_contrast.c - two halves of a bar whose densities, or Young's moduli, are far apart.
 *
 * An operator has one material. Densities differ in the masses that its stepper is given.
 * Moduli differ between two operators, one on each half, whose forces and products are
 * added; and conjugate gradients of this file's own, in double and to a residual, on that
 * sum. Errors are against the same sum in quad precision, in units of a rounding of the
 * sum: what the soft half loses beside the stiff one is what they do not show.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/bench/bench.h"
#include "harness/error.h"
#include "harness/extremes/report.h"
#include "harness/files/mesh.h"
#include "harness/progress.h"
#include "harness/verify/probe.h"

/* h: the step that stiffens (M + h^2 K); residual: by which the solution is done */
enum { CELLS = 4, MOST_ITERATIONS = 1000 };
static const double STEP = 1e-3, RESIDUAL = 1e-6, YOUNG = 1e3;
static const double ratios[] = {1, 1e3, 1e6, 1e9, 1e12};
static const double densities[] = {1, 1e3, 1e6, 1e9};
enum { RATIOS = sizeof ratios / sizeof *ratios, DENSITIES = sizeof densities / sizeof *densities };

static enum cb_status open_bar(unsigned long seed, struct cb_bench_scene *s) {
  static const size_t cells[3] = {CELLS, 1, 1};
  return cb_bench_scene_grid(cells, seed, s);
}

/* ---- two densities ---------------------------------------------------------------------- */

static enum cb_status run_density(const struct cb_bench_scene *s, struct cb_extreme *row) {
  const struct cb_step_parameters step = {.h = STEP, .iterations = MOST_ITERATIONS};
  struct cb_job job = {0};
  double *work = malloc(3 * s->mesh.nodes * sizeof *work);
  enum cb_status status = work ? CB_OK : cb_fail_memory("a bar of two densities");
  if (!status) status = cb_job_create(row->variant, 1, s, &step, &job);
  if (!status) {
    cb_stepper_step(job.stepper, job.x, job.v, NULL);
    const struct cb_ended ended = cb_stepper_ended(job.stepper);
    row->finite = ended.why != CB_ENDED_OVERFLOW && cb_job_finite(&job, job.x, work) &&
                  cb_job_finite(&job, job.v, work);
    snprintf(row->note, sizeof row->note, "%s after %zu iterations",
             ended.why == CB_ENDED_SOLVED       ? "solved to rounding"
             : ended.why == CB_ENDED_ITERATIONS ? "not solved to rounding"
                                                : "ended early",
             ended.iterations);
  }
  cb_job_free(&job);
  free(work);
  return status;
}

static enum cb_status sweep_density(struct cb_extremes *all) {
  struct cb_bench_scene s;
  enum cb_status status = open_bar(all->seed, &s);
  if (status) return status;
  for (size_t n = 0; !status && n < DENSITIES; n++) {
    cb_mesh_mass(&s.mesh, s.material.density, s.mass);
    const struct cb_box box = cb_mesh_bounds(&s.mesh);
    for (size_t i = 0; i < s.mesh.nodes; i++)
      if (s.mesh.X[3 * i] > (box.low[0] + box.high[0]) / 2) s.mass[i] *= densities[n];
    for (size_t v = 0; !status && all->variants[v]; v++) {
      struct cb_extreme row = cb_extreme_blank("contrast", all->variants[v]);
      snprintf(row.parameter, sizeof row.parameter, "densities 1 : %g", densities[n]);
      row.value = densities[n];
      status = run_density(&s, &row);
      if (!status) status = cb_extremes_add(all, &row);
    }
  }
  cb_bench_scene_free(&s);
  return status;
}

/* ---- two moduli --------------------------------------------------------------------------- */

struct halves {
  const struct cb_bench_scene *s;
  struct cb_probe probe[2];
  size_t length; /* 3*nodes */
  double *work;  /* [length] */
};

static void close_halves(struct halves *h) {
  cb_probe_close(&h->probe[0]);
  cb_probe_close(&h->probe[1]);
  free(h->work);
}

static enum cb_status open_halves(const struct cb_variant *v, const struct cb_bench_scene *s,
                                  double ratio, struct halves *h) {
  *h = (struct halves){.s = s, .length = 3 * s->mesh.nodes};
  h->work = malloc(h->length * sizeof *h->work);
  enum cb_status status = h->work ? CB_OK : cb_fail_memory("two halves of a bar");
  for (int n = 0; !status && n < 2; n++) {
    struct cb_material m;
    struct cb_mesh half = s->mesh;
    half.tets = s->mesh.tets / 2, half.tet += n ? 4 * half.tets : 0;
    status = cb_material_isotropic(n ? YOUNG * ratio : YOUNG, 0.3, 1000, &m);
    if (!status) status = cb_probe_open(v, &half, &m, &h->probe[n]);
  }
  if (status) close_halves(h);
  return status;
}

static void force(struct halves *h, const double *x, double *f) {
  cb_probe_force(&h->probe[0], x, f);
  cb_probe_force(&h->probe[1], x, h->work);
  for (size_t i = 0; i < h->length; i++) f[i] += h->work[i];
}

static void product(struct halves *h, const double *u, double *y) {
  cb_probe_product(&h->probe[0], u, y);
  cb_probe_product(&h->probe[1], u, h->work);
  for (size_t i = 0; i < h->length; i++) y[i] += h->work[i];
}

static double dot(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum += a[i] * b[i];
  return sum;
}

static double distance(size_t n, const double *a, const double *b) {
  double sum = 0;
  for (size_t i = 0; i < n; i++) sum = hypot(sum, a[i] - b[i]);
  return sum;
}

/* The larger of both halves' |r| / |b|: beside the stiff one the soft one's would not be
 * seen. The nodes between them count as stiff. */
static double residual(const struct halves *h, const double *b, const double *r) {
  const struct cb_box box = cb_mesh_bounds(&h->s->mesh);
  const double soft = 0.51 * box.low[0] + 0.49 * box.high[0];
  double rr[2] = {0}, bb[2] = {0};
  for (size_t i = 0; i < h->length; i++) {
    const int half = h->s->mesh.X[i / 3 * 3] > soft;
    rr[half] += r[i] * r[i], bb[half] += b[i] * b[i];
  }
  return sqrt(fmax(rr[0] / bb[0], rr[1] / bb[1]));
}

/* (M + h^2 K) dv = b until *left, the residual, is small. The iterations. */
static size_t solve(struct halves *h, const double *b, double *vectors, double *left) {
  const size_t n = h->length;
  double *dv = vectors, *r = dv + n, *p = r + n, *y = p + n;
  memset(dv, 0, n * sizeof *dv);
  memcpy(r, b, n * sizeof *r);
  memcpy(p, b, n * sizeof *p);
  double rr = dot(n, b, b);
  size_t k = 0;
  for (; (*left = residual(h, b, r)) > RESIDUAL && k < MOST_ITERATIONS; k++) {
    product(h, p, y);
    for (size_t i = 0; i < n; i++) y[i] = h->s->mass[i / 3] * p[i] + STEP * STEP * y[i];
    const double py = dot(n, p, y);
    if (!(py > 0)) break;
    for (size_t i = 0; i < n; i++) dv[i] += rr / py * p[i], r[i] -= rr / py * y[i];
    const double next = dot(n, r, r);
    for (size_t i = 0; i < n; i++) p[i] = r[i] + next / rr * p[i];
    rr = next;
  }
  return k;
}

/* f, y of the counted arithmetic, and what a rounding of the positions moves f by. */
struct exact {
  double *f, *y, *u, roundoff, f_unit, y_unit;
};

static enum cb_status know(const struct cb_variant *v, const struct cb_bench_scene *s, double ratio,
                           double *work, struct exact *e) {
  char name[96];
  struct halves h;
  double *f = work, *x = f + 3 * s->mesh.nodes;
  snprintf(name, sizeof name, "%s/ebe/counted", v->model->name);
  const struct cb_variant *counted = cb_variant_find(name);
  e->f_unit = e->y_unit = NAN;
  if (!counted) return CB_OK;
  enum cb_status status = open_halves(counted, s, ratio, &h);
  if (status) return status;
  for (size_t i = 0; i < h.length; i++) /* each coordinate, up or down by a rounding */
    x[i] = s->x[i] * (1 + (i * i % 7 < 4 ? 1 : -1) * e->roundoff);
  force(&h, x, f);
  product(&h, e->u, x);
  force(&h, s->x, e->f);
  product(&h, e->u, e->y);
  e->f_unit = e->roundoff * sqrt(dot(h.length, e->f, e->f)) + distance(h.length, f, e->f);
  e->y_unit = e->roundoff * sqrt(dot(h.length, e->y, e->y)) + distance(h.length, x, e->y);
  close_halves(&h);
  return CB_OK;
}

static enum cb_status run_moduli(const struct cb_bench_scene *s, double *work,
                                 struct cb_extreme *row) {
  const size_t n = 3 * s->mesh.nodes;
  struct exact e = {work, work + n, work + 2 * n, row->variant->arithmetic->roundoff, NAN, NAN};
  double *f = work + 3 * n, *y = f + n, *vectors = y + n, left;
  struct halves h;
  for (size_t i = 0; i < n; i++) e.u[i] = (float)s->v[i];
  enum cb_status status = know(row->variant, s, row->value, vectors, &e);
  if (!status) status = open_halves(row->variant, s, row->value, &h);
  if (status) return status;
  force(&h, s->x, f);
  product(&h, e.u, y);
  row->force_error = distance(n, f, e.f) / e.f_unit;
  row->product_error = distance(n, y, e.y) / e.y_unit;
  for (size_t i = 0; i < n; i++) f[i] *= STEP;
  const size_t iterations = solve(&h, f, vectors, &left);
  for (size_t i = 0; i < n; i++)
    if (!isfinite(f[i] + y[i] + vectors[i])) row->finite = false;
  const bool ended = left > RESIDUAL && iterations < MOST_ITERATIONS;
  snprintf(row->note, sizeof row->note, "residual %.2g after %zu iterations%s", left, iterations,
           ended ? ": not positive definite" : "");
  close_halves(&h);
  return CB_OK;
}

/* x in numbers of float, so that every arithmetic means the same. */
static enum cb_status sweep_moduli(struct cb_extremes *all) {
  struct cb_bench_scene s;
  enum cb_status status = open_bar(all->seed, &s);
  if (status) return status;
  for (size_t i = 0; i < 3 * s.mesh.nodes; i++)
    s.x[i] = (float)s.x[i], s.mesh.X[i] = (float)s.mesh.X[i];
  double *work = malloc(10 * 3 * s.mesh.nodes * sizeof *work);
  if (!work) status = cb_fail_memory("two moduli");
  for (size_t n = 0; !status && n < RATIOS; n++)
    for (size_t v = 0; !status && all->variants[v]; v++) {
      struct cb_extreme row = cb_extreme_blank("contrast", all->variants[v]);
      snprintf(row.parameter, sizeof row.parameter, "Young's moduli 1 : %g", ratios[n]);
      row.value = ratios[n];
      cb_progress((double)n, row.parameter);
      status = cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted; no table")
                                : run_moduli(&s, work, &row);
      if (!status) status = cb_extremes_add(all, &row);
    }
  free(work);
  cb_bench_scene_free(&s);
  return status;
}

static enum cb_status run(struct cb_extremes *all) {
  cb_progress_begin("contrast", RATIOS);
  enum cb_status status = sweep_density(all);
  if (!status) status = sweep_moduli(all);
  cb_progress_end();
  return status;
}

const struct cb_sweep cb_sweep_contrast = {
    "contrast", "neighbours of other density, or of another Young's modulus", run};
