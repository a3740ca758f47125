/* loops.h: the renderer's loops over many rays or samples, one table of them per instruction set.
 *
 * All give the same bits.  Arrays hold whole vectors: n is rounded up to a multiple of LOOP_LANES.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "render/light_tree.h"
#include "render/light_triangle.h"
#include "render/lights.h"
#include "render/linear.h"
#include "render/loop_lanes.h"
#include "render/rays.h"
#include "render/sampler.h"

#ifdef __cplusplus
extern "C" {
#endif

/* stages.h */
struct vertex_list;
struct gradient_list;
struct sight_list;
struct vector_array;
struct ray_array;

/* Of elements of 32 bits, so many of which are moved together. */
enum { PACKED = 8 };
typedef struct packed_array {
    const void *from;
    void *to;
} packed_array;

typedef struct render_loops {
    const char *name;
    void (*nearest)(const linear_scene *s, size_t n, rays r, hits h);
    /* blocked[i]: whether anything lies on ray i. */
    void (*blocked)(const linear_scene *s, size_t n, rays r, uint32_t *blocked);
    /* The group's three numbers for n streams, as 32-bit fractions; NULL: not asked for. */
    void (*points)(const sampler *s, size_t n, const uint32_t *pixel, const uint32_t *index, uint32_t group,
                   uint32_t *const u[3]);
    /* Rays from pixels x, y of a picture of that size, by the numbers u.  extent: half the picture's height at unit
     * distance, or anywhere. */
    void (*view)(const camera *camera, float extent, float width, float height, size_t n, const float *x,
                 const float *y, uint32_t *const u[3], struct ray_array *r);
    /* Copies those of n elements, no more than PATHS, for which keeps is 1, not 0, one after the other: their number.
     * What follows them, up to a vector's, is overwritten.  starts: where each PACKED of them are; NULL: one after the
     * other. */
    uint32_t (*pack)(uint32_t n, const uint32_t *starts, const uint32_t *keeps, size_t n_arrays,
                     const packed_array *arrays);
    /* keeps of those for which it is 1 is changed by that which was packed for them, of n in whole vectors. */
    void (*unpack)(uint32_t n, const uint32_t *starts, const uint32_t *packed, uint32_t *keeps);
    /* sky_place of n directions. */
    void (*find_sky)(size_t n, vectors direction, float *u, float *v);
    /* Vertices from `first`, the first of a block, on: those in the block's hits; wi: wo in world space. */
    void (*meet)(struct vertex_list *v, size_t first, plain_block *block);
    /* For each of n points one of the triangles, or n_triangles for a sky of such a strength, MOST_WEIGHED in all, by
     * the numbers c.rest, of which those that choose the sky get the rest.  has_receivers: by more than positions. */
    void (*choose_light)(uint32_t n_triangles, const light_triangle *triangles, float sky_strength, size_t n,
                         light_receivers to, bool has_receivers, light_choices c);
    /* light_set_rate for those. */
    void (*rate_light)(uint32_t n_triangles, const light_triangle *triangles, float sky_strength, size_t n,
                       light_receivers to, bool has_receivers, light_choices c);
    /* light_tree_draw for n points, among the tree's lights and something distant of a weight of its own, which is
     * LIGHT_DISTANT, by the numbers c.rest.  The receivers get the tree's weight. */
    void (*walk_light_tree)(const light_tree *tree, size_t n, light_receivers to, const float *distant,
                            light_choices c);
    /* light_tree_rate of the tree's lights, its n_lights, among c.which, where c.probability is not 0. */
    void (*rate_light_tree)(const light_tree *tree, uint32_t n_lights, size_t n, light_receivers to, light_choices c);
    /* For each of n points one on its triangle, c.which of few, as light_set_sample (lights.h). */
    void (*light)(uint32_t n_triangles, const light_triangle *triangles, size_t n, vectors from, light_choices c,
                  uint32_t *const u[3], light_samples s);
    /* ... on any triangle. */
    void (*light_any)(const light_triangle *const *chosen, const float *probability, size_t n, vectors from,
                      uint32_t *const u[3], light_samples s);
    /* wi to where the density tells what is broad about the scattering; then, with that density in pdf, `broad` of the
     * receivers, and wi to the mirror image; then, with the density there, the rest of the receivers. */
    void (*look_aside)(struct vertex_list *v);
    void (*look_at_mirror)(struct vertex_list *v);
    void (*receive)(struct vertex_list *v);
    /* wi towards the lights; none where a light lies on the other side of the true surface than of the shading frame.
     * is_implicit: none but delta lights. */
    void (*aim)(struct vertex_list *v, bool is_implicit);
    /* Rays to the lights, and in f what they bring; is_mis: by the power heuristic. */
    void (*connect)(struct vertex_list *v, bool is_mis, struct sight_list *to);
    /* Rays along the sampled directions wi, and in f what the paths carry then. */
    void (*scatter)(struct vertex_list *v, bool has_roulette);
    /* No density where there is nothing to share, and apart what the film cannot hold, which counts it.  Whether any
     * density is left. */
    bool (*drop_dark)(struct gradient_list *g, struct vector_array *far);
    /* wo of second vertices to the first ones of the pixels a step on. */
    void (*look_back)(struct vertex_list *second, const struct vertex_list *first, ptrdiff_t step);
    /* Adds a part of the paths' light to that which is shared and, by f for that wo over the path's own, to what is
     * seen of it from there. */
    void (*contrast)(const struct vertex_list *second, const struct vector_array *own_f,
                     const struct vector_array *light, struct gradient_list *g);
    /* From first vertices to the second ones of the pixels a step before, as to lights. */
    void (*reach)(struct vertex_list *first, struct gradient_list *g, const struct sight_list *to);
    /* What the light of those is worth there, by f and pdf towards the vertices that are to be looked at. */
    void (*rate_seconds)(const struct vertex_list *first, const struct gradient_list *g, struct sight_list *to);
    /* The lamps of the pixels a step before, and the numbers that chose them. */
    void (*take_lamps)(struct vertex_list *first, const struct gradient_list *g, const struct sight_list *to);
    /* What those are worth there, by what they bring. */
    void (*rate_lamps)(const struct vertex_list *first, const struct gradient_list *g, struct sight_list *to);
    /* What is passed on, of lamps by both pixels' sight, is given to pixels and taken from those a step before. */
    void (*give)(struct gradient_list *g, size_t n, const struct sight_list *from, bool is_of_lamps);
    /* Weights of neighbours. */
    void (*liken)(struct gradient_list *g, size_t width, size_t height);
    /* The light that fits best. */
    void (*fit)(struct gradient_list *g, size_t width, size_t height, struct vector_array *light);
    /* All that pixels have gathered. */
    void (*gather)(const struct gradient_list *g, struct vector_array *light);
} render_loops;

/* Those of the instruction set that libfacet's batches use. */
const render_loops *render_loops_chosen(void);

extern const render_loops render_loops_base;
#if defined(__x86_64__)
extern const render_loops render_loops_avx2;
extern const render_loops render_loops_avx512;
#endif

#ifdef __cplusplus
}
#endif
