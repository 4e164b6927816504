/* paper.h - the paper's unassembled product: R, B and D stored apart, and per
 * element the chain R (B^T (D (B (R^T du)))) over its four vertices; with the
 * classic B of any frame, or the sparse B that a qr frame allows. Kept in the
 * paper's form: ebe is what the same product costs at its best.
 * Source: Nesme, Payan, Faure 2005, sections 3.1, 3.2; B in local axes with the
 *         signs that make its rows sum to zero (the printed ones do not).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PAPER_H
#define CB_PAPER_H

#include "kernels/storage/drive.h"
#include "kernels/storage/gradients.h"

/* n := q x r + r x p + p x q, twice the area normal of the face p, q, r: one
 * row of the classic B, 18 multiplications, 15 additions. */
INLINE void face_normal(const T *p, const T *q, const T *r, T *n) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    n[i] = q[j] * r[k] - q[k] * r[j] + r[j] * p[k] - r[k] * p[j] + p[j] * q[k] - p[k] * q[j];
  }
}

/* B[12] := gradients of N_a, N_b, N_c, N_d in local axes, scaled; the classic
 * 72 multiplications and 60 additions.
 * in  e[9]   edges, m
 *     scale  rest volume: root of the scale of B, applied to the edges before;
 *            current volume: scale of B times 6 V, applied afterwards */
INLINE void paper_b_classic(int current_volume, T scale, const T *R, const T *e, T *B) {
  T y[12];
  STAGE(STAGE_FRAME); /* vertices in local axes */
  for (int i = 0; i < 3; i++) y[i] = LIT(0);
  for (int j = 0; j < 9; j += 3) {
    T scaled[3];
    for (int i = 0; i < 3; i++) scaled[i] = current_volume ? e[j + i] : scale * e[j + i];
    apply3_transposed(R, scaled, y + 3 + j);
  }
  STAGE(STAGE_B);
  const T *a = y, *b = y + 3, *c = y + 6, *d = y + 9;
  face_normal(b, d, c, B);
  face_normal(a, c, d, B + 3);
  face_normal(a, d, b, B + 6);
  face_normal(a, b, c, B + 9);
  if (current_volume) {
    scale = scale / dot3(b, B + 3);
    for (int i = 0; i < 12; i++) B[i] = scale * B[i];
  }
}

/* B[9] := the numbers of B that are not zero in the qr frame: a xyz, b xyz,
 * c yz, d z; 7 products, each scaled, and 5 additions.
 * in  y[6]   x_b, x_c, y_c, x_d, y_d, z_d, m
 *     scale  of B; current volume: times 6 V */
INLINE void paper_b_qr(int current_volume, T scale, const T *y, T *B) {
  T xb = y[0], xc = y[1], yc = y[2], xd = y[3], yd = y[4], zd = y[5];
  if (current_volume) scale = scale / (xb * yc * zd);
  T yczd = scale * (yc * zd), xczd = scale * (xc * zd), xbzd = scale * (xb * zd);
  T xcyd = scale * (xc * yd), ycxd = scale * (yc * xd), xbyd = scale * (xb * yd);
  T xbyc = scale * (xb * yc);
  B[0] = -yczd, B[1] = xczd - xbzd, B[2] = ycxd - xcyd + xbyd - xbyc;
  B[3] = yczd, B[4] = -xczd, B[5] = xcyd - ycxd;
  B[6] = xbzd, B[7] = -xbyd;
  B[8] = xbyc;
}

/* strain[6] := B q, engineering shears, from local displacements q[12]. */
INLINE void paper_strain(int sparse, const T *B, const T *q, T *strain) {
  if (sparse) {
    strain[0] = B[0] * q[0] + B[3] * q[3];
    strain[1] = B[1] * q[1] + B[4] * q[4] + B[6] * q[7];
    strain[2] = B[2] * q[2] + B[5] * q[5] + B[7] * q[8] + B[8] * q[11];
    strain[3] = B[1] * q[0] + B[4] * q[3] + B[6] * q[6] + (B[0] * q[1] + B[3] * q[4]);
    strain[4] = B[2] * q[1] + B[5] * q[4] + B[7] * q[7] + B[8] * q[10] +
                (B[1] * q[2] + B[4] * q[5] + B[6] * q[8]);
    strain[5] = B[0] * q[2] + B[3] * q[5] + (B[2] * q[0] + B[5] * q[3] + B[7] * q[6] + B[8] * q[9]);
    return;
  }
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3; /* xy, yz, zx */
    strain[i] = B[i] * q[i] + B[3 + i] * q[3 + i] + B[6 + i] * q[6 + i] + B[9 + i] * q[9 + i];
    strain[3 + i] = B[j] * q[i] + B[3 + j] * q[3 + i] + B[6 + j] * q[6 + i] + B[9 + j] * q[9 + i] +
                    (B[i] * q[j] + B[3 + i] * q[3 + j] + B[6 + i] * q[6 + j] + B[9 + i] * q[9 + j]);
  }
}

/* P[9] := D B R^T u, for displacements u[12] of the four vertices. */
INLINE void paper_stress(int sparse, int ortho, T k, const T *D, const T *R, const T *B, const T *u,
                         T *P) {
  T q[12], strain[6];
  for (int j = 0; j < 12; j += 3) apply3_transposed(R, u + j, q + j);
  paper_strain(sparse, B, q, strain);
  stress_voigt(ortho, k, D, strain, P);
}

/* f[12] := R B^T P for the vertices from `first` (0 = a) on; P[9], the local
 * stress, need not be symmetric. */
INLINE void paper_forces(int sparse, int first, const T *R, const T *B, const T *P, T *f) {
  for (int j = first; j < 4; j++) {
    T p[3];
    if (!sparse || j < 2)
      apply3(P, B + 3 * j, p);
    else
      for (int i = 0; i < 3; i++)
        p[i] = j == 2 ? P[3 * i + 1] * B[6] + P[3 * i + 2] * B[7] : P[3 * i + 2] * B[8];
    apply3(R, p, f + 3 * j);
  }
}

/* One pack: f[12] := c K u over four vertices u[12]. */
typedef void product_nodes_fn(const struct cb_elements *E, const T *rest, const T *state,
                              const T *u, T *f);

INLINE void drive_product_nodes(const struct cb_elements *E, size_t thread, const S *u, S *y,
                                product_nodes_fn *product) {
  for (int part = 0; part < 3; part++) {
    const struct range r = part_begin(E, thread, part);
    for (size_t p = r.first; p < r.last; p++) {
      const uint32_t *tet = E->packs->node + p * 4 * LANES;
      T du[12], f[12];
      for (int j = 0; j < 4; j++) load_nodes(u, tet + j * LANES, du + 3 * j);
      STAGE(STAGE_PRODUCT);
      product(E, E->rest + p * E->rest_numbers, E->state + p * E->state_numbers, du, f);
      STAGE(STAGE_SCATTER);
      for (int j = 0; j < 4; j++) add_to_nodes(y, tet + j * LANES, live_lanes(&r, p), f + 3 * j);
    }
    part_end(E, thread, part);
  }
}

#endif
