/* verb_scene.c - `corobench scene`: is a scene file right, and what is in it?
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdio.h>

#include "harness/error.h"
#include "harness/files/mesh.h"
#include "harness/scene/body.h"

static const char doc[] =
    "Check a scene file and say what it makes: nodes, tetrahedra, what is held, pushed and moved, "
    "steps, and what the result needs.\vThe keys of a scene file are described in "
    "scenes/README.md.";

static void row(struct cb_table *t, const char *name, double value, const char *unit) {
  if (isinf(value)) return; /* no need */
  cb_table_text(t, name);
  cb_table_number(t, value);
  cb_table_text(t, unit);
}

static void add_needs(struct cb_table *t, const struct cb_needs *n) {
  for (int law = 0; law < CB_LAWS; law++)
    if (n->laws & CB_KEEPS(law)) row(t, cb_law_name[law], 1, "needed law");
  row(t, "displacement_error", n->displacement, "needed: at most, of the size");
  row(t, "torque", n->torque, "needed: at most, relative");
  row(t, "energy_error", n->energy, "needed: at most, of the largest energy");
  row(t, "rest_distance", n->rest, "needed: at most, of the size");
  if (n->frames_per_s > 0) row(t, "frames_per_s", n->frames_per_s, "needed, in real time");
  if (n->inversion) row(t, "inversion", 1, "needed: upright in the end");
}

static void add_quality(struct cb_table *t, const struct cb_mesh *mesh) {
  double least = INFINITY, sum = 0;
  for (size_t e = 0; e < mesh->tets; e++) {
    const double quality = fabs(cb_mesh_quality(mesh->X, mesh->tet + 4 * e));
    least = fmin(least, quality);
    sum += quality;
  }
  row(t, "quality_least", least, "of the regular tetrahedron");
  row(t, "quality_mean", sum / (double)mesh->tets, "of the regular tetrahedron");
}

static enum cb_status print(const struct cb_body *b, enum cb_format format) {
  const struct cb_scene *s = b->scene;
  struct cb_table *t = cb_table_create("what,value,unit");
  if (!t) return cb_fail_memory("the table");
  size_t fixed = 0, moved = 0;
  for (size_t i = 0; i < b->at.mesh.nodes; i++) fixed += b->at.fixed[i];
  for (size_t n = 0; n < s->handle_count; n++) moved += b->grip[n].count;
  row(t, "nodes", (double)b->at.mesh.nodes, "");
  row(t, "tetrahedra", (double)b->at.mesh.tets, "");
  add_quality(t, &b->at.mesh);
  row(t, "size", b->size, "m");
  row(t, "held_nodes", (double)(fixed > moved ? fixed - moved : 0), "");
  row(t, "moved_nodes", (double)moved, "");
  row(t, "loads", (double)s->load_count, "");
  if (s->stage_count) row(t, "stages", (double)s->stage_count, "of stiffness");
  if (s->grounded) row(t, "ground", s->ground, "m");
  row(t, "step", s->step, "s");
  row(t, "steps", ceil(s->duration / s->step * (1 - 1e-9)), "");
  add_needs(t, &s->needs);
  if (format == CB_TABLE) printf("%s: %s\n", s->name, s->about);
  enum cb_status status = cb_table_print(t, format, stdout);
  cb_table_free(t);
  return status;
}

static enum cb_status run(int argc, char **argv) {
  struct cb_options o;
  struct cb_scene scene;
  struct cb_body body = {0};
  enum cb_status status =
      cb_options_parse(argc, argv, CB_OPT_SCENE | CB_OPT_FORMAT, doc, NULL, NULL, NULL, &o);
  if (!status) status = cb_scene_read(o.scene_path, &scene);
  if (!status) status = cb_body_create(&scene, 1, &body);
  if (!status) status = print(&body, o.format);
  cb_body_free(&body);
  return status;
}

const struct cb_verb cb_verb_scene = {"scene", "check a scene file and say what is in it", run};
