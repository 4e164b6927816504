/* trade.c - see trade.h: the sweeps, and the front.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/trade/trade.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/journal.h"
#include "harness/progress.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
static const size_t ITERATIONS[] = {1, 2, 3, 5, 7, 10, 14, 20, 30, 50, 70, 100};
static const double NOISE = 0.95; /* of times, in a front */
static const double FINEST = 2;   /* resolution of the truth that refinement is held against */

struct sweeper {
  struct cb_trade *trade;
  const struct cb_options *options;
  struct cb_journal *journal;
  bool quick;
  const char *sweep;
  const struct cb_body *body;
  const struct cb_outcome *truth;
  struct cb_outcome outcome;
  double resolution, done;
};

/* ---- one run ------------------------------------------------------------------------ */

static enum cb_status add(struct sweeper *s, const struct cb_trade_row *row) {
  struct cb_trade *t = s->trade;
  if ((t->count & (t->count - 1)) == 0) { /* a power of two: full */
    struct cb_trade_row *more = realloc(t->rows, (2 * t->count + 1) * sizeof *more);
    if (!more) return cb_fail_memory("the rows of the trade");
    t->rows = more;
  }
  t->rows[t->count++] = *row;
  return CB_OK;
}

/* The numbers of a row, in this order in the journal. */
static json_t *to_json(const struct cb_trade_row *row) {
  return json_pack("[I, b, o, o, o, o]", (json_int_t)row->tetrahedra, (int)row->finite,
                   cb_journal_number(row->seconds), cb_journal_number(row->error),
                   cb_journal_number(row->torque), cb_journal_number(row->energy));
}

static enum cb_status from_json(const json_t *json, struct cb_trade_row *row) {
  const json_t *finite = json_array_get(json, 1);
  row->tetrahedra = (size_t)json_integer_value(json_array_get(json, 0));
  row->finite = json_is_true(finite);
  if (json_is_boolean(finite) && cb_journal_to_number(json_array_get(json, 2), &row->seconds) &&
      cb_journal_to_number(json_array_get(json, 3), &row->error) &&
      cb_journal_to_number(json_array_get(json, 4), &row->torque) &&
      cb_journal_to_number(json_array_get(json, 5), &row->energy))
    return CB_OK;
  return cb_fail(CB_INPUT, "the journal of the earlier run holds what is no row of a trade; start "
                           "anew without --resume");
}

static void name_row(const struct cb_trade_row *row, size_t size, char *key) {
  const struct cb_trial *t = &row->trial;
  snprintf(key, size, "%s: %s, %zu iterations, step %.17g s, resolution %g, tuned %zu %g %g",
           row->sweep, row->variant, t->iterations, t->step, row->resolution,
           t->tuning.frame_iterations, t->tuning.frame_tolerance, t->tuning.lazy);
}

static enum cb_status simulate(struct sweeper *s, struct cb_trade_row *row) {
  const enum cb_status status = cb_body_run(s->body, &row->trial, &s->outcome);
  if (status) return status;
  row->tetrahedra = s->body->at.mesh.tets;
  row->finite = s->outcome.finite;
  row->seconds = s->outcome.seconds;
  row->error = cb_outcome_error(&s->outcome, s->truth, s->body->size);
  row->energy = cb_outcome_energy_error(&s->outcome, s->truth);
  row->torque = s->outcome.torque;
  return CB_OK;
}

static enum cb_status run(struct sweeper *s, const struct cb_trial *trial) {
  struct cb_trade_row row = {.sweep = s->sweep, .trial = *trial, .resolution = s->resolution};
  char what[CB_NAME + 64], key[CB_NAME + 256];
  cb_variant_name(trial->variant, row.variant);
  name_row(&row, sizeof key, key);
  const json_t *finished = s->journal ? cb_journal_row(s->journal, key, &row.session) : NULL;
  if (finished) {
    const enum cb_status status = from_json(finished, &row);
    return status ? status : add(s, &row);
  }
  row.session = s->journal ? cb_journal_session(s->journal) : 1;
  snprintf(what, sizeof what, "%s: %s, %zu iterations", s->sweep, row.variant, trial->iterations);
  cb_progress(s->done, what);
  enum cb_status status = simulate(s, &row);
  if (!status && s->journal) status = cb_journal_add(s->journal, key, to_json(&row));
  return status ? status : add(s, &row);
}

/* The variant of that name, unless --variant leaves it out; NULL: none. */
static const struct cb_variant *find(const struct sweeper *s, const char *model,
                                     enum cb_storage storage, const struct cb_arithmetic *a) {
  char name[CB_NAME];
  snprintf(name, sizeof name, "%s/%s/%s", model, cb_storage_name[storage], a->name);
  const struct cb_variant *v = cb_variant_find(name);
  return v && cb_options_selects(s->options, v) ? v : NULL;
}

static struct cb_trial trial_of(const struct sweeper *s, const struct cb_variant *v,
                                size_t iterations) {
  return (struct cb_trial){.variant = v,
                           .threads = s->options->threads.count ? s->options->threads.of[0] : 1,
                           .iterations = iterations,
                           .step = s->trade->scene->step};
}

/* ---- sweeps --------------------------------------------------------------------------- */

static enum cb_status sweep_models(struct sweeper *s) {
  static const char *const models[] = {"linear",
                                       "green",
                                       "node-warp",
                                       "qr-precomputed",
                                       "qr-updated",
                                       "qr-exact",
                                       "polar-closed-precomputed",
                                       "polar-closed-updated",
                                       "polar-higham-updated",
                                       "polar-exact",
                                       "polar-tangent-clamped",
                                       "polar-quaternion-precomputed",
                                       "svd-updated"};
  const struct cb_arithmetic *const lanes[] = {cb_bench_lanes(4), cb_bench_lanes(8)};
  enum cb_status status = CB_OK;
  for (size_t m = 0; m < COUNT(models); m++)
    for (size_t a = 0; a < 2; a++) {
      const struct cb_variant *v = find(s, models[m], CB_EBE_CLUSTER, lanes[a]);
      if (!v) v = find(s, models[m], CB_EBE, lanes[a]);
      for (size_t i = 0; !status && v && i < COUNT(ITERATIONS); i += s->quick ? 3 : 1) {
        const struct cb_trial trial = trial_of(s, v, ITERATIONS[i]);
        status = run(s, &trial);
      }
    }
  return status;
}

static enum cb_status sweep_storages(struct sweeper *s) {
  static const char *const models[] = {"qr-updated", "polar-closed-updated"};
  static const size_t iterations[] = {5, 20, 50};
  enum cb_status status = CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); !status && v->model; v++) {
    bool taken = false;
    for (size_t m = 0; m < COUNT(models); m++) taken |= strcmp(v->model->name, models[m]) == 0;
    if (!taken || strcmp(v->arithmetic->name, "counted") == 0) continue;
    if (!cb_options_selects(s->options, v)) continue;
    for (size_t i = 0; !status && i < COUNT(iterations); i += s->quick ? 2 : 1) {
      const struct cb_trial trial = trial_of(s, v, iterations[i]);
      status = run(s, &trial);
    }
  }
  return status;
}

static enum cb_status sweep_steps(struct sweeper *s) {
  static const char *const models[] = {"qr-updated", "qr-exact", "polar-exact"};
  static const double factors[] = {0.25, 0.5, 1, 2, 4, 8};
  static const size_t iterations[] = {1, 3, 10, 30, 100};
  enum cb_status status = CB_OK;
  for (size_t m = 0; m < COUNT(models); m++) {
    const struct cb_variant *v = find(s, models[m], CB_EBE_CLUSTER, cb_bench_lanes(4));
    for (size_t f = 0; v && f < COUNT(factors); f++)
      for (size_t i = 0; !status && i < COUNT(iterations); i += s->quick ? 2 : 1) {
        struct cb_trial trial = trial_of(s, v, iterations[i]);
        trial.step *= factors[f];
        status = run(s, &trial);
      }
  }
  return status;
}

static enum cb_status sweep_frames(struct sweeper *s) {
  static const char *const models[] = {"polar-higham-tuned", "polar-quaternion-tuned"};
  enum { MOST = 10, DECADES = 10, ENOUGH = 50 };
  enum cb_status status = CB_OK;
  for (size_t m = 0; m < COUNT(models); m++) {
    const struct cb_variant *v = find(s, models[m], CB_EBE, cb_bench_lanes(8));
    if (!v) continue;
    struct cb_trial trial = trial_of(s, v, 20);
    for (size_t n = 1; !status && n <= MOST; n++) {
      trial.tuning = (struct cb_tuning){.frame_iterations = n};
      status = run(s, &trial);
    }
    for (int n = 1; !status && n <= DECADES; n++) {
      trial.tuning = (struct cb_tuning){ENOUGH, pow(10, -n), 0};
      status = run(s, &trial);
    }
  }
  return status;
}

static enum cb_status sweep_lazy(struct sweeper *s) {
  static const char *const models[] = {"qr-lazy", "polar-closed-lazy"};
  static const double tolerances[] = {0,    1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3,
                                      1e-2, 3e-2, 0.1,  0.3,  1,    1e9};
  enum cb_status status = CB_OK;
  for (size_t m = 0; m < COUNT(models); m++)
    for (size_t k = 0; k < 2; k++) {
      const struct cb_variant *v = k ? find(s, models[m], CB_EBE_PAPER, cb_arithmetics[0])
                                     : find(s, models[m], CB_EBE, cb_bench_lanes(8));
      for (size_t i = 0; !status && v && i < COUNT(tolerances); i++) {
        struct cb_trial trial = trial_of(s, v, 20);
        trial.tuning.lazy = tolerances[i];
        status = run(s, &trial);
      }
    }
  return status;
}

/* On meshes of several resolutions, whose truth is much finer. */
static enum cb_status sweep_resolutions(struct sweeper *s) {
  static const char *const models[] = {"qr-updated", "qr-exact", "polar-closed-updated",
                                       "polar-higham-updated", "svd-updated"};
  static const double resolutions[] = {0.3, 0.45, 0.6, 0.8, 1, 1.25, 1.5};
  static const size_t iterations[] = {5, 10, 20, 50};
  enum cb_status status = CB_OK;
  size_t last = 0;
  for (size_t r = 0; !status && r < COUNT(resolutions); r += s->quick ? 2 : 1) {
    struct cb_body body = {0};
    status = cb_body_create(s->trade->scene, resolutions[r], &body);
    if (!status && body.at.mesh.tets != last) { /* small ones may come out alike */
      s->body = &body, s->resolution = resolutions[r];
      for (size_t m = 0; m < COUNT(models); m++) {
        const struct cb_variant *v = find(s, models[m], CB_EBE_CLUSTER, cb_bench_lanes(4));
        for (size_t i = 0; !status && v && i < COUNT(iterations); i++) {
          const struct cb_trial trial = trial_of(s, v, iterations[i]);
          status = run(s, &trial);
        }
      }
    }
    last = body.at.mesh.tets;
    cb_body_free(&body);
  }
  return status;
}

/* ---- fronts ------------------------------------------------------------------------------ */

static bool same_truth(const struct cb_trade_row *a, const struct cb_trade_row *b) {
  return (strcmp(a->sweep, "refine") == 0) == (strcmp(b->sweep, "refine") == 0);
}

/* Before the others, who do not come off in noise. A row that is not finite is nowhere. */
static void mark_front(struct cb_trade *t) {
  for (size_t i = 0; i < t->count; i++) {
    struct cb_trade_row *row = &t->rows[i];
    row->front = row->finite && isfinite(row->error);
    for (size_t j = 0; j < t->count && row->front; j++) {
      const struct cb_trade_row *other = &t->rows[j];
      if (same_truth(row, other) && other->error <= row->error &&
          other->seconds < NOISE * row->seconds)
        row->front = false;
    }
  }
}

/* ---- the whole ------------------------------------------------------------------------------ */

static enum cb_status sweep_all(struct sweeper *s, struct cb_body *own, struct cb_outcome *truth) {
  static const struct {
    const char *name;
    enum cb_status (*run)(struct sweeper *s);
    double share;
  } sweeps[] = {{"model", sweep_models, 25},
                {"storage", sweep_storages, 15},
                {"step", sweep_steps, 10},
                {"frame", sweep_frames, 5},
                {"lazy", sweep_lazy, 10}};
  cb_progress(s->done, "the scene's truth");
  enum cb_status status = cb_body_truth(own, truth);
  if (!status) status = cb_body_truth_iterated(own, 1, &s->outcome);
  if (!status) s->trade->truth_check = cb_outcome_error(&s->outcome, truth, own->size);
  s->body = own, s->truth = truth, s->resolution = 1, s->done = 20;
  for (size_t i = 0; !status && i < COUNT(sweeps); i++) {
    s->sweep = sweeps[i].name;
    status = sweeps[i].run(s);
    s->done += sweeps[i].share;
  }
  return status;
}

static enum cb_status refine(struct sweeper *s, struct cb_outcome *truth) {
  if (s->trade->scene->mesh_path[0]) return CB_OK; /* comes as it is */
  struct cb_body fine = {0};
  cb_progress(s->done, "the truth of a finer mesh");
  enum cb_status status = cb_body_create(s->trade->scene, FINEST, &fine);
  if (!status) status = cb_body_truth_iterated(&fine, cb_bench_threads().count, truth);
  cb_body_free(&fine);
  s->sweep = "refine", s->truth = truth, s->done += 15;
  return status ? status : sweep_resolutions(s);
}

enum cb_status cb_trade_run(const struct cb_scene *scene, const struct cb_options *options,
                            bool quick, struct cb_journal *journal, struct cb_trade *trade) {
  struct cb_trade made = {.scene = scene};
  struct cb_body own = {0};
  struct sweeper *s = calloc(1, sizeof *s);
  struct cb_outcome *truth = calloc(1, sizeof *truth);
  enum cb_status status = s && truth ? CB_OK : cb_fail_memory("the sweeps");
  if (!status)
    *s = (struct sweeper){.trade = &made, .options = options, .journal = journal, .quick = quick};
  cb_progress_begin("trade", 120);
  if (!status) status = cb_body_create(scene, 1, &own);
  if (!status) status = sweep_all(s, &own, truth);
  if (!status) status = refine(s, truth);
  cb_progress_end();
  if (!status) mark_front(&made);
  cb_body_free(&own);
  free(truth);
  free(s);
  if (status)
    cb_trade_free(&made);
  else
    *trade = made;
  return status;
}

void cb_trade_free(struct cb_trade *trade) {
  free(trade->rows);
  *trade = (struct cb_trade){0};
}
