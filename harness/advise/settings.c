/* settings.c - the recommended variant with longer and shorter steps and on coarser
 * meshes: the cheapest setting is not always a faster kernel.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include "harness/advise/explorer.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

/* The recommended variant with that step, on that mesh, until the needs are met. Errors are
 * those against the scene's own mesh: a coarser one pays for what it leaves out. */
static enum cb_status try_setting(struct explorer *e, struct cb_advice *a, double step,
                                  double resolution) {
  struct cb_setting s = {.step = step, .resolution = resolution};
  struct cb_body body = {0};
  const struct cb_body *own = e->body;
  const double steps_per_frame = a->steps_per_frame;
  enum cb_status status = cb_body_create(own->scene, resolution, &body);
  if (status) return status;
  s.candidate = a->ranked[0];
  s.candidate.trial.step = step;
  s.tetrahedra = body.at.mesh.tets;
  cb_explorer_say(e, "other steps and meshes");
  e->body = &body;
  a->steps_per_frame *= own->scene->step / step;
  for (size_t i = 0; !status && i < CB_ADVISE_ITERATIONS; i++) {
    s.candidate.trial.iterations = cb_advise_iterations[i];
    status = cb_explorer_try(e, a, &s.candidate);
    if (!(s.candidate.unmet & CB_NEED_ERRORS) || !s.candidate.finite) break;
  }
  s.seconds = e->outcome.seconds;
  e->body = own;
  a->steps_per_frame = steps_per_frame;
  if (!status) a->setting[a->setting_count++] = s;
  cb_body_free(&body);
  return status;
}

enum cb_status cb_explorer_settings(struct explorer *e, struct cb_advice *a) {
  static const double steps[] = {1, 2, 4, 0.5}, resolutions[] = {0.8, 0.6};
  const struct cb_scene *scene = e->body->scene;
  enum cb_status status = CB_OK;
  for (size_t i = 0; !status && i < COUNT(steps); i++)
    status = try_setting(e, a, steps[i] * scene->step, 1);
  for (size_t i = 0; !status && !scene->mesh_path[0] && i < COUNT(resolutions); i++)
    status = try_setting(e, a, scene->step, resolutions[i]);
  return status;
}
