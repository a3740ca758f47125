/* surface.h: what a ray sees where it meets a surface: place, frame, scattering, emission.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/geometry.h"
#include "render/loop_lanes.h"
#include "render/scene.h"
#include "render/tracer.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A hit's distance and position are off by a few ulp of the largest coordinate involved; rays that start this
 * far off (relative to it) never met their own primitive again in 1e6 tries (tests/render/test_tracer.c). */
#define RELATIVE_OFFSET 3e-6f

typedef struct surface {
    real3 position;         /* [m] */
    real3 normal;           /* geometric, unit, on the front side */
    float offset;           /* how far rays start from the surface, to clear its rounding errors [m] */
    bool is_front;          /* seen from the front side */
    bool scatters;          /* false: nothing but emission (unlit) */
    bool transmits;         /* bsdf has a transmitting lobe */
    frame shading;          /* n on the side of wo, but outwards for transmitting materials */
    const facet_bsdf *bsdf; /* the material's, where it is the same all over, or made for this point */
    real3 emission;         /* radiance towards wo [W/(m^2 sr)] */
    real3 unlit;            /* radiance of an unlit surface towards the camera */
} surface;

/* What the hits of an instance or a material have in common. */
typedef struct surface_set surface_set;

/* The scene must stay, unchanged, until surface_set_destroy.  FACET_NO_MEMORY. */
facet_status surface_set_create(const scene *s, surface_set **result);
void surface_set_destroy(surface_set *set);

/* The surface at a hit of ray r; wo = -direction, unit.  Where a material is part smooth interface, part opaque,
 * choice in [0,1) picks one of the two, each with its share as probability.  own: room for a bsdf made for this point;
 * to stay as long as the surface. */
void surface_find(const surface_set *set, const ray *r, const hit *h, real3 wo, float choice, facet_bsdf *own,
                  surface *at);

/* A block of hits of plain triangles: of one bsdf, without emission, whose frames are those of their normals.  Loops
 * find them (surface_loops_text.h).  Lanes keep what they have of an instance until another comes. */
typedef struct plain_block {
    float corners[3][3][LOOP_LANES], normals[3][3][LOOP_LANES]; /* of the triangles, as their mesh has them */
    float u[LOOP_LANES], v[LOOP_LANES];
    float to_world[3][4][LOOP_LANES], sign[LOOP_LANES], column[LOOP_LANES], offset[LOOP_LANES]; /* the instance's */
    uint32_t instance[LOOP_LANES];                                                              /* one more */
    uint32_t is_there[LOOP_LANES], is_smooth[LOOP_LANES]; /* all bits, or none; the latter: there are normals */
    float up[3][LOOP_LANES];                              /* the loop's own: the frames' normals */
    uint32_t is_bent[LOOP_LANES];
    bool has_smooth;
} plain_block;

/* Loads the hits order[0], order[1], ... of n into the lanes from `lane` on, up to the end of the block or to one of
 * another kind: their number.  They get their bsdfs, and whether these transmit: all bits, or none. */
uint32_t surface_load_plain(const surface_set *set, hits h, uint32_t n, const uint32_t *order, plain_block *block,
                            uint32_t lane, const facet_bsdf **bsdfs, uint32_t *transmits);

/* Interpolated and mapped normals n may lean so far from the true one g (both on the viewer's side) that the mirror
 * image of wo lies under the surface, and the surface looks black: unless its cosine with g is at least this, ... */
static inline float least_mirror_cosine(float cos_wo)
{
    return kmin(0.9f*cos_wo, 0.01f);
}

static inline float mirror_cosine(real3 n, real3 g, real3 wo)
{
    return 2*dot3(n, wo)*dot3(n, g) - dot3(wo, g);
}

/* ... n is brought back to where it is just enough. */
real3 surface_bend_normal(real3 n, real3 g, real3 wo);

/* glTF's single-sided surfaces are not drawn from behind; light meets them all the same. */
bool surface_is_hidden(const surface_set *set, const hit *h, real3 direction);

/* Fetches what will be wanted of the hits that come some after order[0] of n into the caches. */
void surface_expect(const surface_set *set, hits h, uint32_t n, const uint32_t *order);

/* The indices of the materials at n hits, n_materials for those that are none. */
void surface_materials(const surface_set *set, uint32_t n, hits h, uint32_t *materials);

/* Radiance that a point of a triangle emits on its emitting side(s), from factors and texture. */
real3 surface_emission(const scene *s, const mesh *m, uint32_t triangle, float u, float v);

/* Base-colour alpha at a point of a triangle; user is the scene.  A tracer_opacity. */
float surface_opacity(const void *user, uint32_t mesh_index, uint32_t triangle, float u, float v);

/* A point just off the surface on the side that `direction` leaves to. */
static inline real3 leave_surface(real3 position, real3 normal, float offset, real3 direction)
{
    return madd3(position, dot3(direction, normal) > 0 ? offset : -offset, normal);
}

static inline real3 surface_leave(const surface *at, real3 direction)
{
    return leave_surface(at->position, at->normal, at->offset, direction);
}

#ifdef __cplusplus
}
#endif
