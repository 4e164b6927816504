/* polar_edges.c - polar factor of the matrix of current edges, turned back by that of
 * the rest edges: what some simulators call polar. It is not the polar factor
 * of F, and depends on which vertex comes first.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_higham.h"

/* R := nearest rotation to the matrix with columns e_b, e_c, e_d. */
INLINE void polar_of_edges(const T *e, T *R) {
  T A[9];
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) A[3 * i + j] = e[3 * j + i];
  frame_polar_higham(A, R);
}

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) polar_of_edges(e, R)
#include "kernels/models/corotated.h"

COROTATED_FAMILY(polar_edges, "polar-edges", "polar frame of the edges",
                 "common practice in simulators", AXES_POLAR, 0, LAWS_ELEMENT, LAWS_ELEMENT,
                 LAWS_ELEMENT | LAWS_EULER)
