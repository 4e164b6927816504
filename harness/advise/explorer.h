/* explorer.h - what the parts of cb_advise share: a body that is simulated again and
 * again against its truth.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_EXPLORER_H
#define CB_EXPLORER_H

#include "harness/advise/advise.h"

enum { CB_ADVISE_TIMED = 10 }; /* variants at most that are timed against each other */
/* Needs that more iterations may meet. */
enum { CB_NEED_ERRORS = 1u << CB_NEED_DISPLACEMENT | 1u << CB_NEED_ENERGY };
enum { CB_ADVISE_ITERATIONS = 13 };
extern const size_t cb_advise_iterations[CB_ADVISE_ITERATIONS]; /* that are tried, 1 to 100 */

struct explorer {
  const struct cb_body *body;
  const struct cb_advise_request *request;
  struct cb_outcome truth, outcome;
  struct cb_patches patches;
  double timing_s;
  double done; /* of the progress */
};

/* Show what is being done. */
void cb_explorer_say(struct explorer *e, const char *what);
/* Simulate the scene by c->trial and fill in what comes of it. */
enum cb_status cb_explorer_try(struct explorer *e, const struct cb_advice *a,
                               struct cb_candidate *c);
/* Time a->ranked against each other; the cheapest first. */
enum cb_status cb_explorer_rank(struct explorer *e, struct cb_advice *a);
/* The recommended variant with other steps and meshes. */
enum cb_status cb_explorer_settings(struct explorer *e, struct cb_advice *a);

#endif
