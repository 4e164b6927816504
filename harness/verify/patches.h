/* patches.h - the samples on which laws are measured: many disconnected patches
 * in one mesh, each with its own random deformation; or a user's mesh, which is
 * one patch.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PATCHES_H
#define CB_PATCHES_H

#include "kernels/kernel.h"

struct cb_patches {
  struct cb_mesh mesh;
  size_t count, nodes, tets; /* patches; nodes and tetrahedra of each */
  double size;               /* typical edge, m */
  /* node positions, m, [3*mesh.nodes] */
  double *x;      /* strongly deformed, turned and moved: inverted ones too */
  double *before; /* the shape of the step before x: near it, not it */
  double *cosine; /* a closed path X + cosine cos t + sine sin t, t in [0, 2 pi], */
  double *sine;   /* on which no element comes near inversion */
};

/* count patches of one random tetrahedron (tets = 1) or of two that share a face
 * (tets = 2: what belongs to a node differs from what belongs to an element).
 * strength: standard deviation of node displacements in edges. CB_MEMORY. */
enum cb_status cb_patches_random(size_t count, size_t tets, double strength, unsigned long seed,
                                 struct cb_patches *p);
/* One patch: a copy of the mesh. CB_MEMORY. */
enum cb_status cb_patches_mesh(const struct cb_mesh *mesh, double strength, unsigned long seed,
                               struct cb_patches *p);
void cb_patches_free(struct cb_patches *p);

/* Q[9] := a random rotation, row-major, from three uniform numbers in [0, 1)
 * (Shoemake 1992); angle < 0: uniform over all, else that angle about a random
 * axis. */
void cb_random_rotation(const double u[3], double angle, double *Q);

#endif
