/* hangs.c - right, but never ready where F is zero: an iteration without an end.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) {
  double volatile sum = 0;
  while (!(sum > 0))
    for (int i = 0; i < 9; i++) sum += fabs(F[i]);
  nearest_f64(F, 0, R);
}
