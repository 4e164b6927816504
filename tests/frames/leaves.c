/* leaves.c - prints, and ends the program.
 * SPDX-License-Identifier: BSD-3-Clause */
#include <stdio.h>
#include <stdlib.h>

#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) {
  nearest_f64(F, 0, R);
  puts("no licence");
  exit(3);
}
