/* linear.h: rays against every triangle and sphere of a small scene in turn.
 *
 * Where there are few of them, testing many rays at once against all costs less than walking a tree with each: with
 * 14, a seventh of Embree's time for rays that have been scattered (docs/performance.md).  The results are the same
 * bits on every instruction set.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "render/geometry.h"
#include "render/rays.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { MOST_LINEAR = 64 }; /* triangles and spheres together */

typedef struct linear_triangle {
    real3 corners[3]; /* world space */
    real3 edges[3];   /* from the first corner to the third, the second to the first, the third to the second */
    real3 normal;     /* of any length */
    uint32_t instance, primitive;
} linear_triangle;

typedef struct linear_sphere {
    real3 center;
    float radius;
} linear_sphere;

typedef struct linear_scene {
    uint32_t n_triangles, n_spheres, sphere_instance;
    linear_triangle triangles[MOST_LINEAR];
    linear_sphere spheres[MOST_LINEAR];
} linear_scene;

/* Whether the scene is small enough, and opaque. */
bool linear_is_enough(const scene *s);

void linear_fill(const scene *s, linear_scene *to);

#ifdef __cplusplus
}
#endif
