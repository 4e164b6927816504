/* nan_line.c - right, but NaN where the columns of F are all along one line.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) {
  double most = 0, minor = 0;
  nearest_f64(F, 0, R);
  for (int i = 0; i < 9; i++) {
    const int a = (i / 3 + 1) % 3 * 3, b = (i / 3 + 2) % 3 * 3, c = (i + 1) % 3, d = (i + 2) % 3;
    most = fmax(most, fabs(F[i]));
    minor = fmax(minor, fabs(F[a + c] * F[b + d] - F[a + d] * F[b + c]));
  }
  if (!(minor > 1e-15 * most * most)) R[4] = NAN;
}
