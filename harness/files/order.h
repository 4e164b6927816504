/* order.h - a mesh renumbered so that what is computed together lies together
 * in memory: neighbouring nodes get close numbers, and tetrahedra come in the
 * sequence of their nodes. Only node numbers and the sequence of the tetrahedra
 * change: the four vertices of each keep theirs, on which QR frames depend.
 * Measured (interleaved medians, busy machine): a step of qr-updated/ebe/f64, 5
 * iterations, on a shuffled grid over that on the grid: 106 480 tetrahedra 1.19 as
 * it comes, 1.00 ordered; 973 360: 2.5 and 1.00, along a Hilbert curve 1.04 to 1.07
 * and nodes of one tetrahedron up to the whole mesh apart.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_ORDER_H
#define CB_ORDER_H

#include "kernels/kernel.h"

struct cb_order {
  size_t nodes, tets;
  uint32_t *node; /* [nodes] new number of each old node */
  uint32_t *tet;  /* [tets] old tetrahedron at each new place */
};

/* An order of the mesh's nodes and tetrahedra, found in linear time from the
 * tetrahedra alone, not from positions; the same mesh gives the same order. Any
 * mesh of fewer than 2^32 nodes and tetrahedra is allowed, in several pieces or
 * with nodes that no tetrahedron uses; node indices are not checked. Free with
 * cb_order_free. CB_MEMORY. */
enum cb_status cb_order_create(const struct cb_mesh *mesh, struct cb_order *order);
void cb_order_free(struct cb_order *order); /* and zero it; a zeroed order is allowed */

/* *ordered := the mesh in the new order, to be freed with cb_mesh_free. The mesh
 * must be of the order's size. CB_MEMORY. */
enum cb_status cb_order_mesh(const struct cb_order *order, const struct cb_mesh *mesh,
                             struct cb_mesh *ordered);

/* The mesh put into an order of its own, where no one needs the old numbers. CB_MEMORY. */
enum cb_status cb_order_apply(struct cb_mesh *mesh);

/* Node vectors of `width` numbers a node (mass: 1, positions: 3) from the old
 * numbers to the new, and back. in and out must not overlap. */
void cb_order_forward(const struct cb_order *order, size_t width, const double *in, double *out);
void cb_order_backward(const struct cb_order *order, size_t width, const double *in, double *out);

#endif
