/* cases.c - elements, and the rows that a sweep makes of them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/cases.h"

#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/extremes/report.h"
#include "harness/progress.h"

enum cb_status cb_cases_create(size_t count, bool unit, struct cb_cases *c) {
  struct cb_cases made = {.count = count, .young = 1000, .poisson = 0.3, .unit = unit};
  made.X = calloc(count, 24 * sizeof *made.X);
  if (!made.X) return cb_fail_memory("the elements of a sweep");
  made.x = made.X + 12 * count;
  for (size_t n = 0; unit && n < count; n++)
    made.X[12 * n + 3] = made.X[12 * n + 7] = made.X[12 * n + 11] = 1;
  *c = made;
  return CB_OK;
}

void cb_cases_free(struct cb_cases *c) {
  free(c->X);
  *c = (struct cb_cases){0};
}

enum cb_status cb_cases_open(const struct cb_variant *v, const struct cb_cases *c,
                             struct cb_probe *probe) {
  struct cb_material material;
  uint32_t *tet = malloc(4 * c->count * sizeof *tet);
  struct cb_mesh mesh = {
      .nodes = 4 * c->count, .tets = c->count, .X = c->X, .tet = tet, .share = 1};
  enum cb_status status = tet ? cb_material_isotropic(c->young, c->poisson, 1000, &material)
                              : cb_fail_memory("the elements of a sweep");
  for (uint32_t i = 0; tet && i < 4 * c->count; i++) tet[i] = i;
  if (!status) status = cb_probe_open(v, &mesh, &material, probe);
  free(tet);
  return status;
}

/* ---- all variants of a model against one reference ------------------------------- */

struct sweep {
  const char *name;
  const struct cb_cases *cases;
  size_t same;
  cb_row_name_fn *row_name;
  const void *context;
  struct cb_extremes *all;
  struct cb_extreme *row; /* [cases] */
  size_t done;
};

static bool like(const struct cb_variant *a, const struct cb_variant *b) {
  return a->arithmetic->scalar_bytes == b->arithmetic->scalar_bytes &&
         strcmp(a->model->name, b->model->name) == 0;
}

static enum cb_status add_rows(struct sweep *s, const struct cb_variant *v,
                               const struct cb_reference *r) {
  for (size_t n = 0; n < s->cases->count; n++) s->row[n] = cb_extreme_blank(s->name, v);
  enum cb_status status = cb_cases_measure(v, r, s->row);
  for (size_t n = 0; !status && n < s->cases->count; n += s->same) {
    struct cb_extreme folded = s->row[n];
    for (size_t i = 1; i < s->same; i++) cb_extreme_fold(&folded, &s->row[n + i]);
    s->row_name(s->context, n / s->same, &folded);
    status = cb_extremes_add(s->all, &folded);
  }
  return status;
}

/* The first of its kind brings all of its kind. */
static enum cb_status add_kind(struct sweep *s, const struct cb_variant *const *first) {
  struct cb_reference r;
  char name[96];
  enum cb_status status = cb_reference_create(*first, s->cases, s->all->seed, &r);
  if (status) return status;
  for (const struct cb_variant *const *v = first; !status && *v; v++) {
    if (!like(*first, *v)) continue;
    cb_variant_name(*v, name);
    cb_progress((double)s->done++, name);
    status = add_rows(s, *v, &r);
  }
  cb_reference_free(&r);
  return status;
}

enum cb_status cb_cases_sweep(const char *sweep, const struct cb_cases *cases, size_t same,
                              cb_row_name_fn *name, const void *context, struct cb_extremes *all) {
  struct sweep s = {.name = sweep,
                    .cases = cases,
                    .same = same,
                    .row_name = name,
                    .context = context,
                    .all = all,
                    .row = malloc(cases->count * sizeof *s.row)};
  enum cb_status status = s.row ? CB_OK : cb_fail_memory("the rows of a sweep");
  size_t variants = 0;
  while (all->variants[variants]) variants++;
  cb_progress_begin(sweep, (double)variants);
  for (size_t v = 0; !status && v < variants; v++) {
    size_t first = 0;
    while (!like(all->variants[first], all->variants[v])) first++;
    if (first == v) status = add_kind(&s, all->variants + v);
    if (!status && cb_interrupted()) status = cb_fail(CB_INTERRUPTED, "interrupted; no table");
  }
  cb_progress_end();
  free(s.row);
  return status;
}
