/* film.h - pictures of a body while it runs: for ParaView, and for plots/film.gp, which
 * draws a strip and an animation of them.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_FILM_H
#define CB_FILM_H

#include "harness/files/output.h"
#include "harness/scene/run.h"

enum { CB_STRIP = 8 }; /* pictures in a strip, or all if there are fewer */

struct cb_film_face; /* of the boundary */

struct cb_film {
  const struct cb_body *body;
  const char *directory;
  size_t count, room; /* pictures seen, and that there is room for */
  struct cb_picture {
    double time;     /* s */
    size_t inverted; /* elements */
    double distance; /* cb_body_distance */
    double way;      /* that the nodes have gone so far: mean, of the size */
  } * picture;
  double *before; /* [3*nodes] in the last picture */
  struct cb_film_face *face;
  size_t faces;
  struct cb_output shape, grips;
};

/* directory is made if it is not there; it and the body are kept. most: pictures at most. End
 * with cb_film_close, or cb_film_abandon. CB_IO, CB_MEMORY. */
enum cb_status cb_film_open(const struct cb_body *body, const char *directory, size_t most,
                            struct cb_film *film);
/* One more picture; positions that are not finite make none. A cb_watch.see. */
enum cb_status cb_film_see(void *film, double t, const double *x);
/* Write, beside NAME-0000.vtu and the others, of which NAME.pvd is the list,
 *   NAME-faces.txt   "x_m y_m z_m shade inverted" of nodes of the boundary's faces, each face as
 *                    two scans of two (the last node twice) and one that is not a number, as
 *                    gnuplot's pm3d draws patches; two blank lines after each picture, which is
 *                    an `index`; shade: 0 to 1, by the angle to a light above, in front and to
 *                    the left; inverted: 1 if its element is
 *   NAME-grips.txt   "x_m y_m z_m moved" of every selection that is held (0) or moved (1)
 *   NAME-film.csv    picture,time_s,inverted,tetrahedra,distance,ground_m,strip (1: in the
 *                    strip: about as much time and motion is between two as between others;
 *                    and what there is when the first stage begins and handles let go)
 * and free the film, in any case. The film has a picture. CB_IO, CB_MEMORY. */
enum cb_status cb_film_close(struct cb_film *film);
void cb_film_abandon(struct cb_film *film); /* zeroed is allowed */

#endif
