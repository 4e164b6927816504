/* elements.c - the arrays of one variant on one mesh, and the rest data of its
 * elements. Rest data are computed in double (counted: in quad) and rounded.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "kernels/elements.h"

#include <stdlib.h>
#include <string.h>

#include "kernels/arithmetics.h"
#include "kernels/frames/polar_higham.h"
#include "kernels/material.h"
#include "kernels/memory.h"
#include "kernels/storage/block.h"
#include "kernels/storage/lanes.h"
#include "kernels/team.h"

struct layout {
  const struct cb_model *model;
  const struct cb_material *material;
  bool orthotropic, paper, sparse;
  REAL c, mu; /* scale of the product; Pa */
};

/* The same, counted. */
static void *array(struct cb_elements *E, size_t n, size_t size) {
  void *a = cb_memory(n, size);
  if (a) E->bytes += n * size;
  return a;
}

static size_t rest_numbers(const struct layout *L) {
  size_t n = L->orthotropic ? REST_ORTHOTROPIC : REST_ISOTROPIC;
  if (L->paper && L->model->policy == POLICY_PRECOMPUTED) n += L->sparse ? 9 : 12;
  return n;
}

static REAL dot(const REAL *a, const REAL *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const REAL *a, const REAL *b, REAL *c) {
  for (int i = 0; i < 3; i++) {
    int j = (i + 1) % 3, k = (i + 2) % 3;
    c[i] = a[j] * b[k] - a[k] * b[j];
  }
}

/* q rows := Gram-Schmidt frame of the edges, right-handed. */
static void edge_frame(const REAL *e, REAL *q) {
  REAL length = real_sqrt(dot(e, e));
  for (int i = 0; i < 3; i++) q[i] = e[i] / length;
  REAL along = dot(q, e + 3);
  for (int i = 0; i < 3; i++) q[3 + i] = e[3 + i] - along * q[i];
  length = real_sqrt(dot(q + 3, q + 3));
  for (int i = 0; i < 3; i++) q[3 + i] /= length;
  cross(q, q + 3, q + 6);
}

/* q rows := axes in which the element keeps its rest shape. */
static void rest_axes(int axes, const REAL *e, REAL *q) {
  for (int i = 0; i < 9; i++) q[i] = i % 4 == 0;
  if (axes == AXES_EDGES) edge_frame(e, q);
  if (axes == AXES_POLAR) { /* by the very function that finds the current frame */
    T A[9], R[9];
    for (int i = 0; i < 9; i++) A[i] = splat((S)e[i % 3 * 3 + i / 3]);
    frame_polar_higham(A, R);
    for (int i = 0; i < 9; i++) q[i] = (REAL)LANE(R[i % 3 * 3 + i / 3], 0);
  }
}

/* A := tensor of a Voigt vector; shear: factor of its shears (1/2 for strain). */
static void tensor(const REAL *v, REAL shear, REAL *A) {
  A[0] = v[0], A[4] = v[1], A[8] = v[2];
  A[1] = A[3] = shear * v[3], A[5] = A[7] = shear * v[4], A[2] = A[6] = shear * v[5];
}

/* B := Q A Q^T, or Q^T A Q. */
static void turn(const REAL *Q, bool back, const REAL *A, REAL *B) {
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      REAL sum = 0;
      for (int k = 0; k < 3; k++)
        for (int l = 0; l < 3; l++)
          sum += (back ? Q[3 * k + i] * Q[3 * l + j] : Q[3 * i + k] * Q[3 * j + l]) * A[3 * k + l];
      B[3 * i + j] = sum;
    }
}

/* d[21] := D / mu in the axes q, packed. Column by column: unit strain in the
 * axes, stress in the world, stress in the axes. */
static void turned_material(const struct layout *L, const REAL *q, REAL *d) {
  static const int at[6] = {0, 4, 8, 1, 5, 2};
  for (int c = 0; c < 6; c++) {
    REAL v[6] = {0}, A[9], B[9], s[6];
    v[c] = 1;
    tensor(v, (REAL)0.5, A);
    turn(q, true, A, B);
    for (int i = 0; i < 6; i++) v[i] = (i < 3 ? 1 : 2) * B[at[i]];
    for (int i = 0; i < 6; i++) {
      s[i] = 0;
      for (int j = 0; j < 6; j++) s[i] += (REAL)L->material->D[6 * i + j] * v[j];
    }
    tensor(s, 1, A);
    turn(q, false, A, B);
    for (int r = 0; r <= c; r++) d[packed6(r, c)] = B[at[r]] / L->mu;
  }
}

/* Scales of gradients, edges and forces: see the enum of kernels/elements.h. */
static void scale_rest(const struct layout *L, REAL det, REAL share, REAL *r) {
  REAL volume = (det < 0 ? -det : det), W = share * volume / 6;
  REAL s = real_sqrt(L->c * L->mu * W);
  r[REST_W] = s;
  r[REST_FORCE] = real_sqrt(L->mu * W / L->c);
  if (L->model->policy == POLICY_PRECOMPUTED) {
    for (int i = 0; i < 9; i++) r[REST_G + i] *= s;
    r[REST_EDGE] = 1 / s;
  }
  if (L->model->policy == POLICY_UPDATED) {
    r[REST_W] = s / volume;
    if (L->paper && !L->sparse) r[REST_W] = real_sqrt(r[REST_W]);
    if (det < 0) r[REST_FORCE] = -r[REST_FORCE];
  }
}

/* r := rest data of the tetrahedron of the nodes tet[4]. */
static void element_rest(const struct layout *L, const struct cb_mesh *mesh, const uint32_t *tet,
                         REAL *r) {
  REAL e[9], q[9], y[9], *g = r + REST_G;
  for (int i = 0; i < 9; i++)
    e[i] = (REAL)mesh->X[3 * (size_t)tet[1 + i / 3] + (size_t)(i % 3)] -
           (REAL)mesh->X[3 * (size_t)tet[0] + (size_t)(i % 3)];
  rest_axes(L->model->axes, e, q);
  for (int i = 0; i < 9; i++) y[i] = dot(q + i % 3 * 3, e + i / 3 * 3);
  if (L->sparse) y[1] = y[2] = y[5] = 0;
  cross(y + 3, y + 6, g), cross(y + 6, y, g + 3), cross(y, y + 3, g + 6);
  REAL det = dot(y, g);
  for (int i = 0; i < 9; i++) g[i] /= det;
  scale_rest(L, det, (REAL)mesh->share, r);
  if (L->orthotropic) turned_material(L, q, r + REST_D);
  if (L->paper && L->model->policy == POLICY_PRECOMPUTED) {
    REAL *B = r + (L->orthotropic ? REST_ORTHOTROPIC : REST_ISOTROPIC);
    for (int i = 0; i < 3; i++) B[i] = -(g[i] + g[3 + i] + g[6 + i]);
    for (int i = 0; i < 6; i++) B[3 + i] = g[L->sparse && i >= 3 ? i + 1 : i];
    if (L->sparse)
      B[8] = g[8];
    else
      for (int i = 0; i < 3; i++) B[9 + i] = g[6 + i];
  }
}

/* tet[4] := the nodes of tetrahedron i of a pack, in the vertices' own order, on that
 * lane; returns which vertices of the shape these are, two bits each. */
static unsigned slot_nodes(const struct cb_packs *P, size_t p, size_t i, size_t lane,
                           uint32_t *tet) {
  static const uint16_t single[4] = {0, 1, 2, 3};
  const uint16_t *vertex =
      P->pack ? P->corners[P->shape[P->pack[p].shape].corners + i].vertex : single;
  const size_t first = P->pack ? P->pack[p].node : 4 * p;
  const unsigned code = P->order ? P->order[(P->pack[p].slot + i) * LANES + lane] : 0xe4;
  for (size_t j = 0; j < 4; j++)
    tet[j] = P->node[(first + vertex[code >> 2 * j & 3]) * LANES + lane];
  return code;
}

/* Is the vertices' own order an odd permutation of the shape's? */
static bool is_odd(unsigned code) {
  unsigned inversions = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) inversions += (code >> 2 * i & 3) > (code >> 2 * j & 3);
  return inversions % 2;
}

/* r: rest data with b, c, d in the vertices' own order, then in the shape's; there
 * cofactors of the edges, which updated B is made of, may have the other sign. */
static void order_rest(const struct layout *L, unsigned code, REAL *r) {
  REAL all[12], *g = r + REST_G;
  if (L->model->policy == POLICY_UPDATED && is_odd(code)) r[REST_FORCE] = -r[REST_FORCE];
  for (int i = 0; i < 3; i++) {
    all[3 * (code & 3) + i] = -(g[i] + g[3 + i] + g[6 + i]);
    for (int j = 1; j < 4; j++) all[3 * (code >> 2 * j & 3) + i] = g[3 * (j - 1) + i];
  }
  for (int i = 0; i < 9; i++) g[i] = all[3 + i];
}

static void fill_rest(const struct layout *L, const struct cb_mesh *mesh, struct cb_elements *E) {
  const struct cb_packs *P = E->packs;
  for (size_t p = 0; p < P->packs; p++) {
    const size_t slot = P->pack ? P->pack[p].slot : p;
    const size_t tets = P->pack ? P->shape[P->pack[p].shape].tets : 1;
    for (size_t i = 0; i < tets; i++)
      for (size_t lane = 0; lane < LANES; lane++) {
        REAL r[REST_ORTHOTROPIC + 12];
        uint32_t tet[4];
        const unsigned code = slot_nodes(P, p, i, lane, tet);
        element_rest(L, mesh, tet, r);
        if (P->order) order_rest(L, code, r);
        for (size_t n = 0; n < E->rest_numbers; n++)
          LANE(E->rest[(slot + i) * E->rest_numbers + n], lane) = (S)r[n];
      }
  }
}

/* Rest positions, from the middle of the mesh, which rounds them least. */
static enum cb_status rest_positions(const struct cb_mesh *mesh, struct cb_elements *E) {
  E->X = cb_memory(STRIDE * mesh->nodes, sizeof(S));
  if (!E->X) return CB_MEMORY;
  double middle[3] = {0};
  for (size_t i = 0; i < 3 * mesh->nodes; i++) middle[i % 3] += mesh->X[i] / (double)mesh->nodes;
  for (size_t n = 0; n < mesh->nodes; n++)
    for (size_t i = 0; i < STRIDE; i++)
      E->X[STRIDE * n + i] = i < 3 ? (S)((REAL)mesh->X[3 * n + i] - (REAL)middle[i]) : (S)0;
  return CB_OK;
}

/* Column indices of the scalar rows, into node vectors. */
static enum cb_status scalar_pattern(struct cb_elements *E) {
  const struct cb_pattern *p = E->pattern;
  E->scalar_row = array(E, 3 * p->nodes + 1, sizeof *E->scalar_row);
  E->scalar_column = array(E, 9 * p->blocks, sizeof *E->scalar_column);
  if (!E->scalar_row || !E->scalar_column) return CB_MEMORY;
  uint32_t n = 0;
  for (size_t i = 0; i < p->nodes; i++)
    for (int r = 0; r < 3; r++) {
      E->scalar_row[3 * i + (size_t)r] = n;
      for (uint32_t b = p->row_start[i]; b < p->row_start[i + 1]; b++)
        for (uint32_t c = 0; c < 3; c++) E->scalar_column[n++] = STRIDE * p->column[b] + c;
    }
  E->scalar_row[3 * p->nodes] = n;
  return CB_OK;
}

static enum cb_status assembled_arrays(const struct cb_variant *v, const struct cb_mesh *mesh,
                                       struct cb_elements *E) {
  enum cb_status status =
      cb_pattern_create(mesh, E->packs, STRIDE, v->storage == CB_BCSR_SYMMETRIC, &E->pattern);
  if (status) return status;
  E->bytes += E->pattern->bytes;
  E->values = array(E, 9 * E->pattern->blocks + BLOCK_MARGIN, sizeof(S));
  E->beyond = array(E, STRIDE * E->pattern->beyond, sizeof(S));
  if (!E->values || !E->beyond) return CB_MEMORY;
  return v->storage == CB_CSR ? scalar_pattern(E) : CB_OK;
}

void CB_NAME(cb_elements_free)(struct cb_elements *E) {
  if (!E) return;
  void *arrays[] = {E->turn,       E->X,       E->rest,   E->memory,     E->state,
                    E->x,          E->beyond,  E->values, E->scalar_row, E->scalar_column,
                    E->node_frame, E->node_sum};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) free(arrays[i]);
  cb_packs_free(E->packs);
  cb_pattern_free(E->pattern);
  free(E);
}

/* The matrix of the edges of a left-handed element has no nearest rotation worth
 * the name (a regular one has many): there c and d change places. *copy := the
 * tetrahedra, all right-handed, to be freed. */
static enum cb_status upright(const struct cb_mesh *mesh, uint32_t **copy) {
  uint32_t *tet = malloc(4 * mesh->tets * sizeof *tet);
  if (!tet) return CB_MEMORY;
  memcpy(tet, mesh->tet, 4 * mesh->tets * sizeof *tet);
  for (size_t t = 0; t < mesh->tets; t++)
    if (cb_mesh_six_volumes(mesh, t) < 0) {
      tet[4 * t + 2] = mesh->tet[4 * t + 3];
      tet[4 * t + 3] = mesh->tet[4 * t + 2];
    }
  *copy = tet;
  return CB_OK;
}

static enum cb_status allocate(const struct cb_variant *v, const struct cb_mesh *mesh,
                               bool keeps_rest, struct cb_elements *E) {
  const size_t slots = E->packs->slots, threads = E->packs->threads;
  E->turn = array(E, threads, sizeof *E->turn);
  if (keeps_rest) E->rest = array(E, slots * E->rest_numbers, sizeof(T));
  E->memory = array(E, slots * E->memory_numbers, sizeof(T));
  E->state = array(E, slots * E->state_numbers, sizeof(T));
  if (!E->turn || (keeps_rest && !E->rest) || !E->memory || !E->state) return CB_MEMORY;
  if (v->model->node_frames) {
    E->node_frame = array(E, 9 * E->nodes, sizeof(S));
    E->node_sum = array(E, 9 * E->nodes, sizeof(S));
    if (!E->node_frame || !E->node_sum) return CB_MEMORY;
  }
  if (v->storage == CB_EBE_RECOMPUTE) { /* a node vector, not counted */
    E->x = cb_memory(STRIDE * mesh->nodes, sizeof(S));
    if (!E->x) return CB_MEMORY;
  }
  return v->storage >= CB_CSR ? assembled_arrays(v, mesh, E) : CB_OK;
}

/* From node numbers, which nothing needs any more, to places (lanes.h, cluster.h). */
static enum cb_status place_nodes(struct cb_elements *E) {
  if (E->nodes > UINT32_MAX / PLACES) return CB_INPUT;
  for (size_t i = 0; i < E->packs->nodes * LANES; i++) E->packs->node[i] *= PLACES;
  for (size_t i = 0; i < E->packs->all_corners; i++) {
    struct cb_corners *c = E->packs->corners + i;
    for (size_t j = 0; j < 4; j++) {
      c->vertex[j] = (uint16_t)(3 * sizeof(T) * c->vertex[j]);
      c->sum[j] = (uint16_t)(3 * sizeof(T) * c->sum[j]);
    }
  }
  return CB_OK;
}

/* Numbers that are the same in all elements. */
static void constants(const struct layout *L, const struct cb_mesh *mesh, struct cb_elements *E) {
  const REAL nu = (REAL)L->material->poisson;
  E->k = splat(L->orthotropic ? (S)0 : (S)(2 * nu / (1 - 2 * nu)));
  E->root = splat((S)real_sqrt(L->c * L->mu * (REAL)mesh->share / 6));
  E->inverse_root = splat((S)(1 / real_sqrt(L->c * L->mu * (REAL)mesh->share / 6)));
  E->inverse_c = splat((S)(1 / L->c));
}

/* Which nodes, in which packs. */
static enum cb_status pack(const struct cb_variant *v, const struct cb_mesh *mesh, size_t threads,
                           struct cb_elements *E) {
  const bool clustered = v->storage == CB_EBE_CLUSTER || v->storage == CB_EBE_RECOMPUTE;
  /* While what is kept is near: the step was 6 to 11 % faster at 7 MB, and 3 to 20 % slower at
   * 12 to 80, as numbers do not come while a large unit's nodes are gathered and scattered. */
  const bool joined = LANES > 1 && E->kept_bytes < PRODUCT_FETCHES;
  enum cb_status status = cb_packs_create(mesh, LANES, threads, clustered, joined, &E->packs);
  if (status) return status;
  if (E->axes == AXES_WORLD) cb_packs_disorder(E->packs);
  E->bytes += E->packs->bytes;
  return CB_OK;
}

enum cb_status CB_NAME(cb_elements_create)(const struct cb_variant *v, const struct cb_mesh *given,
                                           const struct cb_material *material, double c,
                                           struct cb_team *team, struct cb_elements **out) {
  struct layout L = {.model = v->model, .material = material, .c = (REAL)c};
  L.orthotropic = material->orthotropic;
  L.paper = v->storage == CB_EBE_PAPER;
  L.sparse = v->model->axes == AXES_EDGES;
  REAL nu = (REAL)material->poisson;
  L.mu = L.orthotropic ? (REAL)material->D[21] : (REAL)material->young / (2 * (1 + nu));
  struct cb_mesh mesh = *given;
  uint32_t *turned = NULL;
  struct cb_elements *E = aligned_alloc(64, (sizeof *E + 63) / 64 * 64);
  if (!E) return CB_MEMORY;
  memset(E, 0, sizeof *E);
  E->nodes = mesh.nodes, E->tets = mesh.tets, E->team = team;
  E->policy = v->model->policy, E->axes = v->model->axes;
  E->rest_numbers = rest_numbers(&L);
  E->memory_numbers = v->model->memory_numbers;
  E->state_numbers = v->model->form[v->storage][L.orthotropic].state_numbers;
  constants(&L, &mesh, E);
  /* In clusters, and one element at a time, speed is the aim: what is kept is not
   * made again. Single elements in lanes are as lean as can be. */
  const bool keeps_rest = LANES == 1 || v->storage == CB_EBE_CLUSTER || v->model->keeps_rest ||
                          L.orthotropic || E->axes == AXES_POLAR;
  E->kept_bytes = (E->state_numbers + E->memory_numbers + (keeps_rest ? E->rest_numbers : 0)) *
                  sizeof(S) * E->tets;
  enum cb_status status = CB_OK;
  if (E->axes == AXES_POLAR) status = upright(given, &turned);
  if (turned) mesh.tet = turned;
  if (!status) status = pack(v, &mesh, cb_team_threads(team), E);
  if (!status) status = allocate(v, &mesh, keeps_rest, E);
  if (!status && !keeps_rest) status = rest_positions(&mesh, E);
  if (!status && keeps_rest) fill_rest(&L, &mesh, E);
  if (!status) status = place_nodes(E);
  if (!status) {
    *out = E;
    E = NULL;
  }
  CB_NAME(cb_elements_free)(E);
  free(turned);
  return status;
}

void CB_NAME(cb_elements_reset)(struct cb_elements *E) {
  memset(E->memory, 0, E->packs->slots * E->memory_numbers * sizeof(T));
}

void CB_NAME(cb_elements_tune)(struct cb_elements *E, const struct cb_tuning *tuning) {
  E->frame_iterations = tuning->frame_iterations;
  E->frame_tolerance = (T)splat((S)tuning->frame_tolerance);
  E->lazy = (T)splat((S)tuning->lazy);
}

size_t CB_NAME(cb_elements_bytes)(const struct cb_elements *E) { return E->bytes; }

double CB_NAME(cb_elements_visits)(const struct cb_elements *E) {
  return (double)(E->packs->nodes * LANES) / (double)E->tets;
}

const struct cb_pattern *CB_NAME(cb_elements_pattern)(const struct cb_elements *E) {
  return E->pattern;
}

void CB_NAME(cb_elements_blocks)(const struct cb_elements *E, double *blocks) {
  const struct cb_pattern *p = E->pattern;
  for (size_t i = 0; i < p->nodes; i++) {
    size_t start = p->row_start[i], width = 3 * (p->row_start[i + 1] - start);
    for (size_t b = start; b < p->row_start[i + 1]; b++)
      for (size_t r = 0; r < 3; r++)
        for (size_t c = 0; c < 3; c++)
          blocks[9 * b + 3 * r + c] =
              (double)E->values[E->scalar_row ? 9 * start + r * width + 3 * (b - start) + c
                                              : 9 * b + 3 * r + c];
  }
}

void CB_NAME(cb_from_double)(size_t nodes, const double *xyz, void *vector) {
  S *v = vector;
  for (size_t n = 0; n < nodes; n++)
    for (size_t i = 0; i < STRIDE; i++) v[STRIDE * n + i] = i < 3 ? (S)xyz[3 * n + i] : (S)0;
}

void CB_NAME(cb_to_double)(size_t nodes, const void *vector, double *xyz) {
  const S *v = vector;
  for (size_t n = 0; n < nodes; n++)
    for (size_t i = 0; i < 3; i++) xyz[3 * n + i] = (double)v[STRIDE * n + i];
}
