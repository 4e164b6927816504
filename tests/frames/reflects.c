/* reflects.c - the nearest orthogonal matrix: a reflection where det F < 0.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) { nearest_f64(F, 1, R); }
