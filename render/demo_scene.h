/* demo_scene.h: the scene that `facet render` shows when it is given none.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Shader balls that show off the models, under soft lights.  The caller destroys *result. */
facet_status demo_scene_create(scene **result, facet_error *why);

#ifdef __cplusplus
}
#endif
