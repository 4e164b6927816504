/* verb_run.c - `corobench run`: simulate a scene and write what is to be seen.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/progress.h"
#include "harness/scene/film.h"

static const char doc[] =
    "Simulate a scene with one variant and say how long a step takes, against real time, and how "
    "the body ends; with several, each after the other, as a table. With --output, write that "
    "table to DIR/NAME-run.csv, and pictures of the first variant of the first --variant: NAME.pvd "
    "for ParaView, with a "
    ".vtu file for each picture, and what plots/draw.sh DIR draws a strip and an animation of.";

enum { KEY_ITERATIONS = 0x5000, KEY_PICTURES, KEY_RESOLUTION };
static const struct argp_option own_options[] = {
    {"iterations", KEY_ITERATIONS, "N", 0, "Conjugate gradient iterations of a step (default 20)",
     0},
    {"pictures", KEY_PICTURES, "N", 0, "Pictures written beside the first (default 50)", 0},
    {"resolution", KEY_RESOLUTION, "R", 0,
     "Cells along each edge for each one of the scene's (default 1)", 0},
    {0}};

struct request {
  unsigned long iterations, pictures;
  double resolution;
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  enum cb_status status = CB_OK;
  switch (key) {
  case KEY_ITERATIONS:
    status = cb_parse_count("--iterations", text, 1, 100000, &r->iterations);
    break;
  case KEY_PICTURES: status = cb_parse_count("--pictures", text, 1, 9999, &r->pictures); break;
  case KEY_RESOLUTION:
    status = cb_parse_number("--resolution", text, 0.1, 10, &r->resolution);
    break;
  default: return ARGP_ERR_UNKNOWN;
  }
  return status ? EINVAL : 0;
}

/* ---- one run ---------------------------------------------------------------------------- */

struct show {
  const char *name;     /* of the variant */
  double before;        /* s that were simulated with others */
  struct cb_film *film; /* NULL: not filmed */
};

static enum cb_status see(void *context, double t, const double *x) {
  const struct show *show = context;
  cb_progress(show->before + t, show->name);
  return show->film ? cb_film_see(show->film, t, x) : CB_OK;
}

/* The n-th of the run; only the first is filmed. */
static enum cb_status simulate(const struct cb_body *body, const struct cb_options *o,
                               const struct request *r, const struct cb_variant *variant, size_t n,
                               struct cb_outcome *outcome) {
  const struct cb_trial trial = {.variant = variant,
                                 .threads = o->threads.count ? o->threads.of[0] : 1,
                                 .iterations = r->iterations,
                                 .step = body->scene->step};
  /* the steps that there will be at least; a shorter step may make some more */
  const size_t steps = (size_t)ceil(body->scene->duration / body->scene->step * (1 - 1e-9));
  const size_t every = steps > r->pictures ? steps / r->pictures : 1;
  char name[CB_NAME];
  struct cb_film film = {0};
  const bool filmed = o->output && n == 0;
  struct show show = {name, (double)n * body->scene->duration, filmed ? &film : NULL};
  const struct cb_watch watch = {every, see, &show};
  cb_variant_name(variant, name);
  enum cb_status status = CB_OK;
  if (filmed) status = cb_film_open(body, o->output, (steps + CB_SAMPLES) / every + 2, &film);
  if (!status) status = cb_body_show(body, &trial, &watch, outcome);
  if (!status && filmed) return cb_film_close(&film);
  cb_film_abandon(&film);
  return status;
}

/* ---- what it says -------------------------------------------------------------------------- */

static void print_one(const struct cb_body *body, const char *name, const struct request *r,
                      const struct cb_outcome *o) {
  const struct cb_needs *needs = &body->scene->needs;
  printf("%s by %s, %lu iterations: %zu steps, %.3g us each, %.3g of real time.\n",
         body->scene->name, name, r->iterations, o->steps, 1e6 * o->step_s, o->seconds);
  if (!o->finite) {
    printf("It breaks down: forces, velocities or positions are not finite.\n");
    return;
  }
  printf("In the end %zu of %zu elements are inverted, at most %zu; ghost torque up to %.2g, net "
         "force up to %.2g (relative).\n",
         o->inverted, body->at.mesh.tets, o->most_inverted, o->torque, o->net_force);
  printf("The shape ends %.2g of its size from the one at rest, at most %.2g.%s\n", o->distance,
         o->most_distance,
         !isfinite(needs->rest)          ? ""
         : cb_outcome_recovers(o, needs) ? " It recovers."
                                         : " It does not recover.");
  if (o->indefinite)
    printf("In %zu steps the operator was not positive definite: conjugate gradients ended early "
           "there.\n",
           o->indefinite);
}

static void add_row(struct cb_table *t, const struct cb_body *body, const char *name,
                    const struct cb_outcome *o) {
  cb_table_text(t, name);
  cb_table_integer(t, (long long)body->at.mesh.tets);
  cb_table_text(t, o->finite ? "yes" : "no");
  cb_table_number(t, o->finite ? 1 - (double)o->inverted / (double)body->at.mesh.tets : NAN);
  cb_table_number(t, o->distance);
  cb_table_integer(t, (long long)o->most_inverted);
  cb_table_number(t, 1e6 * o->step_s);
  cb_table_number(t, o->seconds);
  if (isfinite(body->scene->needs.rest))
    cb_table_text(t, cb_outcome_recovers(o, &body->scene->needs) ? "yes" : "no");
  else
    cb_table_missing(t);
}

/* ---- all of them ---------------------------------------------------------------------------- */

/* Those that one glob selects and no earlier one did. */
static void add_variants(struct cb_options one, const struct cb_variant **list, size_t *count) {
  const size_t before = *count;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++) {
    bool listed = false;
    for (size_t i = 0; i < before; i++) listed |= list[i] == v;
    if (!listed && cb_options_selects(&one, v)) list[(*count)++] = v;
  }
}

/* list[*count] := what is asked for, in the order of the globs, or the one that comes back from
 * most starts, with long steps too; room for all. */
static void the_variants(const struct cb_options *o, const struct cb_variant **list,
                         size_t *count) {
  char name[CB_NAME];
  *count = 0;
  snprintf(name, sizeof name, "polar-exact/ebe-cluster/%s", cb_bench_lanes(sizeof(float))->name);
  if (!o->glob_count) list[(*count)++] = cb_variant_find(name);
  for (size_t g = 0; g < o->glob_count; g++) {
    struct cb_options one = *o;
    one.globs[0] = o->globs[g], one.glob_count = 1;
    add_variants(one, list, count);
  }
}

static enum cb_status run_all(const struct cb_body *body, const struct cb_options *o,
                              const struct request *r, const struct cb_variant *const *list,
                              size_t count) {
  struct cb_table *t = cb_table_create("variant,tetrahedra,finite,upright,distance,most_inverted,"
                                       "step_us,seconds_per_second,recovers");
  struct cb_outcome *outcome = malloc(sizeof *outcome);
  enum cb_status status = t && outcome ? CB_OK : cb_fail_memory("the runs");
  cb_progress_begin("run", body->scene->duration * (double)count);
  char name[CB_NAME];
  for (size_t n = 0; !status && n < count; n++) {
    cb_variant_name(list[n], name);
    status = simulate(body, o, r, list[n], n, outcome);
    if (!status) add_row(t, body, name, outcome);
  }
  cb_progress_end();
  if (!status && count == 1 && o->format == CB_TABLE)
    print_one(body, name, r, outcome);
  else if (!status)
    status = cb_table_print(t, o->format, stdout);
  snprintf(name, sizeof name, "%s-run.csv", body->scene->name);
  if (!status && o->output) status = cb_output_table(o->output, name, t, CB_CSV);
  cb_table_free(t);
  free(outcome);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  const unsigned mask =
      CB_OPT_SCENE | CB_OPT_VARIANT | CB_OPT_OUTPUT | CB_OPT_THREADS | CB_OPT_FORMAT;
  struct request r = {20, 50, 1};
  struct cb_options o;
  struct cb_scene scene;
  struct cb_body body = {0};
  size_t count;
  enum cb_status status = cb_options_parse(argc, argv, mask, doc, own_options, parse, &r, &o);
  if (status) return status;
  cb_variants(&count);
  const struct cb_variant **list = malloc(count * sizeof *list);
  if (!list) return cb_fail_memory("the runs");
  the_variants(&o, list, &count);
  status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_body_create(&scene, r.resolution, &body);
  if (!status) status = run_all(&body, &o, &r, list, count);
  cb_body_free(&body);
  free(list);
  return status;
}

const struct cb_verb cb_verb_run = {"run", "simulate scenes, for ParaView and gnuplot to show",
                                    run};
