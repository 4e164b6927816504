/* tangent.c - see tangent.h. The mesh is exploded: every tetrahedron gets four nodes of
 * its own, so that the same coordinate of the same vertex is displaced in all of them at
 * once, and 24 evaluations give every element's 12x12 matrix.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/tangent.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct cb_tangent {
  const struct cb_variant *variant;
  struct cb_operator *op;
  struct cb_mesh exploded;
  uint32_t *tet;   /* [4*tets] of the mesh itself */
  double *size;    /* [tets] a typical edge, m */
  void *x, *f;     /* node vectors of the exploded mesh */
  double *matrix;  /* [tets][144] K of each element */
  double *at, *up; /* [12*tets] */
};

void cb_tangent_free(struct cb_tangent *t) {
  if (!t) return;
  cb_operator_free(t->op);
  free(t->exploded.X);
  free(t->exploded.tet);
  free(t->tet);
  free(t->size);
  free(t->x);
  free(t->f);
  free(t->matrix);
  free(t->at);
  free(t->up);
  free(t);
}

static void explode(const struct cb_mesh *mesh, struct cb_tangent *t) {
  for (size_t i = 0; i < 4 * mesh->tets; i++) {
    t->tet[i] = mesh->tet[i];
    t->exploded.tet[i] = (uint32_t)i;
    memcpy(t->exploded.X + 3 * i, mesh->X + 3 * (size_t)mesh->tet[i], 3 * sizeof(double));
  }
  for (size_t e = 0; e < mesh->tets; e++) t->size[e] = cbrt(fabs(cb_mesh_six_volumes(mesh, e)));
}

enum cb_status cb_tangent_create(const struct cb_variant *variant, const struct cb_mesh *mesh,
                                 const struct cb_material *material, struct cb_tangent **out) {
  const struct cb_arithmetic *a = variant->arithmetic;
  if (a->stride != 3 || variant->model->node_frames) return CB_INPUT;
  struct cb_tangent *t = calloc(1, sizeof *t);
  if (!t) return CB_MEMORY;
  const size_t nodes = 4 * mesh->tets;
  t->variant = variant;
  t->exploded = (struct cb_mesh){nodes, mesh->tets, malloc(3 * nodes * sizeof(double)),
                                 malloc(nodes * sizeof(uint32_t)), mesh->share};
  t->tet = malloc(nodes * sizeof *t->tet);
  t->size = malloc(mesh->tets * sizeof *t->size);
  t->x = malloc(3 * nodes * a->scalar_bytes);
  t->f = malloc(3 * nodes * a->scalar_bytes);
  t->matrix = malloc(144 * mesh->tets * sizeof *t->matrix);
  t->at = malloc(3 * nodes * sizeof *t->at);
  t->up = malloc(3 * nodes * sizeof *t->up);
  enum cb_status status = CB_MEMORY;
  if (t->exploded.X && t->exploded.tet && t->tet && t->size && t->x && t->f && t->matrix && t->at &&
      t->up) {
    explode(mesh, t);
    status = cb_operator_create(variant, &t->exploded, material, 1, 1, &t->op);
  }
  if (status)
    cb_tangent_free(t);
  else
    *out = t;
  return status;
}

/* f := forces where coordinate c of vertex v of every element is displaced by
 * sign times its step. */
static void displaced(struct cb_tangent *t, int v, int c, double sign, double step, double *f) {
  const size_t nodes = t->exploded.nodes;
  for (size_t e = 0; e < t->exploded.tets; e++)
    t->at[12 * e + (size_t)(3 * v + c)] += sign * step * t->size[e];
  t->variant->arithmetic->from_double(nodes, t->at, t->x);
  cb_operator_reset(t->op); /* a remembered frame would lag behind */
  cb_operator_update(t->op, t->x, NULL, 1, t->f);
  t->variant->arithmetic->to_double(nodes, t->f, f);
}

/* Rounded to powers of two, the displacement is exact and no error of its own. */
static double step_size(const struct cb_tangent *t) {
  const double wanted = fmax(cbrt(t->variant->arithmetic->roundoff), 1e-7);
  return exp2(round(log2(wanted)));
}

static size_t find_block(const uint32_t *row_start, const uint32_t *column, uint32_t i,
                         uint32_t j) {
  size_t b = row_start[i];
  while (column[b] != j) b++;
  return b;
}

static void fill_matrices(struct cb_tangent *t, const double *x) {
  const double step = step_size(t);
  for (size_t i = 0; i < t->exploded.nodes; i++)
    memcpy(t->at + 3 * i, x + 3 * (size_t)t->tet[i], 3 * sizeof *x);
  for (int n = 0; n < 12; n++) {
    displaced(t, n / 3, n % 3, 1, step, t->up);
    for (size_t e = 0; e < t->exploded.tets; e++)
      for (size_t m = 0; m < 12; m++) t->matrix[144 * e + 12 * m + (size_t)n] = t->up[12 * e + m];
    displaced(t, n / 3, n % 3, -2, step, t->up);
    for (size_t e = 0; e < t->exploded.tets; e++)
      for (size_t m = 0; m < 12; m++) {
        double *K = &t->matrix[144 * e + 12 * m + (size_t)n];
        *K = (t->up[12 * e + m] - *K) / (2 * step * t->size[e]);
      }
    for (size_t e = 0; e < t->exploded.tets; e++) {
      const double *from = x + 3 * (size_t)t->tet[4 * e + (size_t)n / 3] + n % 3;
      t->at[12 * e + (size_t)n] = *from;
    }
  }
}

double cb_tangent_blocks(struct cb_tangent *t, const double *x, const uint32_t *row_start,
                         const uint32_t *column, double *blocks) {
  double skew = 0, whole = 0;
  uint32_t nodes = 0;
  fill_matrices(t, x);
  for (size_t i = 0; i < t->exploded.nodes; i++) nodes = t->tet[i] >= nodes ? t->tet[i] + 1 : nodes;
  memset(blocks, 0, 9 * sizeof *blocks * row_start[nodes]);
  for (size_t e = 0; e < t->exploded.tets; e++) {
    const double *K = t->matrix + 144 * e;
    for (size_t m = 0; m < 12; m++)
      for (size_t n = 0; n < 12; n++) {
        const uint32_t i = t->tet[4 * e + m / 3], j = t->tet[4 * e + n / 3];
        const double mean = (K[12 * m + n] + K[12 * n + m]) / 2;
        blocks[9 * find_block(row_start, column, i, j) + 3 * (m % 3) + n % 3] += mean;
        skew += (K[12 * m + n] - mean) * (K[12 * m + n] - mean);
        whole += K[12 * m + n] * K[12 * m + n];
      }
  }
  return sqrt(skew / whole);
}
