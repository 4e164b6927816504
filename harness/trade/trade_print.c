/* trade_print.c - the trade as a table, and what it says in words.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/trade/trade.h"

struct cb_table *cb_trade_table(const struct cb_trade *trade) {
  struct cb_table *t = cb_table_create(
      "scene,sweep,model,storage,arithmetic,threads,iterations,step_s,resolution,tetrahedra,"
      "frame_iterations,frame_tolerance,lazy,seconds_per_second,displacement_error,torque,"
      "energy_error,finite,front,session");
  for (size_t i = 0; t && i < trade->count; i++) {
    const struct cb_trade_row *r = &trade->rows[i];
    const struct cb_variant *v = r->trial.variant;
    cb_table_text(t, trade->scene->name);
    cb_table_text(t, r->sweep);
    cb_table_text(t, v->model->name);
    cb_table_text(t, cb_storage_name[v->storage]);
    cb_table_text(t, v->arithmetic->name);
    cb_table_integer(t, (long long)r->trial.threads);
    cb_table_integer(t, (long long)r->trial.iterations);
    cb_table_number(t, r->trial.step);
    cb_table_number(t, r->resolution);
    cb_table_integer(t, (long long)r->tetrahedra);
    cb_table_integer(t, (long long)r->trial.tuning.frame_iterations);
    cb_table_number(t, r->trial.tuning.frame_tolerance);
    cb_table_number(t, r->trial.tuning.lazy);
    cb_table_number(t, r->seconds);
    cb_table_number(t, r->error);
    cb_table_number(t, r->torque);
    cb_table_number(t, r->energy);
    cb_table_integer(t, r->finite);
    cb_table_integer(t, r->front);
    cb_table_integer(t, (long long)r->session);
  }
  return t;
}

static bool refined(const struct cb_trade_row *r) { return strcmp(r->sweep, "refine") == 0; }

/* ---- the front -------------------------------------------------------------------------- */

static int by_seconds(const void *a, const void *b) {
  const struct cb_trade_row *x = *(const struct cb_trade_row *const *)a;
  const struct cb_trade_row *y = *(const struct cb_trade_row *const *)b;
  return (x->seconds > y->seconds) - (x->seconds < y->seconds);
}

/* Those of the front, the fastest first, each with less error than the one before by a
 * twentieth: what ties with a neighbour is in the file. */
static enum cb_status print_front(const struct cb_trade *trade, bool refine, FILE *stream) {
  const struct cb_trade_row **front = malloc((trade->count + 1) * sizeof *front);
  struct cb_table *t = cb_table_create("variant,iterations,step_ms,tetrahedra,ms_per_second,"
                                       "displacement_error,torque,energy_error");
  size_t count = 0;
  double least = INFINITY;
  enum cb_status status = front && t ? CB_OK : cb_fail_memory("the front");
  for (size_t i = 0; !status && i < trade->count; i++)
    if (trade->rows[i].front && refined(&trade->rows[i]) == refine)
      front[count++] = &trade->rows[i];
  if (!status) qsort(front, count, sizeof *front, by_seconds);
  for (size_t i = 0; !status && i < count; i++) {
    const struct cb_trade_row *r = front[i];
    if (!(r->error < 0.95 * least)) continue;
    least = r->error;
    cb_table_text(t, r->variant);
    cb_table_integer(t, (long long)r->trial.iterations);
    cb_table_number(t, 1e3 * r->trial.step);
    cb_table_integer(t, (long long)r->tetrahedra);
    cb_table_number(t, 1e3 * r->seconds);
    cb_table_number(t, r->error);
    cb_table_number(t, r->torque);
    cb_table_number(t, r->energy);
  }
  if (!status && count) {
    fprintf(stream, "\n%s\n",
            refine ? "Front of meshes of several resolutions (errors against a mesh of twice the "
                     "scene's):"
                   : "Front of the scene's own mesh: no other setting has as small an error in as "
                     "little time:");
    status = cb_table_print(t, CB_TABLE, stream);
  }
  cb_table_free(t);
  free(front);
  return status;
}

/* ---- never on the front -------------------------------------------------------------------- */

/* Of what a row is one: its model, storage or arithmetic. */
static const char *model_of(const struct cb_trade_row *r) { return r->trial.variant->model->name; }
static const char *storage_of(const struct cb_trade_row *r) {
  return cb_storage_name[r->trial.variant->storage];
}
static const char *arithmetic_of(const struct cb_trade_row *r) {
  return r->trial.variant->arithmetic->name;
}

static void print_never(const struct cb_trade *trade, const char *what,
                        const char *(*of)(const struct cb_trade_row *), FILE *stream) {
  size_t said = 0;
  fprintf(stream, "Never on the front, %s: ", what);
  for (size_t i = 0; i < trade->count; i++) {
    const char *name = of(&trade->rows[i]);
    bool first = true, front = false;
    for (size_t j = 0; j < trade->count; j++) {
      if (refined(&trade->rows[j]) || strcmp(of(&trade->rows[j]), name) != 0) continue;
      if (j < i) first = false;
      front |= trade->rows[j].front;
    }
    if (first && !front && !refined(&trade->rows[i]))
      fprintf(stream, "%s%s", said++ ? ", " : "", name);
  }
  fprintf(stream, "%s.\n", said ? "" : "none");
}

/* ---- does a cheaper frame allow more refined meshes? ----------------------------------------- */

static bool begins(const char *text, const char *with) {
  return strncmp(text, with, strlen(with)) == 0;
}

/* Least error among the refined rows of such models in at most so much time. */
static double least_error(const struct cb_trade *trade, const char *models, double seconds) {
  double least = INFINITY;
  for (size_t i = 0; i < trade->count; i++) {
    const struct cb_trade_row *r = &trade->rows[i];
    if (refined(r) && begins(model_of(r), models) && r->finite && r->seconds <= seconds)
      least = fmin(least, r->error);
  }
  return least;
}

static void print_refinement(const struct cb_trade *trade, const char *frame, FILE *stream) {
  size_t budgets = 0, better = 0, worse = 0;
  double ratios = 0;
  for (size_t i = 0; i < trade->count; i++) {
    const struct cb_trade_row *r = &trade->rows[i];
    if (!refined(r) || !begins(model_of(r), frame) || !r->finite) continue;
    const double other = least_error(trade, frame, r->seconds);
    const double qr = least_error(trade, "qr-", r->seconds);
    if (!(isfinite(qr) && isfinite(other))) continue;
    budgets++;
    better += qr < 0.98 * other;
    worse += qr > 1.02 * other;
    ratios += log(qr / other);
  }
  if (!budgets) return;
  fprintf(
      stream,
      "At equal time, QR on a finer mesh has the smaller error than %s* in %zu of %zu cases, the "
      "larger in %zu; its error is %.2f times as large (geometric mean): \"its efficiency "
      "allows more refined meshes\" is %s here.\n",
      frame, better, budgets, worse, exp(ratios / (double)budgets),
      better > worse && ratios < 0 ? "true" : "not true");
}

enum cb_status cb_trade_print(const struct cb_trade *trade, FILE *stream) {
  fprintf(stream,
          "%s: %s\n%zu runs. The truth by iteration differs from the direct one by %.1g of "
          "the size.\n",
          trade->scene->name, trade->scene->about, trade->count, trade->truth_check);
  enum cb_status status = print_front(trade, false, stream);
  if (!status) status = print_front(trade, true, stream);
  if (status) return status;
  fprintf(stream, "\n");
  print_never(trade, "models", model_of, stream);
  print_never(trade, "storages", storage_of, stream);
  print_never(trade, "arithmetics", arithmetic_of, stream);
  print_refinement(trade, "polar-closed", stream);
  print_refinement(trade, "polar-higham", stream);
  print_refinement(trade, "svd", stream);
  return CB_OK;
}
