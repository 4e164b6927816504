/* principal.h - the nearest rotation from principal axes: what the frames by
 * eigenvectors and by singular values share.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_PRINCIPAL_H
#define CB_FRAME_PRINCIPAL_H

#include "kernels/frames/degenerate.h"

/* a[3] := (a1, a2, a0) where `first`, else (a2, a0, a1) where `second`, else a. */
INLINE void cycle3(CHOICE first, CHOICE second, T *a) {
  T a0 = a[0], a1 = a[1], a2 = a[2];
  a[0] = CHOOSE(first, a1, CHOOSE(second, a2, a0));
  a[1] = CHOOSE(first, a2, CHOOSE(second, a0, a1));
  a[2] = CHOOSE(first, a0, CHOOSE(second, a1, a2));
}

/* R := U V^T, det R = +1, from A = F V = U diag(s): the two longest columns of A
 * give two axes, their cross product the third, and with it the sign of the
 * smallest singular value. Nothing is divided by that value.
 * in      F[9]; least: where s_2^2 is less of s_1^2, A has too few digits
 * in/out  n[3] squared lengths of F V's columns, A[9] the same columns but for
 *         positive factors, V[9] rotation: cycled, the shortest last */
INLINE void frame_from_principal(const T *F, T least, T *n, T *A, T *V, T *R) {
  T U[9], u[3], v[3], w[3], along = LIT(0);
  const CHOICE first = LESS(n[0], n[1]) & LESS(n[0], n[2]), second = LESS(n[1], n[2]);
  cycle3(first, second, n);
  for (int i = 0; i < 9; i += 3) cycle3(first, second, A + i), cycle3(first, second, V + i);
  T longest = SELECT(n[0] < n[1], n[1], n[0]), other = SELECT(n[0] < n[1], n[0], n[1]);
  /* Fourth powers are neither denormal nor infinite. */
  CHOICE usual = within(longest, BY_PRECISION(1e-4, 1e-40), BY_PRECISION(1e12, 1e60));
  usual = usual & LESS(least * longest, other);
  T inverse = RSQRT(column_square(A, 0));
  for (int i = 0; i < 3; i++) u[i] = A[3 * i] * inverse;
  for (int i = 0; i < 3; i++) along = along + u[i] * A[3 * i + 1];
  for (int i = 0; i < 3; i++) v[i] = A[3 * i + 1] - along * u[i];
  inverse = RSQRT(dot3(v, v));
  for (int i = 0; i < 3; i++) v[i] = v[i] * inverse;
  cross3(u, v, w);
  for (int i = 0; i < 3; i++) U[3 * i] = u[i], U[3 * i + 1] = v[i], U[3 * i + 2] = w[i];
  multiply3_nt(U, V, R);
  repair(usual, F, false, R);
}

#endif
