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
#include "harness/files/mesh.h"

/* ---- shapes: smooth unions of ellipsoids, length 1 along x, z up ------------------------ */

struct ellipsoid {
  double centre[3], radius[3];
  double lean; /* rad: its z axis leans to -x */
  int sides;   /* 2: mirrored in y as well */
  int sign;    /* -1: cut out */
};
struct shape {
  const char *name;
  double blend; /* radius of the fillets */
  double low[3], high[3];
  size_t count;
  struct ellipsoid part[10];
};

static const struct shape shapes[] = {{"rabbit",
                                       0.05,
                                       {-0.08, -0.32, -0.06},
                                       {1.08, 0.32, 1.12},
                                       9,
                                       {{{0.42, 0, 0.30}, {0.34, 0.22, 0.27}, 0, 1, 1},
                                        {{0.25, 0.10, 0.22}, {0.18, 0.13, 0.20}, 0, 2, 1},
                                        {{0.66, 0, 0.32}, {0.15, 0.15, 0.22}, -0.4, 1, 1},
                                        {{0.82, 0, 0.53}, {0.18, 0.145, 0.155}, 0, 1, 1},
                                        {{0.72, 0.085, 0.83}, {0.085, 0.06, 0.24}, 0.35, 2, 1},
                                        {{0.05, 0, 0.33}, {0.085, 0.08, 0.085}, 0, 1, 1},
                                        {{0.72, 0.09, 0.08}, {0.13, 0.07, 0.085}, 0, 2, 1},
                                        {{0.34, 0.16, 0.07}, {0.21, 0.085, 0.075}, 0, 2, 1},
                                        {{0.96, 0, 0.50}, {0.06, 0.07, 0.06}, 0, 1, 1}}},
                                      {"liver",
                                       0.08,
                                       {-0.06, -0.34, -0.06},
                                       {1.06, 0.34, 0.66},
                                       4,
                                       {{{0.32, 0, 0.30}, {0.33, 0.26, 0.27}, 0.2, 1, 1},
                                        {{0.70, 0.02, 0.38}, {0.31, 0.17, 0.14}, -0.2, 1, 1},
                                        {{0.50, -0.03, 0.38}, {0.26, 0.21, 0.17}, 0, 1, 1},
                                        {{0.46, 0, 0.02}, {0.16, 0.4, 0.13}, 0, 1, -1}}}};

/* About the distance to the ellipsoid, negative inside. */
static double distance(const struct ellipsoid *e, const double *p, double side) {
  double d[3] = {p[0] - e->centre[0], p[1] - side * e->centre[1], p[2] - e->centre[2]}, k = 0,
         g = 0;
  const double c = cos(e->lean), s = sin(e->lean);
  const double x = c * d[0] + s * d[2], z = c * d[2] - s * d[0];
  d[0] = x, d[2] = z;
  for (int i = 0; i < 3; i++) {
    const double q = d[i] / e->radius[i];
    k += q * q, g += q * q / (e->radius[i] * e->radius[i]);
  }
  k = sqrt(k), g = sqrt(g);
  const double least = fmin(e->radius[0], fmin(e->radius[1], e->radius[2]));
  return g > 0 ? k * (k - 1) / g : -least; /* Quilez: first order at the surface */
}

/* The smaller one, rounded off within `blend`. */
static double smooth_minimum(double a, double b, double blend) {
  const double h = fmax(0, blend - fabs(a - b)) / blend;
  return fmin(a, b) - h * h * blend / 4;
}

static double value(const struct shape *s, const double *p) {
  double f = INFINITY;
  for (size_t i = 0; i < s->count; i++)
    for (int side = 0; side < s->part[i].sides; side++) {
      const double d = distance(&s->part[i], p, side ? -1 : 1);
      f = !isfinite(f)          ? d
          : s->part[i].sign < 0 ? -smooth_minimum(-f, d, s->blend)
                                : smooth_minimum(f, d, s->blend);
    }
  return f;
}

static void gradient(const struct shape *s, const double *p, double *g) {
  const double e = 1e-5;
  for (int k = 0; k < 3; k++) {
    double q[3] = {p[0], p[1], p[2]};
    q[k] += e;
    g[k] = value(s, q);
    q[k] -= 2 * e;
    g[k] = (g[k] - value(s, q)) / (2 * e);
  }
}

/* ---- lattice ------------------------------------------------------------------------------ */

struct lattice {
  const struct shape *shape;
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

/* One step of Newton's method to the surface, of at most `reach`; returns whether it was
 * within reach. */
static bool towards_surface(const struct shape *s, double reach, double *p) {
  double g[3];
  const double f = value(s, p);
  gradient(s, p, g);
  const double square = g[0] * g[0] + g[1] * g[1] + g[2] * g[2];
  if (!(square > 0) || !(fabs(f) <= reach * sqrt(square))) return false;
  for (int k = 0; k < 3; k++) p[k] -= f * g[k] / square;
  return true;
}

static void fill_lattice(struct lattice *l) {
  const double reach = 0.3 * l->cell; /* Kuhn's tetrahedra stay upright for it */
  for (size_t z = 0; z <= l->n[2]; z++)
    for (size_t y = 0; y <= l->n[1]; y++)
      for (size_t x = 0; x <= l->n[0]; x++) {
        const uint32_t i = node_at(l, x, y, z);
        const size_t place[3] = {x, y, z};
        double *p = l->X + 3 * i;
        for (int k = 0; k < 3; k++) p[k] = l->shape->low[k] + l->cell * (double)place[k];
        l->f[i] = towards_surface(l->shape, reach, p) ? 0 : value(l->shape, p);
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
      if (flat && value(l->shape, middle) > -0.05 * l->cell) continue;
      if (tet) memcpy(tet + 4 * count, t, sizeof t);
      count++;
    }
  return count;
}

/* ---- from lattice to mesh -------------------------------------------------------------------- */

/* Tetrahedra of the largest part first; returns how many it has. part[nodes]: scratch. */
static size_t largest_part(size_t nodes, size_t tets, uint32_t *tet, uint32_t *part, size_t *size) {
  for (uint32_t i = 0; i < nodes; i++) part[i] = i, size[i] = 0;
  for (size_t n = 0; n < 4 * tets; n++) { /* union-find */
    uint32_t a = tet[n], b = tet[n / 4 * 4];
    while (part[a] != a) a = part[a] = part[part[a]];
    while (part[b] != b) b = part[b] = part[part[b]];
    part[a > b ? a : b] = a > b ? b : a;
  }
  uint32_t best = 0;
  for (size_t e = 0; e < tets; e++) {
    uint32_t a = tet[4 * e];
    while (part[a] != a) a = part[a];
    if (++size[a] > size[best]) best = a;
  }
  size_t kept = 0;
  for (size_t e = 0; e < tets; e++) {
    uint32_t a = tet[4 * e];
    while (part[a] != a) a = part[a];
    if (a == best) memmove(tet + 4 * kept++, tet + 4 * e, 4 * sizeof *tet);
  }
  return kept;
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
    if (!towards_surface(l->shape, l->cell, to)) continue;
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

static int by_face(const void *a, const void *b) { return memcmp(a, b, 3 * sizeof(uint32_t)); }

/* boundary[nodes] := nodes of faces that only one tetrahedron has. face[12*tets]: scratch. */
static void find_boundary(const struct cb_mesh *mesh, uint32_t *face, uint8_t *boundary) {
  for (size_t n = 0; n < 4 * mesh->tets; n++) {
    uint32_t *f = face + 3 * n;
    for (size_t j = 0, filled = 0; j < 4; j++)
      if (j != n % 4) f[filled++] = mesh->tet[n / 4 * 4 + j];
    for (int pass = 0; pass < 3; pass++) /* three are sorted by three exchanges */
      if (f[pass % 2] > f[pass % 2 + 1]) {
        const uint32_t swap = f[pass % 2];
        f[pass % 2] = f[pass % 2 + 1], f[pass % 2 + 1] = swap;
      }
  }
  qsort(face, 4 * mesh->tets, 3 * sizeof *face, by_face);
  memset(boundary, 0, mesh->nodes);
  for (size_t n = 0; n < 4 * mesh->tets; n++) {
    const bool last = n > 0 && by_face(face + 3 * n, face + 3 * (n - 1)) == 0;
    const bool next = n + 1 < 4 * mesh->tets && by_face(face + 3 * n, face + 3 * (n + 1)) == 0;
    for (size_t j = 0; !last && !next && j < 3; j++) boundary[face[3 * n + j]] = 1;
  }
}

static enum cb_status smooth(const struct lattice *l, struct cb_mesh *mesh) {
  uint32_t *face = malloc(12 * mesh->tets * sizeof *face),
           *around = malloc(4 * mesh->tets * sizeof *around);
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

static const struct shape *find_shape(const char *name) {
  for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
    if (strcmp(shapes[i].name, name) == 0) return &shapes[i];
  return NULL;
}

bool cb_mesh_is_shape(const char *name) { return find_shape(name) != NULL; }

enum cb_status cb_mesh_shape(const char *name, size_t cells, double length, struct cb_mesh *mesh) {
  struct lattice l = {.shape = find_shape(name), .cell = 1.0 / (double)cells};
  struct cb_mesh made = {0};
  if (!l.shape || cells < 4 || !(length > 0))
    return cb_fail(CB_INPUT,
                   "a shape is 'rabbit' or 'liver', of at least 4 cells and some length, "
                   "not '%s' of %zu cells and %g m",
                   name, cells, length);
  for (int k = 0; k < 3; k++) l.n[k] = (size_t)ceil((l.shape->high[k] - l.shape->low[k]) / l.cell);
  const size_t nodes = node_count(&l);
  l.X = malloc(3 * nodes * sizeof *l.X);
  l.f = malloc(nodes * sizeof *l.f);
  uint32_t *tet = NULL, *number = malloc(nodes * sizeof *number);
  size_t *size = malloc(nodes * sizeof *size), tets = 0;
  enum cb_status status = l.X && l.f && number && size ? CB_OK : cb_fail_memory("the shape");
  if (!status) {
    fill_lattice(&l);
    tets = inside(&l, NULL);
    tet = malloc((4 * tets + 1) * sizeof *tet);
    if (!tet) status = cb_fail_memory("the shape");
  }
  if (!status) {
    inside(&l, tet);
    tets = largest_part(nodes, tets, tet, number, size);
    status = compact(&l, tets, tet, number, &made);
  }
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
  free(size);
  return status;
}
