/* packs.h - which elements are worked on together, by whom and when. A pack is
 * `lanes` units of the same shape, one a lane; a unit is a tetrahedron, or one or more
 * clusters of them (kernels/cluster_joins.h). Every thread has a chunk of packs, in
 * three parts:
 *   0  packs with a node that a later thread's chunk has as well,
 *   1  packs whose nodes no other chunk has,
 *   2  packs with a node that an earlier thread's chunk has as well.
 * Part 0 is done first; before part 2 a thread waits until the earlier ones it
 * shares nodes with have done their part 0. So no two threads add to a node at
 * the same time, and every node's sum has the same order in every run.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PACKS_H
#define CB_PACKS_H

#include "kernels/cluster_joins.h"

/* A tetrahedron of a shape: its vertices as local nodes; where their sums are before it
 * adds to them: CB_UNIT_NODES, where there is zero, if it is the first that does. In
 * numbers of nodes, until the storage makes places of them. */
struct cb_corners {
  uint16_t vertex[4], sum[4];
};

struct cb_pack_shape {
  uint8_t nodes, tets;
  uint32_t corners; /* those of its tetrahedra begin there */
};

struct cb_pack {
  uint32_t node; /* its node indices begin at node * lanes */
  uint32_t slot; /* its tetrahedra are the slots from here on */
  uint16_t shape;
  uint16_t live; /* lanes that are units of their own; the others repeat the last */
};

struct cb_chunk {
  size_t part[4];    /* packs part[k] to part[k+1] - 1 are part k */
  size_t last_live;  /* live lanes of its last pack; the others are full (single) */
  uint64_t after[2]; /* threads to wait for before part 0, and before part 2; bits */
};

enum { CB_LANES_MOST = 16 };

struct cb_packs {
  size_t lanes, threads, packs;
  size_t slots;           /* of tetrahedra, `lanes` in each; single: a pack is a slot */
  size_t nodes;           /* of node indices, `lanes` of each */
  uint32_t *node;         /* [nodes][lanes]; single: [packs][4][lanes] */
  struct cb_chunk *chunk; /* [threads] */
  /* clusters only, else NULL */
  struct cb_pack *pack; /* [packs] */
  struct cb_pack_shape *shape;
  size_t all_corners;
  struct cb_corners *corners; /* [all_corners] of all shapes */
  uint8_t *order;             /* [slots][lanes] bits 2j and 2j + 1: which vertex of the shape is the
                                 mesh's own vertex j; NULL: all are the same */
  size_t bytes;               /* of every array here */
};

/* clustered: units are clusters; joined: which are joined where that fills packs. CB_MEMORY;
 * CB_INPUT: more than 2^32 numbers. */
enum cb_status cb_packs_create(const struct cb_mesh *mesh, size_t lanes, size_t threads,
                               bool clustered, bool joined, struct cb_packs **out);
/* The models do not depend on the order of vertices: forget the mesh's own. */
void cb_packs_disorder(struct cb_packs *packs);
void cb_packs_free(struct cb_packs *packs); /* NULL is allowed */

#endif
