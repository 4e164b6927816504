/* polar_exact.c - polar frame, rest B, true gradient of the energy. For an
 * isotropic material that is the usual method; for an orthotropic one the usual
 * method drops how R turns with x, and makes a ghost torque.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/frames/polar_closed.h"
#include "kernels/models/strain.h"

/* P := P - [w]x, (tr(S) I - S) w = axial(P S - S P), S = R^T F: then R P is the
 * gradient of W(S): w stands for how R turns with F. Bounded where R may jump, the sum of
 * two stretches being a thousandth or less: W jumps there too. */
INLINE void polar_gradient(const T *S_, T *P) {
  T A[9], G[9], C[9], w[3];
  multiply3(P, S_, A);
  T a[3] = {A[7] - A[5], A[2] - A[6], A[3] - A[1]};
  T trace = S_[0] + S_[4] + S_[8];
  for (int i = 0; i < 9; i++) G[i] = i % 4 == 0 ? trace - S_[i] : -S_[i];
  cofactor3(G, C);
  T det = dot3(G, C), least = LIT(1e-3) * (ABS(C[0]) + ABS(C[4]) + ABS(C[8])) + LIT(1e-30);
  T inverse = LIT(1) / SELECT(det > least, det, least);
  for (int i = 0; i < 3; i++) a[i] = inverse * a[i]; /* first: C a may be beyond float */
  apply3_transposed(C, a, w);
  P[1] = P[1] + w[2], P[3] = P[3] - w[2];
  P[6] = P[6] + w[1], P[2] = P[2] - w[1];
  P[5] = P[5] + w[0], P[7] = P[7] - w[0];
}

INLINE void polar_exact_pack(const struct cb_elements *E, int policy, int exact, int ortho,
                             const T *rest, const T *e, const T *own, T *memory, T *R, T *P, T *y) {
  T F[9], stretch[9];
  (void)exact, (void)own, (void)memory, (void)y;
  deformation_gradient(policy, rest, e, F);
  frame_polar_closed(F, R);
  STAGE(STAGE_FORCE);
  corotated_stress(E->k, rest, ortho, R, F, stretch, P);
  if (!ortho) return;
  for (int i = 0; i < 9; i += 4) stretch[i] = stretch[i] + LIT(1);
  polar_gradient(stretch, P);
}

#define SPARSE 0
#define NO_FRAME 0
#define FRAME_ROTATION(e, F, memory, R) frame_polar_closed(F, R)
#if CB_LANES > 1
#define FRAMES_AT_ONCE CLOSED_AT_ONCE
#define FRAME_ROTATIONS(count, F, R) frames_polar_closed(count, F, R)
#endif
#define FRAME_PACK polar_exact_pack
#include "kernels/models/corotated.h"

#define LAWS (LAWS_ELEMENT | LAWS_EULER | LAWS_ENERGY | LAWS_ORDER)

COROTATED_MODEL(polar_exact, "polar-exact", "polar frame, rest B, true gradient of the energy",
                "this project; frame of Hoger & Carlson 1984", POLICY_PRECOMPUTED, AXES_WORLD, 0, 0,
                LAWS, LAWS)
