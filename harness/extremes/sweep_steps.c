/* sweep_steps.c - the largest step that a variant stands, by integrator, from 1e-7 to 1 s;
 * and what a million steps do to energy and momenta.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/report.h"
#include "harness/extremes/steps.h"
#include "harness/progress.h"

/* Stable: in so many steps the energy has never been ten times that of the start. While
 * symplectic Euler is stable it swings by 1 / (1 - (h omega / 2)^2), five times at nine
 * tenths of the limit. The decades are tried from below, the first bad one is halved. */
enum { STEPS = 300, LOOKS = 30, DECADES = 8, HALVINGS = 5 };
static const double SHORTEST = 1e-7, TEN_TIMES = 10;
/* A thirtieth of the longest that symplectic Euler stands. */
enum { MILLION = 1000000, DRIFT_LOOKS = 100 };
static const double DRIFT_STEP = 1e-4;

static bool stable(const struct cb_swing *s) { return s->finite && s->most < TEN_TIMES; }

struct limit {
  double h;              /* the largest stable step; 0: none */
  struct cb_swing there; /* with it */
  struct cb_swing last;  /* with one second */
};

static enum cb_status find_limit(const struct cb_variant *v, const struct cb_bench_scene *scene,
                                 enum cb_integrator integrator, struct limit *l) {
  struct cb_swing s;
  double good = 0, bad = 0;
  *l = (struct limit){.there = {false, NAN, NAN, NAN, NAN}};
  enum cb_status status = cb_swing(v, scene, integrator, 1, STEPS, LOOKS, &l->last);
  for (int n = 0; !status && !(bad > 0) && n < DECADES; n++) {
    const double h = SHORTEST * pow(10, n);
    status = cb_swing(v, scene, integrator, h, STEPS, LOOKS, &s);
    if (stable(&s))
      good = h, l->there = s;
    else
      bad = h;
  }
  for (int n = 0; !status && good > 0 && bad > 0 && n < HALVINGS; n++) {
    const double h = sqrt(good * bad);
    status = cb_swing(v, scene, integrator, h, STEPS, LOOKS, &s);
    if (stable(&s))
      good = h, l->there = s;
    else
      bad = h;
  }
  l->h = good;
  return status;
}

/* The same in columns. */
static enum cb_status add_columns(const struct cb_variant *v, enum cb_integrator integrator,
                                  const char *what, double h, size_t steps,
                                  const struct cb_swing *s, struct cb_extremes *all) {
  const struct cb_extreme_step step = {.variant = v,
                                       .integrator = cb_integrator_name[integrator],
                                       .what = what,
                                       .h = h,
                                       .steps = steps,
                                       .finite = s->finite,
                                       .most = s->most,
                                       .energy = s->energy,
                                       .momentum = s->momentum,
                                       .angular = s->angular};
  return cb_extremes_add_step(all, &step);
}

/* A step that is too long is no fault of a variant: nothing is broken by a row. */
static enum cb_status add_limit(const struct cb_variant *v, const struct cb_bench_scene *scene,
                                enum cb_integrator integrator, struct cb_extremes *all) {
  struct cb_extreme row = cb_extreme_blank("steps", v);
  struct limit l;
  enum cb_status status = find_limit(v, scene, integrator, &l);
  if (status) return status;
  row.value = l.h;
  row.finite = l.h > 0;
  snprintf(row.parameter, sizeof row.parameter, "%s: largest stable step, s",
           cb_integrator_name[integrator]);
  if (l.last.finite)
    snprintf(row.note, sizeof row.note, "at 1 s energy up to %.3g of the start's", l.last.most);
  else
    snprintf(row.note, sizeof row.note, "at 1 s not finite");
  status = add_columns(v, integrator, "largest stable", l.h, STEPS, &l.there, all);
  if (!status) status = add_columns(v, integrator, "one second", 1, STEPS, &l.last, all);
  return status ? status : cb_extremes_add(all, &row);
}

static enum cb_status add_drift(const struct cb_variant *v, const struct cb_bench_scene *scene,
                                enum cb_integrator integrator, struct cb_extremes *all) {
  struct cb_extreme row = cb_extreme_blank("steps", v);
  struct cb_swing s;
  enum cb_status status = cb_swing(v, scene, integrator, DRIFT_STEP, MILLION, DRIFT_LOOKS, &s);
  if (status) return status;
  row.value = DRIFT_STEP;
  row.finite = s.finite;
  snprintf(row.parameter, sizeof row.parameter, "%s: a million steps",
           cb_integrator_name[integrator]);
  snprintf(row.note, sizeof row.note, "energy x %.4g, most %.4g; momentum %.1e, angular %.1e",
           s.energy, s.most, s.momentum, s.angular);
  status = add_columns(v, integrator, "million", DRIFT_STEP, MILLION, &s, all);
  return status ? status : cb_extremes_add(all, &row);
}

/* Of those that have the same formulas in more lanes one is enough. */
static bool wanted(const struct cb_variant *v) { return v->arithmetic->lanes == 1; }

struct bodies {
  const struct cb_variant *variant;
  const struct cb_bench_scene *body, *one;
};

static enum cb_status run_variant(struct cb_extremes *all, const void *context) {
  const struct bodies *b = context;
  const struct cb_variant *v = b->variant;
  char name[96];
  enum cb_status status = add_limit(v, b->body, CB_IMPLICIT_ITERATED, all);
  if (!status) status = add_limit(v, b->body, CB_EXPLICIT, all);
  if (v->arithmetic != cb_arithmetics[0]) return status;
  snprintf(name, sizeof name, "%s/bcsr/f64", v->model->name);
  const struct cb_variant *direct = cb_variant_find(name);
  if (!status && direct) status = add_limit(direct, b->body, CB_IMPLICIT_DIRECT, all);
  if (!status) status = add_drift(v, b->one, CB_EXPLICIT, all);
  return status;
}

static enum cb_status run(struct cb_extremes *all) {
  struct cb_bench_scene body = {0}, one = {0};
  enum cb_status status = cb_swing_body(all->seed, &body);
  if (!status) status = cb_swing_tetrahedron(all->seed, &one);
  size_t variants = 0;
  while (all->variants[variants]) variants++;
  cb_progress_begin("steps", (double)variants);
  for (size_t n = 0; !status && n < variants; n++) {
    const struct bodies part = {all->variants[n], &body, &one};
    char key[128] = "steps: ";
    cb_variant_name(part.variant, key + strlen(key));
    cb_progress((double)n, key + strlen("steps: "));
    if (wanted(part.variant)) status = cb_extremes_part(all, key, run_variant, &part);
  }
  cb_progress_end();
  cb_bench_scene_free(&body);
  cb_bench_scene_free(&one);
  return status;
}

const struct cb_sweep cb_sweep_steps = {"steps",
                                        "largest stable step by integrator; a million steps", run};
