/* qr.h - element frame by Gram-Schmidt on the current edges.
 * Source: Nesme, Payan, Faure 2005, section 2.1.
 * Trade:  cheapest frame; the first edge keeps its direction, so the result
 *         depends on how the four vertices are numbered.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_QR_H
#define CB_FRAME_QR_H

#include "kernels/tensor3.h"

/* R := Q, right-handed, with e_b, e_c in its first axis and first plane.
 * in   e[9]  edges b-a, c-a, d-a, one a row, m
 * out  R[9]  rotation, row-major; columns are the local axes
 *      y[3]  e_b and e_c in local axes: x_b, x_c, y_c, m
 * fail       b-a = 0, or c-a along it: NaN in that lane only */
INLINE void frame_qr_axes(const T *e, T *R, T *y) {
  T q[9], r[3];
  T square = dot3(e, e), inverse = RSQRT(square);
  y[0] = square * inverse;
  for (int i = 0; i < 3; i++) q[i] = inverse * e[i];
  y[1] = dot3(q, e + 3);
  for (int i = 0; i < 3; i++) r[i] = e[3 + i] - y[1] * q[i];
  square = dot3(r, r), inverse = RSQRT(square);
  y[2] = square * inverse;
  for (int i = 0; i < 3; i++) q[3 + i] = inverse * r[i];
  cross3(q, q + 3, q + 6);
  for (int i = 0; i < 9; i++) R[i] = q[i % 3 * 3 + i / 3];
}

/* The same, and y[6] := all edges in local axes: x_d, y_d, z_d as well. */
INLINE void frame_qr(const T *e, T *R, T *y) {
  frame_qr_axes(e, R, y);
  apply3_transposed(R, e + 6, y + 3);
}

#endif
