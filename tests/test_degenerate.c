/* test_degenerate.c - the frames of every finite deformation gradient, in each
 * arithmetic: rotations to rounding, and the nearest ones wherever that is defined.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "tests/element.h"
#include "tests/families.h"

/* Roundings: of R R^T - I and det R - 1, measured at most 220, of Gram-Schmidt on edges at
 * 1 : 32, others 31; of R times the condition, measured at most 240, of a needle of
 * 1000 : 1 by higham in double, others 100. */
static const double ORTHOGONAL = 500, NEAREST = 1000;
enum { FIRST = -12, LAST = 12, BATCH = 64, CODES = 19683 };

/* ---- every frame there is -------------------------------------------------------- */

/* The three policies of a family share its frame. */
static bool is_the_same(const char *name) {
  return strstr(name, "-updated") || strcmp(name, "polar-tangent-clamped") == 0;
}
static bool reflects(const char *name) { return strstr(name, "reflected") != NULL; }
static bool is_qr(const char *name) { return strncmp(name, "qr", 2) == 0; }

/* What went wrong with one frame in one arithmetic; to be printed with its worst. */
struct tally {
  const struct cb_arithmetic *a;
  const struct cb_model *model;
  size_t lost;                /* not finite */
  double orthogonal, nearest; /* roundings */
};

typedef void each_fn(gsl_rng *rng, struct tally *t);

static void for_each_frame(const char *what, each_fn *each) {
  size_t frames = 0, lost = 0;
  double orthogonal = 0, nearest = 0;
  for (const struct cb_arithmetic *const *a = cb_arithmetics; *a; a++)
    for (const struct cb_model *const *m = (*a)->models; *m; m++) {
      if (!(*m)->frame || is_the_same((*m)->name)) continue;
      if ((*a)->scalar_bytes == sizeof(quad) || !cb_arithmetic_runs(*a)) continue;
      gsl_rng *rng = scene_rng();
      struct tally t = {.a = *a, .model = *m};
      each(rng, &t);
      gsl_rng_free(rng);
      print_message("# %s, %s, %s: %zu not finite, orthogonal to %.2g, off by %.2g\n", what,
                    (*m)->name, (*a)->name, t.lost, t.orthogonal, t.nearest);
      frames++, lost += t.lost;
      orthogonal = fmax(orthogonal, t.orthogonal), nearest = fmax(nearest, t.nearest);
    }
  assert_true(frames >= 2 * 12); /* f64 and f32 at least */
  assert_int_equal(lost, 0);
  assert_within(what, orthogonal, ORTHOGONAL);
  assert_within(what, nearest, NEAREST);
}

/* R[9*count] := frames of F, which is rounded to what the arithmetic takes. */
static void frames_of(const struct tally *t, size_t count, double *F, double *R) {
  float f[9 * BATCH], r[9 * BATCH];
  assert_true(count <= BATCH);
  if (t->a->scalar_bytes == sizeof(double)) {
    t->model->frame(count, F, R);
    return;
  }
  for (size_t i = 0; i < 9 * count; i++) F[i] = f[i] = (float)F[i];
  t->model->frame(count, f, r);
  for (size_t i = 0; i < 9 * count; i++) R[i] = (double)r[i];
}

static void is_rotation(struct tally *t, const double *R) {
  double RR[9], det = determinant3(R);
  product3_nt(R, R, RR);
  for (int i = 0; i < 9; i += 4) RR[i] -= 1;
  if (reflects(t->model->name)) det = fabs(det);
  double off = fmax(norm(9, RR), fabs(det - 1)) / t->a->roundoff;
  if (!isfinite(off))
    t->lost++;
  else
    t->orthogonal = fmax(t->orthogonal, off);
}

static void is_near(struct tally *t, const double *R, const double *exact, double condition) {
  double unit = condition * t->a->roundoff;
  if (!(unit < 0.01)) return; /* rounding of F moves it anywhere */
  double off = distance(9, R, exact) / unit;
  if (isfinite(off)) t->nearest = fmax(t->nearest, off);
}

/* ---- singular values over 24 orders of magnitude, in all orders --------------------- */

/* One matrix of given singular values, its nearest rotation, and by how much of a rounding
 * that moves: s_1 / (s_2 + s_3), s_3 signed; and s_1 / s_2 times that by eigenvectors. */
struct given {
  double R[9], condition;
};

static void given_values(gsl_rng *rng, const struct tally *t, double s[3], bool inverted, double *F,
                         struct given *g) {
  double U[9], V[9], turned[9];
  int least = 0, most = 0;
  for (int i = 1; i < 3; i++)
    if (s[i] < s[least]) least = i;
  for (int i = 0; i < 3; i++)
    if (i != least && (most == least || s[i] > s[most])) most = i;
  double middle = s[3 - least - most];
  if (inverted) s[least] = -s[least];
  random_rotation(rng, U);
  random_rotation(rng, V);
  for (int i = 0; i < 9; i++) turned[i] = U[i] * s[i % 3];
  product3_nt(turned, V, F);
  g->condition = s[most] / (middle + s[least]);
  if (strncmp(t->model->name, "polar-eigen", 11) == 0) g->condition *= s[most] / middle;
  if (reflects(t->model->name)) { /* U diag(+-1) V^T, which moves less, if det F has a sign */
    g->condition = s[most] / (middle + fabs(s[least]));
    if (fabs(s[least]) < 100 * t->a->roundoff * s[most]) g->condition = INFINITY;
    for (int i = least; inverted && i < 9; i += 3) U[i] = -U[i];
  }
  product3_nt(U, V, g->R);
}

/* Edges e_b, e_c, e_d are the columns of F, as rounded. */
static void given_edges(const double *F, struct given *g) {
  quad e[9], Q[9];
  double along = 0, b = 0, c = 0;
  for (int i = 0; i < 9; i++) e[i] = F[i];
  q_gram_schmidt(e, Q);
  for (int i = 0; i < 9; i++) g->R[i] = (double)Q[i];
  for (int i = 0; i < 9; i += 3)
    along += g->R[i + 1] * F[i + 1], b += F[i] * F[i], c += F[i + 1] * F[i + 1];
  g->condition = b > 0 && along > 0 ? 1 + sqrt(c) / along : INFINITY;
}

static void all_values(gsl_rng *rng, struct tally *t) {
  double F[9 * BATCH], R[9 * BATCH];
  struct given g[BATCH];
  size_t count = 0;
  const int side = LAST - FIRST + 1, all = 2 * side * side * side;
  for (int n = 0; n < all; n++) {
    double s[3] = {pow(10, n / 2 % side + FIRST), pow(10, n / 2 / side % side + FIRST),
                   pow(10, n / 2 / side / side + FIRST)};
    given_values(rng, t, s, n % 2, F + 9 * count, &g[count]);
    if (++count < BATCH && n + 1 < all) continue;
    frames_of(t, count, F, R);
    for (size_t i = 0; i < count; i++) {
      if (is_qr(t->model->name)) given_edges(F + 9 * i, &g[i]);
      is_rotation(t, R + 9 * i);
      is_near(t, R + 9 * i, g[i].R, g[i].condition);
    }
    count = 0;
  }
}

static void frames_of_all_singular_values(void **state) {
  (void)state;
  for_each_frame("values", all_values);
}

/* ---- small whole numbers: every rank, permutation, tie and half turn ------------------ */

static void all_codes(gsl_rng *rng, struct tally *t) {
  static const double scale[] = {1, 1e-12, 1e12, 1e-18, 1e18, 3e-40, 1e30};
  double F[9 * BATCH], R[9 * BATCH];
  size_t count = 0;
  (void)rng;
  for (size_t k = 0; k < sizeof scale / sizeof *scale; k++)
    for (int code = 0; code < CODES; code += k == 0 ? 1 : 13) {
      for (int i = 0, rest = code; i < 9; i++, rest /= 3)
        F[9 * count + (size_t)i] = scale[k] * (rest % 3 - 1);
      if (++count < BATCH && code + 13 < CODES) continue;
      frames_of(t, count, F, R);
      for (size_t i = 0; i < count; i++) is_rotation(t, R + 9 * i);
      count = 0;
    }
}

static void frames_of_any_rank(void **state) {
  (void)state;
  for_each_frame("ranks", all_codes);
}

/* ---- rotations --------------------------------------------------------------------- */

/* R := turn about the unit vector n. */
static void turn_about(const double *n, double angle, double *R) {
  double c = cos(angle), s = sin(angle);
  for (int i = 0; i < 9; i++) R[i] = (1 - c) * n[i / 3] * n[i % 3] + (i % 4 == 0 ? c : 0);
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    R[3 * k + j] += s * n[i], R[3 * j + k] -= s * n[i];
  }
}

/* By 0, 90, 180 and 180 - 10^-k degrees, about any axis and those of the world. */
static void all_rotations(gsl_rng *rng, struct tally *t) {
  for (int trial = 0; trial < 40; trial++)
    for (int k = -3; k < 15; k++) {
      double axis[3] = {trial == 0, trial == 1, trial == 2}, F[9], R[9];
      if (trial > 2) random_vector(rng, 3, axis);
      double length = norm(3, axis), degrees = k < 0 ? 90 * (k + 3) : 180 - pow(10, -k);
      for (int i = 0; i < 3; i++) axis[i] /= length;
      turn_about(axis, degrees * M_PI / 180, F);
      frames_of(t, 1, F, R);
      is_rotation(t, R);
      is_near(t, R, F, 1);
    }
}

static void rotations_are_their_own_frames(void **state) {
  (void)state;
  for_each_frame("rotations", all_rotations);
}

/* ---- where the nearest rotation is not unique -------------------------------------------- */

/* F = u p^T, rank 1: p goes to u, by the turn of least angle, of trace 1 + 2 u.p. Rank 0: I. */
static void one_direction(gsl_rng *rng, struct tally *t) {
  if (is_qr(t->model->name)) return;
  for (int trial = 0; trial < 200; trial++) {
    double u[3], p[3], F[9], R[9], along = 0, image[3];
    random_vector(rng, 3, u);
    random_vector(rng, 3, p);
    double lu = norm(3, u), lp = norm(3, p), size = pow(10, trial % 25 - 12);
    for (int i = 0; i < 3; i++) u[i] /= lu, p[i] /= lp, along += u[i] * p[i];
    if (along < -0.9) continue; /* the angle of a half turn is a square root's */
    for (int i = 0; i < 9; i++) F[i] = trial ? size * u[i / 3] * p[i % 3] : 0;
    frames_of(t, 1, F, R);
    is_rotation(t, R);
    for (int i = 0; i < 3; i++)
      image[i] = R[3 * i] * p[0] + R[3 * i + 1] * p[1] + R[3 * i + 2] * p[2];
    double trace = R[0] + R[4] + R[8];
    double off = fmax(distance(3, image, u), fabs(trace - 1 - 2 * along));
    if (trial == 0) off = fabs(trace - 3);
    t->nearest = fmax(t->nearest, off / t->a->roundoff);
  }
}

static void a_line_turns_least(void **state) {
  (void)state;
  for_each_frame("lines", one_direction);
}

/* A collapsed edge is put where the element is right-handed: z_d > 0. */
static void collapsed_edges_are_right_handed(gsl_rng *rng, struct tally *t) {
  if (!is_qr(t->model->name)) return;
  for (int trial = 0; trial < 200; trial++) {
    double F[9], R[9], zd = 0;
    random_vector(rng, 9, F);
    for (int i = 0; i < 9; i += 3) {
      if (trial % 2 == 0) F[i] = 0;            /* b = a */
      if (trial % 2 == 1) F[i + 1] = 2 * F[i]; /* c along b */
      if (trial % 4 == 3) F[i + 1] = 0;        /* c = a */
    }
    frames_of(t, 1, F, R);
    is_rotation(t, R);
    for (int i = 0; i < 9; i += 3) zd += R[i + 2] * F[i + 2];
    if (!(zd > 0)) t->lost++;
  }
}

static void gram_schmidt_goes_on_right_handed(void **state) {
  (void)state;
  for_each_frame("collapsed", collapsed_edges_are_right_handed);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(frames_of_all_singular_values),     cmocka_unit_test(frames_of_any_rank),
      cmocka_unit_test(rotations_are_their_own_frames),    cmocka_unit_test(a_line_turns_least),
      cmocka_unit_test(gram_schmidt_goes_on_right_handed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
