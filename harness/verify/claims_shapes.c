/* claims_shapes.c - claims that are measured on shapes of their own.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/verify/claim.h"
#include "harness/verify/laws.h"
#include "harness/verify/probe.h"
#include "reference/oracles.h"

/* ---- C1: rotation ----------------------------------------------------------- */

/* Forces of a model on a block that is rigidly turned by 60 degrees about
 * (1, 1, 1): the largest, and the virial sum x . f / (E V), > 0: it inflates. */
static enum cb_status turned_block(const struct cb_variant *v, double *largest, double *virial) {
  struct cb_mesh mesh = {0};
  struct cb_material m;
  struct cb_probe probe = {0};
  double *x = NULL, *f;
  const double edge = 0.1,
               Q[9] = {2. / 3, -1. / 3, 2. / 3, 2. / 3, 2. / 3, -1. / 3, -1. / 3, 2. / 3, 2. / 3};
  enum cb_status status = cb_mesh_grid(2, 2, 2, edge, &mesh);
  if (!status) status = cb_material_isotropic(1, 0.3, 1, &m);
  if (!status) status = cb_probe_open(v, &mesh, &m, &probe);
  if (status) goto done;
  x = calloc(6 * mesh.nodes, sizeof *x);
  if (!x) {
    status = cb_fail_memory("the claims");
    goto done;
  }
  f = x + 3 * mesh.nodes;
  for (size_t i = 0; i < 3 * mesh.nodes; i++)
    for (size_t k = 0; k < 3; k++) x[i] += Q[3 * (i % 3) + k] * mesh.X[i - i % 3 + k];
  cb_probe_force(&probe, x, f);
  *largest = *virial = 0;
  for (size_t i = 0; i < 3 * mesh.nodes; i++) {
    *largest = cb_worst(*largest, fabs(f[i]) / (edge * edge));
    *virial += x[i] * f[i] / (8 * edge * edge * edge);
  }
done:
  cb_probe_close(&probe);
  cb_mesh_free(&mesh);
  free(x);
  return status;
}

enum cb_status cb_claim_rotation(struct cb_claimant *a) {
  double linear = NAN, virial = NAN, worst = 0, largest, unused;
  size_t count = 0;
  enum cb_status status = CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (v->storage != CB_EBE || strcmp(v->arithmetic->name, "f64") != 0) continue;
    if (strcmp(v->model->name, "linear") == 0) status = turned_block(v, &linear, &virial);
    if (!cb_is_corotated(v->model)) continue;
    status = turned_block(v, &largest, &unused);
    worst = cb_worst(worst, largest);
    count++;
  }
  MEASURED(a->claim,
           "block turned by 60 degrees: linear pushes outwards with %.2g E V (largest node force "
           "%.2g E A); largest force of %zu corotated models %.1g E A",
           virial, linear, count, worst);
  VERDICT(a->claim, virial > 1e-3 && worst <= 1e-10 ? "reproduced" : "not reproduced");
  return status;
}

/* ---- C2: strain ------------------------------------------------------------- */

static double distance_to_identity(const double *R, const double *F, bool symmetric) {
  double E[9], sum = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      E[3 * i + j] = R[i] * F[j] + R[3 + i] * F[3 + j] + R[6 + i] * F[6 + j] - (i == j);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      sum += pow(symmetric ? (E[3 * i + j] + E[3 * j + i]) / 2 : E[3 * i + j], 2);
  return sqrt(sum);
}

enum cb_status cb_claim_strain(struct cb_claimant *a) {
  enum { SAMPLES = 2000 };
  double ratio[SAMPLES], tensor[SAMPLES];
  size_t higher = 0;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng) return cb_fail_memory("the claims");
  gsl_rng_set(rng, a->seed);
  enum cb_status status = CB_OK;
  for (size_t n = 0; n < SAMPLES && !status; n++) {
    double F[9], Q[9], R[9];
    for (int i = 0; i < 9; i++) F[i] = (i % 4 == 0) + gsl_ran_gaussian(rng, 0.25);
    status = cb_oracle_polar(F, R);
    if (!status) status = cb_oracle_qr(F, Q);
    ratio[n] = distance_to_identity(Q, F, false) / distance_to_identity(R, F, false);
    tensor[n] = distance_to_identity(Q, F, true) / distance_to_identity(R, F, true);
    higher += ratio[n] >= 1;
  }
  gsl_rng_free(rng);
  if (status) return cb_fail(status, "no frame of a random matrix; try another --seed");
  gsl_sort(ratio, 1, SAMPLES);
  gsl_sort(tensor, 1, SAMPLES);
  double median = gsl_stats_median_from_sorted_data(ratio, 1, SAMPLES);
  double median_tensor = gsl_stats_median_from_sorted_data(tensor, 1, SAMPLES);
  MEASURED(a->claim,
           "%d random F: |E - I| of QR over polar: median %.3f, higher in %.1f %%; of the "
           "symmetric strain tensors alone: median %.3f",
           SAMPLES, median, 100.0 * (double)higher / SAMPLES, median_tensor);
  if (median > 1 && median_tensor > 1)
    VERDICT(a->claim, "reproduced");
  else if (median > 1)
    VERDICT(a->claim, "only if the rotation left in E counts as strain");
  else
    VERDICT(a->claim, "not reproduced");
  return CB_OK;
}

/* ---- C8: flat elements ------------------------------------------------------ */

/* Largest node force of a model over E A on a unit tetrahedron whose height is
 * that fraction of the rest height, sheared a little. */
static enum cb_status flattened(const struct cb_variant *v, double height, double *force) {
  double X[12] = {0, 0, 0, 1, 0, 0, 0.2, 1, 0, 0.3, 0.3, 1}, x[12], f[12];
  uint32_t tet[4] = {0, 1, 2, 3};
  struct cb_mesh mesh = {4, 1, X, tet, 1};
  struct cb_material m;
  struct cb_probe probe;
  for (int i = 0; i < 12; i++) x[i] = i % 3 == 2 ? height * X[i] : X[i] + 0.1 * X[(i + 4) % 12];
  enum cb_status status = cb_material_isotropic(1, 0.3, 1, &m);
  if (!status) status = cb_probe_open(v, &mesh, &m, &probe);
  if (status) return status;
  cb_probe_force(&probe, x, f);
  cb_probe_close(&probe);
  *force = 0;
  for (int i = 0; i < 12; i++) *force = cb_worst(*force, fabs(f[i]));
  return CB_OK;
}

enum cb_status cb_claim_flat(struct cb_claimant *a) {
  double worst = 0, least = INFINITY, force;
  size_t finite = 0, count = 0;
  enum cb_status status = CB_OK;
  for (const struct cb_variant *v = cb_variants(NULL); v->model && !status; v++) {
    if (v->storage != CB_EBE_PAPER || strcmp(v->arithmetic->name, "f64") != 0) continue;
    if (cb_is_updated(v->model)) {
      status = flattened(v, 0, &force);
      count++;
      finite += isfinite(force) != 0;
      if (isfinite(force)) worst = fmax(worst, force);
    } else if (cb_is_volume(v->model)) {
      status = flattened(v, 1e-8, &force);
      if (force < least) least = force; /* infinity and NaN are not small */
    }
  }
  MEASURED(a->claim,
           "height 0: force finite in %zu of %zu models with rest volume, at most %.2g E A; height "
           "1e-8, current volume: at least %.1g E A",
           finite, count, worst, least);
  VERDICT(a->claim, finite == count && worst < 1e3 && least > 1e3 ? "reproduced"
                    : finite > 0                                  ? "only for some frames"
                                                                  : "not reproduced");
  return status;
}

/* ---- the erratum --------------------------------------------------------------- */

enum cb_status cb_claim_erratum(struct cb_claimant *a) {
  const double xb = 1.1, xc = 0.3, yc = 0.9, xd = 0.4, yd = 0.2, zd = 0.8;
  const double first[3] = {-yc * zd, xc * zd - xb * zd, yc * xd - xc * yd + xb * yd - xb * yc};
  const double printed[9] = {yc * zd, xc * zd, yc * xd - xc * yd, 0, zd * xb, -yd * xb,
                             0,       0,       -xb * yc};
  const double right[9] = {yc * zd, -xc * zd, xc * yd - yc * xd, 0, xb * zd, -xb * yd, 0,
                           0,       xb * yc};
  double as_printed = 0, corrected = 0;
  for (int i = 0; i < 3; i++) {
    as_printed = fmax(as_printed, fabs(first[i] + printed[i] + printed[3 + i] + printed[6 + i]));
    corrected = fmax(corrected, fabs(first[i] + right[i] + right[3 + i] + right[6 + i]));
  }
  MEASURED(a->claim, "largest row sum of B: as printed %.2g, with corrected signs %.1g", as_printed,
           corrected);
  VERDICT(a->claim, as_printed > 1e-12 && corrected <= 1e-15
                        ? "gamma_b, delta_b and delta_d are printed with the wrong sign"
                        : "not confirmed");
  return CB_OK;
}
