/* ancestors.h - the linear methods that the paper descends from: precomputed
 * inverse [CDC*96, JP99] and condensation [BNC96]. Both answer "which surface
 * displacement u (m) does this surface force f (N) cause?" for one constant
 * stiffness matrix, with nothing left of the interior nodes.
 *
 * Common to both create functions:
 * in   row_start[nodes+1], column[], blocks[9*count]  K, N/m, as for
 *        cb_direct_create and cb_direct_factor; may go away afterwards
 *      fixed[nodes]  nonzero: that node does not move; must hold K still
 *      surface[count]  nodes that are loaded and seen, each once and each below
 *        `nodes`: not checked
 * out  *out  to be freed with the matching free function (NULL allowed)
 * CB_INPUT when count is 0; CB_MEMORY; CB_NUMERIC when K with those nodes fixed
 * is not positive definite to rounding.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ANCESTORS_H
#define CB_ANCESTORS_H

#include "kernels/kernel.h"
#include "reference/surface.h" /* the list that both are made for */

/* ---- precomputed inverse: u = (K^-1)_ss f, a dense product ---------------- */

struct cb_inverse;
enum cb_status cb_inverse_create(size_t nodes, const uint32_t *row_start, const uint32_t *column,
                                 const double *blocks, const uint8_t *fixed, size_t count,
                                 const uint32_t *surface, struct cb_inverse **out);
void cb_inverse_free(struct cb_inverse *inverse);
/* u[3*count] := displacement under f[3*count], nodes in the order of `surface`;
 * exactly 0 at fixed nodes. u must not overlap f (f would be lost). The work does
 * not depend on f. */
void cb_inverse_apply(const struct cb_inverse *inverse, const double *f, double *u);
size_t cb_inverse_bytes(const struct cb_inverse *inverse);

/* ---- condensation: (K_ss - K_si K_ii^-1 K_is) u = f, by dense Cholesky ----- */

struct cb_condensation;
enum cb_status cb_condensation_create(size_t nodes, const uint32_t *row_start,
                                      const uint32_t *column, const double *blocks,
                                      const uint8_t *fixed, size_t count, const uint32_t *surface,
                                      struct cb_condensation **out);
void cb_condensation_free(struct cb_condensation *condensation);
/* As cb_inverse_apply; u may be f. */
void cb_condensation_apply(struct cb_condensation *condensation, const double *f, double *u);
size_t cb_condensation_bytes(const struct cb_condensation *condensation);

#endif
