/* fuzz_scene.c - the bytes as a scene; what is accepted is made into a body, at its own and
 * at another resolution, unless that would be large or needs another file.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>

#include "harness/scene/body.h"
#include "tests/fuzz/fuzz.h"

/* The generated shapes take seconds at their finest. */
static int is_small(const struct cb_scene *s) {
  if (s->mesh_path[0]) return 0;
  if (s->shape[0]) return s->cells[0] <= 6;
  return s->cells[0] * s->cells[1] * s->cells[2] <= 64;
}

static void make_body(const struct cb_scene *scene, double resolution) {
  struct cb_body body = {0};
  const enum cb_status status = cb_body_create(scene, resolution, &body);
  fuzz_require(!status || cb_error_message()[0], "a refusal has a sentence");
  if (status) return;
  fuzz_require(body.at.mesh.tets > 0, "a body has tetrahedra");
  for (size_t i = 0; i < 3 * body.at.mesh.nodes; i++)
    fuzz_require(isfinite(body.at.mesh.X[i]), "a body at rest is finite");
  cb_body_free(&body);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static struct fuzz_file file;
  struct cb_scene scene;
  if (!file.path[0]) fuzz_files(1, (const char *[]){"scene.json"}, &file);
  fuzz_write(&file, data, size);
  const enum cb_status status = cb_scene_read(file.path, &scene);
  fuzz_check(status, file.path);
  if (status) return 0;
  fuzz_require(strcmp(scene.name, "scene") == 0, "a scene is named after its file");
  fuzz_require(scene.duration / scene.step >= 1, "a scene has a step");
  if (!is_small(&scene)) return 0;
  make_body(&scene, 1);
  make_body(&scene, 0.5);
  return 0;
}
