/* polar_eigen.h - nearest rotation from the eigenvectors of F^T F.
 * Source: Etzmuss, Keckeisen, Strasser 2003; Hauth & Strasser 2004, section 4.
 *         They form F S^-1 and divide by the smallest singular value; here the
 *         third axis is a cross product, which also keeps det R = +1.
 * Trade:  F^T F squares the condition: on a needle, stretched s_1 : s_2, the
 *         error is s_1/s_2 times that of the SVD, up to 500 : 1 in float, 400000 : 1
 *         in double; beyond, it is the SVD. Flat elements are as sharp.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_POLAR_EIGEN_H
#define CB_FRAME_POLAR_EIGEN_H

#include "kernels/frames/principal.h"

/* Less than that of s_1^2, s_2^2 is so much rounding that the second column of F V is no
 * more across the first: (s_2/s_1)^3 is about 10 roundings. */
#define EIGEN_LEAST BY_PRECISION(3.5e-6, 5e-12)

/* R := nearest rotation to F, an inversion moved to the smallest singular value. */
INLINE void frame_polar_eigen(const T *F, T *R) {
  T A[9], V[9], lambda[3];
  multiply3_tn(F, F, A);
  jacobi_eigen(A, V, lambda);
  multiply3(F, V, A);
  frame_from_principal(F, EIGEN_LEAST, lambda, A, V, R);
}

#endif
