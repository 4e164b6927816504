/* test_iterations.c - the fixed iteration counts of the frames are the smallest
 * that reach rounding. In quad precision nothing but the missing iterations is
 * left as an error; it is given in units of what one rounding of F in the
 * precision that iterates so often does to the frame, roundoff s_1/(s_2 + s_3).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/families.h"
#include "tests/variants.h"

/* The counts as shipped, then variables in their place. */
#include "kernels/frames/iterations.h"
struct counts {
  int scaled, plain, newton, turns, rough;
};
#define SHIPPED(precision)                                                                         \
  {                                                                                                \
    HIGHAM_SCALED_##precision, HIGHAM_PLAIN_##precision, CLOSED_NEWTON_##precision,                \
        JACOBI_TURNS_##precision, JACOBI_ROUGH_##precision                                         \
  }
static const struct precision {
  const char *name;
  double roundoff;
  struct counts counts;
} precisions[] = {{"float", 0x1p-24, SHIPPED(FLOAT)}, {"double", 0x1p-53, SHIPPED(DOUBLE)}};
/* Estimates are off by that much: ROUGH_SQRT, ROUGH_INVERSE. */
static const double ROUGH = 0x1p-11;
enum { PRECISIONS = sizeof precisions / sizeof *precisions };
static struct counts now;
static int quaternion_turns;
static double rough;
#undef HIGHAM_SCALED
#undef HIGHAM_PLAIN
#undef CLOSED_NEWTON
#undef JACOBI_TURNS
#undef JACOBI_ROUGH
#undef QUATERNION_TURNS
#define HIGHAM_SCALED now.scaled
#define HIGHAM_PLAIN now.plain
#define CLOSED_NEWTON now.newton
#define JACOBI_TURNS now.turns
#define JACOBI_ROUGH now.rough
#define QUATERNION_TURNS quaternion_turns

#define CB_SCALAR __float128
#define CB_LANES 1
#define CB_SUFFIX iterations
#define CB_COUNTED
#include "kernels/arithmetic.h"
#define ROUGH_SQRT(a) (SQRT(a) * (1 + (T)rough))
#define ROUGH_INVERSE(a) ((1 + (T)rough) / (a))
#include "kernels/frames/polar_closed.h"
#include "kernels/frames/polar_eigen.h"
#include "kernels/frames/polar_higham.h"
#include "kernels/frames/polar_quaternion.h"
#include "kernels/frames/svd.h"

enum { TRIALS = 300 };
static const struct counts MANY = {10, 10, 10, 30, 0};

typedef void frame_fn(const T *F, T *R);
static void orthogonal(const T *F, T *R) { orthogonal_higham(F, R); }
static void higham(const T *F, T *R) { frame_polar_higham(F, R); }
static void closed_orthogonal(const T *F, T *R) { orthogonal_closed(F, R); }
static void closed(const T *F, T *R) { frame_polar_closed(F, R); }
static void eigen(const T *F, T *R) { frame_polar_eigen(F, R); }
static void svd(const T *F, T *R) { frame_svd(F, R); }

/* Worst difference between so many iterations and many, in units of what a
 * rounding of F does. */
static double missing(enum family family, frame_fn *frame, const struct precision *p,
                      struct counts counts) {
  gsl_rng *rng = scene_rng();
  double worst = 0;
  for (int t = 0; t < TRIALS; t++) {
    double F[9], singular[3];
    T f[9], R[9], exact[9];
    random_gradient(rng, family, F, singular);
    for (int i = 0; i < 9; i++) f[i] = F[i];
    now = MANY, rough = 0;
    frame(f, exact);
    now = counts, rough = ROUGH;
    frame(f, R);
    double unit = p->roundoff * singular[0] / (singular[1] + fabs(singular[2]));
    double error = quad_distance(9, R, exact) / unit;
    if (!(error <= worst)) worst = error;
  }
  gsl_rng_free(rng);
  return worst;
}

/* The worst family; each one's error is printed. */
static double table(const char *name, frame_fn *frame, const struct precision *p, struct counts c) {
  double worst = 0;
  print_message("# %s, %s, %d scaled, %d plain, %d newton, %d turns:", name, p->name, c.scaled,
                c.plain, c.newton, c.turns);
  for (int family = 0; family < FAMILIES; family++) {
    double error = missing((enum family)family, frame, p, c);
    print_message(" %s %.1e", family_name[family], error);
    if (!(error <= worst)) worst = error;
  }
  print_message("\n");
  return worst;
}

static void higham_counts_are_the_smallest(void **state) {
  (void)state;
  for (const struct precision *p = precisions; p < precisions + PRECISIONS; p++) {
    struct counts c = p->counts, a = c, b = c;
    assert_within(p->name, table("higham", orthogonal, p, c), 1);
    a.scaled--, b.plain--;
    assert_true(table("higham", orthogonal, p, a) > 1);
    assert_true(table("higham", orthogonal, p, b) > 1);
    a.plain++;
    assert_true(table("higham", orthogonal, p, a) > 1);
  }
}

static void closed_counts_are_the_smallest(void **state) {
  (void)state;
  for (const struct precision *p = precisions; p < precisions + PRECISIONS; p++) {
    struct counts c = p->counts;
    assert_within(p->name, table("closed", closed_orthogonal, p, c), 1);
    c.newton--;
    assert_true(table("closed", closed_orthogonal, p, c) > 1);
  }
}

static void turns_are_the_fewest(void **state) {
  (void)state;
  for (const struct precision *p = precisions; p < precisions + PRECISIONS; p++) {
    struct counts c = p->counts;
    assert_within("svd", table("svd", svd, p, c), 1);
    assert_within("eigen", table("eigen", eigen, p, c), 1);
    assert_within("higham", table("higham, det R = 1", higham, p, c), 1);
    assert_within("closed", table("closed, det R = 1", closed, p, c), 1);
    c.turns--;
    assert_true(table("svd", svd, p, c) > 1);
    assert_true(table("eigen", eigen, p, c) > 1);
    if (p->counts.rough >= p->counts.turns) continue;
    c = p->counts, c.rough++;
    assert_true(table("svd, one more by estimates", svd, p, c) > 1);
    assert_true(table("eigen, one more by estimates", eigen, p, c) > 1);
  }
}

/* From a small angle off, one turn leaves between s_3/(s_1 + s_2 + s_3) and
 * s_1/(s_1 + s_2 + s_3) of it. */
static void a_turn_divides_the_angle(void **state) {
  (void)state;
  gsl_rng *rng = scene_rng();
  const double angle = 1e-9;
  for (int t = 0; t < TRIALS; t++) {
    double F[9], s[3], axis[3];
    T f[9], R[9], Q[9], q[4];
    random_gradient(rng, t % 2 ? TURNED : STRETCHED, F, s);
    random_vector(rng, 3, axis);
    for (int i = 0; i < 9; i++) f[i] = F[i];
    now = MANY, rough = 0;
    frame_polar_higham(f, R);
    quaternion_from(R, q);
    /* q (1, angle/2 axis): about an axis in the undeformed shape */
    T x = angle / 2 / norm(3, axis) * (quad)axis[0], y = angle / 2 / norm(3, axis) * (quad)axis[1];
    T z = angle / 2 / norm(3, axis) * (quad)axis[2], w = q[0];
    T start[4] = {w - q[1] * x - q[2] * y - q[3] * z, q[1] + w * x + q[2] * z - q[3] * y,
                  q[2] + w * y + q[3] * x - q[1] * z, q[3] + w * z + q[1] * y - q[2] * x};
    T length =
        SQRT(start[0] * start[0] + start[1] * start[1] + start[2] * start[2] + start[3] * start[3]);
    for (int i = 0; i < 4; i++) start[i] /= length;
    quaternion_turns = 1;
    frame_polar_quaternion(f, start, Q);
    /* |Q - R| = sqrt(2) angle for small angles */
    double left = quad_distance(9, Q, R) / sqrt(2) / angle, trace = s[0] + s[1] + s[2];
    assert_within("most that is left", left, s[0] / trace + 1e-7);
    assert_within("least that is left", s[2] / trace - 1e-7, left);
  }
  gsl_rng_free(rng);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(higham_counts_are_the_smallest),
      cmocka_unit_test(closed_counts_are_the_smallest),
      cmocka_unit_test(turns_are_the_fewest),
      cmocka_unit_test(a_turn_divides_the_angle),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
