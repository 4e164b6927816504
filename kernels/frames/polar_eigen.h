/* polar_eigen.h - nearest rotation from the eigenvectors of F^T F.
 * Source: Etzmuss, Keckeisen, Strasser 2003; Hauth & Strasser 2004, section 4.
 *         They form F S^-1 and divide by the smallest singular value; here the
 *         third axis is a cross product, which also keeps det R = +1.
 * Trade:  F^T F squares the condition: on a needle, stretched s_1 : s_2, the
 *         error is s_1/s_2 times that of the SVD; flat elements are as sharp.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_EIGEN_H
#define CB_FRAME_POLAR_EIGEN_H

#include "kernels/frames/jacobi.h"

/* R := nearest rotation to F, an inversion moved to the smallest singular value.
 * fail  rank F < 2: NaN in that lane */
INLINE void frame_polar_eigen(const T *F, T *R) {
  T A[9], V[9], lambda[3];
  multiply3_tn(F, F, A);
  jacobi_eigen(A, V, lambda);
  multiply3(F, V, A);
  frame_from_principal(lambda, A, V, R);
}

#endif
