/* results_slices.c - see results_slices.h. Every member of every list is named once, in the
 * tables below; an item is an array of them in that order.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/measure/results_slices.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/journal.h"

/* ---- what there is -------------------------------------------------------------------------- */

enum kind {
  COUNT,    /* size_t */
  ROW,      /* size_t, the index of a row: counted from the slice's first */
  REAL,     /* double */
  INTERVAL, /* struct cb_interval */
  TEXT,     /* char[], of `size` bytes */
  CONSTANT  /* const char *, a string constant */
};
struct member {
  enum kind kind;
  size_t at, size;
};
#define M(kind, type, name)                                                                        \
  { kind, offsetof(struct type, name), sizeof(((struct type *)0)->name) }

static const struct member
    rows[] = {M(CONSTANT, cb_row, figure),  M(TEXT, cb_row, variant),
              M(COUNT, cb_row, tetrahedra), M(COUNT, cb_row, nodes),
              M(COUNT, cb_row, iterations), M(COUNT, cb_row, threads),
              M(INTERVAL, cb_row, step),    M(REAL, cb_row, bytes_per_tetrahedron),
              M(TEXT, cb_row, status),      M(REAL, cb_row, setup_s),
              M(REAL, cb_row, update_s),    M(REAL, cb_row, solve_s),
              M(REAL, cb_row, product_s),   M(REAL, cb_row, scatter),
              M(COUNT, cb_row, epochs)},
    samples[] = {M(ROW, cb_sample, row), M(COUNT, cb_sample, round), M(COUNT, cb_sample, repeats),
                 M(REAL, cb_sample, step_s), M(REAL, cb_sample, cpu_s)},
    ratios[] = {M(CONSTANT, cb_ratio, figure),
                M(TEXT, cb_ratio, numerator),
                M(TEXT, cb_ratio, denominator),
                M(COUNT, cb_ratio, tetrahedra),
                M(COUNT, cb_ratio, iterations),
                M(COUNT, cb_ratio, threads),
                M(COUNT, cb_ratio, denominator_threads),
                M(INTERVAL, cb_ratio, ratio),
                M(REAL, cb_ratio, paper)},
    fits[] = {M(TEXT, cb_fit, variant), M(COUNT, cb_fit, tetrahedra), M(COUNT, cb_fit, threads),
              M(INTERVAL, cb_fit, fixed), M(INTERVAL, cb_fit, iteration)},
    crossings[] = {M(TEXT, cb_crossing, assembled),      M(TEXT, cb_crossing, unassembled),
                   M(COUNT, cb_crossing, tetrahedra),    M(COUNT, cb_crossing, threads),
                   M(INTERVAL, cb_crossing, iterations), M(REAL, cb_crossing, paper)},
    convergences[] = {M(TEXT, cb_convergence, variant), M(COUNT, cb_convergence, tetrahedra),
                      M(COUNT, cb_convergence, iterations), M(REAL, cb_convergence, h),
                      M(REAL, cb_convergence, error)},
    rooflines[] = {M(CONSTANT, cb_roofline, work),    M(CONSTANT, cb_roofline, mesh),
                   M(CONSTANT, cb_roofline, level),   M(TEXT, cb_roofline, variant),
                   M(COUNT, cb_roofline, tetrahedra), M(COUNT, cb_roofline, threads),
                   M(REAL, cb_roofline, flops),       M(REAL, cb_roofline, bytes),
                   M(REAL, cb_roofline, visits),      M(INTERVAL, cb_roofline, time),
                   M(REAL, cb_roofline, peak),        M(REAL, cb_roofline, bandwidth),
                   M(REAL, cb_roofline, attainable)},
    speeds[] = {M(CONSTANT, cb_speed, mesh),
                M(TEXT, cb_speed, variant),
                M(COUNT, cb_speed, tetrahedra),
                M(COUNT, cb_speed, threads),
                M(INTERVAL, cb_speed, step),
                M(INTERVAL, cb_speed, faster),
                M(REAL, cb_speed, bytes_per_tetrahedron),
                M(REAL, cb_speed, force_error),
                M(REAL, cb_speed, position_error)},
    frames[] = {M(CONSTANT, cb_frame, mesh),         M(TEXT, cb_frame, variant),
                M(COUNT, cb_frame, threads),         M(COUNT, cb_frame, iterations),
                M(COUNT, cb_frame, measurements),    M(REAL, cb_frame, limit_s),
                M(COUNT, cb_frame, fits.cells),      M(COUNT, cb_frame, fits.tetrahedra),
                M(INTERVAL, cb_frame, fits.step),    M(REAL, cb_frame, fits.bytes),
                M(COUNT, cb_frame, exceeds.cells),   M(COUNT, cb_frame, exceeds.tetrahedra),
                M(INTERVAL, cb_frame, exceeds.step), M(REAL, cb_frame, exceeds.bytes)};

#define L(list, count)                                                                             \
  {                                                                                                \
#list, offsetof(struct cb_results, list), offsetof(struct cb_results, count),                  \
        sizeof *((struct cb_results *)0)->list, sizeof(list) / sizeof *(list), list                \
  }
static const struct list {
  const char *name;
  size_t array, count; /* where in struct cb_results */
  size_t size, members;
  const struct member *member;
} lists[CB_RESULT_LISTS] = {
    L(rows, row_count),           L(samples, sample_count),     L(ratios, ratio_count),
    L(fits, fit_count),           L(crossings, crossing_count), L(convergences, convergence_count),
    L(rooflines, roofline_count), L(speeds, speed_count),       L(frames, frame_count)};

static size_t count_of(const struct cb_results *r, const struct list *list) {
  return *(const size_t *)((const char *)r + list->count);
}

struct cb_mark cb_results_mark(const struct cb_results *r) {
  struct cb_mark mark;
  for (size_t i = 0; i < CB_RESULT_LISTS; i++) mark.count[i] = count_of(r, &lists[i]);
  return mark;
}

/* ---- to JSON --------------------------------------------------------------------------------- */

static json_t *interval_json(const struct cb_interval *interval) {
  return json_pack("[o, o, o]", cb_journal_number(interval->value),
                   cb_journal_number(interval->low), cb_journal_number(interval->high));
}

static json_t *member_json(const struct member *m, const char *item, size_t first_row) {
  const void *at = item + m->at;
  switch (m->kind) {
  case COUNT: return json_integer((json_int_t) * (const size_t *)at);
  case ROW: return json_integer((json_int_t)(*(const size_t *)at - first_row));
  case REAL: return cb_journal_number(*(const double *)at);
  case INTERVAL: return interval_json(at);
  case TEXT: return json_string(at);
  case CONSTANT: return json_string(*(const char *const *)at);
  }
  return NULL;
}

/* Appended to the array; false: out of memory. */
static bool append_item(json_t *array, const struct list *list, const char *item,
                        size_t first_row) {
  json_t *made = json_array();
  bool good = made != NULL;
  for (size_t i = 0; good && i < list->members; i++)
    good = json_array_append_new(made, member_json(&list->member[i], item, first_row)) == 0;
  if (good) return json_array_append_new(array, made) == 0;
  json_decref(made);
  return false;
}

json_t *cb_results_since(const struct cb_results *r, const struct cb_mark *mark) {
  json_t *slice = json_object();
  bool good = slice != NULL;
  for (size_t n = 0; good && n < CB_RESULT_LISTS; n++) {
    const struct list *list = &lists[n];
    const char *items = *(const char *const *)((const char *)r + list->array);
    const size_t count = count_of(r, list);
    json_t *array = count > mark->count[n] ? json_array() : NULL;
    if (count == mark->count[n]) continue;
    good = array && json_object_set_new(slice, list->name, array) == 0;
    for (size_t i = mark->count[n]; good && i < count; i++)
      good = append_item(array, list, items + i * list->size, mark->count[0]);
  }
  if (good) return slice;
  json_decref(slice);
  return NULL;
}

/* ---- and back ----------------------------------------------------------------------------------
 */

static bool to_count(const json_t *json, size_t *count) {
  const json_int_t n = json_integer_value(json);
  if (!json_is_integer(json) || n < 0) return false;
  *count = (size_t)n;
  return true;
}

static bool to_text(const json_t *json, size_t size, char *text) {
  const char *found = json_string_value(json);
  if (!found || strlen(found) >= size) return false;
  strcpy(text, found);
  return true;
}

static bool to_interval(const json_t *json, struct cb_interval *interval) {
  return cb_journal_to_number(json_array_get(json, 0), &interval->value) &&
         cb_journal_to_number(json_array_get(json, 1), &interval->low) &&
         cb_journal_to_number(json_array_get(json, 2), &interval->high);
}

/* own: the slice's first row, and one past its last. */
static bool to_member(const struct member *m, const json_t *json, const size_t own[2], char *item) {
  void *at = item + m->at;
  switch (m->kind) {
  case COUNT: return to_count(json, at);
  case ROW:
    if (!to_count(json, at) || *(size_t *)at >= own[1] - own[0]) return false;
    *(size_t *)at += own[0];
    return true;
  case REAL: return cb_journal_to_number(json, at);
  case INTERVAL: return to_interval(json, at);
  case TEXT: return to_text(json, m->size, at);
  case CONSTANT: return (*(const char **)at = json_string_value(json)) != NULL;
  }
  return false;
}

static enum cb_status refuse(void) {
  return cb_fail(CB_INPUT, "the journal of the earlier run holds what is no result; start anew "
                           "without --resume");
}

static enum cb_status restore_list(struct cb_results *r, const struct list *list,
                                   const json_t *array, const size_t own[2]) {
  char **items = (char **)((char *)r + list->array);
  size_t *count = (size_t *)((char *)r + list->count);
  for (size_t i = 0; i < json_array_size(array); i++) {
    const json_t *from = json_array_get(array, i);
    void *larger = cb_results_grown(*items, *count, list->size);
    if (!larger) return cb_fail_memory("the results");
    *items = larger;
    char *item = memset(*items + *count * list->size, 0, list->size);
    for (size_t k = 0; k < list->members; k++)
      if (!to_member(&list->member[k], json_array_get(from, k), own, item)) return refuse();
    ++*count;
  }
  return CB_OK;
}

enum cb_status cb_results_restore(struct cb_results *r, const json_t *slice, size_t session) {
  enum cb_status status = CB_OK;
  const size_t first = r->row_count;
  size_t own[2] = {first, first};
  for (size_t n = 0; !status && n < CB_RESULT_LISTS; n++) {
    status = restore_list(r, &lists[n], json_object_get(slice, lists[n].name), own);
    own[1] = r->row_count; /* the rows come first */
  }
  for (size_t i = first; i < r->row_count; i++) r->rows[i].session = session;
  return status;
}
