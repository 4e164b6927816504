/* trade.h - speed for accuracy on one scene: what model, storage, arithmetic,
 * iterations, step, resolution, frame iterations and lazy updates cost and lose.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TRADE_H
#define CB_TRADE_H

#include "harness/scene/run.h"

/* One run of the scene. */
struct cb_trade_row {
  const char *sweep; /* string constant: "model", "storage", "step", "refine", "frame", "lazy" */
  char variant[CB_NAME];
  struct cb_trial trial;
  double resolution;
  size_t tetrahedra;
  bool finite;
  double seconds;               /* of computing, for a simulated second */
  double error, torque, energy; /* of displacement, of the size; relative; of energy */
  size_t session;               /* that ran it, from 1: more than one if the trade was resumed */
  bool front; /* no other row of the same truth has as small an error in 95 % of the time */
};

struct cb_journal;

struct cb_trade {
  const struct cb_scene *scene;
  size_t count;
  struct cb_trade_row *rows;
  double truth_check; /* how far the two ways to the truth differ, of the size */
};

/* All sweeps; a row that the journal has (NULL: no journal) is taken from there, the others
 * are added to it: rows are timed one by one, so that one may be of another session. Refinement is
 * held against a truth of twice the resolution, everything else against the scene's own mesh, so
 * that what is seen is not its mesh. A sweep without a variant that --variant selects is left out.
 * CB_NUMERIC: no truth; CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_trade_run(const struct cb_scene *scene, const struct cb_options *options,
                            bool quick, struct cb_journal *journal, struct cb_trade *trade);
void cb_trade_free(struct cb_trade *trade);

struct cb_table *cb_trade_table(const struct cb_trade *trade); /* NULL when out of memory */
/* The front and what follows from it, in words. */
enum cb_status cb_trade_print(const struct cb_trade *trade, FILE *stream);

#endif
