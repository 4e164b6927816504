/* case_newton.c - how Newton's method converges with the usual matrix, which drops how the
 * frame turns, and with the derivative of the force: a beam that is let go under its load.
 * Source: Ortega & Rheinboldt 1970, section 9.2 (R-order); Nocedal & Wright 2006, theorem
 *         3.5: 2 with the derivative.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/truth/beam.h"
#include "harness/truth/truth.h"
#include "reference/equilibrium.h"

/* log |r next| / log |r| of residuals that are small already: 2 where each has twice as
 * many zeros as the one before, about 1 where they fall by a constant factor. */
static double order_of(const struct cb_newton *n) {
  double most = NAN;
  for (size_t i = 0; i < n->iterations; i++) {
    const double order = log(n->residual[i + 1]) / log(n->residual[i]);
    if (n->residual[i] < 1e-2 && !(order <= most)) most = order;
  }
  return most;
}

enum cb_status cb_truth_newton(struct cb_truth *t) {
  static const struct {
    const char *model, *label;
    enum cb_newton_matrix matrix;
  } runs[] = {{"polar-exact", "polar-exact, usual matrix", CB_NEWTON_USUAL},
              {"polar-exact", "polar-exact, differences", CB_NEWTON_TRUE},
              {"polar-tangent", "polar-tangent", CB_NEWTON_USUAL},
              {"polar-tangent-clamped", "polar-tangent-clamped", CB_NEWTON_USUAL},
              {"qr-exact", "qr-exact, usual matrix", CB_NEWTON_USUAL},
              {"qr-exact", "qr-exact, differences", CB_NEWTON_TRUE},
              {"green", "green", CB_NEWTON_USUAL}};
  static const double alphas[] = {0.2, 5};
  enum cb_status status = CB_OK;
  for (size_t n = 0; !status && n < 2 * sizeof runs / sizeof *runs; n++) {
    const size_t k = n / 2;
    struct cb_beam beam = {0};
    struct cb_newton newton;
    char name[CB_TRUTH_NAME];
    if (!cb_truth_asked(t, runs[k].model)) continue;
    status = cb_beam_create(0.1, 10, 1, 1e6, &beam);
    if (status) break;
    cb_beam_push(&beam, alphas[n % 2] * 1e6 * pow(0.1, 4) / 12);
    status = cb_equilibrium_solve(runs[k].model, runs[k].matrix, &beam.mesh, &beam.material,
                                  beam.fixed, beam.external, 1e-10, beam.x, &newton);
    cb_beam_free(&beam);
    const bool converged = status == CB_OK;
    if (status == CB_NUMERIC) status = CB_OK;                   /* is what the row says */
    if (status == CB_MEMORY) cb_fail_memory("Newton's method"); /* the solver says nothing */
    snprintf(name, sizeof name, "Newton's order, alpha %g; fine: iterations", alphas[n % 2]);
    struct cb_truth_row row = cb_truth_row(name, runs[k].label, "Nocedal & Wright 2006");
    row.fine = converged ? (double)newton.iterations : NAN;
    row.coarse = (double)newton.shifts, row.medium = (double)newton.halved;
    row.order = row.judged = converged ? order_of(&newton) : NAN;
    const bool derivative = runs[k].matrix == CB_NEWTON_TRUE || k == 2 || k == 6;
    row.exact = derivative ? 2 : 1;
    if (derivative) row.low = 1.75, row.high = INFINITY; /* a lucky step is no fault */
    if (!status) status = cb_truth_add(t, &row);
  }
  return status;
}
