/* exact.c - see exact.h.
 * Source: Hestenes 1958 (one-sided Jacobi); Gram-Schmidt, once again for what is left.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/extremes/exact.h"

#include <math.h>
#include <string.h>

typedef __float128 quad;
__float128 sqrtq(__float128);

enum cb_definition cb_frame_definition(const struct cb_model *model) {
  static const struct {
    const char *begin;
    enum cb_definition definition;
  } known[] = {{"polar-reflected", CB_NEAREST_ORTHOGONAL},
               {"polar", CB_NEAREST_ROTATION},
               {"svd", CB_NEAREST_ROTATION},
               {"qr", CB_GRAM_SCHMIDT}};
  for (size_t i = 0; model->frame && i < sizeof known / sizeof *known; i++)
    if (strncmp(model->name, known[i].begin, strlen(known[i].begin)) == 0)
      return known[i].definition;
  return CB_UNDEFINED;
}

/* Matrices here are by columns: a[j] is column j. */
static quad dot(const quad *a, const quad *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const quad *a, const quad *b, quad *c) {
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    c[i] = a[j] * b[k] - a[k] * b[j];
  }
}

/* a, b := [a b] turned by tan t: (a + t b, b - t a) / length. */
static void turn(quad t, quad *a, quad *b) {
  const quad c = 1 / sqrtq(1 + t * t);
  for (int i = 0; i < 3; i++) {
    const quad ai = a[i], bi = b[i];
    a[i] = c * (ai + t * bi), b[i] = c * (bi - t * ai);
  }
}

/* Columns of A = F V turned until they are orthogonal to the last bit but a few. */
static void jacobi(quad A[3][3], quad V[3][3]) {
  bool moved = true;
  for (int sweep = 0; moved && sweep < 64; sweep++) {
    moved = false;
    for (int n = 0; n < 3; n++) {
      quad *a = A[n / 2], *b = A[1 + (n + 1) / 2];
      const quad p = dot(a, a), q = dot(b, b), r = dot(a, b);
      if (r * r <= (quad)0x1p-220 * p * q) continue;
      const quad x = (p - q) / (2 * r), h = sqrtq(x * x + 1);
      const quad t = 1 / (x < 0 ? x - h : x + h);
      turn(t, a, b), turn(t, V[n / 2], V[1 + (n + 1) / 2]);
      moved = true;
    }
  }
}

static void exchange(quad *a, quad *b) {
  for (int i = 0; i < 3; i++) {
    const quad ai = a[i];
    a[i] = b[i], b[i] = -ai; /* V stays a rotation */
  }
}

/* q := v / |v| without its part along u (NULL: none). Returns the length of that. */
static quad direction(const quad *v, const quad *u, quad *q) {
  quad w[3] = {v[0], v[1], v[2]};
  for (int twice = 0; u && twice < 2; twice++) {
    const quad along = dot(w, u);
    for (int i = 0; i < 3; i++) w[i] -= along * u[i];
  }
  const quad length = sqrtq(dot(w, w));
  for (int i = 0; i < 3; i++) q[i] = length > 0 ? w[i] / length : 0;
  return length;
}

static double polar(quad A[3][3], bool reflects, double *R) {
  quad V[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, U[3][3];
  jacobi(A, V);
  for (int n = 0; n < 3; n++) {
    const int j = n % 2; /* 0 1, 1 2, 0 1 */
    if (dot(A[j], A[j]) < dot(A[j + 1], A[j + 1]))
      exchange(A[j], A[j + 1]), exchange(V[j], V[j + 1]);
  }
  const quad s1 = direction(A[0], NULL, U[0]), s2 = direction(A[1], U[0], U[1]);
  cross(U[0], U[1], U[2]);
  const quad s3 = dot(A[2], U[2]), size = s3 < 0 ? -s3 : s3;
  const quad distance = reflects ? size : s2 + s3;
  if (!(s2 > 0 && distance > 0)) return HUGE_VAL;
  for (int i = 0; i < 9; i++) {
    const int r = i / 3, c = i % 3;
    const quad third = U[2][r] * V[2][c];
    R[i] = (double)(U[0][r] * V[0][c] + U[1][r] * V[1][c] + (reflects && s3 < 0 ? -third : third));
  }
  return (double)(s1 / distance);
}

static double gram_schmidt(quad A[3][3], double *R) {
  quad Q[3][3];
  const quad first = direction(A[0], NULL, Q[0]), second = direction(A[1], Q[0], Q[1]);
  if (!(first > 0 && second > 0)) return HUGE_VAL;
  cross(Q[0], Q[1], Q[2]);
  for (int i = 0; i < 9; i++) R[i] = (double)Q[i % 3][i / 3];
  return 1 + (double)(sqrtq(dot(A[1], A[1])) / second);
}

void cb_frame_exact(enum cb_definition definition, const double F[9], double R[9],
                    double *condition) {
  quad A[3][3];
  for (int i = 0; i < 9; i++) A[i % 3][i / 3] = F[i];
  *condition = definition == CB_GRAM_SCHMIDT ? gram_schmidt(A, R)
                                             : polar(A, definition == CB_NEAREST_ORTHOGONAL, R);
}
