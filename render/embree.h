/* embree.h: rays against a tree over a scene's triangles and spheres, behind tracer.h.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct embree_scene embree_scene;

/* As tracer_create. */
facet_status embree_scene_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                                 const void *opacity_user, embree_scene **result, facet_error *why);
void embree_scene_destroy(embree_scene *t);

/* As tracer_nearest and tracer_blocked. */
void embree_nearest(const embree_scene *t, size_t n, rays r, bool is_coherent, hits h);
void embree_blocked(const embree_scene *t, size_t n, rays r, uint32_t *is_blocked);

const char *embree_scene_isa(const embree_scene *t);
void embree_prepare_thread(void);

#ifdef __cplusplus
}
#endif
