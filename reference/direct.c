/* direct.c - the implicit step system by CHOLMOD.
 * The long interface: index arrays are small beside a supernodal factor, and no
 * size limit has to be checked.
 * Trade: exact to rounding, at a cost and a memory that grow faster than the
 *        mesh; the conjugate gradients are measured against it.
 * Source: Chen, Davis, Hager, Rajamanickam 2008 (CHOLMOD).
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "reference/direct.h"

#include <cholmod.h>
#include <float.h>
#include <stdlib.h>
#include <string.h>

struct cb_direct {
  cholmod_common common;
  cholmod_sparse *A; /* lower triangle over the free unknowns */
  cholmod_factor *L;
  cholmod_dense *b, *x, *Y, *E; /* right-hand side, solution, solve2's workspace */
  cholmod_dense *first;         /* the solution before its refinement */
  size_t nodes, free_nodes;
  uint32_t *free_node; /* [free_nodes] mesh node of each free one, ascending */
  size_t *source;      /* per entry of A, its place in blocks */
  bool factored;
};

static enum cb_status status_of(const cholmod_common *common) {
  switch (common->status) {
  case CHOLMOD_OK: return CB_OK;
  case CHOLMOD_NOT_POSDEF: return CB_NUMERIC;
  case CHOLMOD_OUT_OF_MEMORY:
  case CHOLMOD_TOO_LARGE: return CB_MEMORY;
  default: return CB_BROKEN;
  }
}

static size_t free_nodes_list(size_t nodes, const uint8_t *fixed, uint32_t *list) {
  size_t count = 0;
  for (size_t i = 0; i < nodes; i++)
    if (!fixed || !fixed[i]) list[count++] = (uint32_t)i;
  return count;
}

/* Entries of the lower triangle: 9 a block, 6 a diagonal block. */
static size_t lower_entries(const struct cb_direct *d, const uint32_t *row_start,
                            const uint32_t *column, const uint8_t *fixed) {
  size_t entries = 0;
  for (size_t f = 0; f < d->free_nodes; f++) {
    uint32_t node = d->free_node[f];
    for (uint32_t k = row_start[node]; k < row_start[node + 1]; k++)
      if (column[k] >= node && !(fixed && fixed[column[k]])) entries += column[k] == node ? 6 : 9;
  }
  return entries;
}

/* Column 3f+c of the lower triangle is row 3f+c of the upper one, which the
 * pattern's row holds in ascending order; so each column starts with its
 * diagonal entry. rank[node]: its place among the free nodes. */
static void fill_pattern(struct cb_direct *d, const uint32_t *row_start, const uint32_t *column,
                         const uint8_t *fixed, const uint32_t *rank) {
  SuiteSparse_long *start = d->A->p, *row = d->A->i;
  size_t entry = 0;
  for (size_t f = 0; f < d->free_nodes; f++) {
    uint32_t node = d->free_node[f];
    for (size_t c = 0; c < 3; c++) {
      start[3 * f + c] = (SuiteSparse_long)entry;
      for (uint32_t k = row_start[node]; k < row_start[node + 1]; k++) {
        if (column[k] < node || (fixed && fixed[column[k]])) continue;
        for (size_t r = column[k] == node ? c : 0; r < 3; r++) {
          row[entry] = 3 * (SuiteSparse_long)rank[column[k]] + (SuiteSparse_long)r;
          d->source[entry++] = 9 * (size_t)k + 3 * c + r;
        }
      }
    }
  }
  start[3 * d->free_nodes] = (SuiteSparse_long)entry;
}

/* What solve2 would allocate by itself; where memory ends there, it reads what it has not got. */
static enum cb_status allocate_workspace(struct cb_direct *d, size_t n) {
  const bool there = cholmod_l_ensure_dense(&d->x, n, 1, n, CHOLMOD_REAL, &d->common) &&
                     cholmod_l_ensure_dense(&d->Y, n, 1, n, CHOLMOD_REAL, &d->common) &&
                     cholmod_l_ensure_dense(&d->E, 1, d->L->maxesize, 1, CHOLMOD_REAL, &d->common);
  return there ? CB_OK : CB_MEMORY;
}

static enum cb_status build_matrix(struct cb_direct *d, const uint32_t *row_start,
                                   const uint32_t *column, const uint8_t *fixed) {
  size_t n = 3 * d->free_nodes, entries = lower_entries(d, row_start, column, fixed);
  uint32_t *rank = calloc(d->nodes, sizeof *rank);
  enum cb_status status = CB_MEMORY;
  d->source = calloc(entries, sizeof *d->source);
  if (!rank || !d->source) goto done;
  for (size_t f = 0; f < d->free_nodes; f++) rank[d->free_node[f]] = (uint32_t)f;
  d->A = cholmod_l_allocate_sparse(n, n, entries, 1, 1, -1, CHOLMOD_REAL, &d->common);
  d->b = cholmod_l_allocate_dense(n, 1, n, CHOLMOD_REAL, &d->common);
  d->first = cholmod_l_allocate_dense(n, 1, n, CHOLMOD_REAL, &d->common);
  if (!d->A || !d->b || !d->first) goto done;
  fill_pattern(d, row_start, column, fixed, rank);
  d->L = cholmod_l_analyze(d->A, &d->common);
  status = status_of(&d->common);
  if (!status) status = allocate_workspace(d, n);
done:
  free(rank);
  return status;
}

enum cb_status cb_direct_create(size_t nodes, const uint32_t *row_start, const uint32_t *column,
                                const uint8_t *fixed, struct cb_direct **out) {
  enum cb_status status = CB_MEMORY;
  struct cb_direct *d = calloc(1, sizeof *d);
  if (!d) return CB_MEMORY;
  cholmod_l_start(&d->common);
  d->common.print = 0;
  d->common.supernodal = CHOLMOD_SUPERNODAL;
  d->nodes = nodes;
  d->free_node = malloc((nodes + 1) * sizeof *d->free_node);
  if (!d->free_node) goto done;
  d->free_nodes = free_nodes_list(nodes, fixed, d->free_node);
  /* Where nothing is free, nothing is built and x = 0. */
  status = d->free_nodes ? build_matrix(d, row_start, column, fixed) : CB_OK;
done:
  if (status == CB_OK)
    *out = d;
  else
    cb_direct_free(d);
  return status;
}

void cb_direct_free(struct cb_direct *d) {
  if (!d) return;
  cholmod_l_free_sparse(&d->A, &d->common);
  cholmod_l_free_factor(&d->L, &d->common);
  cholmod_l_free_dense(&d->b, &d->common);
  cholmod_l_free_dense(&d->first, &d->common);
  cholmod_l_free_dense(&d->x, &d->common);
  cholmod_l_free_dense(&d->Y, &d->common);
  cholmod_l_free_dense(&d->E, &d->common);
  cholmod_l_finish(&d->common);
  free(d->free_node);
  free(d->source);
  free(d);
}

/* A pivot is what the elimination leaves of a diagonal entry. Where it leaves
 * less than the rounding of that entry, the sign says nothing: singular. The
 * ratio does not depend on units or on the scale of single unknowns. */
static bool pivots_are_sound(const struct cb_direct *d) {
  const cholmod_factor *L = d->L;
  const SuiteSparse_long *super = L->super, *pi = L->pi, *px = L->px, *perm = L->Perm;
  const SuiteSparse_long *start = d->A->p;
  const double *l = L->x, *a = d->A->x, limit = (double)L->n * DBL_EPSILON;
  for (size_t s = 0; s < L->nsuper; s++) {
    SuiteSparse_long rows = pi[s + 1] - pi[s];
    for (SuiteSparse_long j = super[s]; j < super[s + 1]; j++) {
      double root = l[px[s] + (j - super[s]) * (rows + 1)];
      if (!(root * root > limit * a[start[perm[j]]])) return false;
    }
  }
  return true;
}

enum cb_status cb_direct_factor(struct cb_direct *d, const double *blocks, const double *diagonal) {
  d->factored = false;
  if (d->free_nodes) {
    const SuiteSparse_long *start = d->A->p;
    double *a = d->A->x;
    size_t n = 3 * d->free_nodes;
    for (size_t e = 0; e < (size_t)start[n]; e++) a[e] = blocks[d->source[e]];
    for (size_t j = 0; diagonal && j < n; j++) a[start[j]] += diagonal[d->free_node[j / 3]];
    cholmod_l_factorize(d->A, d->L, &d->common);
    enum cb_status status = status_of(&d->common);
    if (status != CB_OK) return status;
    if (!pivots_are_sound(d)) return CB_NUMERIC;
  }
  d->factored = true;
  return CB_OK;
}

/* d->x := A^-1 d->b */
static enum cb_status solve_once(struct cb_direct *d) {
  cholmod_l_solve2(CHOLMOD_A, d->L, d->b, NULL, &d->x, NULL, &d->Y, &d->E, &d->common);
  return status_of(&d->common);
}

/* y := y - A x, A symmetric, its lower triangle stored by columns */
static void subtract_product(const cholmod_sparse *A, const double *x, double *y) {
  const SuiteSparse_long *start = A->p, *row = A->i;
  const double *a = A->x;
  for (size_t j = 0; j < A->ncol; j++) {
    double sum = a[start[j]] * x[j];
    for (SuiteSparse_long e = start[j] + 1; e < start[j + 1]; e++) {
      y[row[e]] -= a[e] * x[j];
      sum += a[e] * x[row[e]];
    }
    y[j] -= sum;
  }
}

enum cb_status cb_direct_solve(struct cb_direct *d, const double *b, double *x) {
  size_t n = 3 * d->free_nodes;
  double *first = d->first ? d->first->x : NULL;
  if (!d->factored) return CB_NUMERIC;
  if (n) {
    double *right = d->b->x;
    for (size_t j = 0; j < n; j++) right[j] = b[3 * d->free_node[j / 3] + j % 3];
    enum cb_status status = solve_once(d);
    if (status != CB_OK) return status;
    memcpy(first, d->x->x, n * sizeof *first);
    subtract_product(d->A, first, right);
    status = solve_once(d);
    if (status != CB_OK) return status;
  }
  memset(x, 0, 3 * d->nodes * sizeof *x);
  for (size_t j = 0; j < n; j++)
    x[3 * d->free_node[j / 3] + j % 3] = first[j] + ((const double *)d->x->x)[j];
  return CB_OK;
}

size_t cb_direct_bytes(const struct cb_direct *d) {
  size_t entries = d->A ? d->A->nzmax : 0;
  return sizeof *d + (d->nodes + 1) * sizeof *d->free_node + entries * sizeof *d->source +
         d->common.memory_inuse;
}
