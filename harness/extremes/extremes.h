/* extremes.h - what breaks, and where: each model driven to the extremes of shapes,
 * coordinates, materials, operators and inputs, one sweep a file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EXTREMES_H
#define CB_EXTREMES_H

#include "harness/files/table.h"

/* Whose what a row shows is. */
enum cb_why {
  CB_WHY_MODEL,    /* the model's: its figures say what state it is in */
  CB_WHY_UNJUDGED, /* nobody's: there is nothing to hold it against */
  CB_WHY_METHOD    /* the method's, of which every kernel of it would fail here */
};

/* One model at one extreme. What a sweep does not measure is NaN and printed as nothing;
 * what is not finite is said by `finite`. Errors are against quad precision, in units of
 * the arithmetic's roundoff times how ill-conditioned the exact answer is. */
struct cb_extreme {
  const char *sweep;                /* static, or the journal's */
  char parameter[48];               /* "singular values 1 1e-6 1e-12" */
  double value;                     /* where on the sweep's axis */
  const struct cb_variant *variant; /* static */
  bool finite;                      /* frame, force and product */
  double frame_error, force_error, product_error;
  double orthogonality; /* |R^T R - I|, roundoffs */
  double determinant;   /* of R */
  double torque;        /* relative, roundoffs */
  const char *law;      /* the first law that breaks here, or ""; static, or the journal's */
  enum cb_why why;      /* not the model's: the note says it in words */
  char note[96];        /* "refused: ..."; "" */
};

/* What the sweep of steps says in columns of its own; texts static, or the journal's. */
struct cb_extreme_step {
  const struct cb_variant *variant;
  const char *integrator, *what;
  double h; /* s */
  size_t steps;
  bool finite;
  double most, energy, momentum, angular; /* harness/extremes/steps.h; NaN: not finite */
};

struct cb_journal;

struct cb_extremes {
  unsigned long seed;
  const struct cb_variant *const *variants; /* NULL-terminated */
  struct cb_journal *journal;               /* finished parts, not owned; NULL: none are kept */
  size_t count, step_count, parts;          /* parts: done or found */
  struct cb_extreme *row;
  struct cb_extreme_step *step;
};

/* Append a row. CB_MEMORY, recorded. */
enum cb_status cb_extremes_add(struct cb_extremes *all, const struct cb_extreme *row);
enum cb_status cb_extremes_add_step(struct cb_extremes *all, const struct cb_extreme_step *step);

/* If the journal has that part, its rows are appended from there; else `work` appends them, and
 * they go to the journal, unless it did so in parts of its own. CB_INPUT: they are no rows there;
 * what work returns. */
typedef enum cb_status cb_extremes_work_fn(struct cb_extremes *all, const void *context);
enum cb_status cb_extremes_part(struct cb_extremes *all, const char *key, cb_extremes_work_fn *work,
                                const void *context);

/* One sweep: appends its rows for each variant, shows progress. CB_MEMORY,
 * CB_INTERRUPTED. */
struct cb_sweep {
  const char *name, *summary;
  enum cb_status (*run)(struct cb_extremes *all);
};
extern const struct cb_sweep *const cb_sweeps[]; /* NULL-terminated; sweeps.c */

#endif
