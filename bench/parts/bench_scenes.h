/* bench_scenes.h: the scenes of the renderer's benchmarks.
 *
 * The boxes are open to the front and have one square light: `spheres` (12 triangles, a rough metal and a smooth glass
 * sphere: the scene on which other renderers were measured), `70k` (a displaced ball, 69,324 triangles), `2M` (eight of
 * them, 2,160,012) and `gtr` (two metals with long tails).  `veach` is Veach's scene of plates and lamps, `helmet` and
 * `car` are textured models under photographs of skies; these three are read from ../shared/assets.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/render.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bench_scene {
    const char *name;
    scene *(*make)(void); /* NULL where its file is not there */
    strategy other;       /* what the usual one can be held against: explicit light cannot find what mirrors show */
} bench_scene;

enum { BENCH_SCENES = 7 };
extern const bench_scene bench_scenes[BENCH_SCENES];

/* The ball of `70k` with 12 n^2 triangles. */
scene *bench_ball_scene(uint32_t n);

#ifdef __cplusplus
}
#endif
