/* scene.h - what is to be simulated and what it needs: geometry, material, what is
 * held, pushed and moved, step and duration, laws and tolerances. Read strictly
 * from scenes/NAME.json; units are in the keys.
 *
 * What a scene does not name is not there: absent parts cost nothing in a step.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SCENE_H
#define CB_SCENE_H

#include "kernels/kernel.h"

/* Nodes of the rest shape in a box of fractions of its bounding box. */
struct cb_selection {
  double low[3], high[3];
};

struct cb_load {
  struct cb_selection where;
  double force[3]; /* N, on all of them together, shared out by mass */
};

/* Nodes that go their way: from t = 0 to `over` turned about their centre and moved,
 * then held; free from t = `until` on, starting at rest. */
struct cb_handle {
  struct cb_selection where;
  double turn[3]; /* rad, times the axis */
  double move[3]; /* m */
  double over;    /* s, > 0 */
  double until;   /* s; 0: to the end */
};

/* Young's modulus from that time on, where it is not the material's all the time. */
struct cb_stiffening {
  double from, young; /* s, Pa */
};

enum { CB_SCENE_LIST = 8 }; /* at most so many selections, loads, handles or stages */

/* What the result is for; a tolerance of infinity is no need. */
struct cb_needs {
  unsigned laws;       /* bits CB_KEEPS(law) */
  double displacement; /* largest error of a point, of the scene's size */
  double torque;       /* largest relative ghost torque, 1 */
  double energy;       /* largest error of the energy, of its largest value */
  double frames_per_s; /* in real time; 0: no need */
  double rest;         /* largest cb_body_distance from the rest shape in the end, 1 */
  bool inversion;      /* elements invert, and must be upright in the end */
};

struct cb_scene {
  char name[64], about[200];
  char path[512];      /* of its file, or "": for messages */
  char mesh_path[512]; /* of a mesh file; "": ... */
  char shape[16];      /* ... a cb_mesh_shape; "": a block of ten tetrahedra a cell */
  size_t cells[3];     /* of the block; of a shape the first, to its length */
  double cell;         /* m; of a shape: its length */
  double scale;        /* of the mesh file's lengths */
  struct cb_material material;
  struct cb_selection fixed[CB_SCENE_LIST];
  struct cb_load load[CB_SCENE_LIST];
  struct cb_handle handle[CB_SCENE_LIST];
  struct cb_stiffening stage[CB_SCENE_LIST]; /* in ascending order */
  size_t fixed_count, load_count, handle_count, stage_count;
  double gravity[3];           /* m/s^2 */
  bool grounded;               /* there is a ... */
  double ground;               /* ... plane z = ground, m: no free node is below it after a step */
  double velocity[3], spin[3]; /* at the start, m/s, rad/s about the centre of mass */
  double stretch[3], twist;    /* at the start: 1; rad about z, from foot to head */
  double alpha, beta;          /* Rayleigh damping, s, 1/s; alpha = 0 with handles */
  double step, duration;       /* s */
  struct cb_needs needs;
};

/* Read scenes/NAME.json, name: the file's without .json. CB_INPUT with file, line, what
 * was found and what was expected; CB_IO, CB_MEMORY. */
enum cb_status cb_scene_read(const char *path, struct cb_scene *scene);
/* The same from a text that is no file; messages and a mesh file's folder go by `name`. */
enum cb_status cb_scene_parse(const char *name, const char *text, struct cb_scene *scene);

/* Record "path:line: entry <n + 1> of '<list>' <sentence>", line of that entry in the
 * scene's file; CB_INPUT. Of a scene without a file: "scene '<name>': ...". */
enum cb_status cb_scene_fail(const struct cb_scene *scene, const char *list, size_t n,
                             const char *sentence);

#endif
