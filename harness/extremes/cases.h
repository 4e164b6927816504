/* cases.h - many single elements at once: what a variant makes of them, held against what
 * quad precision makes of the same numbers.
 *
 * An error is in units of what rounding explains: a rounding of the answer, what the answer
 * in quad precision moves by when the input moves by a rounding of its size, and the
 * smallest number of the arithmetic. A shape that is ill-conditioned excuses itself; a
 * kernel that loses more does not.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_CASES_H
#define CB_CASES_H

#include "harness/extremes/extremes.h"
#include "harness/verify/probe.h"

/* Element n has the nodes 4n to 4n + 3 to itself. */
struct cb_cases {
  size_t count;
  double *X, *x;         /* [12*count] vertices at rest and now, m */
  double young, poisson; /* Pa, 1; 1000 and 0.3 unless changed; density 1000 kg/m^3 */
  bool unit;             /* a = 0, and at rest the edges are the unit vectors: then those of now
                            are F, and frames are judged */
};
/* x zero, X zero or (unit) filled. CB_MEMORY, recorded. */
enum cb_status cb_cases_create(size_t count, bool unit, struct cb_cases *c);
void cb_cases_free(struct cb_cases *c);
/* A variant on them, cold. CB_MEMORY, recorded. Close with cb_probe_close. */
enum cb_status cb_cases_open(const struct cb_variant *v, const struct cb_cases *c,
                             struct cb_probe *probe);
/* R[9*count] := its model's frames of F. Only of a model that has one. CB_MEMORY. */
enum cb_status cb_cases_frames(const struct cb_variant *v, const struct cb_cases *c, double *R);

/* Roundoff times the condition of a frame: above, a thousand roundings turn it by as much as
 * it can be wrong. */
extern const double cb_well_conditioned;

/* What is known of one case in numbers of so many bytes. */
struct cb_known {
  bool framed; /* R is known and well-conditioned in that arithmetic */
  bool jumps;  /* R is defined by the model, but not here or not well: finite is enough */
  bool flat;   /* of no volume now, or of one that is lost in rounding */
  bool lost;   /* of no volume at rest: rounded away */
  double R[9], condition;
  double triple;        /* the products that make the volume, all taken as positive, by the volume:
                           a rounding of each moves it by up to so many */
  double f[12], f_unit; /* N; NaN: not known */
  double y[12], y_unit; /* K u, N/m of u */
};
struct cb_reference {
  double roundoff, least, most; /* of the arithmetic: smallest normal, largest number */
  struct cb_cases cases;        /* rounded to it */
  double *u;                    /* [12*count] */
  struct cb_known *known;
};
/* Of v's model: forces by the counted arithmetic, unknown if it has no such model; the
 * frame by its definition (exact.h). Valid for each variant of that model with as many
 * bytes. CB_MEMORY, recorded. */
enum cb_status cb_reference_create(const struct cb_variant *v, const struct cb_cases *cases,
                                   unsigned long seed, struct cb_reference *r);
void cb_reference_free(struct cb_reference *r);

/* row[count]: finite, figures, law and note of each case; the rest of the row stays.
 * CB_MEMORY, recorded. */
enum cb_status cb_cases_measure(const struct cb_variant *v, const struct cb_reference *r,
                                struct cb_extreme *row);

/* A row that is inaccurate, or breaks no law but `rotation` (by `turned` units of the force,
 * NaN: not measured), where the method's own rounding explains all of it: is the method's. */
void cb_method_judge(const struct cb_variant *v, const struct cb_reference *r,
                     const struct cb_known *k, double turned, struct cb_extreme *row);

/* row->parameter, value (and note) := those of row n of a sweep. */
typedef void cb_row_name_fn(const void *context, size_t n, struct cb_extreme *row);
/* Rows of all variants; each `same` cases after each other share one, which says the worst
 * of them. CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_cases_sweep(const char *sweep, const struct cb_cases *cases, size_t same,
                              cb_row_name_fn *name, const void *context, struct cb_extremes *all);

#endif
