/* claims_scenes.c - the claims of figures 5 and 6, on the scenes that are shipped, coarser:
 * every model, in scalar double.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/scene/run.h"
#include "harness/verify/claim.h"

/* The files themselves, so that the program needs none where it is run. */
__asm__(".section .rodata\n"
        "cb_scene_rabbit_text: .incbin \"scenes/rabbit-crush.json\"\n.byte 0\n"
        "cb_scene_liver_text: .incbin \"scenes/liver-yank.json\"\n.byte 0\n"
        ".previous\n");
extern const char cb_scene_rabbit_text[], cb_scene_liver_text[];

static const double RESOLUTION = 0.8; /* half of the elements: seconds for all models */
enum { ITERATIONS = 20 };
static const char PAPER[] = "qr-updated";

/* ---- one run --------------------------------------------------------------------------- */

static enum cb_status see(void *context, double t, const double *x) {
  (void)context, (void)t, (void)x;
  return cb_interrupted() ? cb_fail(CB_INTERRUPTED, "interrupted while judging the claims") : CB_OK;
}

static enum cb_status simulate(const struct cb_body *body, const struct cb_variant *v,
                               struct cb_outcome *outcome) {
  const struct cb_trial trial = {
      .variant = v, .threads = 1, .iterations = ITERATIONS, .step = body->scene->step};
  const struct cb_watch watch = {100, see, NULL};
  return cb_body_show(body, &trial, &watch, outcome);
}

/* ---- all models ---------------------------------------------------------------------------- */

struct tally {
  char recovers[1000], stays[1400], breaks[600]; /* models, by how they end */
  size_t models, recovered, inverted;          /* most elements of a recovered one */
  bool paper;
  double distance; /* the farthest on the way, of recovered ones */
};

static void count(struct tally *t, const struct cb_body *body, const char *model,
                  const struct cb_outcome *o) {
  const double upright = 1 - (double)o->inverted / (double)body->at.mesh.tets;
  t->models++;
  if (!o->finite)
    cb_claim_say(t->breaks, sizeof t->breaks, "%s%s", *t->breaks ? ", " : "", model);
  else if (!cb_outcome_recovers(o, &body->scene->needs))
    cb_claim_say(t->stays, sizeof t->stays, "%s%s %.2g", *t->stays ? ", " : "", model, o->distance);
  else {
    cb_claim_say(t->recovers, sizeof t->recovers, "%s%s %.2g", *t->recovers ? ", " : "", model,
                 o->distance);
    t->recovered++;
    if (o->most_inverted > t->inverted) t->inverted = o->most_inverted;
    t->distance = fmax(t->distance, o->most_distance);
    if (strcmp(model, PAPER) == 0) t->paper = true;
  }
  if (o->finite && upright < 1 && !cb_outcome_recovers(o, &body->scene->needs))
    cb_claim_say(t->stays, sizeof t->stays, " (%.0f %% upright)", 100 * upright);
}

static enum cb_status all_models(const struct cb_body *body, struct tally *t) {
  struct cb_outcome *o = malloc(sizeof *o);
  enum cb_status status = o ? CB_OK : cb_fail_memory("the claims");
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (v->storage != CB_EBE || strcmp(v->arithmetic->name, "f64") != 0) continue;
    status = simulate(body, v, o);
    if (!status) count(t, body, v->model->name, o);
  }
  free(o);
  return status;
}

static void report(struct cb_claim *c, const struct cb_body *body, const struct tally *t) {
  MEASURED(c,
           "%zu tetrahedra, step %g ms, %d iterations; distance of the end from the rest shape, of "
           "the size, at most %g where it recovers: %s",
           body->at.mesh.tets, 1e3 * body->scene->step, ITERATIONS, body->scene->needs.rest,
           *t->recovers ? t->recovers : "none");
  if (*t->stays) MEASURED(c, "; does not recover: %s", t->stays);
  if (*t->breaks) MEASURED(c, "; not finite: %s", t->breaks);
}

static void judge(struct cb_claim *c, const struct tally *t) {
  if (t->recovered == t->models)
    VERDICT(c, "reproduced, for every model");
  else
    VERDICT(c, "%s with the paper's own %s; it holds for %zu of %zu models",
            t->paper ? "reproduced" : "not reproduced", PAPER, t->recovered, t->models);
}

/* ---- C13: the rabbit regains its shape --------------------------------------------------- */

enum cb_status cb_claim_rabbit(struct cb_claimant *a) {
  struct cb_scene scene;
  struct cb_body body = {0};
  struct tally t = {0};
  enum cb_status status = cb_scene_parse("rabbit-crush.json", cb_scene_rabbit_text, &scene);
  if (!status) status = cb_body_create(&scene, RESOLUTION, &body);
  if (!status) status = all_models(&body, &t);
  if (!status) {
    report(a->claim, &body, &t);
    judge(a->claim, &t);
  }
  cb_body_free(&body);
  return status;
}

/* ---- C14: the liver stays stable and recovers --------------------------------------------- */

enum { PARTS = 4 };

/* *most := the largest part of the handle's way, in quarters, that the paper's own model recovers
 * from, as from all smaller ones; *inverted: elements at that look which had the most. */
static enum cb_status weaker(const struct cb_scene *scene, size_t *most, size_t *inverted) {
  char name[CB_NAME];
  struct cb_outcome *o = malloc(sizeof *o);
  enum cb_status status = o ? CB_OK : cb_fail_memory("the claims");
  snprintf(name, sizeof name, "%s/ebe/f64", PAPER);
  *most = *inverted = 0;
  for (size_t n = 1; n <= PARTS && !status && *most == n - 1; n++) {
    struct cb_scene part = *scene;
    struct cb_body body = {0};
    for (int k = 0; k < 3; k++) part.handle[0].move[k] *= (double)n / PARTS;
    status = cb_body_create(&part, RESOLUTION, &body);
    if (!status) status = simulate(&body, cb_variant_find(name), o);
    if (!status && cb_outcome_recovers(o, &part.needs)) *most = n, *inverted = o->most_inverted;
    cb_body_free(&body);
  }
  free(o);
  return status;
}

enum cb_status cb_claim_liver(struct cb_claimant *a) {
  struct cb_scene scene;
  struct cb_body body = {0};
  struct tally t = {0};
  size_t most = 0, inverted = 0;
  enum cb_status status = cb_scene_parse("liver-yank.json", cb_scene_liver_text, &scene);
  if (!status) status = cb_body_create(&scene, RESOLUTION, &body);
  if (!status) status = all_models(&body, &t);
  if (!status) status = weaker(&scene, &most, &inverted);
  if (!status) {
    MEASURED(a->claim,
             "up to %zu elements inverted, %s recovers from %zu/%d of the way (%zu inverted); ",
             t.inverted, PAPER, most, PARTS, inverted);
    report(a->claim, &body, &t);
    judge(a->claim, &t);
    if (!t.paper && most) VERDICT(a->claim, "; with %s for a weaker pull", PAPER);
  }
  cb_body_free(&body);
  return status;
}
