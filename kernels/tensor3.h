/* tensor3.h - vectors and 3x3 matrices of T, row-major T[9]. Outputs must not
 * overlap inputs.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TENSOR3_H
#define CB_TENSOR3_H

#include "kernels/arithmetic.h"

INLINE T dot3(const T *a, const T *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

INLINE T square9(const T *A) { return dot3(A, A) + dot3(A + 3, A + 3) + dot3(A + 6, A + 6); }

/* c := a x b */
INLINE void cross3(const T *a, const T *b, T *c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* y := A x */
INLINE void apply3(const T *A, const T *x, T *y) {
  for (int i = 0; i < 3; i++) y[i] = dot3(A + 3 * i, x);
}

/* y := A^T x */
INLINE void apply3_transposed(const T *A, const T *x, T *y) {
  for (int i = 0; i < 3; i++) y[i] = A[i] * x[0] + A[3 + i] * x[1] + A[6 + i] * x[2];
}

/* C := A B */
INLINE void multiply3(const T *A, const T *B, T *C) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[3 * i] * B[j] + A[3 * i + 1] * B[3 + j] + A[3 * i + 2] * B[6 + j];
}

/* C := A^T B */
INLINE void multiply3_tn(const T *A, const T *B, T *C) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] = A[i] * B[j] + A[3 + i] * B[3 + j] + A[6 + i] * B[6 + j];
}

/* C := A B^T */
INLINE void multiply3_nt(const T *A, const T *B, T *C) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) C[3 * i + j] = dot3(A + 3 * i, B + 3 * j);
}

/* C := R A R^T, A symmetric */
INLINE void rotate3_symmetric(const T *R, const T *A, T *C) {
  T RA[9];
  multiply3(R, A, RA);
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++) C[3 * i + j] = C[3 * j + i] = dot3(RA + 3 * i, R + 3 * j);
}

/* Cofactor matrix: C := det(A) A^-T, rows are cross products of rows */
INLINE void cofactor3(const T *A, T *C) {
  cross3(A + 3, A + 6, C);
  cross3(A + 6, A, C + 3);
  cross3(A, A + 3, C + 6);
}

/* A := symmetric matrix of v[6], Voigt order xx yy zz xy yz zx, tensor components */
INLINE void full3(const T *v, T *A) {
  A[0] = v[0], A[4] = v[1], A[8] = v[2];
  A[1] = A[3] = v[3];
  A[5] = A[7] = v[4];
  A[2] = A[6] = v[5];
}

INLINE void identity3(T *A) {
  for (int i = 0; i < 9; i++) A[i] = LIT(i % 4 == 0);
}

#endif
