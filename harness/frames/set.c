/* set.c - the inputs, group by group, and their exact answers.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <float.h>
#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/table.h"
#include "harness/frames/frames.h"

/* ---- matrices -------------------------------------------------------------------------- */

/* Q := rotation by that angle (rad) about the axis, which need not be of length 1. */
static void rotation(const double axis[3], double angle, double Q[9]) {
  const double l = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
  const double n[3] = {axis[0] / l, axis[1] / l, axis[2] / l}, c = cos(angle), s = sin(angle);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      const int k = 3 - i - j;
      const double skew = i == j ? 0 : (j == (i + 1) % 3 ? -1 : 1) * n[k];
      Q[3 * i + j] = (i == j) * c + (1 - c) * n[i] * n[j] + s * skew;
    }
}

static void random_rotation(gsl_rng *rng, double Q[9]) {
  double axis[3];
  gsl_ran_dir_3d(rng, axis, axis + 1, axis + 2);
  rotation(axis, gsl_ran_flat(rng, 0, 2 * M_PI), Q);
}

/* F := U diag(a, b, c) V^T; turned: U, V any rotations, else F is that diagonal itself, with
 * its axes exchanged. */
static void of_values(gsl_rng *rng, bool turned, double a, double b, double c, double F[9]) {
  const double s[3] = {a, b, c};
  double U[9], V[9];
  if (!turned) {
    const size_t first = gsl_rng_uniform_int(rng, 3);
    for (size_t i = 0; i < 9; i++) F[i] = 0;
    for (size_t i = 0; i < 3; i++) F[4 * ((i + first) % 3)] = s[i];
    return;
  }
  random_rotation(rng, U);
  random_rotation(rng, V);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      F[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) F[3 * i + j] += s[k] * U[3 * i + k] * V[3 * j + k];
    }
}

static double between(gsl_rng *rng, double low, double high) {
  return exp(gsl_ran_flat(rng, log(low), log(high)));
}
static double power(size_t n, size_t count) { return pow(10, -1.0 - (double)(n % count)); }

/* ---- groups: input n of a group ---------------------------------------------------------- */

static void near_identity(gsl_rng *rng, size_t n, double F[9]) {
  const double strain = n < 4 ? 0 : power(n / 4, 16);
  for (int i = 0; i < 9; i++) F[i] = (i % 4 == 0) + strain * gsl_ran_gaussian(rng, 1);
  if (n % 4 == 3) /* the same along all axes: 1 + 10^-k */
    for (int i = 0; i < 9; i++) F[i] = (i % 4 == 0) * (1 + strain);
}

static void rotations(gsl_rng *rng, size_t n, double F[9]) {
  double axis[3];
  if (n < 24) { /* those of the cube: quarter and half turns without any rounding */
    static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                    {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
    const int *p = order[n % 6], odd = n % 6 > 2;
    const int x = n / 6 % 2 ? -1 : 1, y = n / 12 ? -1 : 1, z = (odd ? -1 : 1) * x * y;
    memset(F, 0, 9 * sizeof *F);
    F[p[0]] = x, F[3 + p[1]] = y, F[6 + p[2]] = z;
    return;
  }
  gsl_ran_dir_3d(rng, axis, axis + 1, axis + 2);
  if (n % 4 == 0)
    rotation(axis, M_PI, F);
  else if (n % 4 == 1)
    rotation(axis, M_PI - power(n / 4, 16) * M_PI / 180, F);
  else if (n % 4 == 2)
    rotation(axis, power(n / 4, 16) * M_PI / 180, F);
  else
    random_rotation(rng, F);
}

static void any(gsl_rng *rng, size_t n, double F[9]) {
  (void)n;
  for (int i = 0; i < 9; i++) F[i] = gsl_ran_gaussian(rng, 1);
}

static void stretched(gsl_rng *rng, size_t n, double F[9]) {
  of_values(rng, n % 4 != 0, between(rng, 0.05, 20), between(rng, 0.05, 20), between(rng, 0.05, 20),
            F);
}

static void ties(gsl_rng *rng, size_t n, double F[9]) {
  const double e = power(n / 8, 8);
  const double s[4][3] = {{1, 1, 1}, {1, 1, e}, {1, e, e}, {e, e, e}};
  of_values(rng, n / 4 % 2, s[n % 4][0], s[n % 4][1], s[n % 4][2], F);
}

static void flat(gsl_rng *rng, size_t n, double F[9]) {
  if (n % 3 == 0) { /* of rank 2 exactly: a column is made of the other two */
    for (int i = 0; i < 9; i += 3) {
      F[i] = (double)gsl_rng_uniform_int(rng, 17) - 8;
      F[i + 1] = (double)gsl_rng_uniform_int(rng, 17) - 8;
      F[i + 2] = F[i] - 2 * F[i + 1];
    }
    return;
  }
  of_values(rng, n % 3 == 2, between(rng, 0.5, 2), 1, n % 2 ? 0 : power(n / 6, 16), F);
}

static void line(gsl_rng *rng, size_t n, double F[9]) {
  const double e = n % 2 ? 0 : power(n / 6, 16);
  double a[3], b[3];
  of_values(rng, n % 3 == 2, 1, e * between(rng, 0.1, 1), e * between(rng, 0.1, 1), F);
  if (n % 3) return;
  for (int i = 0; i < 3; i++) { /* of rank 1 exactly */
    a[i] = (double)gsl_rng_uniform_int(rng, 17) - 8.5;
    b[i] = (double)gsl_rng_uniform_int(rng, 17) - 8.5;
  }
  for (int i = 0; i < 9; i++) F[i] = a[i / 3] * b[i % 3];
}

static void point(gsl_rng *rng, size_t n, double F[9]) {
  (void)rng;
  for (int i = 0; i < 9; i++) F[i] = n % 2 ? -0.0 : 0;
}

static void inverted(gsl_rng *rng, size_t n, double F[9]) {
  const double c = between(rng, 0.05, 1);
  of_values(rng, n % 4 != 0, c * between(rng, 1.2, 10), c * between(rng, 1.2, 10), -c, F);
}

/* The two smallest singular values alike, and det F < 0: many rotations are the nearest. */
static void mirrored(gsl_rng *rng, size_t n, double F[9]) {
  const double a = n % 3 ? between(rng, 1, 4) : 1;
  of_values(rng, n % 4 != 0, n % 5 ? a : -a, 1, n % 5 ? -1 : 1, F);
}

static void needles(gsl_rng *rng, size_t n, double F[9]) {
  const double e = power(n / 2, 6);
  of_values(rng, n % 8 != 0, 1, e, (n % 2 ? 1 : 0.1) * e * between(rng, 0.1, 0.9), F);
}

static void scales(gsl_rng *rng, size_t n, double F[9]) {
  const double scale = pow(10, (double)(n % 25) - 12);
  for (int i = 0; i < 9; i++)
    F[i] = scale * ((i % 4 == 0) * (n % 2 ? 1 : -1) + gsl_ran_gaussian(rng, 0.5));
}

static const struct {
  const char *name, *about;
  void (*make)(gsl_rng *rng, size_t n, double F[9]);
  size_t count;
} groups[CB_FRAME_GROUPS] = {
    {"near-identity", "I, I (1 + 10^-k), I + 10^-k N, N normal, k = 1 to 16", near_identity, 200},
    {"rotations", "of the cube, exactly; by 180, 180 - 10^-k, 10^-k and any degrees", rotations,
     200},
    {"random", "entries normal, det F of either sign", any, 200},
    {"stretched", "singular values from 1/20 to 20, turned in any way", stretched, 200},
    {"ties", "singular values 1 1 1, 1 1 e, 1 e e, e e e, e = 10^-1 to 10^-8", ties, 200},
    {"flat", "rank 2, exactly and to 10^-k", flat, 200},
    {"line", "rank 1, exactly and to 10^-k", line, 200},
    {"point", "all zero", point, 2},
    {"inverted", "det F < 0, the smallest singular value apart from the others", inverted, 200},
    {"mirrored", "det F < 0, the two smallest alike: no unique answer", mirrored, 200},
    {"needles", "singular values 1, e, less than e, e = 10^-1 to 10^-6", needles, 200},
    {"scales", "det F of either sign, values from 10^-12 to 10^12", scales, 200}};

/* ---- the set ------------------------------------------------------------------------------ */

static void complete(struct cb_frame_set *set, struct cb_frame_input *input) {
  const double known = 0x1p-10; /* three digits */
  if (set->scalar_bytes == sizeof(float))
    for (int i = 0; i < 9; i++) input->F[i] = (float)input->F[i];
  (set->kind == CB_FRAME_QR ? cb_exact_qr : cb_exact_polar)(input->F, &input->exact);
  input->unique = set->roundoff * input->exact.condition <= known;
}

enum cb_status cb_frame_set_create(enum cb_frame_kind kind, size_t scalar_bytes, unsigned long seed,
                                   struct cb_frame_set *set) {
  struct cb_frame_set made = {.kind = kind, .scalar_bytes = scalar_bytes};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  made.roundoff = scalar_bytes == sizeof(float) ? 0x1p-24 : 0x1p-53;
  for (size_t g = 0; g < CB_FRAME_GROUPS; g++) {
    made.group[g] =
        (struct cb_frame_group){groups[g].name, groups[g].about, made.count, groups[g].count};
    made.count += groups[g].count;
  }
  made.input = calloc(made.count, sizeof *made.input);
  if (!rng || !made.input) {
    if (rng) gsl_rng_free(rng);
    free(made.input);
    return cb_fail_memory("the conformance set");
  }
  gsl_rng_set(rng, seed);
  for (size_t g = 0; g < CB_FRAME_GROUPS; g++)
    for (size_t n = 0; n < groups[g].count; n++) {
      struct cb_frame_input *input = &made.input[made.group[g].first + n];
      groups[g].make(rng, n, input->F);
      complete(&made, input);
    }
  gsl_rng_free(rng);
  *set = made;
  return CB_OK;
}

void cb_frame_set_free(struct cb_frame_set *set) {
  free(set->input);
  *set = (struct cb_frame_set){0};
}

struct cb_table *cb_frame_set_table(const struct cb_frame_set *set) {
  const bool polar = set->kind == CB_FRAME_POLAR;
  struct cb_table *t = cb_table_create(
      "group,unique,condition,largest,F11,F12,F13,F21,F22,F23,F31,F32,F33,R11,R12,R13,R21,R22,R23,"
      "R31,R32,R33");
  for (size_t g = 0; t && g < CB_FRAME_GROUPS; g++)
    for (size_t n = 0; n < set->group[g].count; n++) {
      const struct cb_frame_input *input = &set->input[set->group[g].first + n];
      const struct cb_exact_frame *exact = &input->exact;
      cb_table_text(t, set->group[g].name);
      cb_table_text(t, input->unique ? "yes" : "no");
      if (isfinite(exact->condition))
        cb_table_number(t, exact->condition);
      else
        cb_table_missing(t);
      if (polar)
        cb_table_number(t, (double)(exact->s[0] + exact->s[1] + exact->s[2]));
      else
        cb_table_missing(t);
      for (int i = 0; i < 9; i++) cb_table_number(t, input->F[i]);
      for (int i = 0; i < 9; i++)
        if (input->unique)
          cb_table_number(t, (double)exact->R[i]);
        else
          cb_table_missing(t);
    }
  return t;
}
