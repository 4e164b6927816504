/* green.c - no frame: Green strain and St. Venant-Kirchhoff, with its own exact
 * tangent as the operator.
 * Source: Picinbono, Delingette, Ayache 2003; Bonet & Wood 2008, section 6.
 * Trade:  invariant without a frame; weakens under compression, and then the
 *         operator is indefinite.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/models/forms.h"
#include "kernels/models/strain.h"
#include "kernels/storage/gradients.h"

/* Variation of the first Piola stress: dP = H S + F (D : sym(F^T H)), / mu. */
INLINE void green_variation(const struct cb_elements *E, int ortho, const T *rest, const T *F,
                            const T *P2, const T *H, T *dP) {
  T A[9], dS[9], FdS[9];
  multiply3_tn(F, H, A);
  stress(ortho, E->k, rest + REST_D, A, dS);
  multiply3(F, dS, FdS);
  multiply3(H, P2, dP);
  for (int i = 0; i < 9; i++) dP[i] = dP[i] + FdS[i];
}

/* F and the second Piola stress / mu of one pack, and f = h f - c K v. */
INLINE void green_pack(const struct cb_elements *E, int ortho, const T *rest, const T *e,
                       const T *ev, T h, T *F, T *P2, T *f) {
  T C[9], P[9], H[9], dP[9], strain[6];
  deformation_gradient(POLICY_PRECOMPUTED, rest, e, F);
  STAGE(STAGE_FORCE);
  for (int i = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      C[3 * i + j] = F[i] * F[j] + F[3 + i] * F[3 + j] + F[6 + i] * F[6 + j];
  for (int i = 0; i < 3; i++) strain[i] = LIT(0.5) * (C[4 * i] - LIT(1));
  strain[3] = C[1], strain[4] = C[5], strain[5] = C[2];
  stress_voigt(ortho, E->k, rest + REST_D, strain, P2);
  multiply3(F, P2, P);
  T scale = -(h * rest[REST_FORCE]);
  for (int i = 0; i < 9; i++) P[i] = scale * P[i];
  if (ev) {
    gradient3(ev, rest + REST_G, H);
    green_variation(E, ortho, rest, F, P2, H, dP);
    for (int i = 0; i < 9; i++) P[i] = P[i] - dP[i];
  }
  forces3(P, rest + REST_G, f);
}

INLINE void green_ebe(const struct cb_elements *E, int ortho, const T *rest, const T *e,
                      const T *ev, T h, T *state, T *f) {
  T P2[9];
  green_pack(E, ortho, rest, e, ev, h, state, P2, f);
  static const uint8_t voigt[6] = {0, 4, 8, 1, 5, 2};
  for (int i = 0; i < 6; i++) state[9 + i] = P2[voigt[i]];
}

INLINE void green_product(const struct cb_elements *E, int ortho, const T *rest, const T *state,
                          const T *u, T *f) {
  T P2[9], H[9], dP[9];
  full3(state + 9, P2);
  gradient3(u, rest + REST_G, H);
  green_variation(E, ortho, rest, state, P2, H, dP);
  forces3(dP, rest + REST_G, f);
}

/* X[6][9] := c K_ij = (g_i . S g_j) I + F B_i^T D B_j F^T. */
INLINE void green_blocks(const struct cb_elements *E, int ortho, const T *rest, const T *e,
                         const T *ev, T h, T *X, T *f) {
  T F[9], P2[9], FF[9], g[12], w[12], Sg[12];
  green_pack(E, ortho, rest, e, ev, h, F, P2, f);
  STAGE(STAGE_ASSEMBLY);
  const T *G = rest + REST_G;
  for (int i = 0; i < 3; i++) g[i] = -(G[i] + G[3 + i] + G[6 + i]);
  for (int i = 0; i < 9; i++) g[3 + i] = G[i];
  for (int j = 3; j < 12; j += 3) apply3(P2, g + j, Sg + j);
  if (ortho)
    edge_blocks_local(rest + REST_D, F, G, X);
  else {
    multiply3_nt(F, F, FF);
    for (int j = 0; j < 12; j += 3) apply3(F, g + j, w + j);
  }
  for (int n = 0; n < 6; n++) {
    int p = 3 * cb_tet_edge[n][0], q = 3 * cb_tet_edge[n][1];
    T *K = X + 9 * n, geometric = dot3(g + p, Sg + q);
    if (!ortho) {
      T both = dot3(g + p, g + q);
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          K[3 * r + c] = E->k * (w[p + r] * w[q + c]) + w[q + r] * w[p + c] + both * FF[3 * r + c];
    }
    for (int i = 0; i < 9; i += 4) K[i] = K[i] + geometric;
  }
}

#define GREEN(ORTHO, TAG)                                                                          \
  INLINE void green_ebe_##TAG(const struct cb_elements *E, const T *r, const T *e, const T *own,   \
                              const T *ev, T h, T *m, T *s, T *f) {                                \
    (void)m, (void)own;                                                                            \
    green_ebe(E, ORTHO, r, e, ev, h, s, f);                                                        \
  }                                                                                                \
  INLINE void green_ebe_product_##TAG(const struct cb_elements *E, const T *r, const T *s,         \
                                      const T *u, T *f) {                                          \
    green_product(E, ORTHO, r, s, u, f);                                                           \
  }                                                                                                \
  INLINE void green_blocks_##TAG(const struct cb_elements *E, const T *r, const T *e,              \
                                 const T *own, const T *ev, T h, T *m, T *X, T *f) {               \
    (void)m, (void)own;                                                                            \
    green_blocks(E, ORTHO, r, e, ev, h, X, f);                                                     \
  }                                                                                                \
  STORAGE_EBE(green, TAG)                                                                          \
  STORAGE_EBE_PRODUCT(green, TAG)                                                                  \
  STORAGE_CLUSTER(green, TAG, update_clusters, green_ebe_##TAG)                                    \
  STORAGE_CLUSTER_PRODUCT(green, TAG, product_clusters_of_model)                                   \
  STORAGE_BLOCKS(green, TAG, 0)                                                                    \
  STORAGE_ASSEMBLED(green, TAG, green_blocks_##TAG, TERMS_BLOCKS)
GREEN(0, iso)
GREEN(1, ortho)

#define GREEN_LAWS                                                                                 \
  (CB_KEEPS(CB_LAW_ROTATION) | CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) |              \
   CB_KEEPS(CB_LAW_TANGENT) | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER)

const struct cb_model CB_NAME(cb_model_green) = {
    .name = "green",
    .summary = "Green strain, St. Venant-Kirchhoff, exact tangent",
    .source = "Picinbono, Delingette, Ayache 2003",
    .laws = {GREEN_LAWS, GREEN_LAWS},
    .policy = POLICY_PRECOMPUTED,
    .keeps_rest = true,
    .form = {[CB_EBE] = {FORM_EBE(green, iso, 15), FORM_EBE(green, ortho, 15)},
             [CB_EBE_CLUSTER] = {FORM_CLUSTER(green, iso, 15), FORM_CLUSTER(green, ortho, 15)},
             [CB_EBE_MATRIX] = {FORM_MATRIX(green, iso), FORM_MATRIX(green, ortho)},
             [CB_CSR] = FORMS_CSR(green, TERMS_BLOCKS, TERMS_BLOCKS),
             [CB_BCSR] = FORMS_BCSR(green, TERMS_BLOCKS, TERMS_BLOCKS),
             [CB_BCSR_SYMMETRIC] = FORMS_BCSR_SYMMETRIC(green, TERMS_BLOCKS, TERMS_BLOCKS)}};
