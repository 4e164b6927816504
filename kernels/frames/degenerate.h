/* degenerate.h - the nearest rotation to any finite matrix: of rank 1 or 0, far from 1,
 * or a needle. The frames test for free whether a lane needs it, and call it then.
 * Source: one-sided Jacobi (Hestenes 1958) of F scaled to entries up to 1; where the
 *         nearest rotation is not unique, the one of those that turns least.
 * Trade:  twice the turns of svd.h, and a call; next to nothing where nobody calls.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_DEGENERATE_H
#define CB_FRAME_DEGENERATE_H

#include <stdbool.h>

#include "kernels/frames/jacobi.h"

/* What is called where a lane needs it: out of the way of the others. */
#define RARE static __attribute__((noinline, cold, unused))

/* Of two limits, the one of this precision. */
#define BY_PRECISION(in_float, in_double) LIT(sizeof(S) == sizeof(float) ? (in_float) : (in_double))
/* Below this, by the largest of what was added, a sum is rounding: 16 of them. */
#define LOST BY_PRECISION(0x1p-20, 0x1p-49)
/* The square of a length by the longest, below which it is the same. */
#define LEAST_SQUARE BY_PRECISION(0x1p-40, 0x1p-98)

/* low < a < high; false of what is not a number. */
INLINE CHOICE within(T a, T low, T high) { return LESS(low, a) & LESS(a, high); }

/* a := b but where m; not in a loop, of which compilers make a copy of memory, and keep
 * what is in no need of it there. */
INLINE void choose3(CHOICE m, const T *b, T *a) {
  a[0] = CHOOSE(m, a[0], b[0]);
  a[1] = CHOOSE(m, a[1], b[1]);
  a[2] = CHOOSE(m, a[2], b[2]);
}

/* A[count] := A by the largest of its magnitudes, denormal ones too; zero stays. */
INLINE void scale_to_one(int count, T *A) {
  T most = LIT(0);
  for (int i = 0; i < count; i++) {
    T a = ABS(A[i]);
    most = SELECT(a > most, a, most);
  }
  T up = SELECT(most < BY_PRECISION(0x1p-60, 0x1p-500), BY_PRECISION(0x1p90, 0x1p700), LIT(1));
  most = most * up;
  T scale = LIT(1) / SELECT(most > LIT(0), most, LIT(1));
  for (int i = 0; i < count; i++) A[i] = scale * (up * A[i]);
}

/* v[3] := unit vector along v, a part along the unit vector u taken away: twice, as
 * most of v may be. */
INLINE void normalise_across(const T *u, T *v) {
  for (int n = 0; n < 2; n++) {
    T along = dot3(u, v);
    for (int i = 0; i < 3; i++) v[i] = v[i] - along * u[i];
    T inverse = RSQRT(dot3(v, v));
    for (int i = 0; i < 3; i++) v[i] = v[i] * inverse;
  }
}

/* v[3] := where q goes when p goes to u, p, q, r right-handed unit vectors, by a turn of
 * least angle: that maximises u.p + v.q + (u x v).r. Not normalised. Where u = -p, about q. */
INLINE void turned_least(const T *u, const T *q, const T *r, T *v) {
  T across[3], along = dot3(u, q), square;
  cross3(r, u, across);
  for (int i = 0; i < 3; i++) v[i] = q[i] - along * u[i] + across[i];
  square = dot3(v, v);
  for (int i = 0; i < 3; i++) v[i] = SELECT(square > LIT(1e-4), v[i], q[i]);
}

/* A[9] := F V, columns orthogonal, V[9] := rotation; the longest column first; F scaled. */
INLINE void principal_of_any(const T *F, T *A, T *V) {
  T n[3], e[3] = {LIT(1), LIT(1), LIT(1)};
  for (int i = 0; i < 9; i++) A[i] = F[i];
  scale_to_one(9, A);
  identity3(V);
  for (int m = 0; m < 2 * JACOBI_TURNS; m += 3) {
    jacobi_columns_turn(m, A, V, e, 0, 1);
    jacobi_columns_turn(m + 1, A, V, e, 0, 2);
    jacobi_columns_turn(m + 2, A, V, e, 1, 2);
  }
  jacobi_normalise(V, e);
  for (int i = 0; i < 9; i++) A[i] = A[i] * e[i % 3];
  for (int j = 0; j < 3; j++) n[j] = column_square(A, j);
  principal_sort(n, A, V);
}

/* Q := nearest rotation to F, or, where it reflects, nearest orthogonal matrix. */
RARE void orthogonal_of_any(const T *F, bool reflects, T *Q) {
  T A[9], V[9], U[9], p[3], q[3], r[3], u[3], v[3], w[3], least[3];
  principal_of_any(F, A, V);
  for (int i = 0; i < 3; i++) {
    u[i] = A[3 * i], v[i] = A[3 * i + 1], w[i] = A[3 * i + 2];
    p[i] = V[3 * i], q[i] = V[3 * i + 1], r[i] = V[3 * i + 2];
  }
  const T longest = dot3(u, u), third[3] = {w[0], w[1], w[2]};
  T inverse = RSQRT(SELECT(longest > LIT(0), longest, LIT(1)));
  for (int i = 0; i < 3; i++) u[i] = SELECT(longest > LIT(0), u[i] * inverse, p[i]);
  MASK line = dot3(v, v) <= LEAST_SQUARE * longest;
  turned_least(u, q, r, least);
  for (int i = 0; i < 3; i++) v[i] = SELECT(line, least[i], v[i]);
  scale_to_one(3, v);
  normalise_across(u, v);
  cross3(u, v, w);
  MASK left = dot3(w, third) < -LOST; /* and not by rounding */
  const T sign = SELECT(left, LIT(reflects ? -1 : 1), LIT(1));
  for (int i = 0; i < 3; i++) U[3 * i] = u[i], U[3 * i + 1] = v[i], U[3 * i + 2] = sign * w[i];
  multiply3_nt(U, V, Q);
}

/* Q := as above but where usual; F and Q need not be in memory for it. */
INLINE void repair(CHOICE usual, const T *F, bool reflects, T *Q) {
  if (ALL(usual)) return;
  const T from[9] = {F[0], F[1], F[2], F[3], F[4], F[5], F[6], F[7], F[8]};
  T to[9];
  orthogonal_of_any(from, reflects, to);
  for (int i = 0; i < 9; i += 3) choose3(usual, to + i, Q + i);
}

#endif
