/* recovery.h - does a body come back from where no body should be? One tetrahedron, inverted
 * in every way, and a block with its nodes at random places, collapsed and mirrored, let go.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_RECOVERY_H
#define CB_RECOVERY_H

#include "harness/bench/bench.h"

/* ---- starts (starts.c) -------------------------------------------------------------------- */

struct cb_recovery_start {
  const char *name, *about; /* static */
  bool block;               /* else one tetrahedron */
  void (*place)(const struct cb_mesh *mesh, unsigned long seed, double *x);
};
enum { CB_RECOVERY_STARTS = 13 };
/* How far a vertex is pushed through, of its height, and an edge, of its distance. */
#define CB_RECOVERY_DEPTH 0.5
extern const struct cb_recovery_start cb_recovery_starts[CB_RECOVERY_STARTS];
const struct cb_recovery_start *cb_recovery_start(const char *name); /* NULL: there is none */

struct cb_recovery_body {
  const struct cb_recovery_start *start;
  struct cb_bench_scene at; /* nothing is fixed, nothing moves */
  double *inverse;          /* [9*tets] of the matrix of rest edges, 1/m */
  double size;              /* largest edge of the bounding box at rest, m */
};
/* X[12]: rest positions of the one tetrahedron (m), or NULL for the usual one; of a block
 * NULL. CB_MEMORY, recorded. */
enum cb_status cb_recovery_body_create(const struct cb_recovery_start *start, const double *X,
                                       unsigned long seed, struct cb_recovery_body *body);
void cb_recovery_body_free(struct cb_recovery_body *body); /* zeroed is allowed */

/* ---- a run (recovery.c) --------------------------------------------------------------------- */

/* One setting for all. */
extern const struct cb_step_parameters cb_recovery_step;
enum { CB_RECOVERY_STEPS = 2000, CB_RECOVERY_EVERY = 20 };
enum { CB_RECOVERY_LOOKS = CB_RECOVERY_STEPS / CB_RECOVERY_EVERY + 1 };
/* An element is at rest when |F^T F - I| is at most this: strained by about 5 %. */
#define CB_RECOVERY_STRAIN 0.1
/* Farther from the rest shape than so many sizes it has exploded, and the run ends. */
#define CB_RECOVERY_FAR 10

struct cb_recovery {
  const struct cb_recovery_start *start;
  const struct cb_variant *variant;
  size_t elements;
  double lost;     /* s: from then on something is not finite; NaN: never. Of the end: */
  double back;     /* share of the elements at rest and right-handed; 0 when lost */
  double mirrored; /* share of them at rest but left-handed */
  double distance; /* from the rest shape, after the best rigid motion: root mean square over
                      mass, of the body's size; NaN when lost */
  double turn;     /* rad, of that motion; NaN when lost */
  double time;     /* s, from which on all elements are back; NaN: they are not */
  double share[CB_RECOVERY_LOOKS]; /* back, at every CB_RECOVERY_EVERY'th step */
};

/* Let go and wait, until nothing moves any more or the time is over. CB_MEMORY,
 * CB_INTERRUPTED. */
enum cb_status cb_recovery_run(const struct cb_recovery_body *body,
                               const struct cb_variant *variant, struct cb_recovery *r);

/* ---- all of them (survey.c) ------------------------------------------------------------------ */

struct cb_recoveries {
  size_t count; /* start by start, variants in one order in each */
  struct cb_recovery *of;
};
/* Every start with every variant that is selected (without --variant: ebe, f64). Shows
 * progress. CB_INPUT: none is selected that can step. */
enum cb_status cb_recovery_survey(const struct cb_options *options, struct cb_recoveries *all);
void cb_recoveries_free(struct cb_recoveries *all);
/* Tables; NULL: out of memory. For people: a line a variant, a column a start. */
struct cb_table *cb_recovery_matrix(const struct cb_recoveries *all);
struct cb_table *cb_recovery_table(const struct cb_recoveries *all);
struct cb_table *cb_recovery_times(const struct cb_recoveries *all);
/* "recovered": all back; "mirrored": at least half at rest but left-handed; "NaN": not finite;
 * "exploded": the distance is more than CB_RECOVERY_FAR; "stuck": anything else. Static. */
const char *cb_recovery_outcome(const struct cb_recovery *r);

#endif
