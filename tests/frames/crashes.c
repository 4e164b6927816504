/* crashes.c - right, but writes to nowhere where det F < 0.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) {
  double *volatile nowhere = (double *)0;
  nearest_f64(F, 0, determinant(F) < 0 ? nowhere : R);
}
