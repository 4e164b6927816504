/* material.h - stress from strain, everything divided by mu (G_xy for an
 * orthotropic material).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_MATERIAL_H
#define CB_MATERIAL_H

#include "kernels/tensor3.h"

/* Where row r, column c >= r of a symmetric 6x6 matrix is in its packed upper
 * triangle of 21 numbers. */
INLINE int packed6(int r, int c) { return r <= c ? r * (11 - r) / 2 + c : c * (11 - c) / 2 + r; }

/* P[9] := D : strain, full and symmetric, 1.
 * in  v[6]  strain, Voigt order, engineering shears
 *     k     lambda/mu, read when isotropic
 *     D     21 packed numbers, read when orthotropic */
INLINE void stress_voigt(int orthotropic, T k, const T *D, const T *v, T *P) {
  T s[6];
  if (orthotropic) {
    for (int i = 0; i < 6; i++) {
      s[i] = D[packed6(i, 0)] * v[0];
      for (int j = 1; j < 6; j++) s[i] = s[i] + D[packed6(i, j)] * v[j];
    }
  } else {
    T pressure = k * (v[0] + v[1] + v[2]);
    for (int i = 0; i < 3; i++) s[i] = pressure + (v[i] + v[i]);
    for (int i = 3; i < 6; i++) s[i] = v[i];
  }
  full3(s, P);
}

/* The same from a matrix whose symmetric part is the strain. */
INLINE void stress(int orthotropic, T k, const T *D, const T *E, T *P) {
  T v[6] = {E[0], E[4], E[8], E[1] + E[3], E[5] + E[7], E[2] + E[6]};
  stress_voigt(orthotropic, k, D, v, P);
}

#endif
