/* run.c - see run.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/scene/way.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/measure/timer.h"
#include "harness/progress.h"
#include "reference/energy.h"

/* ---- one step ------------------------------------------------------------------------ */

static void move_handles(struct cb_way *w, double t) {
  cb_body_grip(w->body, t, w->x);
  for (size_t n = 0; n < w->body->scene->handle_count; n++)
    for (size_t i = 0; i < w->body->grip[n].count; i++) {
      const size_t node = w->body->grip[n].node[i];
      if (!cb_handle_holds(w->body->grip[n].handle, t)) break;
      for (size_t k = 0; k < 3; k++) cb_way_put(w, w->job.x, node, k, w->x[3 * node + k]);
    }
}

/* In double, as the direct solver is. */
static enum cb_status step_directly(struct cb_way *w) {
  double *x = w->job.x, *v = w->job.v, *dv = w->f;
  const struct cb_bench_scene *at = &w->body->at;
  cb_stepper_right_side(w->job.stepper, x, v, w->external);
  cb_operator_blocks(w->job.op, w->blocks);
  enum cb_status status = cb_direct_factor(w->direct, w->blocks, w->diagonal);
  if (!status) status = cb_direct_solve(w->direct, cb_stepper_b(w->job.stepper), dv);
  for (size_t i = 0; !status && i < 3 * at->mesh.nodes; i++) {
    v[i] = w->held[i / 3] ? 0 : v[i] + dv[i];
    x[i] += w->step.h * v[i];
  }
  return cb_bench_explain(status, "a step of the scene");
}

/* ---- a look --------------------------------------------------------------------------- */

/* The larger one; NaN if either is. */
static double larger(double a, double b) { return isnan(a) || a > b ? a : b; }

/* Sums over the elastic forces, which are internal: they should vanish. */
static void look_at_forces(struct cb_way *w) {
  const size_t nodes = w->body->at.mesh.nodes;
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  double c[3] = {0}, net[3] = {0}, torque[3] = {0}, force = 0, lever = 0;
  cb_operator_update(w->job.op, w->job.x, NULL, 1, w->force);
  a->to_double(nodes, w->force, w->f);
  for (size_t i = 0; i < 3 * nodes; i++) c[i % 3] += w->x[i] / (double)nodes;
  for (size_t i = 0; i < nodes; i++) {
    const double *f = w->f + 3 * i;
    double r[3];
    for (int k = 0; k < 3; k++) r[k] = w->x[3 * i + k] - c[k];
    for (int k = 0; k < 3; k++) {
      net[k] += f[k];
      torque[k] += r[(k + 1) % 3] * f[(k + 2) % 3] - r[(k + 2) % 3] * f[(k + 1) % 3];
    }
    const double size = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
    force += size;
    lever += size * sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]);
  }
  w->most_net = larger(sqrt(net[0] * net[0] + net[1] * net[1] + net[2] * net[2]), w->most_net);
  w->most_torque = larger(
      sqrt(torque[0] * torque[0] + torque[1] * torque[1] + torque[2] * torque[2]), w->most_torque);
  w->most_force = larger(force, w->most_force);
  w->most_lever = larger(lever, w->most_lever);
}

static void look(struct cb_way *w, struct cb_outcome *o, size_t sample) {
  const struct cb_bench_scene *at = &w->body->at;
  const struct cb_arithmetic *a = w->job.variant->arithmetic;
  a->to_double(at->mesh.nodes, w->job.x, w->x);
  a->to_double(at->mesh.nodes, w->job.v, w->v);
  for (size_t i = 0; i < 3 * at->mesh.nodes; i++)
    if (!isfinite(w->x[i]) || !isfinite(w->v[i])) o->finite = false;
  if (!o->finite) return;
  cb_body_points(w->body, w->x, o->point[sample]);
  look_at_forces(w);
  double kinetic = 0;
  for (size_t i = 0; i < 3 * at->mesh.nodes; i++)
    kinetic += at->mass[i / 3] / 2 * w->v[i] * w->v[i];
  o->energy[sample] = kinetic + cb_elastic_energy(&at->mesh, &w->material, w->x, &o->inverted);
  o->distance = cb_body_distance(w->body, w->x);
  if (o->inverted > o->most_inverted) o->most_inverted = o->inverted;
  o->most_distance = larger(o->distance, o->most_distance);
}

/* ---- all steps -------------------------------------------------------------------------- */

static int ascending(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static enum cb_status step_once(struct cb_way *w, size_t n, struct cb_outcome *o) {
  enum cb_status status = cb_way_change(w, n);
  if (status) return status;
  if (w->body->scene->handle_count) move_handles(w, (double)(n + 1) * w->step.h);
  const double begin = cb_timer_now();
  if (w->direct)
    status = step_directly(w);
  else
    cb_stepper_step(w->job.stepper, w->job.x, w->job.v, w->external);
  w->time[n] = cb_timer_now() - begin;
  if (!w->direct) {
    const enum cb_ending why = cb_stepper_ended(w->job.stepper).why;
    o->indefinite += why == CB_ENDED_INDEFINITE;
    if (why == CB_ENDED_OVERFLOW) o->finite = false;
  }
  if (w->touching) cb_way_land(w);
  if (cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted while simulating");
  return status;
}

static void conclude(struct cb_way *w, struct cb_outcome *o, size_t steps) {
  qsort(w->time, steps, sizeof *w->time, ascending);
  o->steps = w->steps;
  o->step_s = w->time[steps / 2];
  o->seconds = o->step_s / w->step.h;
  if (!o->finite) o->distance = NAN;
  o->torque = !o->finite ? NAN : w->most_lever > 0 ? w->most_torque / w->most_lever : 0;
  o->net_force = !o->finite ? NAN : w->most_force > 0 ? w->most_net / w->most_force : 0;
}

static enum cb_status show(struct cb_way *w, const struct cb_watch *watch, size_t step) {
  if (!watch || (step % watch->every && step < w->steps)) return CB_OK;
  w->job.variant->arithmetic->to_double(w->body->at.mesh.nodes, w->job.x, w->x);
  return watch->see(watch->context, (double)step * w->step.h, w->x);
}

enum cb_status cb_body_run(const struct cb_body *body, const struct cb_trial *trial,
                           struct cb_outcome *outcome) {
  return cb_body_show(body, trial, NULL, outcome);
}

enum cb_status cb_body_show(const struct cb_body *body, const struct cb_trial *trial,
                            const struct cb_watch *watch, struct cb_outcome *outcome) {
  struct cb_way w;
  struct cb_outcome o = {.finite = true};
  enum cb_status status = cb_way_open(body, trial, &w);
  size_t done = 0;
  const size_t between = w.steps / CB_SAMPLES;
  if (!status) status = show(&w, watch, 0);
  while (!status && o.finite && done < w.steps) {
    status = step_once(&w, done++, &o);
    if (!status && done % between == 0) look(&w, &o, done / between - 1);
    if (!status) status = show(&w, watch, done);
  }
  if (!status) {
    conclude(&w, &o, done);
    *outcome = o;
  }
  cb_way_close(&w);
  return status;
}

static enum cb_status find_truth(const struct cb_body *body, const struct cb_trial *trial,
                                 struct cb_outcome *truth) {
  enum cb_status status = cb_body_run(body, trial, truth);
  if (!status && !truth->finite)
    status = cb_fail(CB_NUMERIC,
                     "scene '%s' has no truth: it breaks down at a tenth of its step; "
                     "give it a shorter one",
                     body->scene->name);
  return status;
}

enum cb_status cb_body_truth(const struct cb_body *body, struct cb_outcome *truth) {
  const struct cb_trial trial = {.variant = cb_variant_find("polar-exact/bcsr/f64"),
                                 .threads = 1,
                                 .step = body->scene->step / 10};
  return find_truth(body, &trial, truth);
}

enum cb_status cb_body_truth_iterated(const struct cb_body *body, size_t threads,
                                      struct cb_outcome *truth) {
  char name[CB_NAME];
  snprintf(name, sizeof name, "polar-exact/ebe-cluster/%s", cb_bench_lanes(sizeof(double))->name);
  const struct cb_trial trial = {.variant = cb_variant_find(name),
                                 .threads = threads,
                                 .iterations = 200,
                                 .step = body->scene->step / 10};
  return find_truth(body, &trial, truth);
}

double cb_outcome_error(const struct cb_outcome *outcome, const struct cb_outcome *truth,
                        double size) {
  double worst = outcome->finite ? 0 : NAN;
  for (size_t s = 0; s < CB_SAMPLES; s++)
    for (size_t p = 0; p < 3 * CB_POINTS; p += 3) {
      const double *a = outcome->point[s] + p, *b = truth->point[s] + p;
      worst = larger(worst, sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                                 (a[2] - b[2]) * (a[2] - b[2])) /
                                size);
    }
  return worst;
}

double cb_outcome_energy_error(const struct cb_outcome *outcome, const struct cb_outcome *truth) {
  double worst = outcome->finite ? 0 : NAN, largest = 0;
  for (size_t s = 0; s < CB_SAMPLES; s++) {
    worst = larger(worst, fabs(outcome->energy[s] - truth->energy[s]));
    largest = fmax(largest, fabs(truth->energy[s]));
  }
  return worst / largest;
}

bool cb_outcome_recovers(const struct cb_outcome *outcome, const struct cb_needs *needs) {
  return outcome->finite && outcome->inverted == 0 && outcome->distance <= needs->rest;
}
