/* exact_frames.c - see exact_frames.h.
 * Source: one-sided Jacobi (Hestenes 1958); Gram-Schmidt, twice.
 * Trade:  quad precision by the compiler's library: a hundred microseconds a matrix.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/exact_frames.h"

#include <math.h>
#include <stdbool.h>

typedef __float128 Q;

Q sqrtq(Q); /* of libquadmath, whose header not every compiler finds */

/* What is smaller than this, relatively, is rounding in quad. */
static const Q NOTHING = 1e-30Q;

static Q magnitude(Q a) { return a < 0 ? -a : a; }
static Q dot(const Q *a, const Q *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
static Q length(const Q *a) { return sqrtq(dot(a, a)); }

static void cross(const Q *a, const Q *b, Q *c) {
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

/* n := a unit vector at a right angle to the unit vector u: made of the axis that is the
 * farthest from it. */
static void normal_to(const Q *u, Q *n) {
  int least = 0;
  for (int i = 1; i < 3; i++)
    if (magnitude(u[i]) < magnitude(u[least])) least = i;
  const Q axis[3] = {least == 0, least == 1, least == 2};
  cross(u, axis, n);
  const Q l = length(n);
  for (int i = 0; i < 3; i++) n[i] /= l;
}

/* v := the unit vector along what of a is at a right angle to u; false if nothing is. */
static bool orthonormal(const Q *u, const Q *a, Q *v) {
  const Q all = length(a);
  for (int i = 0; i < 3; i++) v[i] = a[i];
  for (int twice = 0; twice < 2; twice++) {
    const Q along = dot(u, v);
    for (int i = 0; i < 3; i++) v[i] -= along * u[i];
  }
  const Q l = length(v);
  if (!(l > NOTHING * all)) return false;
  for (int i = 0; i < 3; i++) v[i] /= l;
  return true;
}

/* Rows a, b of the columns' transposed A = F V, and with them V, turned until a . b = 0.
 * Returns whether they were not. */
static bool turn(Q *a, Q *b, Q *va, Q *vb) {
  const Q p = dot(a, a), q = dot(b, b), r = dot(a, b);
  if (!(magnitude(r) > 1e-33Q * sqrtq(p * q))) return false;
  const Q zeta = (q - p) / (2 * r);
  const Q t = (zeta < 0 ? -1 : 1) / (magnitude(zeta) + sqrtq(1 + zeta * zeta));
  const Q c = 1 / sqrtq(1 + t * t), s = c * t;
  for (int i = 0; i < 3; i++) {
    const Q x = a[i], y = va[i];
    a[i] = c * x - s * b[i], b[i] = s * x + c * b[i];
    va[i] = c * y - s * vb[i], vb[i] = s * y + c * vb[i];
  }
  return true;
}

static void swap(Q *a, Q *b) { /* (a, b) -> (b, -a): V stays a rotation */
  for (int i = 0; i < 3; i++) {
    const Q x = a[i];
    a[i] = b[i], b[i] = -x;
  }
}

void cb_exact_polar(const double F[9], struct cb_exact_frame *exact) {
  enum { SWEEPS = 60 }; /* ten do; a needle in quad takes a few more */
  Q A[3][3], V[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, U[3][3];
  for (int i = 0; i < 9; i++) A[i % 3][i / 3] = F[i];
  bool turned = true;
  for (int n = 0; n < SWEEPS && turned; n++) {
    turned = turn(A[0], A[1], V[0], V[1]);
    turned |= turn(A[0], A[2], V[0], V[2]);
    turned |= turn(A[1], A[2], V[1], V[2]);
  }
  for (int n = 0; n < 3; n++) {
    const int j = n == 1 ? 1 : 0;
    if (dot(A[j], A[j]) < dot(A[j + 1], A[j + 1])) swap(A[j], A[j + 1]), swap(V[j], V[j + 1]);
  }
  const Q s = length(A[0]);
  for (int i = 0; i < 3; i++) U[0][i] = s > 0 ? A[0][i] / s : V[0][i];
  if (!(length(A[1]) > NOTHING * s) || !orthonormal(U[0], A[1], U[1])) normal_to(U[0], U[1]);
  cross(U[0], U[1], U[2]);
  for (int j = 0; j < 3; j++) exact->s[j] = dot(U[j], A[j]);
  for (int i = 0; i < 9; i++) {
    exact->R[i] = 0;
    for (int j = 0; j < 3; j++) exact->R[i] += U[j][i / 3] * V[j][i % 3];
  }
  exact->column[0] = exact->column[1] = 0;
  const Q gap = exact->s[1] + exact->s[2];
  exact->condition = gap > NOTHING * s ? fmax((double)(s / gap), 1) : INFINITY;
}

void cb_exact_qr(const double F[9], struct cb_exact_frame *exact) {
  Q a[3], b[3], u[3], v[3], w[3];
  for (int i = 0; i < 3; i++) a[i] = F[3 * i], b[i] = F[3 * i + 1];
  const Q first = length(a), second = length(b);
  exact->column[0] = first, exact->column[1] = second;
  exact->condition = INFINITY;
  for (int i = 0; i < 3; i++) u[i] = first > 0 ? a[i] / first : i == 0;
  if (!orthonormal(u, b, v))
    normal_to(u, v);
  else if (first > 0)
    exact->condition = (double)(1 + second / dot(v, b));
  cross(u, v, w);
  for (int i = 0; i < 3; i++) {
    exact->R[3 * i] = u[i], exact->R[3 * i + 1] = v[i], exact->R[3 * i + 2] = w[i];
    exact->s[i] = 0;
  }
}
