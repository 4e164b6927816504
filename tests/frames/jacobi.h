/* jacobi.h - the nearest rotation as a stranger might write it: one-sided Jacobi in long
 * double, any rank. What the libraries of this directory are made of.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_FRAMES_JACOBI_H
#define CB_TESTS_FRAMES_JACOBI_H

#include <math.h>

typedef long double real;

void corobench_frame(const double F[9], double R[9]);
void corobench_frame_f32(const float F[9], float R[9]);

static inline real inner(const real *a, const real *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void outer(const real *a, const real *b, real *c) {
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* Rows of A: columns of F V; rows of V: its columns. */
static inline void decompose(real A[3][3], real V[3][3]) {
  for (int n = 0; n < 90; n++) {
    const int j = n % 3 == 2, k = n % 3 == 0 ? 1 : 2;
    const real p = inner(A[j], A[j]), q = inner(A[k], A[k]), r = inner(A[j], A[k]);
    if (r == 0) continue;
    const real a = 0.5L * atan2l(2 * r, p - q), c = cosl(a), s = sinl(a);
    for (int i = 0; i < 3; i++) {
      const real x = A[j][i], y = V[j][i];
      A[j][i] = c * x + s * A[k][i], A[k][i] = c * A[k][i] - s * x;
      V[j][i] = c * y + s * V[k][i], V[k][i] = c * V[k][i] - s * y;
    }
  }
}

/* *u := unit vector along a, or at a right angle to the unit vector `beside` if a is nothing
 * beside a vector of that length. */
static inline void unit(const real *a, real length, const real *beside, real *u) {
  real l = sqrtl(inner(a, a));
  for (int i = 0; i < 3; i++) u[i] = a[i];
  if (!(l > 1e-17L * length)) {
    const int k = fabsl(beside[0]) < 0.6L ? 0 : 1;
    const real axis[3] = {k == 0, k == 1, 0};
    outer(beside, axis, u);
    l = sqrtl(inner(u, u));
  }
  for (int i = 0; i < 3; i++) u[i] /= l;
}

/* R := the nearest rotation; reflect: the nearest orthogonal matrix. */
static inline void nearest(const real *F, int reflect, real *R) {
  real A[3][3], V[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, U[3][3];
  int order[3] = {0, 1, 2};
  for (int i = 0; i < 9; i++) A[i % 3][i / 3] = F[i];
  decompose(A, V);
  for (int n = 0; n < 3; n++) {
    const int j = n % 2, a = order[j], b = order[j + 1];
    if (inner(A[a], A[a]) < inner(A[b], A[b])) order[j] = b, order[j + 1] = a;
  }
  const int a = order[0], b = order[1], c = order[2];
  const real length = sqrtl(inner(A[a], A[a]));
  real handed[3];
  unit(A[a], length, V[a], U[a]);
  if (!(length > 0)) /* all zero: any rotation */
    for (int i = 0; i < 3; i++) U[a][i] = V[a][i];
  unit(A[b], length, U[a], U[b]);
  outer(U[a], U[b], U[c]);
  outer(V[a], V[b], handed);
  real sign = inner(handed, V[c]) < 0 ? -1 : 1;
  if (reflect && sign * inner(U[c], A[c]) < 0) sign = -sign;
  for (int i = 0; i < 9; i++)
    R[i] = U[a][i / 3] * V[a][i % 3] + U[b][i / 3] * V[b][i % 3] + sign * U[c][i / 3] * V[c][i % 3];
}

static inline void nearest_f64(const double *F, int reflect, double *R) {
  real A[9], Q[9];
  for (int i = 0; i < 9; i++) A[i] = F[i];
  nearest(A, reflect, Q);
  for (int i = 0; i < 9; i++) R[i] = (double)Q[i];
}

static inline double determinant(const double *A) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

#endif
