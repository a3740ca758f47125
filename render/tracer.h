/* tracer.h: rays against a scene's triangles and spheres.  embree.c is behind it.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tracer tracer;

/* t_min < t < t_max along an unnormalised direction.  seed: decides about half-transparent surfaces. */
typedef struct ray {
    float origin[3], t_min, direction[3], t_max;
    uint32_t seed;
} ray;

/* What a ray met.  instance: index into scene.instances, or scene.n_instances for a sphere; primitive: the
 * triangle or the sphere; u, v: weights of the triangle's second and third vertex. */
typedef struct hit {
    float t, u, v;
    uint32_t instance, primitive;
} hit;

/* The opacity in [0,1] of a triangle at (u,v), for meshes whose material is not opaque. */
typedef float tracer_opacity(const void *user, uint32_t mesh, uint32_t triangle, float u, float v);

/* isa: see render_settings.  The scene must stay until tracer_destroy.  Thread safe from then on. */
facet_status tracer_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                           const void *opacity_user, tracer **result, facet_error *why);
void tracer_destroy(tracer *t);

/* The nearest surface; false if there is none, or if a coordinate of the ray is not finite or above 1e18. */
bool tracer_intersect(const tracer *t, const ray *r, hit *found);

/* Whether anything lies on the ray; true for rays that cannot be traced. */
bool tracer_occluded(const tracer *t, const ray *r);

/* The instruction set in use: "avx2", ...; static storage. */
const char *tracer_isa(const tracer *t);

/* To be called once by each thread that traces: denormal numbers become zero, as Embree asks. */
void tracer_prepare_thread(void);

#ifdef __cplusplus
}
#endif
