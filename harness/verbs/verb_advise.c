/* verb_advise.c - `corobench advise`: the cheapest variant that is right for a scene.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <math.h>

#include "harness/advise/advise.h"
#include "harness/error.h"

static const char doc[] =
    "Simulate a scene with each model and more and more iterations, drop what breaks a need of the "
    "scene, time the rest on this machine, and recommend the cheapest: variant, iterations, "
    "threads, with reasons, the runner-up, and what each need costs. In about a minute."
    "\vExit status 3: nothing meets the needs.";

enum { KEY_TOLERANCE = 0x3000, KEY_BUDGET, KEY_QUICK };
static const struct argp_option own_options[] = {
    {"tolerance", KEY_TOLERANCE, "E", 0,
     "Largest error of a displacement, of the scene's size, instead of the scene's own", 0},
    {"budget", KEY_BUDGET, "MS", 0,
     "Time for the steps of one frame (of the scene's frames_per_s, else of 30 a second), instead "
     "of the frame's length",
     0},
    {"quick", KEY_QUICK, NULL, 0, "Fewer candidates and samples", 0},
    {0}};

static error_t parse(int key, char *text, struct argp_state *state) {
  struct cb_advise_request *r = state->input;
  enum cb_status status = CB_OK;
  switch (key) {
  case KEY_TOLERANCE:
    status = cb_parse_number("--tolerance", text, DBL_MIN, DBL_MAX, &r->tolerance);
    break;
  case KEY_BUDGET:
    status = cb_parse_number("--budget", text, DBL_MIN, DBL_MAX, &r->budget_s);
    r->budget_s *= 1e-3;
    break;
  case KEY_QUICK: r->quick = true; break;
  default: return ARGP_ERR_UNKNOWN;
  }
  return status ? EINVAL : 0;
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  struct cb_advise_request request = {.options = &o, .tolerance = NAN, .budget_s = NAN};
  struct cb_scene scene;
  struct cb_body body = {0};
  struct cb_advice advice = {0};
  enum cb_status status = cb_options_parse(
      argc, argv, CB_OPT_SCENE | CB_OPT_VARIANT | CB_OPT_FORMAT | CB_OPT_SEED | CB_OPT_THREADS, doc,
      own_options, parse, &request, &o);
  if (!status) status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_body_create(&scene, 1, &body);
  if (!status) {
    if (!o.threads.count) o.threads = cb_bench_threads();
    status = cb_advise(&body, &request, &advice);
  }
  if (!status) status = cb_advice_print(&body, &advice, o.format);
  if (!status && !advice.ranked_count)
    status = cb_fail(CB_UNMET, "nothing meets the needs of scene '%s'%s%s", scene.name,
                     advice.binding == CB_NEEDS ? "" : "; what binds is ",
                     advice.binding == CB_NEEDS ? "" : cb_need_name[advice.binding]);
  cb_advice_free(&advice);
  cb_body_free(&body);
  return status;
}

const struct cb_verb cb_verb_advise = {"advise", "the cheapest kernel that is right for a scene",
                                       run};
