/* report.c - a piece of advice as text, CSV or JSON.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "harness/advise/advise.h"
#include "harness/error.h"

/* ---- tables ---------------------------------------------------------------------------- */

static struct cb_table *ranking(const struct cb_advice *a) {
  struct cb_table *t = cb_table_create("variant,threads,iterations,step_us,low_us,high_us,"
                                       "displacement_error,torque,energy_error,note");
  for (size_t i = 0; t && i < a->ranked_count; i++) {
    const struct cb_candidate *c = &a->ranked[i];
    cb_table_text(t, c->name);
    cb_table_integer(t, (long long)c->trial.threads);
    cb_table_integer(t, (long long)c->trial.iterations);
    cb_table_number(t, 1e6 * c->step.value);
    cb_table_number(t, 1e6 * c->step.low);
    cb_table_number(t, 1e6 * c->step.high);
    cb_table_number(t, c->error);
    cb_table_number(t, c->torque);
    cb_table_number(t, c->energy);
    cb_table_text(t, i == 0 ? "recommended" : c->tie ? "tie" : "");
  }
  return t;
}

/* The first need that a candidate does not meet. */
static enum cb_need first_unmet(const struct cb_candidate *c) {
  int need = 0;
  while (!(c->unmet & 1u << need)) need++;
  return need;
}

static struct cb_table *rejected(const struct cb_advice *a) {
  struct cb_table *t = cb_table_create("variant,iterations,need,value,limit");
  for (size_t i = 0; t && i < a->tried_count; i++) {
    const struct cb_candidate *c = &a->tried[i];
    if (!c->unmet || !c->last) continue;
    const enum cb_need need = first_unmet(c);
    cb_table_text(t, c->name);
    cb_table_integer(t, (long long)c->trial.iterations);
    cb_table_text(t, cb_need_name[need]);
    cb_table_number(t, cb_need_value(a, c, need));
    cb_table_number(t, cb_need_limit(a, need));
  }
  return t;
}

static struct cb_table *relaxed(const struct cb_advice *a) {
  struct cb_table *t = cb_table_create("need,relaxed_to,then,iterations,displacement_error,"
                                       "torque,time_of_a_step");
  for (size_t i = 0; t && i < a->relaxed_count; i++) {
    const struct cb_relaxation *r = &a->relaxed[i];
    cb_table_text(t, cb_need_name[r->need]);
    if (r->need < CB_NEED_FINITE || r->need == CB_NEED_INVERSION)
      cb_table_text(t, "not needed");
    else
      cb_table_text(t, "ten times");
    if (r->candidate == SIZE_MAX) {
      cb_table_text(t, "nothing cheaper");
      for (int n = 0; n < 4; n++) cb_table_missing(t);
      continue;
    }
    const struct cb_candidate *c = &a->tried[r->candidate];
    cb_table_text(t, c->name);
    cb_table_integer(t, (long long)c->trial.iterations);
    cb_table_number(t, c->error);
    cb_table_number(t, c->torque);
    if (isnan(r->gain))
      cb_table_missing(t);
    else
      cb_table_number(t, r->gain);
  }
  return t;
}

static struct cb_table *settings(const struct cb_advice *a) {
  struct cb_table *t = cb_table_create("step_ms,tetrahedra,iterations,ms_per_second,"
                                       "displacement_error,torque,energy_error,meets_the_needs");
  for (size_t i = 0; t && i < a->setting_count; i++) {
    const struct cb_setting *s = &a->setting[i];
    cb_table_number(t, 1e3 * s->step);
    cb_table_integer(t, (long long)s->tetrahedra);
    cb_table_integer(t, (long long)s->candidate.trial.iterations);
    cb_table_number(t, 1e3 * s->seconds);
    cb_table_number(t, s->candidate.error);
    cb_table_number(t, s->candidate.torque);
    cb_table_number(t, s->candidate.energy);
    cb_table_text(t, s->candidate.unmet ? "no" : "yes");
  }
  return t;
}

static enum cb_status print_table(const char *title, struct cb_table *t) {
  enum cb_status status = t ? CB_OK : cb_fail_memory("a table");
  if (!status && !cb_table_is_empty(t)) {
    printf("\n%s\n", title);
    status = cb_table_print(t, CB_TABLE, stdout);
  }
  cb_table_free(t);
  return status;
}

/* ---- text -------------------------------------------------------------------------------- */

/* "for: so much measured, so much allowed" for each need, the rule first. */
static void print_reasons(const struct cb_advice *a, const struct cb_candidate *c) {
  for (int need = 0; need < CB_NEEDS; need++)
    if (cb_need_asked(a, need) && need != CB_NEED_FINITE)
      printf("  %-19s %.2g measured, %.2g allowed\n", cb_need_name[need], cb_need_value(a, c, need),
             cb_need_limit(a, need));
}

static void print_recommended(const struct cb_body *body, const struct cb_advice *a) {
  const struct cb_candidate *c = &a->ranked[0];
  char sofa[160], vega[160];
  printf("Recommended: %s, %zu iterations, %zu thread%s: %.3g us a step, %.3g ms for a simulated "
         "second.\n"
         "It is right:\n",
         c->name, c->trial.iterations, c->trial.threads, c->trial.threads == 1 ? "" : "s",
         1e6 * c->step_s, 1e3 * c->step_s / body->scene->step);
  print_reasons(a, c);
  for (size_t i = 1; i < a->ranked_count; i++) {
    const struct cb_candidate *next = &a->ranked[i];
    if (strcmp(next->trial.variant->model->name, c->trial.variant->model->name) == 0) continue;
    printf("Runner-up of another model: %s, %zu iterations, %.2f times the time%s\n", next->name,
           next->trial.iterations, next->step_s / c->step_s, next->tie ? " (a tie)" : "");
    break;
  }
  cb_advise_settings(c, sofa, vega);
  printf("In SOFA:    %s\nIn VegaFEM: %s\n", sofa, vega);
}

static void print_none(const struct cb_advice *a) {
  if (a->binding == CB_NEEDS)
    printf("Nothing meets the needs, nor would it if any single one were relaxed.\n");
  else
    printf("Nothing meets the needs. What binds is %s: see below what would do without it.\n",
           cb_need_name[a->binding]);
}

static enum cb_status print_text(const struct cb_body *body, const struct cb_advice *a) {
  printf("%s: %s\n%zu tetrahedra, step %g ms, %g s. Errors are against %s, solved directly at a "
         "tenth of the step.\n\n",
         body->scene->name, body->scene->about, body->at.mesh.tets, 1e3 * body->scene->step,
         body->scene->duration, "polar-exact");
  if (a->ranked_count)
    print_recommended(body, a);
  else
    print_none(a);
  enum cb_status status = CB_OK;
  if (a->ranked_count)
    status = print_table("The cheapest that do (times interleaved, 95 % interval of the median):",
                         ranking(a));
  if (!status) status = print_table("Tried and dropped, with the first need unmet:", rejected(a));
  if (!status)
    status = print_table("The recommended variant with other steps and meshes (the scene's own "
                         "first), at the fewest iterations that do:",
                         settings(a));
  if (!status)
    status = print_table("What relaxing a need would gain (time of a step by that of the cheapest "
                         "that does):",
                         relaxed(a));
  return status;
}

/* ---- JSON ---------------------------------------------------------------------------------- */

static json_t *number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

/* The list with the item behind the others; NULL, and both freed, where one is NULL. */
static json_t *with(json_t *list, json_t *item) {
  if (json_array_append_new(list, item) == 0) return list;
  json_decref(list);
  return NULL;
}

static json_t *laws_json(const struct cb_advice *a, const struct cb_candidate *c) {
  json_t *laws = json_object();
  bool whole = true;
  for (int law = 0; law <= CB_LAW_ORDER; law++)
    if (a->needs.laws & CB_KEEPS(law))
      whole &= json_object_set_new(laws, cb_law_name[law], number(c->law[law])) == 0;
  if (whole) return laws;
  json_decref(laws);
  return NULL;
}

static json_t *candidate_json(const struct cb_advice *a, const struct cb_candidate *c) {
  return json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:b, s:o}", "variant", c->name,
                   "threads", (json_int_t)c->trial.threads, "iterations",
                   (json_int_t)c->trial.iterations, "step_s", number(c->step_s), "step_s_low",
                   number(c->step.low), "step_s_high", number(c->step.high), "error",
                   number(c->error), "torque", number(c->torque), "energy_error", number(c->energy),
                   "tie", c->tie, "laws", laws_json(a, c));
}

static json_t *rejected_json(const struct cb_advice *a) {
  json_t *list = json_array();
  for (size_t i = 0; i < a->tried_count; i++) {
    const struct cb_candidate *c = &a->tried[i];
    if (!c->unmet || !c->last) continue;
    const enum cb_need need = first_unmet(c);
    list = with(list, json_pack("{s:s, s:I, s:s, s:o, s:o}", "variant", c->name, "iterations",
                                (json_int_t)c->trial.iterations, "need", cb_need_name[need],
                                "value", number(cb_need_value(a, c, need)), "limit",
                                number(cb_need_limit(a, need))));
  }
  return list;
}

static json_t *relaxed_json(const struct cb_advice *a) {
  json_t *list = json_array();
  for (size_t i = 0; i < a->relaxed_count; i++) {
    const struct cb_relaxation *r = &a->relaxed[i];
    const struct cb_candidate *c = r->candidate == SIZE_MAX ? NULL : &a->tried[r->candidate];
    list = with(list,
                json_pack("{s:s, s:o, s:o}", "need", cb_need_name[r->need], "then",
                          c ? candidate_json(a, c) : json_null(), "time_ratio", number(r->gain)));
  }
  return list;
}

static json_t *settings_json(const struct cb_advice *a) {
  json_t *list = json_array();
  for (size_t i = 0; i < a->setting_count; i++) {
    const struct cb_setting *s = &a->setting[i];
    list =
        with(list, json_pack("{s:o, s:f, s:I, s:I, s:o, s:o, s:b}", "step_s", number(s->step),
                             "resolution", s->resolution, "tetrahedra", (json_int_t)s->tetrahedra,
                             "iterations", (json_int_t)s->candidate.trial.iterations,
                             "seconds_per_second", number(s->seconds), "error",
                             number(s->candidate.error), "meets", !s->candidate.unmet));
  }
  return list;
}

static enum cb_status print_json(const struct cb_body *body, const struct cb_advice *a) {
  errno = 0;
  json_t *list = json_array();
  for (size_t i = 0; i < a->ranked_count; i++) list = with(list, candidate_json(a, &a->ranked[i]));
  json_t *all = json_pack(
      "{s:s, s:I, s:o, s:o, s:o, s:o, s:o, s:o}", "scene", body->scene->name, "tetrahedra",
      (json_int_t)body->at.mesh.tets, "recommended",
      a->ranked_count ? candidate_json(a, &a->ranked[0]) : json_null(), "ranking", list, "rejected",
      rejected_json(a), "settings", settings_json(a), "relaxed", relaxed_json(a), "binding",
      a->ranked_count || a->binding == CB_NEEDS ? json_null()
                                                : json_string(cb_need_name[a->binding]));
  const bool written =
      all && json_dumpf(all, stdout, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) == 0;
  const bool starved = !written && errno == ENOMEM;
  putchar('\n');
  json_decref(all);
  if (starved) return cb_fail_memory("the advice");
  return written ? CB_OK : cb_fail(CB_IO, "cannot write the advice to standard output");
}

enum cb_status cb_advice_print(const struct cb_body *body, const struct cb_advice *a,
                               enum cb_format format) {
  if (format == CB_TABLE) return print_text(body, a);
  if (format == CB_JSON) return print_json(body, a);
  struct cb_table *t = ranking(a);
  enum cb_status status = t ? cb_table_print(t, CB_CSV, stdout) : cb_fail_memory("the ranking");
  cb_table_free(t);
  return status;
}
