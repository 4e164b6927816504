/* advise.c - see advise.h.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/advise/explorer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/measure/timer.h"
#include "harness/progress.h"
#include "harness/verify/laws.h"

/* Models that a simulator would use; the others are kept to show what is wrong with
 * them, and are tried when --variant names them. */
static const char *const MODELS[] = {"linear",
                                     "green",
                                     "node-warp",
                                     "qr-precomputed",
                                     "qr-updated",
                                     "qr-exact",
                                     "polar-closed-precomputed",
                                     "polar-closed-updated",
                                     "polar-exact",
                                     "polar-quaternion-precomputed",
                                     "svd-updated"};
const size_t cb_advise_iterations[CB_ADVISE_ITERATIONS] = {1,  2,  3,  4,  5,  7,  10,
                                                           14, 20, 30, 45, 70, 100};
#define COUNT(array) (sizeof(array) / sizeof *(array))
enum { WIDENED = 6, WIDENED_QUICK = 3 }; /* model and precision pairs */

/* ---- one candidate ------------------------------------------------------------------ */

void cb_explorer_say(struct explorer *e, const char *what) { cb_progress(e->done, what); }

enum cb_status cb_explorer_try(struct explorer *e, const struct cb_advice *a,
                               struct cb_candidate *c) {
  enum cb_status status = cb_body_run(e->body, &c->trial, &e->outcome);
  if (status) return status;
  c->finite = e->outcome.finite;
  c->error = cb_outcome_error(&e->outcome, &e->truth, e->body->size);
  c->energy = cb_outcome_energy_error(&e->outcome, &e->truth);
  c->torque = e->outcome.torque;
  c->inverted = e->outcome.inverted;
  c->rest = e->outcome.distance;
  c->step_s = e->outcome.step_s;
  c->unmet = cb_needs_unmet(a, c);
  return CB_OK;
}

/* Any variant of the model in that arithmetic, clusters before single elements. */
static const struct cb_variant *variant_of(const char *model, const struct cb_arithmetic *a) {
  static const enum cb_storage storages[] = {CB_EBE_CLUSTER, CB_EBE, CB_EBE_MATRIX};
  char name[CB_NAME];
  for (size_t i = 0; i < COUNT(storages); i++) {
    snprintf(name, sizeof name, "%s/%s/%s", model, cb_storage_name[storages[i]], a->name);
    const struct cb_variant *v = cb_variant_find(name);
    if (v) return v;
  }
  return NULL;
}

/* Worst violation of each law that is needed, on random elements, of scalar double. */
static enum cb_status measure_laws(struct explorer *e, const struct cb_advice *a, const char *model,
                                   struct cb_candidate *c) {
  struct cb_law_value values[CB_LAWS];
  for (int law = 0; law <= CB_LAW_ORDER; law++) c->law[law] = NAN;
  if (!a->needs.laws) return CB_OK;
  enum cb_status status =
      cb_laws_measure(variant_of(model, cb_arithmetics[0]), &e->body->at.material, &e->patches,
                      a->needs.laws, values);
  for (int law = 0; !status && law <= CB_LAW_ORDER; law++)
    if (a->needs.laws & CB_KEEPS(law)) c->law[law] = values[law].worst;
  return status;
}

/* ---- models: the fewest iterations that do -------------------------------------------- */

/* More iterations make nothing better but errors, and a step dearer. Shown is the first
 * that does, or the one with the smallest error. */
static enum cb_status try_model(struct explorer *e, struct cb_advice *a, const char *model,
                                const struct cb_arithmetic *arithmetic) {
  const struct cb_variant *v = variant_of(model, arithmetic);
  if (!v) return CB_OK;
  struct cb_candidate c = {.trial = {.variant = v, .threads = 1, .step = e->body->scene->step}};
  size_t best = a->tried_count;
  cb_variant_name(v, c.name);
  cb_explorer_say(e, c.name);
  enum cb_status status = measure_laws(e, a, model, &c);
  for (size_t i = 0; !status && i < CB_ADVISE_ITERATIONS; i++) {
    c.trial.iterations = cb_advise_iterations[i];
    status = cb_explorer_try(e, a, &c);
    if (status) break;
    a->tried[a->tried_count] = c;
    if (!i || !(c.error >= 0.98 * a->tried[best].error) || !c.unmet) best = a->tried_count;
    a->tried_count++;
    if (!(c.unmet & CB_NEED_ERRORS) || !c.finite) break; /* the rest is no matter of iterations */
  }
  if (!status) a->tried[best].last = true;
  return status;
}

static bool asked(const struct cb_options *o, const char *model) {
  if (o->glob_count == 0) {
    for (size_t i = 0; i < COUNT(MODELS); i++)
      if (strcmp(MODELS[i], model) == 0) return true;
    return false;
  }
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    if (strcmp(v->model->name, model) == 0 && cb_options_selects(o, v)) return true;
  return false;
}

static enum cb_status try_models(struct explorer *e, struct cb_advice *a) {
  const struct cb_arithmetic *const lanes[] = {cb_bench_lanes(4), cb_bench_lanes(8)};
  const struct cb_model *const *models = cb_arithmetics[0]->models;
  size_t count = 0;
  for (size_t m = 0; models[m]; m++) count += asked(e->request->options, models[m]->name);
  a->tried = calloc(2 * CB_ADVISE_ITERATIONS * count + 1, sizeof *a->tried);
  if (!a->tried) return cb_fail_memory("the list of models");
  enum cb_status status = CB_OK;
  for (size_t m = 0; !status && models[m]; m++) {
    if (!asked(e->request->options, models[m]->name)) continue;
    for (size_t i = 0; !status && i < 2; i++) {
      status = try_model(e, a, models[m]->name, lanes[i]);
      e->done += 20.0 / (double)(2 * count);
    }
  }
  return status;
}

/* ---- storages, arithmetics and threads of the cheapest models ---------------------------- */

static int by_step(const void *a, const void *b) {
  const struct cb_candidate *c = a, *d = b;
  return (c->step_s > d->step_s) - (c->step_s < d->step_s);
}

static bool worth_trying(const struct cb_variant *v, const struct cb_candidate *c) {
  const struct cb_arithmetic *wide = c->trial.variant->arithmetic;
  return strcmp(v->model->name, c->trial.variant->model->name) == 0 &&
         (v->arithmetic == wide || (v->arithmetic == cb_arithmetics[0] && wide->scalar_bytes == 8));
}

/* ranked := all variants of the cheapest models that do, each run on the scene. */
static enum cb_status widen(struct explorer *e, struct cb_advice *a) {
  const struct cb_threads *threads = &e->request->options->threads;
  const size_t most = e->request->quick ? WIDENED_QUICK : WIDENED;
  size_t variants, taken = 0;
  cb_variants(&variants);
  a->ranked = calloc(variants * threads->count + 1, sizeof *a->ranked);
  if (!a->ranked) return cb_fail_memory("the list of candidates");
  enum cb_status status = CB_OK;
  for (size_t i = 0; !status && i < a->tried_count && taken < most; i++) {
    if (a->tried[i].unmet) continue;
    taken++;
    for (const struct cb_variant *v = cb_variants(NULL); !status && v->model; v++)
      for (size_t t = 0; !status && worth_trying(v, &a->tried[i]) && t < threads->count; t++) {
        struct cb_candidate c = a->tried[i];
        c.trial.variant = v, c.trial.threads = threads->of[t];
        cb_variant_name(v, c.name);
        cb_explorer_say(e, c.name);
        status = cb_explorer_try(e, a, &c);
        if (!status && !c.unmet) a->ranked[a->ranked_count++] = c;
      }
    e->done += 15.0 / (double)most;
  }
  qsort(a->ranked, a->ranked_count, sizeof *a->ranked, by_step);
  if (a->ranked_count > CB_ADVISE_TIMED) a->ranked_count = CB_ADVISE_TIMED;
  return status;
}

/* ---- without a need --------------------------------------------------------- */

/* The cheapest of those tried that meet the needs of a; SIZE_MAX: none. */
static size_t cheapest(const struct cb_advice *a) {
  for (size_t i = 0; i < a->tried_count; i++)
    if (!cb_needs_unmet(a, &a->tried[i])) return i;
  return SIZE_MAX;
}

static void loosen(struct cb_advice *a, enum cb_need need) {
  const double more = 10;
  if (need < CB_NEED_FINITE) a->needs.laws &= ~CB_KEEPS(need);
  switch (need) {
  case CB_NEED_DISPLACEMENT: a->needs.displacement *= more; break;
  case CB_NEED_TORQUE: a->needs.torque *= more; break;
  case CB_NEED_ENERGY: a->needs.energy *= more; break;
  case CB_NEED_INVERSION: a->needs.inversion = false; break;
  case CB_NEED_REST: a->needs.rest *= more; break;
  case CB_NEED_FRAMES: a->frame_s *= more; break;
  default: break;
  }
}

static void relax(struct cb_advice *a) {
  const size_t base = cheapest(a);
  a->binding = CB_NEEDS;
  for (int need = 0; need < CB_NEEDS; need++) {
    if (!cb_need_asked(a, need) || need == CB_NEED_FINITE) continue;
    struct cb_advice loose = *a;
    loosen(&loose, need);
    const size_t other = cheapest(&loose);
    const bool gains = other < base; /* the cheapest come first */
    if (base == SIZE_MAX && gains && a->binding == CB_NEEDS) a->binding = need;
    a->relaxed[a->relaxed_count++] = (struct cb_relaxation){
        need, gains ? other : SIZE_MAX,
        gains && base != SIZE_MAX ? a->tried[other].step_s / a->tried[base].step_s : NAN};
  }
}

/* ---- the whole -------------------------------------------------------------- */

static void set_needs(const struct cb_body *body, const struct cb_advise_request *r,
                      struct cb_advice *a) {
  const struct cb_scene *s = body->scene;
  a->needs = s->needs;
  if (!isnan(r->tolerance)) a->needs.displacement = r->tolerance;
  const bool budget = !isnan(r->budget_s);
  const double rate = s->needs.frames_per_s > 0 ? s->needs.frames_per_s : 30;
  a->steps_per_frame = 1 / (rate * s->step);
  a->frame_s = budget ? r->budget_s : s->needs.frames_per_s > 0 ? 1 / rate : INFINITY;
}

enum cb_status cb_advise(const struct cb_body *body, const struct cb_advise_request *request,
                         struct cb_advice *advice) {
  struct explorer *e = calloc(1, sizeof *e);
  struct cb_advice a = {0};
  if (!e) return cb_fail_memory("the trials");
  *e = (struct explorer){.body = body, .request = request, .timing_s = request->quick ? 2 : 12};
  set_needs(body, request, &a);
  cb_progress_begin("advise", 50 + e->timing_s);
  cb_explorer_say(e, "the scene's truth");
  enum cb_status status = cb_body_truth(body, &e->truth);
  e->done += 15;
  if (!status) status = cb_patches_random(50, 2, 0.3, request->options->seed, &e->patches);
  if (!status) status = try_models(e, &a);
  if (!status) qsort(a.tried, a.tried_count, sizeof *a.tried, by_step);
  if (!status) status = widen(e, &a);
  if (!status && a.ranked_count) status = cb_explorer_rank(e, &a);
  if (!status && a.ranked_count) status = cb_explorer_settings(e, &a);
  if (!status) relax(&a);
  cb_progress_end();
  cb_patches_free(&e->patches);
  free(e);
  if (status)
    cb_advice_free(&a);
  else
    *advice = a;
  return status;
}

void cb_advice_free(struct cb_advice *advice) {
  free(advice->tried);
  free(advice->ranked);
  *advice = (struct cb_advice){0};
}
