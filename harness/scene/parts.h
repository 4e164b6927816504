/* parts.h - of what a scene is made: readers of its geometry and material.
 *
 * SPDX-License-Identifier: BSD-3-Clause */
#ifndef CB_SCENE_PARTS_H
#define CB_SCENE_PARTS_H

#include "harness/scene/json.h"
#include "harness/scene/scene.h"

/* Read the scene's member of that name into *s. CB_INPUT, recorded. */
enum cb_status cb_scene_geometry(struct cb_json *json, const json_t *object, struct cb_scene *s);
enum cb_status cb_scene_material(struct cb_json *json, const json_t *object, struct cb_scene *s);

#endif
