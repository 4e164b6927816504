/* law_session.h - private to the laws: one measurement on one set of patches.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_LAW_SESSION_H
#define CB_LAW_SESSION_H

#include <gsl/gsl_rng.h>

#include "harness/verify/laws.h"
#include "harness/verify/probe.h"

struct cb_law_session {
  const struct cb_patches *p;
  struct cb_probe probe;
  gsl_rng *rng;
  double *f;         /* force at x of the patches */
  double *g, *x, *u; /* work, [3*nodes] */
  double *value;     /* the result, [count] */
};

/* f[3*nodes] := force at x, coming from the shape before. */
void cb_law_force(struct cb_probe *probe, const double *before, const double *x, double *f);

/* laws_operator.c: value := what laws.h says of the operator K. CB_MEMORY,
 * CB_NUMERIC. *measured: how many patches have a value (tangent: the first). */
enum cb_status cb_law_symmetric(struct cb_law_session *s);
enum cb_status cb_law_semidefinite(struct cb_law_session *s);
enum cb_status cb_law_tangent(struct cb_law_session *s, const struct cb_material *material,
                              size_t *measured);

#endif
