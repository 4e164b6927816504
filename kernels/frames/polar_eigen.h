/* polar_eigen.h - nearest rotation R = F S^-1 from the eigenvalues of F^T F.
 * Source: Etzmuss, Keckeisen, Strasser 2003; Hauth & Strasser 2004, section 4.
 * Trade:  F^T F squares the condition: half the digits are gone on elements
 *         that are nearly flat.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_EIGEN_H
#define CB_FRAME_POLAR_EIGEN_H

#include "kernels/frames/jacobi.h"

/* R := nearest rotation to F; where det F < 0 the sign of the smallest
 * singular value is turned.
 * fail  an eigenvalue of F^T F that rounds to 0 or less: NaN or infinity */
INLINE void frame_polar_eigen(const T *F, T *R) {
  T A[9], V[9], lambda[3], C[9];
  multiply3_tn(F, F, A);
  jacobi_eigen(A, V, lambda);
  cofactor3(F, C);
  T sign = SELECT(dot3(F, C) < LIT(0), LIT(-1), LIT(1));
  MASK first = (lambda[0] <= lambda[1]) & (lambda[0] <= lambda[2]);
  MASK second = ~first & (lambda[1] <= lambda[2]);
  T inverse[3] = {SELECT(first, sign, LIT(1)) / SQRT(lambda[0]),
                  SELECT(second, sign, LIT(1)) / SQRT(lambda[1]),
                  SELECT(first | second, LIT(1), sign) / SQRT(lambda[2])};
  T VS[9];
  for (int i = 0; i < 9; i++) VS[i] = V[i] * inverse[i % 3];
  multiply3_nt(VS, V, A);
  multiply3(F, A, R);
}

#endif
