/* mesh_shape.c - bodies of an implicit surface, filled with tetrahedra.
 * Source: warping lattice nodes onto the surface: Labelle & Shewchuk 2007 (isosurface
 *         stuffing), here on Kuhn's split of a cubic lattice, without their cut
 *         tetrahedra; what is left of the steps is projected where quality allows.
 * Trade:  simple and never tangled; corners finer than a cell are lost.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "harness/error.h"
#include "harness/files/faces.h"
#include "harness/files/mesh.h"
#include "harness/files/shape.h"

/* ---- lattice ------------------------------------------------------------------------------ */

struct lattice {
  const struct cb_shape *shape;
  double low[3];
  size_t n[3]; /* cells */
  double cell;
  double *X, *f; /* of every node */
};

static size_t node_count(const struct lattice *l) {
  return (l->n[0] + 1) * (l->n[1] + 1) * (l->n[2] + 1);
}

static uint32_t node_at(const struct lattice *l, size_t x, size_t y, size_t z) {
  return (uint32_t)((z * (l->n[1] + 1) + y) * (l->n[0] + 1) + x);
}

static void fill_lattice(struct lattice *l) {
  const double reach = 0.3 * l->cell; /* Kuhn's tetrahedra stay upright for it */
  for (size_t z = 0; z <= l->n[2]; z++)
    for (size_t y = 0; y <= l->n[1]; y++)
      for (size_t x = 0; x <= l->n[0]; x++) {
        const uint32_t i = node_at(l, x, y, z);
        const size_t place[3] = {x, y, z};
        double *p = l->X + 3 * i;
        for (int k = 0; k < 3; k++) p[k] = l->low[k] + l->cell * (double)place[k];
        l->f[i] = cb_shape_approach(l->shape, reach, p) ? 0 : cb_shape_value(l->shape, p);
      }
}

static const double LEAST = 0.2; /* quality that is kept */

/* Kuhn's six tetrahedra of a cell: along the diagonal, one for each order of the axes. */
static size_t inside(const struct lattice *l, uint32_t *tet) {
  static const uint8_t order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                      {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  size_t count = 0;
  for (size_t c = 0; c < l->n[0] * l->n[1] * l->n[2]; c++)
    for (int n = 0; n < 6; n++) {
      size_t place[3] = {c % l->n[0], c / l->n[0] % l->n[1], c / (l->n[0] * l->n[1])};
      uint32_t t[4] = {node_at(l, place[0], place[1], place[2])};
      for (int j = 0; j < 3; j++) {
        place[order[n][j]]++;
        t[j + 1] = node_at(l, place[0], place[1], place[2]);
      }
      if (n > 2) { /* odd orders are upside down */
        const uint32_t swap = t[2];
        t[2] = t[3], t[3] = swap;
      }
      bool in = true, flat = true;
      double middle[3] = {0};
      for (int j = 0; j < 4; j++) {
        in &= l->f[t[j]] <= 0;
        flat &= l->f[t[j]] == 0;
        for (int k = 0; k < 3; k++) middle[k] += l->X[3 * t[j] + k] / 4;
      }
      if (!in || !(cb_mesh_quality(l->X, t) > LEAST)) continue;
      if (flat && cb_shape_value(l->shape, middle) > -0.05 * l->cell) continue;
      if (tet) memcpy(tet + 4 * count, t, sizeof t);
      count++;
    }
  return count;
}

/* ---- from lattice to mesh -------------------------------------------------------------------- */

static size_t root_of(size_t *part, size_t e) {
  while (part[e] != e) e = part[e] = part[part[e]];
  return e;
}

/* *tets, tet := the largest part, whose tetrahedra are joined by faces: by an edge or a node
 * alone nothing holds. */
static enum cb_status keep_largest_part(size_t *tets, uint32_t *tet) {
  struct cb_face *face = cb_faces_create(*tets, tet);
  size_t *part = malloc((*tets + 1) * sizeof *part), *size = calloc(*tets + 1, sizeof *size);
  const bool there = face && part && size;
  for (size_t e = 0; there && e < *tets; e++) part[e] = e;
  for (size_t n = 1; there && n < 4 * *tets; n++) { /* union-find */
    if (!cb_face_same(&face[n - 1], &face[n])) continue;
    const size_t a = root_of(part, face[n - 1].tet), b = root_of(part, face[n].tet);
    part[a > b ? a : b] = a > b ? b : a;
  }
  size_t best = 0, kept = 0;
  for (size_t e = 0; there && e < *tets; e++) {
    const size_t a = root_of(part, e);
    if (++size[a] > size[best]) best = a;
  }
  for (size_t e = 0; there && e < *tets; e++)
    if (root_of(part, e) == best) memmove(tet + 4 * kept++, tet + 4 * e, 4 * sizeof *tet);
  free(face);
  free(part);
  free(size);
  if (!there) return cb_fail_memory("the shape");
  *tets = kept;
  return CB_OK;
}

/* Only nodes that are used, in their order. */
static enum cb_status compact(const struct lattice *l, size_t tets, const uint32_t *tet,
                              uint32_t *number, struct cb_mesh *mesh) {
  size_t nodes = 0;
  memset(number, 0xff, node_count(l) * sizeof *number);
  for (size_t n = 0; n < 4 * tets; n++) number[tet[n]] = 0;
  for (size_t i = 0; i < node_count(l); i++)
    if (!number[i]) number[i] = (uint32_t)nodes++;
  enum cb_status status = cb_mesh_allocate(nodes, tets, mesh);
  if (status) return status;
  for (size_t i = 0; i < node_count(l); i++)
    if (number[i] < nodes) memcpy(mesh->X + 3 * number[i], l->X + 3 * i, 3 * sizeof *l->X);
  for (size_t n = 0; n < 4 * tets; n++) mesh->tet[n] = number[tet[n]];
  return CB_OK;
}

/* Nodes of the boundary go to the surface as far as every tetrahedron around stays good.
 * around: tetrahedra of each node, from start[node] on. */
static void project(const struct lattice *l, struct cb_mesh *mesh, const size_t *start,
                    const uint32_t *around, const uint8_t *boundary) {
  for (size_t i = 0; i < mesh->nodes; i++) {
    double from[3], to[3], *p = mesh->X + 3 * i;
    if (!boundary[i]) continue;
    memcpy(from, p, sizeof from);
    memcpy(to, p, sizeof to);
    if (!cb_shape_approach(l->shape, l->cell, to)) continue;
    for (double part = 1; part > 0.1; part /= 2) {
      bool good = true;
      for (int k = 0; k < 3; k++) p[k] = from[k] + part * (to[k] - from[k]);
      for (size_t n = start[i]; n < start[i + 1]; n++)
        good &= cb_mesh_quality(mesh->X, mesh->tet + 4 * around[n]) > LEAST;
      if (good) break;
      memcpy(p, from, sizeof from);
    }
  }
}

/* boundary[nodes] := nodes of faces that only one tetrahedron has. */
static void find_boundary(const struct cb_mesh *mesh, const struct cb_face *face,
                          uint8_t *boundary) {
  memset(boundary, 0, mesh->nodes);
  for (size_t n = 0; n < 4 * mesh->tets; n++) {
    const bool last = n > 0 && cb_face_same(&face[n], &face[n - 1]);
    const bool next = n + 1 < 4 * mesh->tets && cb_face_same(&face[n], &face[n + 1]);
    for (size_t j = 0; !last && !next && j < 3; j++) boundary[face[n].node[j]] = 1;
  }
}

static enum cb_status smooth(const struct lattice *l, struct cb_mesh *mesh) {
  struct cb_face *face = cb_faces_create(mesh->tets, mesh->tet);
  uint32_t *around = malloc(4 * mesh->tets * sizeof *around);
  uint8_t *boundary = malloc(mesh->nodes);
  size_t *start = calloc(mesh->nodes + 2, sizeof *start);
  const bool there = face && around && boundary && start;
  if (there) {
    find_boundary(mesh, face, boundary);
    for (size_t n = 0; n < 4 * mesh->tets; n++) start[mesh->tet[n] + 2]++;
    for (size_t i = 2; i < mesh->nodes + 2; i++) start[i] += start[i - 1];
    for (size_t n = 0; n < 4 * mesh->tets; n++)
      around[start[mesh->tet[n] + 1]++] = (uint32_t)(n / 4);
    for (int pass = 0; pass < 3; pass++) project(l, mesh, start, around, boundary);
  }
  free(face);
  free(around);
  free(boundary);
  free(start);
  return there ? CB_OK : cb_fail_memory("the shape");
}

bool cb_mesh_is_shape(const char *name) { return cb_shape_find(name) != NULL; }

enum cb_status cb_mesh_shape(const char *name, size_t cells, double length, struct cb_mesh *mesh) {
  struct lattice l = {.shape = cb_shape_find(name), .cell = 1.0 / (double)cells};
  struct cb_mesh made = {0};
  double high[3];
  if (!l.shape || cells < 4 || !(length > 0))
    return cb_fail(CB_INPUT,
                   "a shape is 'rabbit' or 'liver', of at least 4 cells and some length, "
                   "not '%s' of %zu cells and %g m",
                   name, cells, length);
  cb_shape_bounds(l.shape, l.low, high);
  for (int k = 0; k < 3; k++) l.n[k] = (size_t)ceil((high[k] - l.low[k]) / l.cell);
  const size_t nodes = node_count(&l);
  l.X = malloc(3 * nodes * sizeof *l.X);
  l.f = malloc(nodes * sizeof *l.f);
  uint32_t *tet = NULL, *number = malloc(nodes * sizeof *number);
  size_t tets = 0;
  enum cb_status status = l.X && l.f && number ? CB_OK : cb_fail_memory("the shape");
  if (!status) {
    fill_lattice(&l);
    tets = inside(&l, NULL);
    tet = malloc((4 * tets + 1) * sizeof *tet);
    if (!tet) status = cb_fail_memory("the shape");
  }
  if (!status) {
    inside(&l, tet);
    status = keep_largest_part(&tets, tet);
  }
  if (!status) status = compact(&l, tets, tet, number, &made);
  if (!status) status = smooth(&l, &made);
  for (size_t i = 0; !status && i < 3 * made.nodes; i++) made.X[i] *= length;
  if (status)
    cb_mesh_free(&made);
  else
    *mesh = made;
  free(l.X);
  free(l.f);
  free(tet);
  free(number);
  return status;
}
