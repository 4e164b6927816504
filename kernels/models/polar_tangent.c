/* polar_tangent.c - the polar model with the derivative of its force as operator:
 * how the frame turns with x is not dropped. Isotropic materials.
 * Source: dR from Chao, Pinkall, Sanan & Schroeder 2010; eigenvalues clamped as
 *         in Smith, de Goes & Kim 2019; the world-axes form below: this project.
 * Trade:  6 more numbers an element and a fifth more work in a product. Under
 *         compression the derivative is indefinite; clamped, it is a derivative no
 *         more, but conjugate gradients and Cholesky get what they need, at the price
 *         of an eigenproblem.
 *
 * In world axes, w_j = R grad0_j, V = F R^T, Z = dF R^T = sum du_j (x) w_j and
 * [a]x = Z - Z^T, the frame turns by omega = (tr(V) I - V)^-1 a, and
 *   dP R^T / mu = Z + Z^T + k tr(Z) I + [C a]x,
 *   C = I - (2 - k tr(V - I)) (tr(V) I - V)^-1:
 * the usual operator and a symmetric 3x3 matrix, whose eigenvalues are those of
 * turning against the stress.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/jacobi.h"
#include "kernels/frames/polar_closed.h"

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_closed(F, R)
#include "kernels/models/corotated.h"

/* tr(V) I - V has the sums of two stretches as eigenvalues, none negative. Where one
 * is below this (a much inverted element, whose frame may jump; or a collapsed one)
 * the turning is bounded: the sum is taken to be as large, or as what rounding may have
 * left of it. */
#define LEAST_TURN LIT(1e-3)

static const uint8_t voigt_row[6] = {0, 1, 2, 0, 1, 2}, voigt_column[6] = {0, 1, 2, 1, 2, 0};

/* C (Voigt order) of V, symmetric, from its eigenvectors. Clamped: eigenvalues below zero
 * made zero: as the form of sym(Z) is never negative, and apart from that of a, this is the
 * nearest semi-definite dP(dF). */
INLINE void turning_by_axes(bool clamped, T k, const T *V, T *C) {
  T trace = V[0] + V[4] + V[8], factor = LIT(2) - k * (trace - LIT(3)), A[9], lambda[3];
  jacobi_eigen(V, A, lambda);
  T lost = LOST * (ABS(lambda[0]) + ABS(lambda[1]) + ABS(lambda[2]));
  const T least = SELECT(lost > LEAST_TURN, lost, LEAST_TURN);
  for (int i = 0; i < 3; i++) {
    T sum = trace - lambda[i]; /* of the two other stretches */
    lambda[i] = LIT(1) - factor / SELECT(sum > least, sum, least);
    if (clamped) lambda[i] = SELECT(lambda[i] < LIT(0), LIT(0), lambda[i]);
  }
  for (int n = 0; n < 6; n++) {
    const T *p = A + 3 * voigt_row[n], *q = A + 3 * voigt_column[n];
    C[n] = lambda[0] * (p[0] * q[0]) + lambda[1] * (p[1] * q[1]) + lambda[2] * (p[2] * q[2]);
  }
}

/* The same where a sum may be below the least, or two, which cofactors do not tell. */
RARE void turning_of_any(T k, const T *V, T *C) { turning_by_axes(false, k, V, C); }

INLINE void turning(T k, const T *V, T *C) {
  T trace = V[0] + V[4] + V[8], A[9], cofactor[9];
  for (int i = 0; i < 9; i++) A[i] = i % 4 == 0 ? trace - V[i] : -V[i];
  cofactor3(A, cofactor);
  T det = dot3(A, cofactor), size = ABS(A[0]) + ABS(A[4]) + ABS(A[8]);
  T most = ABS(cofactor[0]) + ABS(cofactor[4]) + ABS(cofactor[8]);
  /* Cofactors, of which det is a sum, lose roundings of size^2, however small they are. */
  T least = LEAST_TURN * most, lost = LOST * (size * size * size);
  CHOICE usual = LESS(least, det) & LESS(lost, det);
  T scale = (LIT(2) - k * (trace - LIT(3))) / CHOOSE(usual, det, LIT(1));
  for (int n = 0; n < 6; n++) {
    C[n] = -(scale * cofactor[3 * voigt_row[n] + voigt_column[n]]);
    if (n < 3) C[n] = LIT(1) + C[n];
  }
  if (__builtin_expect(ALL(usual), 1)) return;
  const T from[9] = {V[0], V[1], V[2], V[3], V[4], V[5], V[6], V[7], V[8]};
  T bounded[6];
  turning_of_any(k, from, bounded);
  for (int n = 0; n < 6; n++) C[n] = CHOOSE(usual, C[n], bounded[n]);
}

/* M := [k tr(Z) I + Z + Z^T] + [C a]x. */
INLINE void tangent_stress(T k, const T *C, const T *Z, T *M) {
  T full[9], c[3], a[3] = {Z[7] - Z[5], Z[2] - Z[6], Z[3] - Z[1]};
  full3(C, full);
  apply3(full, a, c);
  stress(0, k, NULL, Z, M);
  M[7] = M[7] + c[0], M[5] = M[5] - c[0];
  M[2] = M[2] + c[1], M[6] = M[6] - c[1];
  M[3] = M[3] + c[2], M[1] = M[1] - c[2];
}

/* state: w[9], C[6]; f := h f - c K v. */
INLINE void tangent_ebe(const struct cb_elements *E, bool clamped, const T *rest, const T *e,
                        const T *ev, T h, T *state, T *f) {
  T F[9], R[9], V[9], Z[9], M[9], *C = state + 9;
  deformation_gradient(POLICY_PRECOMPUTED, rest, e, F);
  frame_polar_closed(F, R);
  STAGE(STAGE_B);
  world_gradients(POLICY_PRECOMPUTED, 0, 0, rest, e, R, state);
  multiply3_nt(F, R, V);
  for (int i = 0; i < 3; i++) /* symmetric but for rounding */
    for (int j = 0; j < i; j++)
      V[3 * i + j] = V[3 * j + i] = LIT(0.5) * (V[3 * i + j] + V[3 * j + i]);
  if (clamped)
    turning_by_axes(true, E->k, V, C);
  else
    turning(E->k, V, C);
  STAGE(STAGE_FORCE);
  T scale = -(h * rest[REST_FORCE]);
  for (int i = 0; i < 9; i++) Z[i] = scale * (i % 4 == 0 ? V[i] - LIT(1) : V[i]);
  if (ev)
    for (int i = 0; i < 9; i++)
      for (int j = 0; j < 9; j += 3) Z[i] = Z[i] - ev[j + i / 3] * state[j + i % 3];
  tangent_stress(E->k, C, Z, M);
  forces3(M, state, f);
}

INLINE void tangent_product(const struct cb_elements *E, const T *state, const T *u, T *f) {
  T Z[9], M[9];
  gradient3(u, state, Z);
  tangent_stress(E->k, state + 9, Z, M);
  forces3(M, state, f);
}

/* X[6][9] := c K_ij = k w_i w_j^T + w_j w_i^T + (w_i . w_j) I - [w_i]x C [w_j]x. */
INLINE void tangent_blocks(const struct cb_elements *E, bool clamped, const T *rest, const T *e,
                           const T *ev, T h, T *X, T *f) {
  T state[15], w[12], C[9], turned[27]; /* C [w_j]x of b, c, d */
  tangent_ebe(E, clamped, rest, e, ev, h, state, f);
  STAGE(STAGE_ASSEMBLY);
  full3(state + 9, C);
  for (int i = 0; i < 3; i++) w[i] = -(state[i] + state[3 + i] + state[6 + i]);
  for (int i = 0; i < 9; i++) w[3 + i] = state[i];
  for (int j = 0; j < 3; j++) /* row r of C [w]x is row r of C, times w */
    for (int r = 0; r < 3; r++) cross3(C + 3 * r, state + 3 * j, turned + 9 * j + 3 * r);
  for (int n = 0; n < 6; n++) {
    const T *p = w + 3 * cb_tet_edge[n][0], *q = w + 3 * cb_tet_edge[n][1];
    const T *Y = turned + 9 * (cb_tet_edge[n][1] - 1);
    T both = dot3(p, q), *K = X + 9 * n;
    for (int c = 0; c < 3; c++) {
      T column[3] = {Y[c], Y[3 + c], Y[6 + c]}, cross[3];
      cross3(p, column, cross);
      for (int r = 0; r < 3; r++) K[3 * r + c] = E->k * (p[r] * q[c]) + q[r] * p[c] - cross[r];
      K[4 * c] = K[4 * c] + both;
    }
  }
}

#define TANGENT(ID, CLAMPED, NAME, SUMMARY, LAWS)                                                  \
  INLINE void ID##_ebe_iso(const struct cb_elements *E, const T *r, const T *e, const T *own,      \
                           const T *ev, T h, T *m, T *s, T *f) {                                   \
    (void)m, (void)own;                                                                            \
    tangent_ebe(E, CLAMPED, r, e, ev, h, s, f);                                                    \
  }                                                                                                \
  INLINE void ID##_ebe_product_iso(const struct cb_elements *E, const T *r, const T *s,            \
                                   const T *u, T *f) {                                             \
    (void)r;                                                                                       \
    tangent_product(E, s, u, f);                                                                   \
  }                                                                                                \
  INLINE void ID##_blocks_iso(const struct cb_elements *E, const T *r, const T *e, const T *own,   \
                              const T *ev, T h, T *m, T *X, T *f) {                                \
    (void)m, (void)own;                                                                            \
    tangent_blocks(E, CLAMPED, r, e, ev, h, X, f);                                                 \
  }                                                                                                \
  STORAGE_EBE(ID, iso)                                                                             \
  STORAGE_EBE_PRODUCT(ID, iso)                                                                     \
  STORAGE_CLUSTER(ID, iso, update_clusters, ID##_ebe_iso)                                          \
  STORAGE_CLUSTER_PRODUCT(ID, iso, product_clusters_of_model)                                      \
  STORAGE_BLOCKS(ID, iso, 0)                                                                       \
  STORAGE_ASSEMBLED(ID, iso, ID##_blocks_iso, TERMS_BLOCKS)                                        \
  const struct cb_model CB_NAME(cb_model_##ID) = {                                                 \
      .name = NAME,                                                                                \
      .summary = SUMMARY,                                                                          \
      .source = "Chao, Pinkall, Sanan, Schroeder 2010",                                            \
      .laws = {LAWS, 0},                                                                           \
      .policy = POLICY_PRECOMPUTED,                                                                \
      .frame = FRAMES,                                                                             \
      .form = {[CB_EBE] = {FORM_EBE(ID, iso, 15), {NULL, NULL, 0}},                                \
               [CB_EBE_CLUSTER] = {FORM_CLUSTER(ID, iso, 15), {NULL, NULL, 0}},                    \
               [CB_EBE_MATRIX] = {FORM_MATRIX(ID, iso), {NULL, NULL, 0}},                          \
               [CB_CSR] = {{ID##_assembled_update_iso, CB_NAME(cb_product_csr), TERMS_BLOCKS},     \
                           {NULL, NULL, 0}},                                                       \
               [CB_BCSR] = {{ID##_assembled_update_iso, CB_NAME(cb_product_bcsr), TERMS_BLOCKS},   \
                            {NULL, NULL, 0}},                                                      \
               [CB_BCSR_SYMMETRIC] = {                                                             \
                   {ID##_assembled_update_iso, CB_NAME(cb_product_bcsr_symmetric), TERMS_BLOCKS},  \
                   {NULL, NULL, 0}}}};

#define LAWS_POLAR                                                                                 \
  (CB_KEEPS(CB_LAW_ROTATION) | CB_KEEPS(CB_LAW_NEWTON) | CB_KEEPS(CB_LAW_SYMMETRIC) | LAWS_EULER | \
   LAWS_ENERGY | LAWS_ORDER)

TANGENT(polar_tangent, false, "polar-tangent", "polar frame, rest B, derivative of the force",
        LAWS_POLAR | CB_KEEPS(CB_LAW_TANGENT))
TANGENT(polar_tangent_clamped, true, "polar-tangent-clamped",
        "the same, made positive semi-definite", LAWS_POLAR | CB_KEEPS(CB_LAW_SEMIDEFINITE))
