/* scene_checks.h: what the renderer relies on in a scene that was read.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/scene.h"

/* Every index is in range and every number finite. */
void check_scene(const scene *s);

/* Reads a scene's file; one that is refused says why, one that is read is checked. */
void check_scene_file(const char *path);
