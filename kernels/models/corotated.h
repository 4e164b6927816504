/* corotated.h - every corotated model: a frame x a strain-displacement policy x
 * a material x a storage. A model file defines, then includes this once:
 *   SPARSE          1 if the frame makes local gradients triangular (qr), else 0
 *   NO_FRAME        1 if R = I always (linear), else 0
 *   REFLECTS        defined if R may be a reflection (polar-reflected)
 *   FRAME_ROTATION(e, F, memory, R)  the frame from edges and F (and E, the elements, for
 *                   what is tuned); FRAME_PACK and FRAME_WORLD, with the contracts of
 *                   frame_pack and frame_world below, where something else is to be done
 *                   than they do; ANY_PACK, a frame_pack of what FRAME_WORLD cannot
 *   FRAMES_AT_ONCE, FRAME_ROTATIONS(count, F, R)  where frames of several packs take less
 *                   time together, as in lanes: those of F[count][9], count <= FRAMES_AT_ONCE;
 * returns false where they are not that for each lane and then lists its models with
 * COROTATED_FAMILY or COROTATED_MODEL.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/models/forms.h"
#include "kernels/models/strain.h"

#ifndef FRAMES_AT_ONCE
#define FRAMES_AT_ONCE 1
#endif
_Static_assert((int)FRAMES_AT_ONCE <= (int)SLOTS_AT_ONCE, "clusters bring as many");

/* Numbers that any frame here may remember. */
enum { FRAME_MEMORY = 32 };

#ifdef FRAME_ROTATION
/* Orthotropic elements call the frame, isotropic ones have it inlined, which is
 * 10 % faster for the iterative ones: thirty copies would take minutes to build. */
OUTLINE void frame_called(const struct cb_elements *E, const T *e, const T *F, T *memory, T *R) {
  (void)E, (void)e, (void)F, (void)memory;
  FRAME_ROTATION(e, F, memory, R);
}
#endif

#ifndef FRAME_WORLD
/* Frame and deformation gradient of one pack.
 * in      policy, exact, ortho, quick  constants; rest; e, own (update_pack_fn)
 * in/out  memory
 * out     R[9]  frame
 *         F[9]  such that F R^T - I, made symmetric, is the corotated strain in world
 *               axes; not read for a precomputed B
 *         L[3]  exact: what the local stress / mu has at (2,1), (3,1), (3,2) beyond
 *               a symmetric one
 * Returns false where that is not for each lane: quick_packs_fn, or (exact) a pack for
 * ANY_PACK. */
#define FRAME_WORLD frame_world
INLINE bool frame_world(const struct cb_elements *E, int policy, int exact, int ortho, int quick,
                        const T *rest, const T *e, const T *own, T *memory, T *R, T *F, T *L) {
  (void)E, (void)exact, (void)quick, (void)own, (void)memory, (void)L;
  deformation_gradient(policy, rest, e, F);
  if (ortho)
    frame_called(E, own, F, memory, R);
  else
    FRAME_ROTATION(own, F, memory, R);
  STAGE(STAGE_FORCE);
  return true;
}
#endif

#if NO_FRAME
#define FRAMES NULL
#else
#define FRAMES frames
/* cb_frame_fn. Lanes without a matrix of their own get the last one. */
static void frames(size_t count, const void *F, void *R) {
  static const struct cb_elements E; /* untuned */
  const S *from = F;
  S *to = R;
  T rest[REST_ORTHOTROPIC] = {0};
  rest[REST_G] = rest[REST_G + 4] = rest[REST_G + 8] = rest[REST_EDGE] = LIT(1);
  for (size_t n = 0; n < count; n += LANES) {
    T e[9], memory[FRAME_MEMORY] = {0}, Q[9], G[9], L[3];
    const size_t live = count - n < LANES ? count - n : LANES;
    for (size_t l = 0; l < LANES; l++)
      for (size_t i = 0; i < 9; i++)
        LANE(e[i % 3 * 3 + i / 3], l) = from[9 * (n + (l < live ? l : live - 1)) + i];
    FRAME_WORLD(&E, POLICY_PRECOMPUTED, 0, 1, 0, rest, e, e, memory, Q, G, L);
    for (size_t l = 0; l < live; l++)
      for (size_t i = 0; i < 9; i++) to[9 * (n + l) + i] = LANE(Q[i], l);
  }
}
#endif

#ifndef FRAME_PACK
/* Frame and local first Piola-Kirchhoff stress of one pack.
 * in      policy, exact, ortho  constants; rest; e, own (update_pack_fn)
 * in/out  memory
 * out     R[9]  frame; P[9] R^T (Piola stress) / mu; exact: not symmetric
 *         y[6]  edges in local axes, m (SPARSE frames only) */
#define FRAME_PACK frame_pack
INLINE void frame_pack(const struct cb_elements *E, int policy, int exact, int ortho, const T *rest,
                       const T *e, const T *own, T *memory, T *R, T *P, T *y) {
  T F[9], stretch[9];
  (void)y;
  frame_world(E, policy, exact, ortho, 0, rest, e, own, memory, R, F, NULL);
  corotated_stress(E->k, rest, ortho, R, F, stretch, P);
}
#endif

/* w := world gradients (kernels/elements.h). */
INLINE void world_gradients(int policy, bool sparse, int frameless, const T *rest, const T *e,
                            const T *R, T *w) {
  const T *g = rest + REST_G;
  if (policy == POLICY_PRECOMPUTED) {
    for (int j = 0; j < 9; j += 3)
      if (frameless)
        for (int i = 0; i < 3; i++) w[j + i] = g[j + i];
      else if (sparse && j == 3) /* grad0_c has no x, grad0_d only z */
        for (int i = 0; i < 3; i++) w[3 + i] = R[3 * i + 1] * g[4] + R[3 * i + 2] * g[5];
      else if (sparse && j == 6)
        for (int i = 0; i < 3; i++) w[6 + i] = R[3 * i + 2] * g[8];
      else
        apply3(R, g + j, w + j);
    return;
  }
  T scale = rest[REST_W];
  edge_cofactors(e, w);
  if (policy == POLICY_UPDATED_VOLUME) scale = scale / dot3(e, w);
#ifdef REFLECTS
  if (policy == POLICY_UPDATED) { /* in a reflected frame the volume is upright: */
    T C[9];                       /* world cofactors have the sign of det R */
    cofactor3(R, C);
    scale = scale * dot3(R, C);
  }
#endif
  for (int i = 0; i < 9; i++) w[i] = scale * w[i];
}

#ifdef LAZY
/* What a lazy element remembers: local gradients b[9], and the stretch S[9] that they
 * were made at; behind what the frame does. In ebe-paper B is where it was. */
enum { LAZY_B, LAZY_S = 9, LAZY_NUMBERS = 18 };

/* Where the stretch R^T F has moved by more than E->lazy since then, or never was
 * there: remembered anew. */
INLINE MASK lazy_moved(const struct cb_elements *E, const T *R, const T *F, T *memory) {
  T stretch[9], *last = memory + LAZY_S, far = LIT(0), any = LIT(0);
  multiply3_tn(R, F, stretch);
  for (int i = 0; i < 9; i++) {
    T d = ABS(stretch[i] - last[i]);
    far = SELECT(d > far, d, far);
    any = any + ABS(last[i]);
  }
  MASK moved = (far > E->lazy) | (any == LIT(0));
  for (int i = 0; i < 9; i++) last[i] = SELECT(moved, stretch[i], last[i]);
  return moved;
}

/* w := world gradients, from those remembered in the frame's axes. */
INLINE void lazy_gradients(const struct cb_elements *E, const T *rest, const T *e, const T *R,
                           const T *F, T *memory, T *w) {
  MASK moved = lazy_moved(E, R, F, memory);
  T *b = memory + LAZY_B, now[3];
  if (ANY(moved)) {
    world_gradients(POLICY_UPDATED, 0, 0, rest, e, R, w);
    for (int j = 0; j < 9; j += 3) {
      apply3_transposed(R, w + j, now);
      for (int i = 0; i < 3; i++) b[j + i] = SELECT(moved, now[i], b[j + i]);
    }
  }
  for (int j = 0; j < 9; j += 3) apply3(R, b + j, w + j);
}
#endif

/* M := -h s M - stress of the velocity gradient, orthotropic: force and product in
 * one go. */
INLINE void absorb(const T *rest, T h, const T *b, const T *ev, T *M) {
  T scale = -(h * rest[REST_FORCE]);
  for (int i = 0; i < 9; i++) M[i] = scale * M[i];
  if (ev) {
    T H[9], N[9];
    gradient3(ev, b, H);
    stress(1, LIT(0), rest + REST_D, H, N);
    for (int i = 0; i < 9; i++) M[i] = M[i] - N[i];
  }
}

/* Z := scale (F R^T - I) - sum ev_j (x) w_j: strain and velocity gradient are added
 * before there is a stress of either. With precomputed B, w_j = R grad0_j, and
 * F R^T is a sum over the edges as well. */
INLINE void world_strain(int policy, const T *rest, const T *R, const T *F, T scale, const T *e,
                         const T *ev, const T *w, T *Z) {
  T d[9];
  if (policy == POLICY_PRECOMPUTED) {
    T edge = scale * rest[REST_EDGE];
    for (int i = 0; i < 9; i++) d[i] = ev ? edge * e[i] - ev[i] : edge * e[i];
    gradient3(d, w, Z);
    for (int i = 0; i < 9; i += 4) Z[i] = Z[i] - scale;
    return;
  }
  multiply3_nt(F, R, Z);
  for (int i = 0; i < 9; i++) Z[i] = scale * (i % 4 == 0 ? Z[i] - LIT(1) : Z[i]);
  if (ev)
    for (int i = 0; i < 9; i++)
      for (int j = 0; j < 9; j += 3) Z[i] = Z[i] - ev[j + i / 3] * w[j + i % 3];
}

/* M += scale R P R^T, P = L below its diagonal, zero elsewhere. */
INLINE void add_lower(const T *R, T scale, const T *L, T *M) {
  T p21 = scale * L[0], p31 = scale * L[1], p32 = scale * L[2];
  for (int i = 0; i < 9; i += 3) {
    T first = R[i + 1] * p21 + R[i + 2] * p31, second = R[i + 2] * p32;
    for (int j = 0; j < 3; j++) M[i + j] = M[i + j] + first * R[3 * j] + second * R[3 * j + 1];
  }
}

/* f := h f - c K v, where the stress is a function of F R^T, and of L. */
INLINE void world_forces(const struct cb_elements *E, int policy, int exact, int ortho,
                         const T *rest, const T *R, const T *F, const T *L, T h, const T *e,
                         const T *w, const T *ev, T *f) {
  T Z[9], M[9], scale = -(h * rest[REST_FORCE]);
  world_strain(policy, rest, R, F, scale, e, ev, w, Z);
  stress(ortho, E->k, rest + REST_D, Z, M);
  if (exact) add_lower(R, scale, L, M);
  forces3(M, w, f);
}

INLINE void local_gradients(int policy, const T *rest, const T *e, const T *R, T *b) {
  if (policy == POLICY_PRECOMPUTED) {
    for (int i = 0; i < 9; i++) b[i] = rest[REST_G + i];
  } else {
    T w[9];
    world_gradients(policy, 0, 0, rest, e, R, w);
    for (int j = 0; j < 9; j += 3) apply3_transposed(R, w + j, b + j);
  }
}

#ifdef ANY_PACK
/* An isotropic pack with precomputed B and an exact gradient of any shape: by a call, from
 * the beginning, so that the usual pack holds nothing in registers for it. */
RARE void corotated_any(const struct cb_elements *E, const T *rest, const T *e, const T *own,
                        const T *ev, T h, T *memory, T *R, T *w, T *f) {
  T P[9], y[6], RP[9], Z[9] = {0}, turned[9], M[9];
  STAGE(STAGE_FRAME);
  ANY_PACK(E, POLICY_PRECOMPUTED, 1, 0, rest, e, own, memory, R, P, y);
  STAGE(STAGE_B);
  world_gradients(POLICY_PRECOMPUTED, SPARSE && in_own_order(E), NO_FRAME, rest, e, R, w);
  STAGE(STAGE_FORCE);
  if (ev)
    for (int i = 0; i < 9; i++)
      for (int j = 0; j < 9; j += 3) Z[i] = Z[i] - ev[j + i / 3] * w[j + i % 3];
  stress(0, E->k, rest, Z, M);
  multiply3(R, P, RP);
  multiply3_nt(RP, R, turned);
  for (int i = 0; i < 9; i++) M[i] = M[i] - h * rest[REST_FORCE] * turned[i];
  forces3(M, w, f);
}

INLINE void call_any(const struct cb_elements *E, const T *rest, const T *e, const T *own,
                     const T *ev, T h, T *memory, T *R, T *w, T *f) {
  T r[REST_ISOTROPIC], now[9], first[9], velocity[9], frame[9], gradients[9], force[9];
  for (int i = 0; i < REST_ISOTROPIC; i++) r[i] = rest[i];
  for (int i = 0; i < 9; i++) now[i] = e[i], first[i] = own[i], velocity[i] = ev ? ev[i] : LIT(0);
  corotated_any(E, r, now, first, ev ? velocity : NULL, h, memory, frame, gradients, force);
  for (int i = 0; i < 9; i++) R[i] = frame[i], w[i] = gradients[i], f[i] = force[i];
}
#endif

/* Gradients and force of one pack whose frame is there; world gradients. */
INLINE void corotated_forces(const struct cb_elements *E, int policy, int exact, int ortho,
                             const T *rest, const T *e, const T *ev, T h, T *memory, const T *R,
                             const T *F, const T *L, T *w, T *f) {
  (void)memory;
  STAGE(STAGE_B);
#ifdef LAZY
  lazy_gradients(E, rest, e, R, F, memory, w);
#else
  world_gradients(policy, SPARSE && in_own_order(E), NO_FRAME, rest, e, R, w);
#endif
  STAGE(STAGE_FORCE);
  world_forces(E, policy, exact, ortho, rest, R, F, L, h, e, w, ev, f);
}

/* Frame, gradients and force of one pack. Isotropic or frameless: w are world
 * gradients and R is not needed afterwards; orthotropic: w are local gradients. */
INLINE void corotated_pack(const struct cb_elements *E, int policy, int exact, int ortho,
                           const T *rest, const T *e, const T *own, const T *ev, T h, T *memory,
                           T *R, T *w, T *f) {
  if (NO_FRAME || !ortho) {
    T F[9], L[3];
    const bool done = FRAME_WORLD(E, policy, exact, ortho, 0, rest, e, own, memory, R, F, L);
#ifdef ANY_PACK
    if (exact && __builtin_expect(!done, 0)) {
      call_any(E, rest, e, own, ev, h, memory, R, w, f);
      return;
    }
#endif
    (void)done;
    corotated_forces(E, policy, exact, ortho, rest, e, ev, h, memory, R, F, L, w, f);
    return;
  }
  T P[9], y[6], q[9], p[9];
  FRAME_PACK(E, policy, exact, ortho, rest, e, own, memory, R, P, y);
  STAGE(STAGE_B);
  local_gradients(policy, rest, e, R, w);
  STAGE(STAGE_FORCE);
  if (ev)
    for (int j = 0; j < 9; j += 3) apply3_transposed(R, ev + j, q + j);
  absorb(rest, h, w, ev ? q : NULL, P);
  forces3(P, w, p);
  for (int j = 0; j < 9; j += 3) apply3(R, p + j, f + j);
}

typedef void corotated_pack_fn(const struct cb_elements *E, const T *rest, const T *e, const T *own,
                               const T *ev, T h, T *memory, T *R, T *w, T *f);

/* f := c K u where R = I, orthotropic. */
INLINE void frameless_product(const T *rest, const T *u, T *f) {
  T H[9], M[9];
  gradient3(u, rest + REST_G, H);
  stress(1, LIT(0), rest + REST_D, H, M);
  forces3(M, rest + REST_G, f);
}

/* ---- ebe: state w, or (orthotropic) R and, if it changes, b ----------------- */

#ifdef LAZY /* remembers what it has made: once only */
enum { QUICK = 0 };
#else
enum { QUICK = 1 };
#endif

INLINE void keep_nine(const T *w, T *state) {
  if (NO_FRAME) return; /* the rest gradients are the world gradients */
  for (int i = 0; i < 9; i++) state[i] = w[i];
}

/* Isotropic packs of a cluster: quick_packs_fn. */
INLINE bool corotated_quick(const struct cb_elements *E, int policy, int exact, size_t count,
                            const struct slot *slot, T h) {
  T F[FRAMES_AT_ONCE][9], R[FRAMES_AT_ONCE][9], L[FRAMES_AT_ONCE][3], w[9];
  bool done = true;
#ifdef FRAME_ROTATIONS
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) deformation_gradient(policy, slot[k].rest, slot[k].e, F[k]);
  done = FRAME_ROTATIONS(count, (const T(*)[9])F, R);
#else
  for (size_t k = 0; k < count; k++)
    done &= FRAME_WORLD(E, policy, exact, 0, QUICK, slot[k].rest, slot[k].e, slot[k].own,
                        slot[k].memory, R[k], F[k], L[k]);
#endif
#pragma GCC unroll 3
  for (size_t k = 0; k < count; k++) {
    const struct slot *s = slot + k;
    corotated_forces(E, policy, exact, 0, s->rest, s->e, s->ev, h, s->memory, R[k], F[k], L[k], w,
                     s->f);
    keep_nine(w, s->state);
  }
  return done;
}

INLINE void corotated_ebe(const struct cb_elements *E, corotated_pack_fn *pack, int policy,
                          int ortho, const T *rest, const T *e, const T *own, const T *ev, T h,
                          T *memory, T *state, T *f) {
  T R[9], w[9];
  pack(E, rest, e, own, ev, h, memory, R, w, f);
  keep_nine(ortho ? R : w, state);
  if (ortho && !NO_FRAME && policy != POLICY_PRECOMPUTED)
    for (int i = 0; i < 9; i++) state[9 + i] = w[i];
}

/* Orthotropic; the isotropic ones share cb_product_gradients. */
INLINE void corotated_ebe_product(const struct cb_elements *E, int policy, const T *rest,
                                  const T *state, const T *u, T *f) {
  (void)E;
  if (NO_FRAME)
    frameless_product(rest, u, f);
  else
    local_product(rest + REST_D, state, policy == POLICY_PRECOMPUTED ? rest + REST_G : state + 9, u,
                  f);
}

/* ---- ebe-matrix: edge products (isotropic) or blocks; assembled: gradients or
 * blocks ------------------------------------------------------------------------ */

INLINE void corotated_blocks(const struct cb_elements *E, corotated_pack_fn *pack, int ortho,
                             const T *rest, const T *e, const T *own, const T *ev, T h, T *memory,
                             T *X, T *f) {
  T R[9], w[9];
  pack(E, rest, e, own, ev, h, memory, R, w, f);
  STAGE(STAGE_ASSEMBLY);
  if (ortho)
    edge_blocks_local(rest + REST_D, R, w, X);
  else
    edge_products(w, X);
}

/* Isotropic: what is assembled are gradients. */
INLINE void corotated_gradients(const struct cb_elements *E, corotated_pack_fn *pack, const T *rest,
                                const T *e, const T *own, const T *ev, T h, T *memory, T *w, T *f) {
  T R[9];
  pack(E, rest, e, own, ev, h, memory, R, w, f);
}

/* ---- ebe-paper: state R, and B if it changes; D apart ---------------------- */

/* B of one pack: computed, or from the rest data. Includes a's row. */
INLINE const T *paper_b(int policy, int ortho, const T *rest, const T *state) {
  if (policy != POLICY_PRECOMPUTED) return state + 9;
  return rest + (ortho ? REST_ORTHOTROPIC : REST_ISOTROPIC);
}

INLINE void corotated_paper(const struct cb_elements *E, int policy, int exact, int ortho,
                            const T *rest, const T *e, const T *own, const T *ev, T h, T *memory,
                            T *state, T *f) {
  T *R = state, P[9], y[6], out[12];
  FRAME_PACK(E, policy, exact, ortho, rest, e, own, memory, R, P, y);
  STAGE(STAGE_B);
#ifdef LAZY
  T F[9];
  deformation_gradient(policy, rest, e, F);
  const bool makes = ANY(lazy_moved(E, R, F, memory));
#else
  const bool makes = policy != POLICY_PRECOMPUTED;
#endif
  if (makes) {
    if (SPARSE)
      paper_b_qr(policy == POLICY_UPDATED_VOLUME, rest[REST_W], y, state + 9);
    else
      paper_b_classic(policy == POLICY_UPDATED_VOLUME, rest[REST_W], R, e, state + 9);
  }
  const T *B = paper_b(policy, ortho, rest, state);
  STAGE(STAGE_FORCE);
  T scale = h * rest[REST_FORCE];
  for (int i = 0; i < 9; i++) P[i] = scale * P[i];
  if (ev) {
    T u[12] = {LIT(0), LIT(0), LIT(0)}, N[9];
    for (int i = 0; i < 9; i++) u[3 + i] = ev[i];
    paper_stress(SPARSE, ortho, E->k, rest + REST_D, R, B, u, N);
    for (int i = 0; i < 9; i++) P[i] = P[i] + N[i];
  }
  paper_forces(SPARSE, 1, R, B, P, out);
  for (int i = 0; i < 9; i++) f[i] = -out[3 + i];
}

INLINE void corotated_paper_product(const struct cb_elements *E, int policy, int ortho,
                                    const T *rest, const T *state, const T *u, T *f) {
  T P[9];
  const T *B = paper_b(policy, ortho, rest, state);
  paper_stress(SPARSE, ortho, E->k, rest + REST_D, state, B, u, P);
  paper_forces(SPARSE, 0, state, B, P, f);
}

#include "kernels/models/corotated_forms.h"
