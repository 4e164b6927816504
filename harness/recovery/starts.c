/* starts.c - where the bodies start from.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/recovery/recovery.h"

enum { CELLS = 3 };
static const double EDGE = 0.1;                                 /* m */
static const double YOUNG = 1e4, POISSON = 0.3, DENSITY = 1000; /* Pa, 1, kg/m^3 */

/* Of unit size, without any symmetry. */
static const double TETRAHEDRON[12] = {0, 0, 0, 1, 0.1, 0, 0.2, 0.9, 0.1, 0.3, 0.2, 0.8};

/* ---- one tetrahedron ---------------------------------------------------------------------- */

static void cross(const double *a, const double *b, double *c) {
  for (int i = 0; i < 3; i++)
    c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}
static double dot(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static void subtract(const double *a, const double *b, double *c) {
  for (int i = 0; i < 3; i++) c[i] = a[i] - b[i];
}

/* Vertices `moved` of x: pushed through the plane through `foot` across n, from which they are
 * equally far, to half as far on the other side. As far would be the mirrored shape, the same for
 * all of them, with no nearest rotation. */
static void push_through(double *x, const double *foot, const double *n, unsigned moved) {
  for (int v = 0; v < 4; v++) {
    double above[3];
    if (!(moved & 1u << v)) continue;
    subtract(x + 3 * v, foot, above);
    const double step = (1 + CB_RECOVERY_DEPTH) * dot(above, n) / dot(n, n);
    for (int i = 0; i < 3; i++) x[3 * v + i] -= step * n[i];
  }
}

static void vertex(const struct cb_mesh *mesh, int v, double *x) {
  const double *a = mesh->X + 3 * ((v + 1) % 4), *b = mesh->X + 3 * ((v + 2) % 4),
               *c = mesh->X + 3 * ((v + 3) % 4);
  double ab[3], ac[3], n[3];
  memcpy(x, mesh->X, 12 * sizeof *x);
  subtract(b, a, ab);
  subtract(c, a, ac);
  cross(ab, ac, n);
  push_through(x, a, n, 1u << v);
}

/* The edge from a to v, through the other two vertices' edge. */
static void edge(const struct cb_mesh *mesh, int v, double *x) {
  const double *a = mesh->X, *p = mesh->X + 3 * (v == 1 ? 2 : 1),
               *q = mesh->X + 3 * (v == 3 ? 2 : 3);
  double along[3], across[3], n[3];
  memcpy(x, mesh->X, 12 * sizeof *x);
  subtract(mesh->X + 3 * v, a, along);
  subtract(q, p, across);
  cross(along, across, n);
  push_through(x, p, n, 1u | 1u << v);
}

#define SINGLE(name, call)                                                                         \
  static void name(const struct cb_mesh *mesh, unsigned long seed, double *x) {                    \
    (void)seed;                                                                                    \
    call;                                                                                          \
  }
SINGLE(vertex_a, vertex(mesh, 0, x))
SINGLE(vertex_b, vertex(mesh, 1, x))
SINGLE(vertex_c, vertex(mesh, 2, x))
SINGLE(vertex_d, vertex(mesh, 3, x))
SINGLE(edge_ab, edge(mesh, 1, x))
SINGLE(edge_ac, edge(mesh, 2, x))
SINGLE(edge_ad, edge(mesh, 3, x))

/* ---- any ------------------------------------------------------------------------------------ */

static void middle(const struct cb_mesh *mesh, double c[3]) {
  const struct cb_box box = cb_mesh_bounds(mesh);
  for (int i = 0; i < 3; i++) c[i] = (box.low[i] + box.high[i]) / 2;
}

static void through_centre(const struct cb_mesh *mesh, unsigned long seed, double *x) {
  double c[3];
  (void)seed;
  middle(mesh, c);
  for (size_t i = 0; i < 3 * mesh->nodes; i++) x[i] = 2 * c[i % 3] - mesh->X[i];
}

/* ---- the block ------------------------------------------------------------------------------ */

/* Along no edge of the mesh, nor across one. */
static const double DIRECTION[3] = {0.2672612419124244, 0.5345224838248488, 0.8017837257372732};

/* x := middle + along times what of X - middle is along the direction + across times the rest. */
static void squeeze(const struct cb_mesh *mesh, double along, double across, double *x) {
  double c[3], r[3];
  middle(mesh, c);
  for (size_t n = 0; n < mesh->nodes; n++) {
    subtract(mesh->X + 3 * n, c, r);
    const double s = dot(r, DIRECTION);
    for (size_t i = 0; i < 3; i++)
      x[3 * n + i] = c[i] + across * r[i] + (along - across) * s * DIRECTION[i];
  }
}
SINGLE(plane, squeeze(mesh, 0, 1, x))
SINGLE(line, squeeze(mesh, 1, 0, x))
SINGLE(point, squeeze(mesh, 0, 0, x))
SINGLE(mirrored, squeeze(mesh, -1, 1, x))

static void anywhere(const struct cb_mesh *mesh, unsigned long seed, double *x) {
  const struct cb_box box = cb_mesh_bounds(mesh);
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  for (size_t i = 0; i < 3 * mesh->nodes; i++) x[i] = NAN; /* out of memory is not overlooked */
  if (!rng) return;
  gsl_rng_set(rng, seed);
  for (size_t i = 0; i < 3 * mesh->nodes; i++)
    x[i] = box.low[i % 3] + gsl_rng_uniform(rng) * (box.high[i % 3] - box.low[i % 3]);
  gsl_rng_free(rng);
}

const struct cb_recovery_start cb_recovery_starts[CB_RECOVERY_STARTS] = {
    {"vertex a", "a pushed through the other three's plane, to half its height", false, vertex_a},
    {"vertex b", "b likewise", false, vertex_b},
    {"vertex c", "c likewise", false, vertex_c},
    {"vertex d", "d likewise", false, vertex_d},
    {"edge ab", "ab pushed through cd, to half their distance; the same shape as cd through ab",
     false, edge_ab},
    {"edge ac", "ac through bd", false, edge_ac},
    {"edge ad", "ad through bc", false, edge_ad},
    {"centre", "all four mirrored in the centre: the mirrored shape", false, through_centre},
    {"mirrored", "the block mirrored in a plane", true, mirrored},
    {"plane", "the block collapsed to a plane", true, plane},
    {"line", "the block collapsed to a line", true, line},
    {"point", "the block collapsed to a point", true, point},
    {"random", "all nodes anywhere in the block", true, anywhere}};

const struct cb_recovery_start *cb_recovery_start(const char *name) {
  for (size_t i = 0; i < CB_RECOVERY_STARTS; i++)
    if (strcmp(cb_recovery_starts[i].name, name) == 0) return &cb_recovery_starts[i];
  return NULL;
}

/* ---- bodies ---------------------------------------------------------------------------------- */

/* G := inverse of the matrix whose columns are the rest edges of element e. */
static void invert_edges(const struct cb_mesh *mesh, size_t e, double G[9]) {
  const uint32_t *t = mesh->tet + 4 * e;
  double edges[3][3];
  for (int j = 0; j < 3; j++) subtract(mesh->X + 3 * t[j + 1], mesh->X + 3 * t[0], edges[j]);
  for (int j = 0; j < 3; j++) {
    cross(edges[(j + 1) % 3], edges[(j + 2) % 3], G + 3 * j);
    const double volume = dot(edges[j], G + 3 * j);
    for (int i = 0; i < 3; i++) G[3 * j + i] /= volume;
  }
}

static enum cb_status make_mesh(const struct cb_recovery_start *start, const double *X,
                                struct cb_mesh *mesh) {
  if (start->block) return cb_mesh_grid(CELLS, CELLS, CELLS, EDGE, mesh);
  enum cb_status status = cb_mesh_allocate(4, 1, mesh);
  for (size_t i = 0; !status && i < 12; i++) mesh->X[i] = X ? X[i] : EDGE * TETRAHEDRON[i];
  for (uint32_t i = 0; !status && i < 4; i++) mesh->tet[i] = i;
  return status;
}

enum cb_status cb_recovery_body_create(const struct cb_recovery_start *start, const double *X,
                                       unsigned long seed, struct cb_recovery_body *body) {
  struct cb_recovery_body made = {.start = start};
  struct cb_bench_scene *at = &made.at;
  enum cb_status status = make_mesh(start, X, &at->mesh);
  if (!status) status = cb_material_isotropic(YOUNG, POISSON, DENSITY, &at->material);
  if (status) return status;
  const size_t nodes = at->mesh.nodes;
  at->mass = malloc(nodes * sizeof *at->mass);
  at->fixed = calloc(nodes, sizeof *at->fixed);
  at->x = malloc(3 * nodes * sizeof *at->x);
  at->v = calloc(3 * nodes, sizeof *at->v);
  made.inverse = malloc(9 * at->mesh.tets * sizeof *made.inverse);
  if (!at->mass || !at->fixed || !at->x || !at->v || !made.inverse) {
    cb_recovery_body_free(&made);
    return cb_fail_memory("the body");
  }
  cb_mesh_mass(&at->mesh, at->material.density, at->mass);
  for (size_t e = 0; e < at->mesh.tets; e++) invert_edges(&at->mesh, e, made.inverse + 9 * e);
  const struct cb_box box = cb_mesh_bounds(&at->mesh);
  for (int i = 0; i < 3; i++) made.size = fmax(made.size, box.high[i] - box.low[i]);
  start->place(&at->mesh, seed, at->x);
  *body = made;
  return CB_OK;
}

void cb_recovery_body_free(struct cb_recovery_body *body) {
  cb_bench_scene_free(&body->at);
  free(body->inverse);
  *body = (struct cb_recovery_body){0};
}
