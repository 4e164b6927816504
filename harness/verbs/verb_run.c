/* verb_run.c - `corobench run`: simulate a scene and write what is to be seen.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/error.h"
#include "harness/files/output.h"
#include "harness/files/vtk.h"
#include "harness/progress.h"
#include "harness/scene/run.h"

static const char doc[] =
    "Simulate a scene with one variant and say how long a step takes, against real time, and how "
    "the body ends. With --output, write it to DIR for ParaView: NAME.pvd, and a .vtu file for "
    "each "
    "picture.";

enum { KEY_ITERATIONS = 0x5000, KEY_PICTURES };
static const struct argp_option own_options[] = {
    {"iterations", KEY_ITERATIONS, "N", 0, "Conjugate gradient iterations of a step (default 20)",
     0},
    {"pictures", KEY_PICTURES, "N", 0, "Pictures written beside the first (default 50)", 0},
    {0}};

struct request {
  unsigned long iterations, pictures;
};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct request *r = state->input;
  enum cb_status status = CB_OK;
  switch (key) {
  case KEY_ITERATIONS:
    status = cb_parse_count("--iterations", text, 1, 100000, &r->iterations);
    break;
  case KEY_PICTURES: status = cb_parse_count("--pictures", text, 1, 9999, &r->pictures); break;
  default: return ARGP_ERR_UNKNOWN;
  }
  return status ? EINVAL : 0;
}

/* What is written while the body moves. */
struct film {
  const struct cb_body *body;
  const char *directory; /* NULL: nothing */
  size_t count;
  double *times;
};

static enum cb_status see(void *context, double t, const double *x) {
  struct film *film = context;
  char name[128];
  cb_progress(t, film->body->scene->name);
  if (!film->directory) return CB_OK;
  for (size_t i = 0; i < 3 * film->body->at.mesh.nodes; i++)
    if (!isfinite(x[i])) return CB_OK; /* the outcome says so */
  cb_vtk_name(film->body->scene->name, film->count, name);
  film->times[film->count++] = t;
  return cb_vtk_write(film->directory, name, &film->body->at.mesh, x);
}

static enum cb_status the_variant(const struct cb_options *o, const struct cb_variant **chosen) {
  char name[96];
  size_t count = 0;
  snprintf(name, sizeof name, "qr-exact/ebe-cluster/%s", cb_bench_lanes(sizeof(float))->name);
  *chosen = cb_variant_find(name);
  if (!o->glob_count) return CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); v->model; v++)
    if (cb_options_selects(o, v)) *chosen = v, count++;
  if (count == 1) return CB_OK;
  return cb_fail(CB_INPUT,
                 "run needs exactly one variant, and --variant selects %zu; write one in "
                 "full, e.g. %s",
                 count, name);
}

static void print(const struct cb_body *body, const struct cb_trial *trial,
                  const struct cb_outcome *o) {
  char name[96];
  cb_variant_name(trial->variant, name);
  printf("%s by %s, %zu iterations: %zu steps, %.3g us each, %.3g of real time.\n",
         body->scene->name, name, trial->iterations, o->steps, 1e6 * o->step_s, o->seconds);
  if (!o->finite)
    printf("It breaks down: forces, velocities or positions are not finite.\n");
  else
    printf("In the end %zu of %zu elements are inverted; ghost torque up to %.2g, net force up to "
           "%.2g (relative).\n",
           o->inverted, body->at.mesh.tets, o->torque, o->net_force);
  if (o->indefinite)
    printf("In %zu steps the operator was not positive definite: conjugate gradients ended early "
           "there.\n",
           o->indefinite);
}

static enum cb_status simulate(const struct cb_body *body, const struct cb_options *o,
                               const struct request *r) {
  struct film film = {.body = body, .directory = o->output};
  struct cb_trial trial = {.threads = o->threads.count ? o->threads.of[0] : 1,
                           .iterations = r->iterations,
                           .step = body->scene->step};
  struct cb_outcome *outcome = malloc(sizeof *outcome);
  /* the steps that there will be at least; a shorter step may make some more */
  const size_t steps = (size_t)ceil(body->scene->duration / body->scene->step * (1 - 1e-9));
  const size_t every = steps > r->pictures ? steps / r->pictures : 1;
  film.times = malloc(((steps + CB_SAMPLES) / every + 2) * sizeof *film.times);
  enum cb_status status = outcome && film.times ? CB_OK : cb_fail_memory("the pictures");
  if (!status) status = the_variant(o, &trial.variant);
  if (!status && o->output) status = cb_output_directory(o->output);
  cb_progress_begin("run", body->scene->duration);
  const struct cb_watch watch = {every, see, &film};
  if (!status) status = cb_body_show(body, &trial, &watch, outcome);
  cb_progress_end();
  if (!status && o->output)
    status = cb_vtk_series(o->output, body->scene->name, film.count, film.times);
  if (!status) print(body, &trial, outcome);
  free(film.times);
  free(outcome);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct request r = {20, 50};
  struct cb_options o;
  struct cb_scene scene;
  struct cb_body body = {0};
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_SCENE | CB_OPT_VARIANT | CB_OPT_OUTPUT | CB_OPT_THREADS,
                       doc, own_options, parse, &r, &o);
  if (!status) status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_body_create(&scene, 1, &body);
  if (!status) status = simulate(&body, &o, &r);
  cb_body_free(&body);
  return status;
}

const struct cb_verb cb_verb_run = {"run", "simulate a scene, for ParaView to show", run};
