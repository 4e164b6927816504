/* body.h - a scene made into nodes and numbers, at some resolution.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_BODY_H
#define CB_BODY_H

#include "harness/bench/bench.h"
#include "harness/scene/points.h"
#include "harness/scene/scene.h"

/* Nodes of one handle. */
struct cb_grip {
  const struct cb_handle *handle;
  size_t count;
  uint32_t *node;
  double centre[3]; /* of its nodes at rest, m */
};

struct cb_body {
  const struct cb_scene *scene;
  struct cb_bench_scene at; /* mesh, material, mass, what is held, the start */
  uint8_t *anchored;        /* [nodes] held all the time; at.fixed: and what handles hold */
  double *external;         /* [3*nodes] N; NULL: no load and no gravity */
  struct cb_grip grip[CB_SCENE_LIST];
  struct cb_point point[CB_POINTS]; /* the same places at every resolution */
  double size;                      /* largest edge of the bounding box at rest, m */
};

/* resolution: of a generated mesh, cells for each one of the scene's (0.5: half as
 * many along each edge; at least one); a mesh file is taken as it is: 1. The scene is
 * kept. CB_INPUT, recorded: a selection without nodes, an unreadable mesh, a number
 * that is not finite; CB_IO,
 * CB_MEMORY. */
enum cb_status cb_body_create(const struct cb_scene *scene, double resolution,
                              struct cb_body *body);
void cb_body_free(struct cb_body *body); /* zeroed is allowed */

/* node[] := the nodes that are selected, in their order; node has room for all. Returns how
 * many. */
size_t cb_body_chosen(const struct cb_body *body, const struct cb_selection *where, uint32_t *node);
/* x[3*nodes] := where the handles are at time t; other nodes are left alone, and those of
 * handles that have let go. */
void cb_body_grip(const struct cb_body *body, double t, double *x);
/* p[3*CB_POINTS] := the points' places for node positions x[3*nodes]. */
void cb_body_points(const struct cb_body *body, const double *x, double *p);

/* Does a handle hold for a step that ends at time t? Not where it ends later than `until`. */
bool cb_handle_holds(const struct cb_handle *handle, double t);
/* Largest distance of a node from its place in the rest shape, turned and shifted to where
 * it fits x[3*nodes] best (least squares by mass), of the body's size. NaN where x is not
 * finite. Mirrored shapes are far: no reflection is taken. */
double cb_body_distance(const struct cb_body *body, const double *x);

#endif
