/* element.h - one tetrahedron in quad precision by formulas of its own: energy,
 * force and stiffness product of any frame and any choice of B. Shares no line
 * with kernels/.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_ELEMENT_H
#define CB_TESTS_ELEMENT_H

#include "tests/variants.h"

__float128 sqrtq(__float128);

enum frame { FRAME_NONE, FRAME_GREEN, FRAME_QR, FRAME_POLAR, FRAME_REFLECTED, FRAME_EDGES };
enum gradients { REST_B, CURRENT_B, CURRENT_B_VOLUME };

struct element {
  enum frame frame;
  const struct cb_material *material;
  quad e0[9], e[9];    /* edges b-a, c-a, d-a in columns, at rest and now, m */
  quad F[9], R[9];     /* gradient and frame (identity for none and green) */
  quad cofactors0[12]; /* rows a, b, c, d: 6 V grad N, at rest, m^2 */
  quad cofactors[12];  /* and now */
  quad six0, six;      /* 6 V, signed, m^3 */
};

/* C := A B, A^T B, A B^T */
static inline void q_multiply(const quad *A, bool ta, const quad *B, bool tb, quad *C) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      C[3 * i + j] = 0;
      for (int k = 0; k < 3; k++)
        C[3 * i + j] += A[ta ? 3 * k + i : 3 * i + k] * B[tb ? 3 * j + k : 3 * k + j];
    }
}

static inline quad q_cofactor(const quad *A, int i, int j) {
  int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
  return A[3 * a + c] * A[3 * b + d] - A[3 * a + d] * A[3 * b + c];
}

static inline quad q_determinant(const quad *A) {
  return A[0] * q_cofactor(A, 0, 0) + A[1] * q_cofactor(A, 0, 1) + A[2] * q_cofactor(A, 0, 2);
}

static inline void q_inverse(const quad *A, quad *B) {
  quad det = q_determinant(A);
  for (int i = 0; i < 9; i++) B[i] = q_cofactor(A, i % 3, i / 3) / det;
}

/* Q := orthonormal columns from A's, the third the cross product of the others. */
static inline void q_gram_schmidt(const quad *A, quad *Q) {
  for (int j = 0; j < 2; j++) {
    quad v[3] = {A[j], A[3 + j], A[6 + j]}, length = 0, along = 0;
    for (int i = 0; i < 3; i++) along += j ? Q[3 * i] * v[i] : 0;
    for (int i = 0; i < 3; i++) v[i] -= j ? along * Q[3 * i] : 0;
    for (int i = 0; i < 3; i++) length += v[i] * v[i];
    for (int i = 0; i < 3; i++) Q[3 * i + j] = v[i] / sqrtq(length);
  }
  for (int i = 0; i < 3; i++) {
    int a = 3 * ((i + 1) % 3), b = 3 * ((i + 2) % 3);
    Q[3 * i + 2] = Q[a] * Q[b + 1] - Q[b] * Q[a + 1];
  }
}

/* R := the orthogonal matrix near GSL's where S = R^T F is symmetric, by Newton:
 * turn by w, (tr(S) I - S) w = 2 axial(skew(S)), and orthogonal again. */
static inline void q_polar(const quad *F, bool reflects, quad *R) {
  double f[9], r[9];
  for (int i = 0; i < 9; i++) f[i] = (double)F[i];
  assert_int_equal((reflects ? cb_oracle_polar_orthogonal : cb_oracle_polar)(f, r), CB_OK);
  for (int i = 0; i < 9; i++) R[i] = r[i];
  for (int n = 0; n < 4; n++) {
    quad S[9], G[9], inverse[9], w[3], turned[9];
    q_multiply(R, true, F, false, S);
    quad trace = S[0] + S[4] + S[8], skew[3] = {S[7] - S[5], S[2] - S[6], S[3] - S[1]};
    for (int i = 0; i < 9; i++) G[i] = (i % 4 == 0 ? trace : 0) - (S[i] + S[i % 3 * 3 + i / 3]) / 2;
    q_inverse(G, inverse);
    for (int i = 0; i < 3; i++)
      w[i] = inverse[3 * i] * skew[0] + inverse[3 * i + 1] * skew[1] + inverse[3 * i + 2] * skew[2];
    const quad W[9] = {1, -w[2], w[1], w[2], 1, -w[0], -w[1], w[0], 1};
    q_multiply(R, false, W, false, turned);
    q_gram_schmidt(turned, R);
    for (int i = 2; q_determinant(turned) < 0 && i < 9; i += 3) R[i] = -R[i];
  }
}

/* B := A, the columns c and d exchanged where left. */
static inline void q_upright(const quad *A, bool left, quad *B) {
  for (int i = 0; i < 9; i++) B[i] = A[i / 3 * 3 + (left && i % 3 ? 3 - i % 3 : i % 3)];
}

/* Frames of the current and of the rest edges give one of F: R := Q Q0^T. */
static inline void q_frame(struct element *t) {
  quad Q[9], Q0[9], turned[9];
  for (int i = 0; i < 9; i++) t->R[i] = i % 4 == 0;
  if (t->frame == FRAME_POLAR || t->frame == FRAME_REFLECTED)
    q_polar(t->F, t->frame == FRAME_REFLECTED, t->R);
  if (t->frame == FRAME_QR) {
    q_gram_schmidt(t->e, Q);
    q_gram_schmidt(t->e0, Q0);
    q_multiply(Q, false, Q0, true, t->R);
  }
  if (t->frame == FRAME_EDGES) { /* of the right-handed element */
    q_upright(t->e, t->six0 < 0, turned);
    q_polar(turned, false, Q);
    q_upright(t->e0, t->six0 < 0, turned);
    q_polar(turned, false, Q0);
    q_multiply(Q, false, Q0, true, t->R);
  }
}

/* rows[12] := 6 V grad N of a, b, c, d for edges e in columns. */
static inline void q_cofactor_rows(const quad *e, quad *rows) {
  for (int i = 0; i < 3; i++) {
    rows[i] = 0;
    for (int j = 0; j < 3; j++) {
      rows[3 + 3 * j + i] = q_cofactor(e, i, j);
      rows[i] -= q_cofactor(e, i, j);
    }
  }
}

/* Vertices x[12] now, X[12] at rest, m. */
static inline struct element element_of(enum frame frame, const struct cb_material *material,
                                        const double *X, const quad *x) {
  struct element t = {.frame = frame, .material = material};
  quad inverse[9];
  for (int i = 0; i < 9; i++) {
    t.e[i] = x[3 + i % 3 * 3 + i / 3] - x[i / 3];
    t.e0[i] = (quad)X[3 + i % 3 * 3 + i / 3] - X[i / 3];
  }
  q_inverse(t.e0, inverse);
  q_multiply(t.e, false, inverse, false, t.F);
  q_cofactor_rows(t.e0, t.cofactors0);
  q_cofactor_rows(t.e, t.cofactors);
  t.six0 = q_determinant(t.e0), t.six = q_determinant(t.e);
  q_frame(&t);
  return t;
}

/* S := D : E. An isotropic D is made in quad: the material's own is rounded. */
static inline void q_stress(const struct cb_material *m, const quad *E, quad *S) {
  static const int voigt[6] = {0, 4, 8, 1, 5, 2};
  quad nu = m->poisson, mu = m->young / (2 * (1 + nu)), lambda = mu * 2 * nu / (1 - 2 * nu);
  for (int i = 0; i < 6; i++) {
    quad sum = 0;
    for (int j = 0; j < 6; j++) {
      quad D = m->D[6 * i + j];
      if (!m->orthotropic) D = (i < 3 && j < 3 ? lambda : 0) + (i == j ? (i < 3 ? 2 : 1) * mu : 0);
      sum += D * (E[voigt[j]] + (j < 3 ? 0 : E[voigt[j]]));
    }
    S[voigt[i]] = S[voigt[i] % 3 * 3 + voigt[i] / 3] = sum;
  }
}

static inline quad element_volume(const struct element *t) {
  return (t->six0 < 0 ? -t->six0 : t->six0) / 6;
}

/* E := strain in the rest axes. */
static inline void element_strain(const struct element *t, quad *E) {
  quad A[9];
  q_multiply(t->frame == FRAME_GREEN ? t->F : t->R, true, t->F, false, A);
  for (int i = 0; i < 9; i++) {
    quad twice = A[i] + A[i % 3 * 3 + i / 3] - (i % 4 == 0 ? 2 : 0);
    E[i] = t->frame == FRAME_GREEN ? twice / 4 : twice / 2;
  }
}

/* V/2 E : D : E, J */
static inline quad element_energy(const struct element *t) {
  quad E[9], S[9], W = 0;
  element_strain(t, E);
  q_stress(t->material, E, S);
  for (int i = 0; i < 9; i++) W += E[i] * S[i];
  return element_volume(t) * W / 2;
}

/* w[12] := world gradients that B is made of. An edge frame that reflects turns
 * the edges' handedness round, and with it the sign of their cofactors. */
static inline void element_gradients(const struct element *t, enum gradients b, quad *w) {
  quad scale = b == CURRENT_B_VOLUME ? 1 / t->six : 1 / t->six0;
  if (b == CURRENT_B && q_determinant(t->R) < 0) scale = -scale;
  for (int i = 0; i < 12; i += 3)
    for (int r = 0; r < 3; r++) {
      const quad *g = t->cofactors0 + i;
      w[i + r] =
          b == REST_B
              ? (t->R[3 * r] * g[0] + t->R[3 * r + 1] * g[1] + t->R[3 * r + 2] * g[2]) * scale
              : t->cofactors[i + r] * scale;
    }
}

/* f := V R (D : E) R^T w for each vertex. */
static inline void element_apply(const struct element *t, enum gradients b, const quad *E,
                                 quad *f) {
  quad S[9], RS[9], world[9], w[12];
  q_stress(t->material, E, S);
  q_multiply(t->R, false, S, false, RS);
  q_multiply(RS, false, t->R, true, world);
  element_gradients(t, b, w);
  for (int i = 0; i < 12; i++) {
    const quad *row = world + 3 * (i % 3), *g = w + i / 3 * 3;
    f[i] = element_volume(t) * (row[0] * g[0] + row[1] * g[1] + row[2] * g[2]);
  }
}

/* f[12] := -R V B^T D eps, N: the usual force, frame held still. Not for green. */
static inline void element_force(const struct element *t, enum gradients b, quad *f) {
  quad E[9];
  element_strain(t, E);
  element_apply(t, b, E, f);
  for (int i = 0; i < 12; i++) f[i] = -f[i];
}

/* f[12] := R V B^T D B R^T u. */
static inline void element_product(const struct element *t, enum gradients b, const quad *u,
                                   quad *f) {
  quad H[9] = {0}, RH[9], A[9], w[12];
  element_gradients(t, b, w);
  for (int i = 0; i < 9; i++)
    for (int j = 0; j < 12; j += 3) H[i] += u[j + i / 3] * w[j + i % 3];
  q_multiply(t->R, true, H, false, RH);
  q_multiply(RH, false, t->R, false, A);
  for (int i = 0; i < 9; i++) H[i] = (A[i] + A[i % 3 * 3 + i / 3]) / 2;
  element_apply(t, b, H, f);
}

/* ---- shapes and runs for it -------------------------------------------------- */

/* How much rounding of F moves the nearest rotation, or the Gram-Schmidt frame. */
static inline double frame_condition(const double *X, const double *x) {
  quad q[12];
  double F[9], U[9], s[3], V[9];
  for (int i = 0; i < 12; i++) q[i] = x[i];
  struct cb_material none = {0};
  struct element t = element_of(FRAME_NONE, &none, X, q);
  for (int i = 0; i < 9; i++) F[i] = (double)t.F[i];
  assert_int_equal(cb_oracle_svd(F, U, s, V), CB_OK);
  return s[0] / (s[1] + copysign(s[2], determinant3(F))) * s[0] / s[2];
}

/* One element of either orientation, each vertex moved at random, turned inside
 * out now and then. */
static inline struct scene wild_scene(gsl_rng *rng, int trial) {
  struct scene s = scene_new(rng, trial % 2 ? SCENE_ONE : SCENE_MIRRORED);
  do {
    for (int i = 0; i < 12; i++) s.x[i] = s.mesh.X[i] + gsl_ran_gaussian(rng, 0.4);
    s.condition = frame_condition(s.mesh.X, s.x);
  } while (!(s.condition < 50));
  return s;
}

static inline struct run counted_run(const char *model) {
  struct run r = {.variant = {scene_model(scene_counted(), model), CB_EBE, scene_counted()}};
  return r;
}

static inline void reopen(struct run *r, const struct scene *s, const struct cb_material *m) {
  struct cb_variant v = r->variant;
  run_open(r, s, &v, m, 1);
}

#endif
