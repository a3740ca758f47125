/* tracer.h: rays against a scene's triangles and spheres: by Embree's tree, or one after the other where they are few.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/rays.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tracer tracer;

/* One ray and what it met, as in rays.h. */
typedef struct ray {
    float origin[3], t_min, direction[3], t_max;
    uint32_t seed;
} ray;

typedef struct hit {
    float t, u, v;
    uint32_t instance, primitive;
} hit;

/* The opacity in [0,1] of a triangle at (u,v), for meshes whose material is not opaque. */
typedef float tracer_opacity(const void *user, uint32_t mesh, uint32_t triangle, float u, float v);

/* isa: see render_settings; with the name of an instruction set Embree traces whatever the size.  The scene must stay
 * until tracer_destroy.  Thread safe from then on. */
facet_status tracer_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                           const void *opacity_user, tracer **result, facet_error *why);
void tracer_destroy(tracer *t);

/* Arrays of rays, hits and answers hold whole vectors: room for n rounded up to a multiple of this. */
enum { TRACER_LANES = 64 };

/* The nearest surface of n rays; none for rays with a coordinate that is not finite or above 1e18.  coherent: they
 * have one origin, and neighbours in the array are neighbours in direction.  What a ray meets does not depend on the
 * others. */
void tracer_nearest(const tracer *t, size_t n, rays r, bool is_coherent, hits h);

/* Whether anything lies on each of n rays; true for rays that cannot be traced. */
void tracer_blocked(const tracer *t, size_t n, rays r, uint32_t *is_blocked);

/* The same for one ray; false if there is no surface. */
bool tracer_intersect(const tracer *t, const ray *r, hit *found);
bool tracer_occluded(const tracer *t, const ray *r);

/* Embree's instruction set in use: "avx2", ...; "any" where it does not trace, and all give the same bits.  Static
 * storage. */
const char *tracer_isa(const tracer *t);

/* To be called once by each thread that traces: denormal numbers become zero, as Embree asks. */
void tracer_prepare_thread(void);

#ifdef __cplusplus
}
#endif
