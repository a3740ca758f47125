/* light_set.h: what emits, as light_points.c chooses from it and lights.c collects it.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/alias.h"
#include "render/light_tree.h"
#include "render/light_triangle.h"
#include "render/lights.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum emitter_kind { EMITTER_TRIANGLE, EMITTER_SPHERE, EMITTER_PUNCTUAL, EMITTER_SKY } emitter_kind;

typedef struct emitter {
    emitter_kind kind;
    uint32_t instance, primitive; /* triangle; primitive alone: sphere or punctual light */
    bool is_double_sided;
    bool is_even;            /* a triangle that emits the same radiance everywhere */
    light_triangle triangle; /* light_triangle.h */
    float offset;            /* how far shadow rays stop from a sphere [m] */
    float strength;          /* mean radiance, or intensity, or irradiance of a directional light (luminances) */
} emitter;

struct light_set {
    const scene *scene;
    sky sky;
    emitter *emitters;
    uint32_t n_emitters, capacity;
    uint32_t n_placed;   /* these come first; the rest are equally far from all points */
    light_tree placed;   /* for more than MOST_WEIGHED */
    alias_table distant; /* likewise, over the rest, if there are any */
    float distant_weight;
    bool needs_receivers;  /* more than MOST_ALIKE */
    bool is_few_triangles; /* no more than MOST_WEIGHED, all of them triangles but for the sky, if there is one: */
    bool is_plain;         /* ... no sky, and all of the triangles even */
    uint32_t n_triangles;
    light_triangle triangles[MOST_WEIGHED];
    float sky_strength;        /* emitter.strength; 0: none */
    size_t *first_of_instance; /* [n_instances] index of the emitter of triangle 0, or NONE */
    size_t *of_sphere;         /* [n_spheres] emitter or NONE */
    size_t sky_emitter;        /* or NONE */
};

/* About the irradiance that a distant emitter brings. */
static inline float distant_importance(const emitter *e)
{
    return e->kind == EMITTER_SKY ? e->strength*PI : e->strength;
}

#ifdef __cplusplus
}
#endif
