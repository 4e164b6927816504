/* distance.c - how far a shape is from the one at rest, wherever it is.
 * Source: the rotation of least squares is the polar factor of the correlation (Kabsch 1976).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "harness/scene/body.h"
#include "reference/oracles.h"

static void centre(const struct cb_body *b, const double *x, double c[3]) {
  double mass = 0;
  c[0] = c[1] = c[2] = 0;
  for (size_t i = 0; i < b->at.mesh.nodes; i++) {
    mass += b->at.mass[i];
    for (int k = 0; k < 3; k++) c[k] += b->at.mass[i] * x[3 * i + k];
  }
  for (int k = 0; k < 3; k++) c[k] /= mass;
}

double cb_body_distance(const struct cb_body *b, const double *x) {
  const double *X = b->at.mesh.X;
  double c[3], C[3], A[9] = {0}, R[9], worst = 0;
  centre(b, x, c);
  centre(b, X, C);
  for (size_t i = 0; i < b->at.mesh.nodes; i++)
    for (int n = 0; n < 9; n++)
      A[n] += b->at.mass[i] * (x[3 * i + n / 3] - c[n / 3]) * (X[3 * i + n % 3] - C[n % 3]);
  if (cb_oracle_polar(A, R) != CB_OK) return NAN; /* not finite */
  for (size_t i = 0; i < b->at.mesh.nodes; i++) {
    double square = 0;
    if (!(b->at.mass[i] > 0)) continue; /* of no element */
    for (int k = 0; k < 3; k++) {
      double d = x[3 * i + k] - c[k];
      for (int j = 0; j < 3; j++) d -= R[3 * k + j] * (X[3 * i + j] - C[j]);
      square += d * d;
    }
    worst = fmax(worst, sqrt(square));
  }
  return worst / b->size;
}
