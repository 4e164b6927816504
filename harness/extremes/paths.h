/* paths.h - an element turned inside out: through each vertex, each pair of opposite edges
 * and the centre, in small steps, flat after a third of the way; and one vertex straight
 * through its face, where the nearest rotation jumps: elsewhere it turns fast.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_PATHS_H
#define CB_PATHS_H

#include "harness/extremes/exact.h"
#include "harness/extremes/extremes.h"
#include "harness/files/table.h"

enum { CB_PATHS = 9, CB_PATH_CENTRE = 7, CB_PATH_STEPS = 150 };
extern const char *const cb_path_name[CB_PATHS];

/* F of an element with the unit vectors as edges at rest; t in [0, 1], flat at 1/3. No two
 * of its singular values are the same but at rest, at the centre, and straight. */
void cb_path_gradient(size_t path, double t, double F[9]);

/* Every path at the times 0, 1 / CB_PATH_STEPS ... 1, one path after the other. */
struct cb_walk {
  enum cb_definition definition; /* of the frame */
  bool framed;                   /* the model offers its frame */
  double *R;                     /* [9] each: frames, each by itself (cold) */
  double *f;                     /* [12] each: force / (E L^2), one step after the other */
  double *exact;                 /* [9] each: R by its definition; well-conditioned or NaN */
};
/* known: an earlier one of the same definition and precision, to take `exact` from; NULL:
 * none. CB_MEMORY, recorded. Free with cb_walk_free. */
enum cb_status cb_walk_along(const struct cb_variant *v, const struct cb_walk *known,
                             struct cb_walk *w);
void cb_walk_free(struct cb_walk *w);
static inline size_t cb_walk_index(size_t path, size_t step) {
  return path * (CB_PATH_STEPS + 1) + step;
}

/* The angle between two rotations, degrees, 0 to 180; 90 for a rotation and the same one
 * reflected; NaN if either is not finite. */
double cb_frames_angle(const double *Q, const double *R);

/* One model of each frame that the variants have, in f64: how far its frame and the exact
 * one have turned since rest and in this step, force and its change. CB_MEMORY, recorded. */
enum cb_status cb_paths_table(const struct cb_extremes *all, struct cb_table **table);

#endif
