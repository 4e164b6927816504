/* angle.c - the nearest rotation through its angle and axis, in float: a common mistake. The
 * arc cosine of the trace is blind near 0 and the axis vanishes near 180 degrees.
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/frames/jacobi.h"

void corobench_frame_f32(const float F[9], float R[9]) {
  real A[9], Q[9];
  float n[3];
  for (int i = 0; i < 9; i++) A[i] = F[i];
  nearest(A, 0, Q);
  const float trace = (float)(Q[0] + Q[4] + Q[8]);
  const float angle = acosf(fminf(1, fmaxf(-1, (trace - 1) / 2))), c = cosf(angle), s = sinf(angle);
  const float over = s > 1e-7f ? 1 / (2 * s) : 0;
  n[0] = over * (float)(Q[7] - Q[5]), n[1] = over * (float)(Q[2] - Q[6]);
  n[2] = over * (float)(Q[3] - Q[1]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const float skew = i == j ? 0 : (j == (i + 1) % 3 ? -1 : 1) * n[3 - i - j];
      R[3 * i + j] = (i == j ? c : 0) + (1 - c) * n[i] * n[j] + s * skew;
    }
}
