/* rays.h: many rays and what they met, as arrays.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Components of as many vectors. */
typedef struct vectors {
    float *x, *y, *z;
} vectors;

static inline vectors vectors_from(vectors v, size_t first)
{
    const vectors rest = {v.x + first, v.y + first, v.z + first};
    return rest;
}

/* t_min < t < t_max along an unnormalised direction.  seed: decides about half-transparent surfaces. */
typedef struct rays {
    vectors origin, direction;
    float *t_min, *t_max;
    uint32_t *seed;
} rays;

#define NO_HIT UINT32_MAX

/* instance: index into scene.instances, scene.n_instances for a sphere, NO_HIT where there is no surface, and the rest
 * is not set then; primitive: the triangle or the sphere; u, v: weights of the triangle's second and third vertex. */
typedef struct hits {
    float *t, *u, *v;
    uint32_t *instance, *primitive;
} hits;

#ifdef __cplusplus
}
#endif
