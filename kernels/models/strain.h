/* strain.h - deformation gradient and corotated strain of one pack; and the sets
 * of laws that models claim (verify tests every claim).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_STRAIN_H
#define CB_STRAIN_H

#include "kernels/elements.h"
#include "kernels/material.h"

/* F[9] := sum e_j (x) grad0_j. */
INLINE void deformation_gradient(int policy, const T *rest, const T *e, T *F) {
  T scaled[9];
  for (int i = 0; i < 9; i++)
    scaled[i] = policy == POLICY_PRECOMPUTED ? rest[REST_EDGE] * e[i] : e[i];
  multiply3_tn(scaled, rest + REST_G, F);
}

/* P := D : (sym(R^T F) - I), the local stress of every frame but qr; R NULL: I.
 * E[9] := R^T F - I. */
INLINE void corotated_stress(T k, const T *rest, int ortho, const T *R, const T *F, T *E, T *P) {
  if (R)
    multiply3_tn(R, F, E);
  else
    for (int i = 0; i < 9; i++) E[i] = F[i];
  for (int i = 0; i < 9; i += 4) E[i] = E[i] - LIT(1);
  stress(ortho, k, rest + REST_D, E, P);
}

/* Kept by every element that is a function of its own shape and rest shape. */
#define LAWS_ELEMENT                                                                               \
  (CB_KEEPS(CB_LAW_ROTATION) | CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) |              \
   CB_KEEPS(CB_LAW_SEMIDEFINITE))
#define LAWS_EULER CB_KEEPS(CB_LAW_EULER)
#define LAWS_ENERGY CB_KEEPS(CB_LAW_ENERGY)
#define LAWS_ORDER CB_KEEPS(CB_LAW_ORDER)

#endif
