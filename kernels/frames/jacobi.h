/* jacobi.h - one plane rotation of Jacobi's method, the eigenvectors of a
 * symmetric 3x3 matrix by a fixed number of them, and their order.
 * Source: Golub & Van Loan, Matrix Computations, 3rd ed., sections 8.4 and 5.1.13:
 *         fast rotations, [1 -u; t 1] without their length.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_JACOBI_H
#define CB_FRAME_JACOBI_H

#include "kernels/frames/iterations.h"
#include "kernels/tensor3.h"

/* Columns that fast rotations are applied to stay orthogonal and get longer, by at
 * most sqrt(2) each: e[j] is the square of what column j has been multiplied by.
 * t, u := the fast rotation [1 -u; t 1] that makes [1 -u; t 1]^T [p r; r q] [1 -u; t 1]
 * diagonal, by the smaller angle; t = u = 0 when r = 0. The angle need not be exact, only
 * t : u: estimates will do for the n-th turn, n < JACOBI_ROUGH.
 * in/out  e[3]  of which j and k are used */
INLINE void jacobi_turn(int n, T p, T q, T r, int j, int k, T *e, T *t, T *u) {
  /* Of the angle: tan 2a = y / x, tan a = y / (x + sign(x) hypot(x, y)), with
   * y^2 = 4 r^2 e_j e_k, t = tan a (e_j/e_k)^(1/2), u = tan a (e_k/e_j)^(1/2). */
  const T least = LIT(sizeof(S) == sizeof(float) ? 1e-37 : 1e-300);
  T x = e[k] * p - e[j] * q;
  T y = r + r, square = x * x + (e[j] * e[k] * (y * y) + least);
  T sum = ABS(x) + (n < JACOBI_ROUGH ? ROUGH_SQRT(square) : SQRT(square));
  y = SIGNED_AS(x, y);
  T w = n < JACOBI_ROUGH ? y * ROUGH_INVERSE(sum) : y / sum;
  *t = e[j] * w, *u = e[k] * w;
  T longer = LIT(1) + *t * *u;
  e[j] = e[j] * longer, e[k] = e[k] * longer;
}

/* Columns j, k of A[9] := columns times [1 -u; t 1]. */
INLINE void jacobi_columns(T *A, int j, int k, T t, T u) {
  for (int i = 0; i < 9; i += 3) {
    T a = A[i + j], b = A[i + k];
    A[i + j] = a + t * b;
    A[i + k] = b - u * a;
  }
}

INLINE T column_square(const T *A, int j) {
  return A[j] * A[j] + A[3 + j] * A[3 + j] + A[6 + j] * A[6 + j];
}

/* Columns j, k of A = F V, and with them V, turned until orthogonal (Hestenes 1958). */
INLINE void jacobi_columns_turn(int n, T *A, T *V, T *e, int j, int k) {
  T t, u, r = A[j] * A[k] + A[3 + j] * A[3 + k] + A[6 + j] * A[6 + k];
  jacobi_turn(n, column_square(A, j), column_square(A, k), r, j, k, e, &t, &u);
  jacobi_columns(A, j, k, t, u);
  jacobi_columns(V, j, k, t, u);
}

/* V[9] := V with columns of length 1, by[j] what column j has been multiplied by. */
INLINE void jacobi_normalise(T *V, T *by) {
  for (int j = 0; j < 3; j++) {
    by[j] = RSQRT(column_square(V, j));
    for (int i = j; i < 9; i += 3) V[i] = V[i] * by[j];
  }
}

/* B[9] symmetric, V[9]: B := [1 -u; t 1]^T B [1 -u; t 1], its j, k element about 0. */
INLINE void jacobi_eigen_turn(int n, T *B, T *V, T *e, int j, int k) {
  int o = 3 - j - k;
  T t, u, p = B[4 * j], q = B[4 * k], r = B[3 * j + k], jo = B[3 * j + o], ko = B[3 * k + o];
  jacobi_turn(n, p, q, r, j, k, e, &t, &u);
  B[4 * j] = p + t * (r + r + t * q);
  B[4 * k] = q - u * (r + r - u * p);
  B[3 * j + k] = B[3 * k + j] = r + t * q - u * (p + t * r);
  B[3 * j + o] = B[3 * o + j] = jo + t * ko;
  B[3 * k + o] = B[3 * o + k] = ko - u * jo;
  jacobi_columns(V, j, k, t, u);
}

/* A = V diag(lambda) V^T.
 * in   A[9]       symmetric
 * out  V[9]       rotation, eigenvectors in columns (not ordered)
 *      lambda[3]  eigenvalues */
INLINE void jacobi_eigen(const T *A, T *V, T *lambda) {
  T B[9], e[3] = {LIT(1), LIT(1), LIT(1)};
  for (int i = 0; i < 9; i++) B[i] = A[i];
  identity3(V);
  for (int n = 0; n < JACOBI_TURNS; n += 3) {
    jacobi_eigen_turn(n, B, V, e, 0, 1);
    if (n + 1 < JACOBI_TURNS) jacobi_eigen_turn(n + 1, B, V, e, 0, 2);
    if (n + 2 < JACOBI_TURNS) jacobi_eigen_turn(n + 2, B, V, e, 1, 2);
  }
  jacobi_normalise(V, e);
  for (int i = 0; i < 3; i++) lambda[i] = B[4 * i] * (e[i] * e[i]);
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

/* Columns of A and V so that n[0] >= n[1] >= n[2]. */
INLINE void principal_sort(T *n, T *A, T *V) {
  principal_swap(n[0] < n[1], n, A, V, 0, 1);
  principal_swap(n[1] < n[2], n, A, V, 1, 2);
  principal_swap(n[0] < n[1], n, A, V, 0, 1);
}

#endif
