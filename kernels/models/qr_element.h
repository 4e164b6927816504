/* qr_element.h - frame, stretch and stress of one pack by Gram-Schmidt on the current
 * edges: what the QR models share.
 * Source: Nesme, Payan, Faure 2005, sections 2.1, 3.1; qr_gradient: this project.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_QR_ELEMENT_H
#define CB_QR_ELEMENT_H

#include "kernels/frames/qr.h"
#include "kernels/models/strain.h"

/* What qr-exact divides by, at least. */
#define LEAST_EDGE LIT(1e-3)

/* F[9] := F Q0. Rest shapes are kept in their own edge frame Q0: rest gradients are
 * triangular where the vertices have their own order, b: xyz, c: 0yz, d: 00z. */
INLINE void qr_gradient_of_edges(const struct cb_elements *E, int policy, const T *rest, const T *e,
                                 T *F) {
  const T *g = rest + REST_G;
  if (!in_own_order(E)) {
    deformation_gradient(policy, rest, e, F);
    return;
  }
  for (int i = 0; i < 3; i++) {
    F[3 * i] = e[i] * g[0];
    F[3 * i + 1] = e[i] * g[1] + e[3 + i] * g[4];
    F[3 * i + 2] = e[i] * g[2] + e[3 + i] * g[5] + e[6 + i] * g[8];
  }
  if (policy == POLICY_PRECOMPUTED)
    for (int i = 0; i < 9; i++) F[i] = rest[REST_EDGE] * F[i];
}

/* F Q0 = R U, U[6] = U11 U12 U22 U13 U23 U33 upper triangular; from edges in local
 * axes, y, where the vertices have their own order. */
INLINE void qr_stretch(const struct cb_elements *E, int policy, const T *rest, const T *e,
                       const T *R, const T *y, T *U) {
  const T *g = rest + REST_G;
  if (!in_own_order(E)) {
    T F[9];
    qr_gradient_of_edges(E, policy, rest, e, F);
    for (int n = 0; n < 6; n++) {
      static const uint8_t row[6] = {0, 0, 1, 0, 1, 2}, column[6] = {0, 1, 1, 2, 2, 2};
      U[n] = LIT(0);
      for (int i = 0; i < 9; i += 3) U[n] = U[n] + R[i + row[n]] * F[i + column[n]];
    }
    return;
  }
  T s[6];
  for (int i = 0; i < 6; i++) s[i] = policy == POLICY_PRECOMPUTED ? rest[REST_EDGE] * y[i] : y[i];
  U[0] = s[0] * g[0];
  U[1] = s[0] * g[1] + s[1] * g[4];
  U[2] = s[2] * g[4];
  U[3] = s[0] * g[2] + s[1] * g[5] + s[3] * g[8];
  U[4] = s[2] * g[5] + s[4] * g[8];
  U[5] = s[5] * g[8];
}

INLINE void qr_stress(T k, int ortho, const T *rest, const T *U, T *P) {
  T strain[6] = {U[0] - LIT(1), U[2] - LIT(1), U[5] - LIT(1), U[1], U[4], U[3]};
  stress_voigt(ortho, k, rest + REST_D, strain, P);
}

/* P's lower triangle := what makes Q P the gradient of W(U): the usual method
 * drops how Q turns with x, and with that the balance of torques.
 *   p32 = (S23 U33 - S33 U23) / U22
 *   p31 = (S13 U33 - S33 U13 - p32 U12) / U11
 *   p21 = (S12 U22 + S13 U23 - S22 U12 - S23 U13) / U11
 * in  first, second  1 / U11, 1 / U22 */
INLINE void qr_turning(T first, T second, const T *U, T *P) {
  T s12 = P[1], s13 = P[2], s22 = P[4], s23 = P[5], s33 = P[8];
  P[7] = (s23 * U[5] - s33 * U[4]) * second;
  P[6] = (s13 * U[5] - s33 * U[3] - P[7] * U[1]) * first;
  P[3] = (s12 * U[2] + s13 * U[4] - s22 * U[1] - s23 * U[3]) * first;
}

/* The same, bounded: where an edge or a face collapses W has no limit and its gradient no
 * bound: divided by LEAST_EDGE at least, which leaves a ghost torque. Says where it is not. */
INLINE CHOICE qr_gradient(const T *U, T *P) {
  const T least = LEAST_EDGE;
  qr_turning(LIT(1) / SELECT(U[0] > least, U[0], least), LIT(1) / SELECT(U[2] > least, U[2], least),
             U, P);
  return LESS(least, U[0]) & LESS(least, U[2]);
}

/* D[9]: the least with which P + D makes no torque, (P + D) U^T symmetric: D = [w]x U with
 * (tr(U U^T) I - U U^T) w = axial(U P^T - P U^T). Along a line that is as good as singular:
 * a few roundings more on the diagonal keep w bounded. */
RARE void balance_of_any(const T *stretch, const T *P, T *D) {
  T U[6], A[9], C[9], G[9], inner[9], sum[9];
  for (int i = 0; i < 6; i++) U[i] = stretch[i];
  scale_to_one(6, U);
  const T rows[9] = {U[0], U[1], U[3], LIT(0), U[2], U[4], LIT(0), LIT(0), U[5]};
  multiply3_nt(rows, rows, C);
  const T more = LOST * (C[0] + C[4] + C[8]);
  for (int i = 0; i < 9; i++) G[i] = -C[i], sum[i] = P[i];
  G[0] = C[4] + C[8] + more, G[4] = C[0] + C[8] + more, G[8] = C[0] + C[4] + more;
  cofactor3(G, inner);
  const T det = dot3(G, inner), inverse = SELECT(det > LIT(0), LIT(1) / det, LIT(0));
  for (int n = 0; n < 2; n++) { /* again with what rounding and `more` have left */
    T w[3];
    multiply3_nt(sum, rows, A);
    const T a[3] = {A[5] - A[7], A[6] - A[2], A[1] - A[3]};
    for (int i = 0; i < 3; i++) w[i] = inverse * dot3(inner + 3 * i, a);
    for (int j = 0; j < 3; j++) {
      const T column[3] = {rows[j], rows[3 + j], rows[6 + j]};
      T turned[3];
      cross3(w, column, turned);
      for (int i = 0; i < 3; i++) sum[3 * i + j] = sum[3 * i + j] + turned[i];
    }
  }
  for (int i = 0; i < 9; i++) D[i] = sum[i] - P[i];
}

INLINE void qr_pack(const struct cb_elements *E, int policy, int exact, int ortho, const T *rest,
                    const T *e, const T *own, T *memory, T *R, T *P, T *y) {
  T U[6];
  (void)memory;
  frame_qr(own, R, y);
  STAGE(STAGE_FORCE);
  qr_stretch(E, policy, rest, e, R, y, U);
  qr_stress(E->k, ortho, rest, U, P);
  if (!exact || ALL(qr_gradient(U, P))) return;
  T stretch[6], stress[9], D[9];
  for (int i = 0; i < 9; i++) stress[i] = P[i];
  for (int i = 0; i < 6; i++) stretch[i] = U[i];
  balance_of_any(stretch, stress, D);
  for (int i = 0; i < 9; i++) P[i] = P[i] + D[i];
}

INLINE bool qr_world(const struct cb_elements *E, int policy, int exact, int ortho, int quick,
                     const T *rest, const T *e, const T *own, T *memory, T *R, T *F, T *L) {
  T y[6], U[6], P[9];
  (void)memory;
  if (!exact) {
    bool usual = true;
    if (quick)
      usual = ALL(frame_qr_axes_usually(own, R, y));
    else
      frame_qr_axes(own, R, y);
    STAGE(STAGE_FORCE);
    if (policy != POLICY_PRECOMPUTED) qr_gradient_of_edges(E, policy, rest, e, F);
    return usual;
  }
  CHOICE usual = frame_qr_usually(own, R, y);
  STAGE(STAGE_FORCE);
  qr_stretch(E, policy, rest, e, R, y, U);
  usual = usual & LESS(LEAST_EDGE, U[0]) & LESS(LEAST_EDGE, U[2]);
  if (!quick && !ALL(usual)) return false;
  qr_stress(E->k, ortho, rest, U, P);
  qr_turning(LIT(1) / U[0], LIT(1) / U[2], U, P);
  L[0] = P[3] - P[1], L[1] = P[6] - P[2], L[2] = P[7] - P[5];
  return ALL(usual);
}

#endif
