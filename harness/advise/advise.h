/* advise.h - which variant is the cheapest that is still right for a scene, on this
 * machine: each model is tried on the scene itself, with more and more iterations,
 * until what the scene needs is met; the storages, arithmetics and threads of what is
 * left are then timed against each other.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ADVISE_H
#define CB_ADVISE_H

#include "harness/scene/run.h"
#include "harness/verify/patches.h"

/* What can be unmet. Laws come first, in the order of enum cb_law. */
enum cb_need {
  CB_NEED_FINITE = CB_LAW_ORDER + 1,
  CB_NEED_DISPLACEMENT,
  CB_NEED_TORQUE,
  CB_NEED_ENERGY,
  CB_NEED_INVERSION,
  CB_NEED_REST,
  CB_NEED_FRAMES,
  CB_NEEDS
};
extern const char *const cb_need_name[CB_NEEDS];

/* Measured on a scene. */
struct cb_candidate {
  struct cb_trial trial;
  char name[CB_NAME];
  bool finite;
  double law[CB_LAW_ORDER + 1]; /* worst violation, where the scene needs that law */
  double error, torque, energy; /* of displacement, relative torque, of energy */
  double rest;                  /* distance from the rest shape in the end */
  size_t inverted;
  double step_s; /* median of the run; timed: of the interleaved epochs */
  struct cb_interval step;
  unsigned unmet; /* bits 1 << enum cb_need */
  bool tie;       /* its interval reaches that of the best */
  bool last;      /* tried: of its model and precision, the one to be shown */
};

/* The cheapest if a law were not needed, or ten times as much were allowed. */
struct cb_relaxation {
  enum cb_need need;
  size_t candidate; /* index into tried; SIZE_MAX: none is cheaper */
  double gain;      /* its time of a step by that of the cheapest that does, both as tried; NaN:
                       none does */
};

/* The recommended variant with another step or on a coarser mesh, at the fewest
 * iterations that do. */
struct cb_setting {
  double step, resolution;
  size_t tetrahedra;
  struct cb_candidate candidate; /* unmet: nothing up to 100 iterations did */
  double seconds;                /* of computing for a simulated second, as tried */
};
enum { CB_SETTINGS = 6 };

struct cb_advice {
  struct cb_needs needs; /* of the scene, or as asked */
  double frame_s;        /* that a frame may take; infinity: no need */
  double steps_per_frame;
  size_t tried_count, ranked_count, relaxed_count;
  struct cb_candidate *tried;  /* each model and precision, with more and more iterations until
                                  they do; the cheapest first */
  struct cb_candidate *ranked; /* the cheapest first */
  struct cb_relaxation relaxed[CB_NEEDS];
  size_t setting_count;
  struct cb_setting setting[CB_SETTINGS]; /* the scene's own first */
  enum cb_need binding; /* nothing ranked: the need whose relaxation alone would do; CB_NEEDS:
                           no single one */
};

struct cb_advise_request {
  const struct cb_options *options; /* variants (models), threads, seed */
  double tolerance;                 /* of displacement; NaN: the scene's */
  double budget_s;                  /* of a frame; NaN: a frame's length */
  bool quick;
};

/* CB_OK as well where nothing meets the needs: ranked_count is 0 then. Free with
 * cb_advice_free. CB_NUMERIC: the scene has no truth; CB_MEMORY, CB_INTERRUPTED. */
enum cb_status cb_advise(const struct cb_body *body, const struct cb_advise_request *request,
                         struct cb_advice *advice);
void cb_advice_free(struct cb_advice *advice);

/* Unmet needs of a candidate. */
unsigned cb_needs_unmet(const struct cb_advice *a, const struct cb_candidate *c);
/* What was measured for that need, and what is allowed. */
double cb_need_value(const struct cb_advice *a, const struct cb_candidate *c, enum cb_need need);
double cb_need_limit(const struct cb_advice *a, enum cb_need need);
/* Does the scene have it? */
bool cb_need_asked(const struct cb_advice *a, enum cb_need need);

/* *simulators := what to type into other simulators for that model. */
void cb_advise_settings(const struct cb_candidate *c, char sofa[160], char vega[160]);

enum cb_status cb_advice_print(const struct cb_body *body, const struct cb_advice *a,
                               enum cb_format format);

#endif
