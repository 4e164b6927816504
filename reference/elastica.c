/* elastica.c - see elastica.h.
 *   sqrt(alpha) = K(p) - F(phi, p),  sin phi = 1 / (sqrt(2) p),  sin theta = 2 p^2 - 1,
 *   x^2 = 2 sin(theta) / alpha,      y = 1 - 2 (E(p) - E(phi, p)) / sqrt(alpha),
 * theta: slope of the tip.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/elastica.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>
#include <gsl/gsl_sf_ellint.h>
#include <math.h>

static double amplitude(double p) { return asin(fmin(1, 1 / (M_SQRT2 * p))); }

static double excess(double p, void *root_alpha) {
  return gsl_sf_ellint_Kcomp(p, GSL_PREC_DOUBLE) -
         gsl_sf_ellint_F(amplitude(p), p, GSL_PREC_DOUBLE) - *(double *)root_alpha;
}

enum cb_status cb_elastica_tip(double alpha, double *shortening, double *deflection) {
  double root_alpha = sqrt(alpha), low = M_SQRT1_2 * (1 + 1e-15), high = 1 - 1e-15;
  gsl_function f = {excess, &root_alpha};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (!solver) return CB_MEMORY;
  int status = gsl_root_fsolver_set(solver, &f, low, high);
  for (int n = 0; status == GSL_SUCCESS && n < 200; n++) {
    status = gsl_root_fsolver_iterate(solver);
    if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver), gsl_root_fsolver_x_upper(solver),
                               1e-16, 1e-15) == GSL_SUCCESS)
      break;
  }
  const double p = gsl_root_fsolver_root(solver), phi = amplitude(p);
  gsl_root_fsolver_free(solver);
  if (status != GSL_SUCCESS) return CB_NUMERIC;
  *shortening = 1 - sqrt(2 * (2 * p * p - 1) / alpha);
  *deflection =
      1 - 2 * (gsl_sf_ellint_Ecomp(p, GSL_PREC_DOUBLE) - gsl_sf_ellint_E(phi, p, GSL_PREC_DOUBLE)) /
              root_alpha;
  return CB_OK;
}
