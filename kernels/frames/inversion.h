/* inversion.h - the nearest rotation from the nearest orthogonal matrix, where there is
 * one.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_INVERSION_H
#define CB_FRAME_INVERSION_H

#include "kernels/frames/degenerate.h"

/* R := nearest rotation to F (det R = +1). Where det Q < 0 the direction of the
 * smallest singular value is turned round: R = Q (I - 2 v v^T), S v = s_min v.
 * in   F[9], Q[9]  F = Q S, Q orthogonal, S positive semi-definite
 *      sign        det Q, +1 or -1
 *      usual       where Q and sign are so; elsewhere they are not read */
INLINE void rotation_of_orthogonal(const T *F, const T *Q, T sign, CHOICE usual, T *R) {
  CHOICE upright = LESS(LIT(0), sign);
  for (int i = 0; i < 9; i++) R[i] = Q[i];
  if (!ALL(upright & usual)) {
    T stretch[9], V[9], s[3], v[3], Qv[3];
    multiply3_tn(Q, F, stretch);
    jacobi_eigen(stretch, V, s);
    for (int i = 0; i < 3; i++) v[i] = V[3 * i];
    T least = s[0];
    for (int j = 1; j < 3; j++) {
      MASK less = s[j] < least;
      least = SELECT(less, s[j], least);
      for (int i = 0; i < 3; i++) v[i] = SELECT(less, V[3 * i + j], v[i]);
    }
    apply3(Q, v, Qv);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++)
        R[3 * i + j] = CHOOSE(upright, Q[3 * i + j], Q[3 * i + j] - LIT(2) * (Qv[i] * v[j]));
    repair(usual, F, false, R);
  }
}

#endif
