/* gram_schmidt.c - the QR frame of the columns; any where they are dependent.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) {
  real a[3], b[3], u[3], v[3], w[3];
  const real x[3] = {1, 0, 0};
  for (int i = 0; i < 3; i++) a[i] = F[3 * i], b[i] = F[3 * i + 1];
  const real first = sqrtl(inner(a, a)), second = sqrtl(inner(b, b));
  unit(a, first, x, u);
  for (int n = 0; n < 2; n++) {
    const real along = inner(u, b);
    for (int i = 0; i < 3; i++) b[i] -= along * u[i];
  }
  unit(b, second, u, v);
  outer(u, v, w);
  for (int i = 0; i < 3; i++)
    R[3 * i] = (double)u[i], R[3 * i + 1] = (double)v[i], R[3 * i + 2] = (double)w[i];
}
