/* summary.c - a routine in one row: the worst of all groups, and which group that is.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/files/table.h"
#include "harness/frames/frames.h"

void cb_frame_summary_add(struct cb_frame_summary *s, const struct cb_frame_result *r,
                          const struct cb_frame_set *set, const struct cb_frame_group *group) {
  const struct cb_frame_group none = {.count = 0};
  const int severity = cb_frame_severity(r, set);
  struct cb_frame_result *worst = &s->worst;
  if (!s->groups) {
    *worst = cb_frame_unmeasured(&none);
    s->error = s->fastest_ns = NAN;
  }
  worst->inputs += r->inputs;
  worst->unique += r->unique;
  worst->not_finite += r->not_finite;
  worst->flipped += r->flipped;
  /* NaN is of nothing, and the lesser to fmax */
  worst->error = fmax(worst->error, r->error);
  worst->degrees = fmax(worst->degrees, r->degrees);
  worst->orthogonality = fmax(worst->orthogonality, r->orthogonality);
  worst->determinant = fmax(worst->determinant, r->determinant);
  worst->excess = fmax(worst->excess, r->excess);
  worst->ns = fmax(worst->ns, r->ns);
  s->fastest_ns = fmin(s->fastest_ns, r->ns);
  const bool larger = r->error > s->error || (isnan(s->error) && !isnan(r->error));
  if (!s->groups || severity > s->severity || (severity == s->severity && larger))
    s->group = group->name, s->severity = severity, s->error = r->error;
  s->groups++;
  s->right += severity == 0;
}

static void number(struct cb_table *t, double value) {
  if (isnan(value))
    cb_table_missing(t);
  else
    cb_table_number(t, value);
}

void cb_frame_summary_row(const char *name, const char *arithmetic,
                          const struct cb_frame_summary *s, struct cb_table *t) {
  char text[128];
  snprintf(text, sizeof text, "%s/%s", name, arithmetic);
  cb_table_text(t, text);
  snprintf(text, sizeof text, "%zu/%zu", s->right, s->groups);
  cb_table_text(t, text);
  cb_table_text(t, s->group);
  number(t, s->worst.error);
  number(t, s->worst.orthogonality);
  cb_table_integer(t, (long long)s->worst.flipped);
  cb_table_integer(t, (long long)s->worst.not_finite);
  snprintf(text, sizeof text, "%.0f-%.0f", s->fastest_ns, s->worst.ns);
  cb_table_text(t, text);
}
