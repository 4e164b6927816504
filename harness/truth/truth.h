/* truth.h - what is known without this program, and what its models give: one case is
 * one file, harness/truth/case_NAME.c.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TRUTH_H
#define CB_TRUTH_H

#include "harness/verbs/verbs.h"

enum { CB_TRUTH_NAME = 64, CB_TRUTH_SOURCE = 96 };

/* One line of the table. A figure that a case has not is NaN. */
struct cb_truth_row {
  char name[CB_TRUTH_NAME], model[CB_TRUTH_NAME], source[CB_TRUTH_SOURCE];
  double exact;
  double coarse, medium, fine; /* meshes, or what the case says */
  double order;                /* of convergence, between the last two */
  double judged, low, high;    /* within: low <= judged <= high; low NaN: shown, not judged */
};

struct cb_truth {
  const struct cb_options *options; /* which models */
  size_t count;
  struct cb_truth_row *rows;
};

/* Append a copy. CB_MEMORY. */
enum cb_status cb_truth_add(struct cb_truth *t, const struct cb_truth_row *row);
/* A row whose numbers are all NaN. */
struct cb_truth_row cb_truth_row(const char *name, const char *model, const char *source);
/* Is the row within its band? True for one that is not judged; NaN is never within. */
bool cb_truth_within(const struct cb_truth_row *row);
/* log(|coarse - exact| / |fine - exact|) / log(ratio), ratio: of the cell sizes. */
double cb_truth_order(double exact, double coarse, double fine, double ratio);
/* Does --variant select that model (in any storage, f64)? */
bool cb_truth_asked(const struct cb_truth *t, const char *model);

typedef enum cb_status cb_truth_fn(struct cb_truth *t);
cb_truth_fn cb_truth_patch, cb_truth_manufactured, cb_truth_uniaxial, cb_truth_torsion,
    cb_truth_vibration, cb_truth_spin, cb_truth_cantilever, cb_truth_newton;

/* Every case, with progress. CB_MEMORY, CB_NUMERIC, CB_INTERRUPTED; recorded. */
enum cb_status cb_truth_run(const struct cb_options *options, struct cb_truth *truth);
void cb_truth_free(struct cb_truth *truth);
struct cb_table *cb_truth_table(const struct cb_truth *truth); /* NULL when out of memory */

/* ---- the tangent against strain ------------------------------------------------------ */

/* |K u - dF| / |dF| of each model that is asked for, at strains 1e-6 to 1 (largest over
 * random elements, directions): "model,strain,error". NULL: out of memory. */
enum cb_status cb_tangent_sweep(const struct cb_options *options, struct cb_table **table);

#endif
