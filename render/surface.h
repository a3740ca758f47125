/* surface.h: what a ray sees where it meets a surface: place, frame, scattering, emission.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/geometry.h"
#include "render/scene.h"
#include "render/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A hit's distance and position are off by a few ulp of the largest coordinate involved; rays that start this
 * far off (relative to it) never met their own primitive again in 1e6 tries (tests/render/test_tracer.c). */
#define RELATIVE_OFFSET 3e-6f

typedef struct surface {
    real3 position; /* [m] */
    real3 normal;   /* geometric, unit, on the front side */
    float offset;   /* how far rays start from the surface, to clear its rounding errors [m] */
    bool is_front;  /* seen from the front side */
    bool scatters;  /* false: nothing but emission (unlit) */
    bool transmits; /* bsdf has a transmitting lobe */
    frame shading;  /* n on the side of wo, but outwards for transmitting materials */
    facet_bsdf bsdf;
    real3 emission; /* radiance towards wo [W/(m^2 sr)] */
    real3 unlit;    /* radiance of an unlit surface towards the camera */
} surface;

/* The surface at a hit of ray r; wo = -direction, unit.  Where a material is part smooth interface, part opaque,
 * choice in [0,1) picks one of the two, each with its share as probability. */
surface surface_at(const scene *s, const ray *r, const hit *h, real3 wo, float choice);

/* Radiance that a point of a triangle emits on its emitting side(s), from factors and texture. */
real3 surface_emission(const scene *s, const mesh *m, uint32_t triangle, float u, float v);

/* Base-colour alpha at a point of a triangle; user is the scene.  A tracer_opacity. */
float surface_opacity(const void *user, uint32_t mesh_index, uint32_t triangle, float u, float v);

/* A point just off the surface on the side that `direction` leaves to. */
real3 surface_leave(const surface *at, real3 direction);

#ifdef __cplusplus
}
#endif
