/* qr.h - element frame by Gram-Schmidt on the current edges.
 * Source: Nesme, Payan, Faure 2005, section 2.1. Where edges have collapsed: this project.
 * Trade:  cheapest frame; the first edge keeps its direction, so the result
 *         depends on how the four vertices are numbered.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FRAME_QR_H
#define CB_FRAME_QR_H

#include "kernels/frames/degenerate.h"

/* b[3] := a unit vector for a first edge that has none: across the other two, on the side
 * where the element is right-handed; else across the one there is; else x.
 * in  c[3], d[3]  e_c, e_d, scaled to 1 */
INLINE void first_axis(const T *c, const T *d, T *b) {
  T one[3], least = LIT(2);
  MASK no_c = dot3(c, c) == LIT(0);
  for (int i = 0; i < 3; i++) one[i] = SELECT(no_c, d[i], c[i]);
  T across[3] = {LIT(0), LIT(0), LIT(0)}, square = dot3(one, one), inverse = RSQRT(square);
  for (int i = 0; i < 3; i++) one[i] = SELECT(square > LIT(0), one[i] * inverse, LIT(0));
  for (int i = 0; i < 3; i++) { /* the world axis that is least along it */
    MASK less = ABS(one[i]) < least;
    least = SELECT(less, ABS(one[i]), least);
    for (int j = 0; j < 3; j++) across[j] = SELECT(less, LIT(i == j), across[j]);
  }
  cross3(c, d, b);
  MASK line = dot3(b, b) <= LEAST_SQUARE;
  for (int i = 0; i < 3; i++) b[i] = SELECT(line, across[i], b[i]);
  scale_to_one(3, b);
  normalise_across(one, b);
}

/* c[3] := a direction for a second edge that has none across the unit vector u: where that
 * makes the element right-handed, else where y goes when x turns to u. */
INLINE void second_axis(const T *u, const T *d, T *c) {
  const T y[3] = {LIT(0), LIT(1), LIT(0)}, z[3] = {LIT(0), LIT(0), LIT(1)};
  T least[3];
  turned_least(u, y, z, least);
  cross3(d, u, c);
  MASK line = dot3(c, c) <= LEAST_SQUARE;
  for (int i = 0; i < 3; i++) c[i] = SELECT(line, least[i], c[i]);
  scale_to_one(3, c);
  normalise_across(u, c);
}

/* frame_qr_axes of any edges: short, long, along each other, or none; q[9] := its axes. */
RARE void qr_axes_of_any(const T *e, T *q, T *y) {
  T b[3], c[3], d[3], v[3];
  for (int i = 0; i < 3; i++) b[i] = e[i], c[i] = e[3 + i], d[i] = e[6 + i];
  scale_to_one(3, b), scale_to_one(3, c), scale_to_one(3, d);
  T square = dot3(b, b), inverse = RSQRT(square);
  first_axis(c, d, v);
  for (int i = 0; i < 3; i++) q[i] = SELECT(square > LIT(0), b[i] * inverse, v[i]);
  T along = dot3(q, c);
  for (int i = 0; i < 3; i++) v[i] = c[i] - along * q[i];
  MASK line = dot3(v, v) <= LEAST_SQUARE * dot3(c, c);
  scale_to_one(3, v);
  normalise_across(q, v);
  second_axis(q, d, c);
  for (int i = 0; i < 3; i++) q[3 + i] = SELECT(line, c[i], v[i]);
  cross3(q, q + 3, q + 6);
  y[0] = dot3(q, e), y[1] = dot3(q, e + 3), y[2] = dot3(q + 3, e + 3);
  y[2] = SELECT(y[2] > LIT(0), y[2], LIT(0));
}

/* q[9], y[3] := by that but where usual. */
INLINE void qr_repair(CHOICE usual, const T *e, T *q, T *y) {
  if (__builtin_expect(ALL(usual), 1)) return;
  const T from[9] = {e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8]};
  T axes[9], local[3];
  qr_axes_of_any(from, axes, local);
  choose3(usual, axes, q);
  choose3(usual, axes + 3, q + 3);
  choose3(usual, local, y);
}

/* Are the squares of e_b and of what Gram-Schmidt leaves of e_c neither denormal nor
 * infinite, and is that more than rounding of what was taken from it? */
INLINE CHOICE qr_usual(T square_b, T square_c, const T *y) {
  const T least = BY_PRECISION(1e-36, 1e-300);
  return within(square_b, least, BY_PRECISION(1e36, 1e300)) & LESS(least, square_c) &
         LESS(LIT(1.0 / 32) * ABS(y[1]), y[2]);
}

/* q[9] := axes, the third not yet, y[3] := x_b, x_c, y_c; right where usual. */
INLINE CHOICE qr_axes(const T *e, T *q, T *y) {
  T r[3];
  T square = dot3(e, e), inverse = RSQRT(square);
  y[0] = square * inverse;
  for (int i = 0; i < 3; i++) q[i] = inverse * e[i];
  y[1] = dot3(q, e + 3);
  for (int i = 0; i < 3; i++) r[i] = e[3 + i] - y[1] * q[i];
  T rest = dot3(r, r);
  inverse = RSQRT(rest);
  y[2] = rest * inverse;
  for (int i = 0; i < 3; i++) q[3 + i] = inverse * r[i];
  return qr_usual(square, rest, y);
}

INLINE void qr_complete(T *q, T *R) {
  cross3(q, q + 3, q + 6);
  for (int i = 0; i < 9; i++) R[i] = q[i % 3 * 3 + i / 3];
}

/* R := Q, right-handed, with e_b, e_c in its first axis and first plane.
 * in   e[9]  edges b-a, c-a, d-a, one a row, m
 * out  R[9]  rotation, row-major; columns are the local axes
 *      y[3]  e_b and e_c in local axes: x_b, x_c, y_c, m; x_b, y_c >= 0
 * b-a = 0, or c-a along it: an axis that makes the element right-handed if one does. */
INLINE void frame_qr_axes(const T *e, T *R, T *y) {
  T q[9];
  qr_repair(qr_axes(e, q, y), e, q, y);
  qr_complete(q, R);
}

/* The same, and y[6] := all edges in local axes: x_d, y_d, z_d as well. */
INLINE void frame_qr(const T *e, T *R, T *y) {
  frame_qr_axes(e, R, y);
  apply3_transposed(R, e + 6, y + 3);
}

/* Both where they are usual: say where. */
INLINE CHOICE frame_qr_axes_usually(const T *e, T *R, T *y) {
  T q[9];
  CHOICE usual = qr_axes(e, q, y);
  qr_complete(q, R);
  return usual;
}

INLINE CHOICE frame_qr_usually(const T *e, T *R, T *y) {
  CHOICE usual = frame_qr_axes_usually(e, R, y);
  apply3_transposed(R, e + 6, y + 3);
  return usual;
}

#endif
