/* stages.h: the stages of the path tracer and what they hand on: arrays over all paths of a tile.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "render/loops.h"
#include "render/path.h"
#include "render/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Groups of numbers: one for the camera, then these for every scattering event. */
enum { GROUP_CAMERA, GROUP_LIGHT, GROUP_SCATTER, GROUP_CHANCE, GROUPS_PER_EVENT = 3 };

/* Roulette starts at this event, and ends paths that carry less than this share of the light (docs/performance.md). */
#define ROULETTE_START 2
#define ROULETTE_BELOW 0.5f

/* Arrays of a power of two would lie at equal offsets in their pages, and evict each other from the first cache. */
enum { PATHS = TILE_SIZE*TILE_SIZE, ROOM = PATHS + 16 };

/* An array that begins with a cache line; so do those that follow it. */
#define LINE_ALIGNED __attribute__((aligned(64)))

/* Arrays that are packed at once. */
enum { MOST_PACKED = 32 };

typedef struct vector_array {
    float x[ROOM], y[ROOM], z[ROOM];
} vector_array;

/* Numbers of pixels, with so much room before and after them that every pixel has four neighbours. */
enum { NEIGHBOURS = 4, MARGIN = TILE_SIZE, FRAMED = PATHS + 2*MARGIN };
typedef struct framed_array {
    float x[FRAMED], y[FRAMED], z[FRAMED];
} framed_array;

typedef struct ray_array {
    vector_array origin, direction;
    float t_min[ROOM], t_max[ROOM];
    uint32_t seed[ROOM];
} ray_array;

/* Where light is taken up (light_receiver.h), beside the position. */
typedef struct receiver_array {
    vector_array normal, mirror;
    float around[ROOM], broad[ROOM], peak[ROOM], width[ROOM], weight[ROOM];
} receiver_array;

/* Paths that go on, and the ray that each follows, of unit direction.  Those that end are left out of the next list. */
typedef struct path_list {
    LINE_ALIGNED uint32_t slot[ROOM];  /* pixel of the tile */
    uint32_t pixel[ROOM], index[ROOM]; /* sample_stream */
    ray_array ray;
    vector_array throughput;
    float eta_scale[ROOM];   /* radiance lost to refraction and got back on leaving: not a reason to end a path */
    vector_array previous;   /* where the ray was scattered */
    receiver_array receiver; /* ... if the lights ask for it */
    float pdf_scatter[ROOM]; /* of its direction [1/sr] */
    uint32_t lobe[ROOM];     /* facet_lobe that sent it, 0: the camera */
    uint32_t n;
} path_list;

/* Lights chosen for vertices (lights.h). */
typedef struct light_array {
    uint32_t which[ROOM];
    float probability[ROOM];
    double rest[ROOM];
    vector_array direction, target, radiance;
    float pdf[ROOM];
    uint32_t is_infinite[ROOM], is_delta[ROOM];
} light_array;

/* The path of a vertex that is not there. */
#define NO_PATH UINT32_MAX

/* Where paths meet surfaces that scatter, ordered by material; the first ones, if light is shared, by slot, so that
 * neighbours are a step away: where a pixel has none stands one that nothing comes from.  The first arrays are copies
 * of what the paths have. */
typedef struct vertex_list {
    uint32_t n;
    LINE_ALIGNED uint32_t path[ROOM]; /* index into the list of paths, or NO_PATH */
    uint32_t slot[ROOM], pixel[ROOM], index[ROOM];
    uint32_t chance[ROOM]; /* for roulette */
    vector_array throughput;
    float eta_scale[ROOM];
    /* surface.h */
    vector_array position, normal;
    float offset[ROOM];
    vector_array t, b, up;    /* the shading frame */
    float facing[ROOM];       /* cosine between wo and the normal: its sign tells the side */
    uint32_t transmits[ROOM]; /* all bits, or none */
    const facet_bsdf *bsdf[ROOM];
    uint32_t n_alike[ROOM]; /* how many from here on share a bsdf that batches serve; 0: they do not */
    facet_bsdf own[ROOM];
    receiver_array receiver; /* if the lights ask for it */
    /* Scattering */
    uint32_t u[3][ROOM];
    vector_array wo, wi, number; /* local; number: the sampler's, as floats */
    vector_array f;              /* or weight of a sample; then what a ray brings, or the path's next throughput */
    float pdf[ROOM];
    uint32_t lobe[ROOM];
    float eta[ROOM];
    light_array light;
    ray_array ray;        /* scattered; it starts at 0 */
    uint32_t keeps[ROOM]; /* whether that ray is traced */
} vertex_list;

/* What vertices look at: their lights, or what the pixels a step before have found.  Framed arrays begin at MARGIN. */
typedef struct sight_list {
    int step;                              /* in slots; 0: none */
    LINE_ALIGNED uint32_t is_beside[ROOM]; /* whether there is a pixel a step before */
    framed_array origin, direction;        /* of the ray, which starts at 0 */
    float t_max[FRAMED];
    uint32_t seed[FRAMED];
    uint32_t is_open[FRAMED]; /* whether the ray is to be traced; then, whether nothing is in the way */
    framed_array worth;       /* what that pixel passes on, if nothing is in the way */
} sight_list;

/* Rays that are traced together. */
typedef struct shadow_list {
    uint32_t n;
    LINE_ALIGNED ray_array ray;
    uint32_t is_blocked[ROOM];
} shadow_list;

/* Paths that leave the scene. */
typedef struct sky_list {
    LINE_ALIGNED uint32_t path[ROOM];
    vector_array direction;
    float u[ROOM], v[ROOM]; /* sky_place */
} sky_list;

/* What paths see first (film.h), by slot. */
typedef struct feature_list {
    vector_array albedo, normal;
    float distance[ROOM];
    bool is_known[ROOM]; /* albedo and normal are, and stay */
} feature_list;

/* The weight of a pixel's own light beside differences of light, and the least of these (docs/performance.md). */
#define LIGHT_WEIGHT 0.04f
#define LEAST_ALIKENESS 1e-3f

/* Where there is less light than this share of the tile's mean, errors are those of this and more. */
#define LEAST_LEVEL 0.3f

/* Light that looks so many times brighter or darker from the neighbour is not shared, nor what could overflow. */
#define MOST_CONTRAST 4.0f
#define MOST_PASSED 1e30f

/* Steps towards the fit; they are the best ones for eigenvalues of the equations between these two. */
enum { GRADIENT_STEPS = 12 };
#define LEAST_EIGENVALUE 0.1f
#define MOST_EIGENVALUE 2.0f

/* What neighbouring pixels tell each other (stage_gradients.c), by slot if nothing else is said, which is the place of
 * the first vertex, too.  Framed arrays begin at MARGIN, but `up` at 0. */
typedef struct gradient_list {
    LINE_ALIGNED vector_array apart; /* radiance that is not shared */
    bool has_lamps;                  /* for first vertices: */
    uint32_t lamp[FRAMED];           /* which was chosen, */
    float lamp_probability[FRAMED];  /* ... 0: none, */
    double lamp_rest[FRAMED];        /* ... and the numbers that draw the point on it */
    uint32_t lamp_u[2][FRAMED];
    framed_array brought;          /* by it, if nothing is in the way */
    uint32_t is_lit[FRAMED];       /* whether nothing is */
    vector_array near;             /* that of lights at the second vertex; the rest is path_batch.radiance */
    float up[3][FRAMED];           /* the first vertex's normal, 0 where there is none */
    framed_array throughput;       /* from the first vertex on */
    float pdf[ROOM];               /* of the direction from there [1/sr]; 0: not of a lobe */
    framed_array position, target; /* of the second vertex, and just off it */
    framed_array normal, shading;  /* ... its normals, on wo's side */
    float density[FRAMED];         /* of finding it from the first [1/m^2]; 0: nothing is shared */
    framed_array own, seen;        /* the light that is shared, and what the neighbour would see of it */
    /* By second vertices: directions to the light and onwards, f cos for them and the path's own wo */
    vector_array to_light, onward, near_f, far_f;
    vector_array near_light, far_light; /* the paths' light: of lights there, and the rest */
    vector_array own_light, seen_light; /* of it, as own and seen */
    /* Towards the second vertex of the pixel a step before */
    float distance2[ROOM], cosine[ROOM]; /* at that vertex */
    /* The equations */
    LINE_ALIGNED float self[FRAMED];    /* weight of a pixel's own light */
    float right[FRAMED], below[FRAMED]; /* of its difference from a neighbour's */
    float passed[3][FRAMED], given[3][FRAMED], step[FRAMED], found[FRAMED], scale[FRAMED];
} gradient_list;

struct path_batch {
    path_list lists[2];
    vector_array radiance;  /* gathered so far, by slot */
    float x[ROOM], y[ROOM]; /* the pixels, by slot */
    float t[ROOM], u[ROOM], v[ROOM];
    uint32_t instance[ROOM], primitive[ROOM];
    uint32_t chance[3][ROOM];
    uint32_t material[ROOM], order[ROOM]; /* of what the paths met; the paths by it */
    sky_list skies;
    vertex_list vertex_lists[3];   /* of the first event, the second, and later ones */
    sight_list sights[NEIGHBOURS]; /* the first one for the vertices' own lights, before */
    shadow_list shadows;
    gradient_list gradients;
    plain_block plain; /* vertices whose surfaces are still to be found */
    feature_list features;
    vertex_list *vertices;   /* those of the present event */
    facet_bsdf black;        /* of first vertices that are not there */
    uint32_t *n_of_material; /* counts, then places, of two more than the scene's materials */
};

static inline vectors vectors_of(vector_array *a)
{
    return (vectors){a->x, a->y, a->z};
}

/* Whether a lobe with a density sent the ray of path i, rather than the camera or a mirror. */
static inline bool is_of_lobe(const path_list *list, uint32_t i)
{
    return list->lobe[i] && !(list->lobe[i] & FACET_DELTA);
}

static inline light_receivers receivers_of(vector_array *position, receiver_array *a)
{
    return (light_receivers){vectors_of(position),
                             vectors_of(&a->normal),
                             vectors_of(&a->mirror),
                             a->around,
                             a->broad,
                             a->peak,
                             a->width,
                             a->weight};
}

static inline rays rays_of(ray_array *a)
{
    return (rays){vectors_of(&a->origin), vectors_of(&a->direction), a->t_min, a->t_max, a->seed};
}

static inline light_choices choices_of(light_array *a)
{
    return (light_choices){a->which, a->probability, a->rest};
}

static inline facet_dirs dirs_at(const vector_array *a, uint32_t first)
{
    return (facet_dirs){a->x + first, a->y + first, a->z + first};
}

static inline real3 get3(const vector_array *a, uint32_t i)
{
    return make3(a->x[i], a->y[i], a->z[i]);
}

static inline void set3(vector_array *a, uint32_t i, real3 v)
{
    a->x[i] = v.x;
    a->y[i] = v.y;
    a->z[i] = v.z;
}

static inline void set_ray(ray_array *a, uint32_t i, real3 origin, real3 direction, float t_max, uint32_t seed)
{
    set3(&a->origin, i, origin);
    set3(&a->direction, i, direction);
    a->t_min[i] = 0;
    a->t_max[i] = t_max;
    a->seed[i] = seed;
}

static inline void copy3(vector_array *to, uint32_t i, const vector_array *from, uint32_t k)
{
    to->x[i] = from->x[k];
    to->y[i] = from->y[k];
    to->z[i] = from->z[k];
}

/* Appends what pack is to move from the one array to the other, or three of them. */
static inline void pack_array(packed_array **end, const void *from, void *to)
{
    *(*end)++ = (packed_array){from, to};
}

static inline void pack_vectors(packed_array **end, const vector_array *from, vector_array *to)
{
    pack_array(end, from->x, to->x);
    pack_array(end, from->y, to->y);
    pack_array(end, from->z, to->z);
}

static inline void pack_framed(packed_array **end, const framed_array *from, vector_array *to)
{
    pack_array(end, from->x, to->x);
    pack_array(end, from->y, to->y);
    pack_array(end, from->z, to->z);
}

static inline void add_radiance(path_batch *batch, uint32_t slot, real3 radiance)
{
    set3(&batch->radiance, slot, add3(get3(&batch->radiance, slot), radiance));
}

/* Whether the film can hold it. */
static inline int is_held(real3 light)
{
    const real3 size = make3(kabs(light.x), kabs(light.y), kabs(light.z));
    return (size.x <= FILM_MOST) & (size.y <= FILM_MOST) & (size.z <= FILM_MOST);
}

/* The power heuristic for the technique with density a against the other with density b. */
static inline float power_heuristic(float a, float b)
{
    const float ratio = b/a; /* squares of densities overflow, squares of their ratio do so harmlessly */
    return 1/(1 + ratio*ratio);
}

/* One path per pixel of the tile, with its camera ray, into the first list. */
void stage_generate(path_batch *batch, const path_context *c, tile where, uint32_t sample);

/* The nearest surface of every path's ray. */
void stage_trace(path_batch *batch, const path_context *c, path_list *list, bool is_first, path_counts *counts);

/* The surfaces that paths have met: their emission is gathered, and those that scatter become vertices, by slot or by
 * material. */
void stage_meet(path_batch *batch, const path_context *c, const path_list *list, bool is_by_slot, bool is_last);

/* Explicit light connection. */
void stage_connect(path_batch *batch, const path_context *c, uint32_t group, path_counts *counts);

/* Extends paths by scattered rays, into the next list. */
void stage_scatter(path_batch *batch, const path_context *c, const path_list *list, uint32_t n_events, uint32_t group,
                   path_list *next);

/* f cos and pdf at the directions wi of the vertices whose light.pdf is positive, and of others at will. */
void vertices_evaluate(vertex_list *v);

/* Draws the points on the vertices' lights, which have been chosen, by the numbers u, and turns wi there. */
void vertices_aim(vertex_list *v, const path_context *c);

/* Rays to there, and in f what comes from there, if nothing is in the way; is_mis: weighted. */
void vertices_connect(vertex_list *v, bool is_mis, sight_list *to);

/* Finds what is in the way of n rays of each of the first so many lists.  Those towards what one pixel has found are
 * traced close to each other, while the tree's nodes on their way are in the cache. */
void sights_trace(path_batch *batch, const path_context *c, uint32_t n_lists, uint32_t n, path_counts *counts);

/* ---- Gradients: light that neighbouring pixels share by their second vertices, if context.has_gradients says so.
 * Between stage_generate and the film: ---- */

/* The first vertices have been given directions. */
void gradient_start(path_batch *batch);

/* They have been connected to lights. */
void gradient_of_first_lights(path_batch *batch, const path_context *c);

/* The second vertices have been found, and what paths have gathered so far is set apart. */
void gradient_of_second_vertices(path_batch *batch);

/* They have been connected to lights. */
void gradient_of_lights(path_batch *batch);

/* All paths have ended: the radiance becomes that which fits the light and its gradients best. */
void gradient_solve(path_batch *batch, const path_context *c, tile where, path_counts *counts);

/* ---- Features: albedo and normal of the first surface that neither mirrors nor lets through all light unscattered, as
 * seen in and through those that do; the distance of the first surface of all.  Only for films that keep them. ---- */

/* Of paths that have just begun. */
void feature_start(path_batch *batch, uint32_t n);

/* Path i of the list has met the sky, or a surface where it ends. */
void feature_of_sky(path_batch *batch, const path_list *list, uint32_t i, real3 radiance);
void feature_of_surface(path_batch *batch, const path_list *list, uint32_t i, const surface *at);

/* Vertex k has been found. */
void feature_of_vertex(path_batch *batch, const path_list *list, uint32_t k);

/* Vertex k has been given a direction. */
void feature_of_scattering(path_batch *batch, const path_list *list, uint32_t k);

#ifdef __cplusplus
}
#endif
