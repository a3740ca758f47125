/* write_glb.h: a benchmark's scene as a .glb file.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/scene.h"

/* The scene's meshes, its materials, which must be of lambert and named by their specification (add_material does so)
 * and emit grey, and a camera at (0, 1, 3.9) that looks along -z.  A failure ends the program. */
void write_glb(const scene *s, const char *path);
