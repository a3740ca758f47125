/* path.h: the path tracer: all paths of a tile together through the stages generate, trace, meet
 * surfaces, connect to lights, scatter.
 *
 * [cs500] CS500 Project 3, TracePath, in its corrected form: light is found both by rays towards lights and by
 * scattered rays that meet them, weighted by the power heuristic with the bare densities of the two; Russian
 * roulette comes after the explicit term, so that it touches neither density.  docs/integrator.md.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "render/film.h"
#include "render/lights.h"
#include "render/render.h"
#include "render/sampler.h"
#include "render/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Everything that paths share; read only while they run. */
typedef struct path_context {
    const scene *scene;
    const camera *camera;
    const tracer *tracer;
    const light_set *lights;
    const surface_set *surfaces;
    sampler sampler;
    bool keeps_features;             /* the film does */
    bool has_mixed_surfaces;         /* some material is part smooth interface, part opaque */
    bool has_gradients;              /* neighbouring pixels share light */
    const render_settings *settings; /* crop filled in */
} path_context;

typedef struct path_counts {
    uint64_t n_paths, n_rays, n_shadow_rays, n_bad;
    uint32_t n_reported;
    bad_sample bad[RENDER_MAX_REPORTED];
} path_counts;

/* Pixels x0 <= x < x1, y0 <= y < y1 of the crop. */
typedef struct tile {
    uint32_t x0, y0, x1, y1;
} tile;

/* A tile is a block of film_noise, so that its own error can end it. */
#define TILE_SIZE FILM_BLOCK

/* A thread's workspace for one tile's paths. */
typedef struct path_batch path_batch;
path_batch *path_batch_create(const scene *s);
void path_batch_destroy(path_batch *batch);

/* Adds sample number `sample` of every pixel of the tile to the film, and its features if the film keeps them. */
void path_batch_run(path_batch *batch, const path_context *context, tile where, uint32_t sample, film *to,
                    path_counts *counts);

#ifdef __cplusplus
}
#endif
