/* cost.h - the work and the traffic of a product, per tetrahedron.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_COST_H
#define CB_COST_H

#include "harness/bench/bench.h"

/* Is the product that of an assembled matrix, whole or half? */
bool cb_cost_assembled(const struct cb_variant *v);

/* Operations (multiplications, additions, divisions, roots; a fused multiply-add is
 * two) of one product, and of one whole step of cb_bench_step, executed by the counted
 * arithmetic of the same model and storage on the scene, by its tetrahedra. Clusters
 * of lanes may differ a little from those of the counted one. CB_MEMORY; CB_BROKEN
 * when the program was linked without the counter. */
enum cb_status cb_cost_product(const struct cb_variant *v, const struct cb_bench_scene *scene,
                               double *flops);
enum cb_status cb_cost_step(const struct cb_variant *v, const struct cb_bench_scene *scene,
                            double *flops);

/* Bytes that one product has to move at least: what it reads of the operator (all of
 * it but what only the update uses: rest shape, memory of frames, sums of edges), and
 * its node vectors, each read or written once (recompute reads the positions as well). */
double cb_cost_bytes(const struct cb_operator *op, const struct cb_mesh *mesh);

#endif
