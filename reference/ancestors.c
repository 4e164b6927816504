/* ancestors.c - precomputed inverse and condensation, through the direct solver.
 * Source: Cotin, Delingette, Clement et al. 1996; James, Pai 1999 (inverse);
 *         Bro-Nielsen, Cotin 1996 (condensation).
 * Trade:  a load costs (3 count)^2 products, whatever the interior; memory is
 *         dense in the surface, and K may not change.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/ancestors.h"

#include "reference/direct.h"

#include <float.h>
#include <gsl/gsl_cblas.h>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <stdlib.h>
#include <string.h>

/* The create functions' matrix. */
struct stiffness {
  size_t nodes;
  const uint32_t *row_start, *column;
  const double *blocks;
};

/* Place in a mesh vector of a place in a surface vector. */
static size_t mesh_place(const uint32_t *surface, size_t place) {
  return 3 * (size_t)surface[place / 3] + place % 3;
}

static enum cb_status factor_new(const struct stiffness *K, const uint8_t *fixed,
                                 struct cb_direct **out) {
  struct cb_direct *d = NULL;
  enum cb_status status = cb_direct_create(K->nodes, K->row_start, K->column, fixed, &d);
  if (status != CB_OK) return status;
  status = cb_direct_factor(d, K->blocks, NULL);
  if (status == CB_OK)
    *out = d;
  else
    cb_direct_free(d);
  return status;
}

/* ---- precomputed inverse -------------------------------------------------- */

struct cb_inverse {
  size_t n;  /* surface unknowns, 3 a node */
  double *G; /* n*n row-major, column j: surface displacement under a unit force at j */
};

/* Fixed nodes need no case of their own: their columns and rows come out 0. */
static enum cb_status inverse_columns(struct cb_direct *d, size_t nodes, const uint32_t *surface,
                                      struct cb_inverse *inverse) {
  enum cb_status status = CB_MEMORY;
  double *b = calloc(3 * nodes, sizeof *b), *x = calloc(3 * nodes, sizeof *x);
  if (!b || !x) goto done;
  for (size_t j = 0; j < inverse->n; j++) {
    b[mesh_place(surface, j)] = 1;
    status = cb_direct_solve(d, b, x);
    if (status != CB_OK) goto done;
    b[mesh_place(surface, j)] = 0;
    for (size_t i = 0; i < inverse->n; i++)
      inverse->G[i * inverse->n + j] = x[mesh_place(surface, i)];
  }
done:
  free(b);
  free(x);
  return status;
}

enum cb_status cb_inverse_create(size_t nodes, const uint32_t *row_start, const uint32_t *column,
                                 const double *blocks, const uint8_t *fixed, size_t count,
                                 const uint32_t *surface, struct cb_inverse **out) {
  struct stiffness K = {nodes, row_start, column, blocks};
  struct cb_direct *d = NULL;
  struct cb_inverse *inverse = NULL;
  if (count == 0) return CB_INPUT;
  enum cb_status status = factor_new(&K, fixed, &d);
  if (status != CB_OK) return status;
  status = CB_MEMORY;
  inverse = calloc(1, sizeof *inverse);
  if (!inverse) goto done;
  inverse->n = 3 * count;
  inverse->G = calloc(inverse->n, inverse->n * sizeof *inverse->G);
  if (!inverse->G) goto done;
  status = inverse_columns(d, nodes, surface, inverse);
done:
  cb_direct_free(d);
  if (status == CB_OK)
    *out = inverse;
  else
    cb_inverse_free(inverse);
  return status;
}

void cb_inverse_free(struct cb_inverse *inverse) {
  if (!inverse) return;
  free(inverse->G);
  free(inverse);
}

void cb_inverse_apply(const struct cb_inverse *inverse, const double *f, double *u) {
  int n = (int)inverse->n;
  /* By rows: by columns GSL skips the zeros of f, and the time of a product would
   * depend on how many nodes are loaded. */
  cblas_dgemv(CblasRowMajor, CblasNoTrans, n, n, 1, inverse->G, n, f, 1, 0, u, 1);
}

size_t cb_inverse_bytes(const struct cb_inverse *inverse) {
  return sizeof *inverse + inverse->n * inverse->n * sizeof *inverse->G;
}

/* ---- condensation --------------------------------------------------------- */

struct cb_condensation {
  size_t n, free_count; /* surface unknowns, and how many of them are free */
  size_t *place;        /* [free_count] places of the free ones, ascending */
  gsl_matrix *S;        /* Cholesky factor of the Schur complement, or NULL */
  gsl_vector *u;        /* free unknowns of one load, or NULL: nothing is free */
};

/* (K x) in one unknown. */
static double row_product(const struct stiffness *K, size_t dof, const double *x) {
  size_t node = dof / 3, r = dof % 3;
  double sum = 0;
  for (uint32_t k = K->row_start[node]; k < K->row_start[node + 1]; k++) {
    const double *row = K->blocks + 9 * (size_t)k + 3 * r, *xk = x + 3 * (size_t)K->column[k];
    sum += row[0] * xk[0] + row[1] * xk[1] + row[2] * xk[2];
  }
  return sum;
}

/* b := -K e_dof, for a symmetric K */
static void negative_column(const struct stiffness *K, size_t dof, double *b) {
  size_t node = dof / 3, r = dof % 3;
  memset(b, 0, 3 * K->nodes * sizeof *b);
  for (uint32_t k = K->row_start[node]; k < K->row_start[node + 1]; k++)
    for (size_t c = 0; c < 3; c++)
      b[3 * (size_t)K->column[k] + c] = -K->blocks[9 * (size_t)k + 3 * r + c];
}

/* Column j of the Schur complement is the surface force that holds a unit
 * displacement of j while the interior settles at w_i = -K_ii^-1 K_ij. The
 * Cholesky decomposition reads the lower triangle only. diagonal[] := that of
 * K_ss. */
static enum cb_status schur_columns(const struct stiffness *K, struct cb_direct *interior,
                                    const uint32_t *surface, struct cb_condensation *c,
                                    double *diagonal) {
  enum cb_status status = CB_OK;
  double *b = calloc(3 * K->nodes, sizeof *b), *w = calloc(3 * K->nodes, sizeof *w);
  if (!b || !w) status = CB_MEMORY;
  for (size_t j = 0; j < c->free_count && status == CB_OK; j++) {
    size_t dof = mesh_place(surface, c->place[j]);
    negative_column(K, dof, b);
    status = cb_direct_solve(interior, b, w);
    if (status != CB_OK) break;
    diagonal[j] = -b[dof];
    w[dof] = 1;
    for (size_t i = j; i < c->free_count; i++)
      gsl_matrix_set(c->S, i, j, row_product(K, mesh_place(surface, c->place[i]), w));
  }
  free(b);
  free(w);
  return status;
}

/* S := its Cholesky factor. Sound pivots as in direct.c: S inherits the rounding
 * of K_ss, whose diagonal is given, and of all unknowns that were eliminated. */
static enum cb_status schur_factor(gsl_matrix *S, size_t unknowns, const double *diagonal) {
  const double limit = (double)unknowns * DBL_EPSILON;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  int failed = gsl_linalg_cholesky_decomp1(S);
  gsl_set_error_handler(handler);
  if (failed) return CB_NUMERIC;
  for (size_t j = 0; j < S->size1; j++) {
    double root = gsl_matrix_get(S, j, j);
    if (!(root * root > limit * diagonal[j])) return CB_NUMERIC;
  }
  return CB_OK;
}

static enum cb_status condense(const struct stiffness *K, struct cb_direct *interior,
                               const uint32_t *surface, struct cb_condensation *c) {
  if (c->free_count == 0) return CB_OK;
  double *diagonal = calloc(c->free_count, sizeof *diagonal);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  c->S = gsl_matrix_alloc(c->free_count, c->free_count);
  c->u = gsl_vector_alloc(c->free_count);
  gsl_set_error_handler(handler);
  enum cb_status status = CB_MEMORY;
  if (c->S && c->u && diagonal) status = schur_columns(K, interior, surface, c, diagonal);
  if (status == CB_OK) status = schur_factor(c->S, 3 * K->nodes, diagonal);
  free(diagonal);
  return status;
}

enum cb_status cb_condensation_create(size_t nodes, const uint32_t *row_start,
                                      const uint32_t *column, const double *blocks,
                                      const uint8_t *fixed, size_t count, const uint32_t *surface,
                                      struct cb_condensation **out) {
  struct stiffness K = {nodes, row_start, column, blocks};
  struct cb_direct *interior = NULL;
  if (count == 0) return CB_INPUT;
  enum cb_status status = CB_MEMORY;
  struct cb_condensation *c = calloc(1, sizeof *c);
  uint8_t *outside = calloc(nodes, 1); /* nodes that are not eliminated */
  if (!c || !outside) goto done;
  c->n = 3 * count;
  c->place = calloc(c->n, sizeof *c->place);
  if (!c->place) goto done;
  if (fixed) memcpy(outside, fixed, nodes);
  for (size_t i = 0; i < c->n; i++)
    if (!fixed || !fixed[surface[i / 3]]) c->place[c->free_count++] = i;
  for (size_t i = 0; i < count; i++) outside[surface[i]] = 1;
  status = factor_new(&K, outside, &interior);
  if (status == CB_OK) status = condense(&K, interior, surface, c);
done:
  cb_direct_free(interior);
  free(outside);
  if (status == CB_OK)
    *out = c;
  else
    cb_condensation_free(c);
  return status;
}

void cb_condensation_free(struct cb_condensation *c) {
  if (!c) return;
  free(c->place);
  gsl_matrix_free(c->S);
  gsl_vector_free(c->u);
  free(c);
}

void cb_condensation_apply(struct cb_condensation *c, const double *f, double *u) {
  for (size_t i = 0; i < c->free_count; i++) gsl_vector_set(c->u, i, f[c->place[i]]);
  if (c->free_count) gsl_linalg_cholesky_svx(c->S, c->u);
  memset(u, 0, c->n * sizeof *u);
  for (size_t i = 0; i < c->free_count; i++) u[c->place[i]] = gsl_vector_get(c->u, i);
}

size_t cb_condensation_bytes(const struct cb_condensation *c) {
  size_t free_count = c->free_count;
  return sizeof *c + c->n * sizeof *c->place +
         (free_count ? sizeof *c->S + sizeof *c->u + 2 * sizeof(gsl_block) : 0) +
         (free_count + 1) * free_count * sizeof(double);
}
