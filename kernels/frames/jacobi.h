/* jacobi.h - one plane rotation of Jacobi's method, and the eigenvectors of a
 * symmetric 3x3 matrix by a fixed number of cyclic sweeps.
 * Source: Golub & Van Loan, Matrix Computations, section 8.5 (4th ed.).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_JACOBI_H
#define CB_FRAME_JACOBI_H

#include "kernels/frames/iterations.h"
#include "kernels/tensor3.h"

/* c, s := the rotation that makes [c -s; s c]^T [p r; r q] [c -s; s c] diagonal,
 * by the smaller angle; c = 1, s = 0 when r = 0. */
INLINE void jacobi_angle(T p, T q, T r, T *c, T *s) {
  /* tan(2 theta) = 2 r / (p - q) =: y / x, tan theta = y / (x + sign(x) hypot(x, y)) */
  T x = p - q, y = r + r;
  T h = SQRT(x * x + y * y);
  T d = ABS(x) + h;
  d = SELECT(d > LIT(0), d, LIT(1));
  T t = SELECT(x < LIT(0), -y, y) / d;
  *c = RSQRT(LIT(1) + t * t);
  *s = t * *c;
}

/* Columns j, k of A[9] := columns times [c -s; s c]. */
INLINE void jacobi_columns(T *A, int j, int k, T c, T s) {
  for (int i = 0; i < 3; i++) {
    T a = A[3 * i + j], b = A[3 * i + k];
    A[3 * i + j] = c * a + s * b;
    A[3 * i + k] = c * b - s * a;
  }
}

/* A = V diag(lambda) V^T.
 * in   A[9]       symmetric
 * out  V[9]       rotation, eigenvectors in columns (not ordered)
 *      lambda[3]  eigenvalues */
INLINE void jacobi_eigen(const T *A, T *V, T *lambda) {
  static const int plane[3][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};
  T B[9];
  for (int i = 0; i < 9; i++) B[i] = A[i];
  identity3(V);
  for (int sweep = 0; sweep < JACOBI_SWEEPS; sweep++)
    for (int n = 0; n < 3; n++) {
      int p = plane[n][0], q = plane[n][1], o = plane[n][2];
      T c, s, apq = B[3 * p + q];
      jacobi_angle(B[4 * p], B[4 * q], apq, &c, &s);
      T a = B[4 * p], b = B[4 * q], cross = (apq + apq) * (c * s);
      B[4 * p] = c * c * a + cross + s * s * b;
      B[4 * q] = s * s * a - cross + c * c * b;
      T po = B[3 * p + o], qo = B[3 * q + o];
      B[3 * p + q] = B[3 * q + p] = LIT(0);
      B[3 * p + o] = B[3 * o + p] = c * po + s * qo;
      B[3 * q + o] = B[3 * o + q] = c * qo - s * po;
      jacobi_columns(V, p, q, c, s);
    }
  for (int i = 0; i < 3; i++) lambda[i] = B[4 * i];
}

/* Where m: exchange columns j and k, (a, b) -> (b, -a), so that V stays a rotation. */
INLINE void principal_swap(MASK m, T *n, T *A, T *V, int j, int k) {
  T t = n[j];
  n[j] = SELECT(m, n[k], t), n[k] = SELECT(m, t, n[k]);
  for (int i = 0; i < 3; i++) {
    T a = A[3 * i + j], v = V[3 * i + j];
    A[3 * i + j] = SELECT(m, A[3 * i + k], a), A[3 * i + k] = SELECT(m, -a, A[3 * i + k]);
    V[3 * i + j] = SELECT(m, V[3 * i + k], v), V[3 * i + k] = SELECT(m, -v, V[3 * i + k]);
  }
}

/* R := U V^T, det R = +1, from A = F V = U diag(s): the two longest columns of A
 * give two axes, their cross product the third, and with it the sign of the
 * smallest singular value. Nothing is divided by that value.
 * in/out  n[3] squared lengths of A's columns; A[9]; V[9] rotation: sorted
 * fail    rank A < 2: NaN in that lane */
INLINE void frame_from_principal(T *n, T *A, T *V, T *R) {
  T U[9], u[3], v[3], w[3], along = LIT(0);
  principal_swap(n[0] < n[1], n, A, V, 0, 1);
  principal_swap(n[1] < n[2], n, A, V, 1, 2);
  principal_swap(n[0] < n[1], n, A, V, 0, 1);
  T inverse = RSQRT(n[0]);
  for (int i = 0; i < 3; i++) u[i] = A[3 * i] * inverse;
  for (int i = 0; i < 3; i++) along = along + u[i] * A[3 * i + 1];
  for (int i = 0; i < 3; i++) v[i] = A[3 * i + 1] - along * u[i];
  inverse = RSQRT(dot3(v, v));
  for (int i = 0; i < 3; i++) v[i] = v[i] * inverse;
  cross3(u, v, w);
  for (int i = 0; i < 3; i++) U[3 * i] = u[i], U[3 * i + 1] = v[i], U[3 * i + 2] = w[i];
  multiply3_nt(U, V, R);
}

#endif
