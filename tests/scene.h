/* scene.h - random meshes, shapes and materials for the tests of kernels/, and
 * how much rounding a shape amplifies.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_TESTS_SCENE_H
#define CB_TESTS_SCENE_H

#include "tests/vectors.h"

#include <gsl/gsl_randist.h>
#include <stdlib.h>
#include <string.h>

#include "harness/files/mesh.h"
#include "kernels/kernel.h"
#include "reference/oracles.h"

enum { SCENE_SEED = 20050829 };

static inline gsl_rng *scene_rng(void) {
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  assert_non_null(rng);
  gsl_rng_set(rng, SCENE_SEED);
  return rng;
}

/* ---- 3x3 matrices, row-major ---------------------------------------------- */

static inline double determinant3(const double A[9]) {
  return A[0] * (A[4] * A[8] - A[5] * A[7]) - A[1] * (A[3] * A[8] - A[5] * A[6]) +
         A[2] * (A[3] * A[7] - A[4] * A[6]);
}

/* C := A B^T */
static inline void product3_nt(const double A[9], const double B[9], double C[9]) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      C[3 * i + j] =
          A[3 * i] * B[3 * j] + A[3 * i + 1] * B[3 * j + 1] + A[3 * i + 2] * B[3 * j + 2];
}

/* Uniform over all rotations. */
static inline void random_rotation(gsl_rng *rng, double R[9]) {
  double q[4], length = 0;
  for (int i = 0; i < 4; i++) q[i] = gsl_ran_gaussian(rng, 1);
  for (int i = 0; i < 4; i++) length += q[i] * q[i];
  double w = q[0], x = q[1], y = q[2], z = q[3], s = 2 / length;
  const double turned[9] = {
      1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
      s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
      s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
  memcpy(R, turned, sizeof turned);
}

/* ---- meshes and shapes ------------------------------------------------------ */

struct scene {
  struct cb_mesh mesh;
  double *x, *v, *u; /* [3*nodes] positions, velocities, any vector */
  double condition;  /* rounding of positions arrives in strains times this */
};

enum scene_kind {
  SCENE_ONE,      /* one element */
  SCENE_MIRRORED, /* one element of negative orientation */
  SCENE_RANDOM,   /* 23 elements of both orientations, isolated nodes between them */
  SCENE_GRID,     /* superposed splits, each with half the volume */
  SCENES
};
static const char *const scene_name[SCENES] = {"one", "mirrored", "random", "grid"};

static inline void scene_free(struct scene *s) {
  cb_mesh_free(&s->mesh);
  free(s->x);
  free(s->v);
  free(s->u);
}

/* Isolated nodes of SCENE_RANDOM: the first, the last, and others. */
static inline bool scene_isolated(uint32_t node) { return node % 6 == 0; }

static inline void random_tet(gsl_rng *rng, struct cb_mesh *mesh, size_t e) {
  uint32_t *t = mesh->tet + 4 * e;
  bool isolated;
  do {
    isolated = false;
    for (int j = 0; j < 4; j++) {
      t[j] = (uint32_t)gsl_rng_uniform_int(rng, mesh->nodes);
      isolated = isolated || scene_isolated(t[j]);
    }
  } while (isolated || fabs(cb_mesh_six_volumes(mesh, e)) < 0.15); /* repeated nodes: zero */
}

static inline void random_mesh(gsl_rng *rng, size_t nodes, size_t tets, struct cb_mesh *mesh) {
  assert_int_equal(cb_mesh_allocate(nodes, tets, mesh), CB_OK);
  for (size_t i = 0; i < 3 * nodes; i++) mesh->X[i] = gsl_rng_uniform(rng);
  for (size_t e = 0; e < tets; e++) random_tet(rng, mesh, e);
}

/* Vertices 0, 1, 2, 3 in that order, about a corner of a cube. */
static inline void one_tet(gsl_rng *rng, bool mirrored, struct cb_mesh *mesh) {
  static const double X[12] = {0, 0, 0, 1, 0.1, 0, 0.2, 1, 0.1, 0.3, 0.2, 1};
  assert_int_equal(cb_mesh_allocate(4, 1, mesh), CB_OK);
  for (int i = 0; i < 12; i++)
    mesh->X[i] = (mirrored && i % 3 == 0 ? -1 : 1) * (X[i] + 0.2 * gsl_rng_uniform(rng));
  for (uint32_t j = 0; j < 4; j++) mesh->tet[j] = j;
}

/* E rows := edges b-a, c-a, d-a of element e. */
static inline void tet_edges(const struct cb_mesh *mesh, const double *X, size_t e, double E[9]) {
  const uint32_t *t = mesh->tet + 4 * e;
  for (int j = 0; j < 3; j++)
    for (int i = 0; i < 3; i++) E[3 * j + i] = X[3 * t[j + 1] + i] - X[3 * t[0] + i];
}

/* Largest over smallest singular value. */
static inline double condition3(const double A[9]) {
  double U[9], s[3], V[9];
  assert_int_equal(cb_oracle_svd(A, U, s, V), CB_OK);
  return s[0] / s[2];
}

/* The worst element's condition of its rest shape times that of its shape x;
 * infinite when an element is turned inside out. */
static inline double shape_condition(const struct cb_mesh *mesh, const double *x) {
  double worst = 1;
  for (size_t e = 0; e < mesh->tets; e++) {
    double rest[9], now[9];
    tet_edges(mesh, mesh->X, e, rest);
    tet_edges(mesh, x, e, now);
    if (determinant3(rest) * determinant3(now) <= 0) return INFINITY;
    worst = fmax(worst, condition3(rest) * condition3(now));
  }
  return worst;
}

/* x := the rest shape strained, turned and shifted as a whole, and every node
 * moved by itself; no element is inside out or nearly flat. */
static inline void deform(gsl_rng *rng, struct scene *s) {
  double R[9], A[9], F[9], shift[3];
  do {
    random_rotation(rng, R);
    random_vector(rng, 3, shift);
    for (int i = 0; i < 9; i++) A[i] = (i % 4 == 0) + gsl_ran_gaussian(rng, 0.15);
    product3_nt(R, A, F);
    for (size_t n = 0; n < 3 * s->mesh.nodes; n++) {
      const double *X = s->mesh.X + n / 3 * 3, *row = F + n % 3 * 3;
      s->x[n] = row[0] * X[0] + row[1] * X[1] + row[2] * X[2] + shift[n % 3] +
                gsl_ran_gaussian(rng, 0.01);
    }
    s->condition = shape_condition(&s->mesh, s->x);
  } while (!(s->condition < 1000));
}

/* Everything but the mesh. */
static inline void scene_complete(gsl_rng *rng, struct scene *s) {
  size_t n = 3 * s->mesh.nodes;
  s->x = malloc(n * sizeof *s->x);
  s->v = malloc(n * sizeof *s->v);
  s->u = malloc(n * sizeof *s->u);
  assert_true(s->x && s->v && s->u);
  random_vector(rng, n, s->v);
  random_vector(rng, n, s->u);
  deform(rng, s);
}

static inline struct scene scene_new(gsl_rng *rng, enum scene_kind kind) {
  struct scene s = {.condition = 1};
  if (kind == SCENE_GRID) {
    assert_int_equal(cb_mesh_grid(2, 1, 1, 0.5, &s.mesh), CB_OK);
    for (size_t i = 0; i < 3 * s.mesh.nodes; i++) s.mesh.X[i] += gsl_ran_gaussian(rng, 0.02);
  } else if (kind == SCENE_RANDOM)
    random_mesh(rng, 19, 23, &s.mesh);
  else
    one_tet(rng, kind == SCENE_MIRRORED, &s.mesh);
  scene_complete(rng, &s);
  return s;
}

/* ---- materials --------------------------------------------------------------- */

/* Isotropic, or with a different modulus along each axis. */
static inline struct cb_material scene_material(bool orthotropic) {
  static const double E[3] = {900, 1700, 2600}, nu[3] = {0.25, 0.2, 0.3}, G[3] = {400, 700, 550};
  struct cb_material m;
  if (orthotropic)
    assert_int_equal(cb_material_orthotropic(E, nu, G, 1000, &m), CB_OK);
  else
    assert_int_equal(cb_material_isotropic(1500, 0.3, 1000, &m), CB_OK);
  return m;
}

#endif
