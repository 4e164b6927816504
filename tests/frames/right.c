/* right.c - the nearest rotation, in double and in float.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame(const double F[9], double R[9]) { nearest_f64(F, 0, R); }

void corobench_frame_f32(const float F[9], float R[9]) {
  real A[9], Q[9];
  for (int i = 0; i < 9; i++) A[i] = F[i];
  nearest(A, 0, Q);
  for (int i = 0; i < 9; i++) R[i] = (float)Q[i];
}
