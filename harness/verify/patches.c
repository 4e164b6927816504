/* SPDX-License-Identifier: BSD-3-Clause */
#include "harness/verify/patches.h"

#include <gsl/gsl_randist.h>
#include <gsl/gsl_rng.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/mesh.h"

void cb_random_rotation(const double u[3], double angle, double *Q) {
  double q[4];
  if (angle < 0) {
    double a = sqrt(1 - u[0]), b = sqrt(u[0]);
    q[0] = a * sin(2 * M_PI * u[1]), q[1] = a * cos(2 * M_PI * u[1]);
    q[2] = b * sin(2 * M_PI * u[2]), q[3] = b * cos(2 * M_PI * u[2]);
  } else {
    double z = 2 * u[0] - 1, r = sqrt(1 - z * z);
    q[0] = cos(angle / 2), q[3] = sin(angle / 2) * z;
    q[1] = sin(angle / 2) * r * cos(2 * M_PI * u[1]);
    q[2] = sin(angle / 2) * r * sin(2 * M_PI * u[1]);
  }
  double w = q[0], x = q[1], y = q[2], z = q[3];
  double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                    2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                    2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
  memcpy(Q, rows, sizeof rows);
}

static void random_rotation(gsl_rng *rng, double angle, double *Q) {
  double u[3];
  for (int i = 0; i < 3; i++) u[i] = gsl_rng_uniform(rng);
  cb_random_rotation(u, angle, Q);
}

/* Frobenius norm of the gradient of node field u in one tetrahedron. */
static double gradient_norm(const struct cb_mesh *mesh, const uint32_t *tet, const double *u) {
  double e[9], du[9], g[9], sum = 0;
  for (int i = 0; i < 9; i++) {
    size_t a = 3 * (size_t)tet[0] + (size_t)(i % 3),
           b = 3 * (size_t)tet[1 + i / 3] + (size_t)(i % 3);
    e[i] = mesh->X[b] - mesh->X[a];
    du[i] = u[b] - u[a];
  }
  for (int j = 0; j < 3; j++) { /* g rows: cofactors of the edges / determinant */
    const double *p = e + 3 * ((j + 1) % 3), *q = e + 3 * ((j + 2) % 3);
    for (int i = 0; i < 3; i++)
      g[3 * j + i] = p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3];
  }
  double det = e[0] * g[0] + e[1] * g[1] + e[2] * g[2];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      double H = du[i] * g[k] + du[3 + i] * g[3 + k] + du[6 + i] * g[6 + k];
      sum += H * H;
    }
  return sqrt(sum) / fabs(det);
}

/* Scale both fields of each patch so that |grad cosine| + |grad sine| <= 0.6 in
 * each element: every singular value of F stays above 0.4 along the path. */
static void limit_path(struct cb_patches *p) {
  for (size_t n = 0; n < p->count; n++) {
    double worst = 0;
    for (size_t t = n * p->tets; t < (n + 1) * p->tets; t++) {
      const uint32_t *tet = p->mesh.tet + 4 * t;
      double g = gradient_norm(&p->mesh, tet, p->cosine) + gradient_norm(&p->mesh, tet, p->sine);
      if (g > worst) worst = g;
    }
    for (size_t i = 3 * n * p->nodes; i < 3 * (n + 1) * p->nodes; i++)
      p->cosine[i] *= 0.6 / worst, p->sine[i] *= 0.6 / worst;
  }
}

/* x and its step before: node noise, then a turn and a move of each patch. */
static void deform(struct cb_patches *p, double strength, gsl_rng *rng) {
  for (size_t n = 0; n < p->count; n++) {
    double Q[9], q[9], t[3];
    random_rotation(rng, -1, Q);
    random_rotation(rng, 0.05, q);
    for (int i = 0; i < 3; i++) t[i] = gsl_ran_gaussian(rng, p->size);
    for (size_t node = n * p->nodes; node < (n + 1) * p->nodes; node++) {
      double a[3], b[3], c[3];
      for (int i = 0; i < 3; i++) {
        a[i] = p->mesh.X[3 * node + (size_t)i] + gsl_ran_gaussian(rng, strength * p->size);
        b[i] = a[i] + gsl_ran_gaussian(rng, 0.02 * p->size);
        p->cosine[3 * node + (size_t)i] = gsl_ran_gaussian(rng, p->size);
        p->sine[3 * node + (size_t)i] = gsl_ran_gaussian(rng, p->size);
      }
      for (int i = 0; i < 3; i++)
        c[i] = q[3 * i] * b[0] + q[3 * i + 1] * b[1] + q[3 * i + 2] * b[2];
      for (int i = 0; i < 3; i++) {
        const double *row = Q + 3 * i;
        p->x[3 * node + (size_t)i] = row[0] * a[0] + row[1] * a[1] + row[2] * a[2] + t[i];
        p->before[3 * node + (size_t)i] = row[0] * c[0] + row[1] * c[1] + row[2] * c[2] + t[i];
      }
    }
  }
  limit_path(p);
}

/* Allocate the fields of p->mesh and fill them. On failure p is emptied. */
static enum cb_status finish(struct cb_patches *p, double strength, unsigned long seed) {
  double **fields[] = {&p->x, &p->before, &p->cosine, &p->sine};
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  bool there = rng != NULL;
  for (int i = 0; i < 4; i++) {
    *fields[i] = calloc(3 * p->mesh.nodes + 1, sizeof(double));
    there = there && *fields[i];
  }
  if (there) {
    gsl_rng_set(rng, seed + 1);
    deform(p, strength, rng);
  }
  if (rng) gsl_rng_free(rng);
  if (there) return CB_OK;
  cb_patches_free(p);
  return cb_fail_memory("the samples");
}

/* X of one patch: vertices in a unit cube, well-shaped enough that rounding of
 * the rest shape is not what is measured: |6V| > 0.15 for a and b. The fifth
 * vertex is the fourth mirrored in the shared face, with noise. */
static void random_patch(gsl_rng *rng, size_t nodes, double *X) {
  double six = 0;
  while (!(fabs(six) > 0.15)) {
    for (size_t i = 0; i < 12; i++) X[i] = gsl_rng_uniform(rng);
    double e[9];
    for (size_t i = 0; i < 9; i++) e[i] = X[3 + i] - X[i % 3];
    six = e[0] * (e[4] * e[8] - e[5] * e[7]) + e[1] * (e[5] * e[6] - e[3] * e[8]) +
          e[2] * (e[3] * e[7] - e[4] * e[6]);
  }
  for (size_t i = 12; i < 3 * nodes; i++) {
    double face = (X[i - 12] + X[i - 9] + X[i - 6]) / 3;
    X[i] = 2 * face - X[i - 3] + 0.05 * gsl_ran_gaussian(rng, 1);
  }
}

enum cb_status cb_patches_random(size_t count, size_t tets, double strength, unsigned long seed,
                                 struct cb_patches *p) {
  struct cb_patches new = {.count = count, .nodes = 3 + tets, .tets = tets, .size = 0.66};
  enum cb_status status = cb_mesh_allocate(count * new.nodes, count * tets, &new.mesh);
  if (status) return status;
  gsl_rng *rng = gsl_rng_alloc(gsl_rng_mt19937);
  if (!rng) {
    cb_mesh_free(&new.mesh);
    return cb_fail_memory("the samples");
  }
  gsl_rng_set(rng, seed);
  for (size_t n = 0; n < count; n++) {
    random_patch(rng, new.nodes, new.mesh.X + 3 * n *new.nodes);
    for (size_t t = 0; t < tets; t++)
      for (size_t j = 0; j < 4; j++)
        new.mesh.tet[4 * (n * tets + t) + j] = (uint32_t)(n * new.nodes + (j < 3 ? j : 3 + t));
  }
  gsl_rng_free(rng);
  status = finish(&new, strength, seed);
  if (!status) *p = new;
  return status;
}

enum cb_status cb_patches_mesh(const struct cb_mesh *mesh, double strength, unsigned long seed,
                               struct cb_patches *p) {
  struct cb_patches new = {.count = 1, .nodes = mesh->nodes, .tets = mesh->tets};
  enum cb_status status = cb_mesh_allocate(mesh->nodes, mesh->tets, &new.mesh);
  if (status) return status;
  memcpy(new.mesh.X, mesh->X, 3 * mesh->nodes * sizeof *mesh->X);
  memcpy(new.mesh.tet, mesh->tet, 4 * mesh->tets * sizeof *mesh->tet);
  new.mesh.share = mesh->share;
  /* the shortest edge of the first vertices: noise must not turn a fine mesh
   * inside out everywhere */
  new.size = INFINITY;
  for (size_t t = 0; t < mesh->tets; t++)
    for (size_t j = 1; j < 4; j++) {
      const double *a = mesh->X + 3 * (size_t)mesh->tet[4 * t];
      const double *b = mesh->X + 3 * (size_t)mesh->tet[4 * t + j];
      new.size = fmin(new.size, hypot(hypot(b[0] - a[0], b[1] - a[1]), b[2] - a[2]));
    }
  status = finish(&new, strength, seed);
  if (!status) *p = new;
  return status;
}

void cb_patches_free(struct cb_patches *p) {
  cb_mesh_free(&p->mesh);
  free(p->x);
  free(p->before);
  free(p->cosine);
  free(p->sine);
  *p = (struct cb_patches){0};
}
