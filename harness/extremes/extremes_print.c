/* extremes_print.c - rows, the map, and the map in words.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/extremes/report.h"

static void exactly(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

/* Three digits: what is measured are roundings. */
static void number(struct cb_table *t, double value) {
  char text[32];
  snprintf(text, sizeof text, "%.3g", value);
  exactly(t, strtod(text, NULL));
}

static void variant_name(struct cb_table *t, const struct cb_variant *v) {
  char name[96];
  cb_variant_name(v, name);
  cb_table_text(t, name);
}

struct cb_table *cb_extremes_rows(const struct cb_extremes *all) {
  struct cb_table *t =
      cb_table_create("sweep,parameter,variant,finite,frame_error,force_error,orthogonality,torque,"
                      "first_broken_law,value,product_error,determinant,state,note");
  for (size_t i = 0; t && i < all->count; i++) {
    const struct cb_extreme *r = &all->row[i];
    cb_table_text(t, r->sweep);
    cb_table_text(t, r->parameter);
    variant_name(t, r->variant);
    cb_table_text(t, r->finite ? "yes" : "no");
    number(t, r->frame_error);
    number(t, r->force_error);
    number(t, r->orthogonality);
    number(t, r->torque);
    cb_table_text(t, r->law);
    exactly(t, r->value);
    number(t, r->product_error);
    number(t, r->determinant);
    cb_table_text(t, cb_extreme_state_name[cb_extreme_state(r)]);
    cb_table_text(t, r->note);
  }
  return t;
}

struct cb_table *cb_extremes_steps(const struct cb_extremes *all) {
  struct cb_table *t = cb_table_create("variant,integrator,what,step_s,steps,finite,most_energy,"
                                       "end_energy,momentum_change,angular_change");
  for (size_t i = 0; t && i < all->step_count; i++) {
    const struct cb_extreme_step *s = &all->step[i];
    variant_name(t, s->variant);
    cb_table_text(t, s->integrator);
    cb_table_text(t, s->what);
    cb_table_number(t, s->h);
    cb_table_integer(t, (long long)s->steps);
    cb_table_text(t, s->finite ? "yes" : "no");
    exactly(t, s->most);
    exactly(t, s->energy);
    exactly(t, s->momentum);
    exactly(t, s->angular);
  }
  return t;
}

/* ---- one cell for all rows of a variant in a sweep ------------------------------------ */

struct cell {
  const struct cb_extreme *first, *worst; /* worst: the first one in the worst state */
  enum cb_extreme_state state;
  size_t rows, of[CB_EXTREME_STATES];
};

static struct cell cell_of(const struct cb_extremes *all, const char *sweep,
                           const struct cb_variant *v) {
  struct cell c = {.state = CB_NOT_JUDGED};
  for (size_t i = 0; i < all->count; i++) {
    const struct cb_extreme *r = &all->row[i];
    if (r->variant != v || strcmp(r->sweep, sweep) != 0) continue;
    const enum cb_extreme_state state = cb_extreme_state(r);
    if (!c.rows++) c.first = r;
    c.of[state]++;
    if (!c.worst || state > c.state) c.worst = r, c.state = state;
  }
  return c;
}

struct cb_table *cb_extremes_map(const struct cb_extremes *all) {
  struct cb_table *t = cb_table_create(
      "sweep,model,storage,arithmetic,state,rank,first_parameter,first_value,first_broken_law,"
      "rows,right,by_method,inaccurate,breaks_a_law,not_finite,not_judged,note");
  for (size_t s = 0; t && cb_sweeps[s]; s++)
    for (size_t v = 0; all->variants[v]; v++) {
      const struct cb_variant *variant = all->variants[v];
      const struct cell c = cell_of(all, cb_sweeps[s]->name, variant);
      if (!c.rows) continue;
      const bool marked = c.state > CB_RIGHT;
      cb_table_text(t, cb_sweeps[s]->name);
      cb_table_text(t, variant->model->name);
      cb_table_text(t, cb_storage_name[variant->storage]);
      cb_table_text(t, variant->arithmetic->name);
      cb_table_text(t, cb_extreme_state_name[c.state]);
      cb_table_integer(t, c.state);
      cb_table_text(t, marked ? c.worst->parameter : "");
      exactly(t, marked ? c.worst->value : NAN);
      cb_table_text(t, c.worst->law);
      cb_table_integer(t, (long long)c.rows);
      for (int n = CB_RIGHT; n < CB_EXTREME_STATES; n++) cb_table_integer(t, (long long)c.of[n]);
      cb_table_integer(t, (long long)c.of[CB_NOT_JUDGED]);
      cb_table_text(t, c.worst->note);
    }
  return t;
}

/* "right", "inaccurate", "not finite", or the law; "-": no such row. */
static void word(struct cb_table *t, const struct cell *c) {
  if (!c->rows)
    cb_table_missing(t);
  else
    cb_table_text(t, c->state == CB_BREAKS ? c->worst->law : cb_extreme_state_name[c->state]);
}

static bool has_rows(const struct cb_extremes *all, const char *sweep) {
  for (size_t i = 0; i < all->count; i++)
    if (strcmp(all->row[i].sweep, sweep) == 0) return true;
  return false;
}

struct cb_table *cb_extremes_words(const struct cb_extremes *all) {
  char columns[512] = "model,storage,arithmetic";
  for (size_t s = 0; cb_sweeps[s]; s++) {
    if (!has_rows(all, cb_sweeps[s]->name)) continue;
    strncat(columns, ",", sizeof columns - strlen(columns) - 1);
    strncat(columns, cb_sweeps[s]->name, sizeof columns - strlen(columns) - 1);
  }
  struct cb_table *t = cb_table_create(columns);
  for (size_t v = 0; t && all->variants[v]; v++) {
    cb_table_text(t, all->variants[v]->model->name);
    cb_table_text(t, cb_storage_name[all->variants[v]->storage]);
    cb_table_text(t, all->variants[v]->arithmetic->name);
    for (size_t s = 0; cb_sweeps[s]; s++) {
      const struct cell c = cell_of(all, cb_sweeps[s]->name, all->variants[v]);
      if (has_rows(all, cb_sweeps[s]->name)) word(t, &c);
    }
  }
  return t;
}
