/* embree.c: rays against a tree, by Embree 3.  The only file that sees its headers.
 *
 * A mesh that one instance uses is put into the scene in world space; a mesh that several use becomes a scene
 * of its own, instanced (one level, Embree's limit here).  RTC_SCENE_FLAG_ROBUST: watertight.
 * SPDX-License-Identifier: MIT */
#include "render/embree.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <embree3/rtcore.h>
#if defined(__x86_64__)
#include <pmmintrin.h>
#include <xmmintrin.h>
#endif

#include "core/error.h"
#include "render/geometry.h"
#include "render/sampler.h"

/* What the filter of a mesh that is not opaque needs. */
typedef struct opacity_data {
    const embree_scene *owner;
    uint32_t mesh;
} opacity_data;

struct embree_scene {
    const scene *scene;
    tracer_opacity *opacity;
    const void *opacity_user;
    const char *isa;
    RTCDevice device;
    RTCScene top;
    RTCScene *shared;        /* [n_meshes] scenes of the meshes with several instances; else NULL */
    opacity_data *opacities; /* [n_meshes] */
    enum RTCError error;     /* the first that Embree reported */
    char message[128];
};

static void record_error(void *user, enum RTCError code, const char *text)
{
    embree_scene *t = user;
    if (t->error != RTC_ERROR_NONE) return;
    t->error = code;
    size_t length = text ? strlen(text) : 0;
    if (length >= sizeof t->message) length = sizeof t->message - 1;
    if (length) memcpy(t->message, text, length);
}

/* Embree's arrays of N rays or hits, by field (rtcore_ray.h), whose accessors C does not have. */
enum { RAY_ID = 10, HIT_U = 3, HIT_V = 4, HIT_PRIMITIVE = 5, HIT_GEOMETRY = 6, HIT_INSTANCE = 7 };

static uint32_t word_of(const void *fields, unsigned field, unsigned n, unsigned i)
{
    uint32_t word;
    memcpy(&word, (const char *)fields + sizeof word*(field*n + i), sizeof word);
    return word;
}

static float number_of(const void *fields, unsigned field, unsigned n, unsigned i)
{
    float number;
    memcpy(&number, (const char *)fields + sizeof number*(field*n + i), sizeof number);
    return number;
}

/* Keeps or drops candidate hits: below the cutoff of a mask, or by chance for blending.  The chance depends on
 * the ray and the triangle alone, so that the order of traversal does not matter. */
static void filter_by_opacity(const struct RTCFilterFunctionNArguments *args)
{
    const opacity_data *data = args->geometryUserPtr;
    const embree_scene *t = data->owner;
    const unsigned n = args->N;
    for (unsigned i = 0; i < n; i++) {
        if (args->valid[i] == 0) continue;
        const uint32_t primitive = word_of(args->hit, HIT_PRIMITIVE, n, i);
        const float opacity = t->opacity(t->opacity_user, data->mesh, primitive, number_of(args->hit, HIT_U, n, i),
                                         number_of(args->hit, HIT_V, n, i));
        const uint32_t chance = hash_pair(
            hash_pair(word_of(args->ray, RAY_ID, n, i), word_of(args->hit, HIT_INSTANCE, n, i)),
            hash_pair(word_of(args->hit, HIT_GEOMETRY, n, i), primitive));
        if (!(fraction(chance) < opacity)) args->valid[i] = 0;
    }
}

/* The triangles of a mesh as an Embree geometry, in world space when `to_world` is given; NULL on failure. */
static RTCGeometry triangles_create(embree_scene *t, size_t mesh_index, const float (*to_world)[4])
{
    const mesh *m = &t->scene->meshes[mesh_index];
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    float *vertices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3*sizeof(float),
                                              m->n_vertices);
    uint32_t *indices = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3*sizeof(uint32_t),
                                                m->n_triangles);
    if (!vertices || !indices) {
        rtcReleaseGeometry(g);
        return NULL;
    }
    for (size_t i = 0; i < m->n_vertices; i++) {
        const real3 local = vector_of(m->positions[i]);
        const real3 p = to_world ? map_point(to_world, local) : local;
        vertices[3*i] = p.x;
        vertices[3*i + 1] = p.y;
        vertices[3*i + 2] = p.z;
    }
    memcpy(indices, m->triangles, m->n_triangles*sizeof m->triangles[0]);
    if (t->scene->materials[m->material].alpha != ALPHA_OPAQUE) {
        t->opacities[mesh_index] = (opacity_data){.owner = t, .mesh = (uint32_t)mesh_index};
        rtcSetGeometryUserData(g, &t->opacities[mesh_index]);
        rtcSetGeometryIntersectFilterFunction(g, filter_by_opacity);
        rtcSetGeometryOccludedFilterFunction(g, filter_by_opacity);
    }
    rtcCommitGeometry(g);
    return g;
}

static RTCScene scene_new(embree_scene *t)
{
    RTCScene s = rtcNewScene(t->device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
    return s;
}

/* The mesh's own scene, made on first use; NULL on failure. */
static RTCScene shared_scene(embree_scene *t, size_t mesh_index)
{
    if (!t->shared[mesh_index]) {
        RTCGeometry g = triangles_create(t, mesh_index, NULL);
        if (!g) return NULL;
        t->shared[mesh_index] = scene_new(t);
        rtcAttachGeometryByID(t->shared[mesh_index], g, 0);
        rtcReleaseGeometry(g);
        rtcCommitScene(t->shared[mesh_index]);
    }
    return t->shared[mesh_index];
}

/* Embree wants the inverse of an instance's map: singular ones have no surface that a ray could meet. */
static bool is_invertible(const float m[3][4])
{
    const float scale = max_abs3(map_column(m, 0))*max_abs3(map_column(m, 1))*max_abs3(map_column(m, 2));
    const float det = map_determinant(m);
    return isfinite(scale) && kabs(det) > 1e-7f*scale;
}

static bool add_instance(embree_scene *t, size_t i, bool is_shared)
{
    const instance *in = &t->scene->instances[i];
    if (t->scene->meshes[in->mesh].n_triangles == 0 || (is_shared && !is_invertible(in->to_world))) return true;
    RTCGeometry g;
    if (is_shared) {
        RTCScene own = shared_scene(t, in->mesh);
        if (!own) return false;
        g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, own);
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_ROW_MAJOR, in->to_world);
        rtcCommitGeometry(g);
    } else {
        g = triangles_create(t, in->mesh, in->to_world);
        if (!g) return false;
    }
    rtcAttachGeometryByID(t->top, g, (unsigned)i);
    rtcReleaseGeometry(g);
    return true;
}

static bool add_spheres(embree_scene *t)
{
    const scene *s = t->scene;
    if (s->n_spheres == 0) return true;
    RTCGeometry g = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    float *points = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4*sizeof(float),
                                            s->n_spheres);
    if (points) {
        for (size_t i = 0; i < s->n_spheres; i++) {
            memcpy(&points[4*i], s->spheres[i].center, 3*sizeof(float));
            points[4*i + 3] = s->spheres[i].radius;
        }
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(t->top, g, (unsigned)s->n_instances);
    }
    rtcReleaseGeometry(g);
    return points != NULL;
}

static bool build(embree_scene *t)
{
    const scene *s = t->scene;
    size_t *n_users = calloc(s->n_meshes + 1, sizeof *n_users);
    if (!n_users) return false;
    for (size_t i = 0; i < s->n_instances; i++) n_users[s->instances[i].mesh]++;
    bool is_built = true;
    for (size_t i = 0; is_built && i < s->n_instances; i++)
        is_built = add_instance(t, i, n_users[s->instances[i].mesh] > 1);
    free(n_users);
    if (!is_built || !add_spheres(t)) return false;
    rtcCommitScene(t->top);
    return t->error == RTC_ERROR_NONE;
}

/* The names that users give, worst first, and whether this processor has them. */
static bool cpu_has(const char *isa)
{
#if defined(__x86_64__)
    if (strcmp(isa, "sse2") == 0) return true;
    if (strcmp(isa, "sse4.2") == 0) return __builtin_cpu_supports("sse4.2");
    if (strcmp(isa, "avx") == 0) return __builtin_cpu_supports("avx");
    if (strcmp(isa, "avx2") == 0) return __builtin_cpu_supports("avx2");
    if (strcmp(isa, "avx512") == 0)
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
               __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl");
    return false;
#else
    return strcmp(isa, "default") == 0;
#endif
}

static const char *const isa_names[] = {"avx2", "avx", "sse4.2", "sse2", "avx512", "default"};

/* AVX2 traces scattered rays as fast as AVX-512 or faster, and is what most machines have. */
static facet_status choose_isa(const char *wanted, const char **chosen, facet_error *why)
{
    for (size_t i = 0; i < sizeof isa_names/sizeof isa_names[0]; i++)
        if (wanted ? strcmp(wanted, isa_names[i]) == 0 : cpu_has(isa_names[i])) {
            if (!cpu_has(isa_names[i]))
                return facet_error_set(why, FACET_UNSUPPORTED, "isa",
                                       "this processor has no %s; leave the choice to facet", wanted);
            *chosen = isa_names[i];
            return FACET_OK;
        }
    return facet_error_set(why, FACET_UNKNOWN_NAME, "isa", "'%s' is not one of sse2, sse4.2, avx, avx2, avx512",
                           wanted ? wanted : "");
}

facet_status embree_scene_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                                 const void *opacity_user, embree_scene **result, facet_error *why)
{
    const char *chosen = NULL;
    const facet_status status = choose_isa(isa, &chosen, why);
    if (status) return status;
    embree_scene *t = calloc(1, sizeof *t);
    if (!t) return facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the scene");
    t->scene = s;
    t->opacity = opacity;
    t->opacity_user = opacity_user;
    t->isa = chosen;
    char config[64];
    snprintf(config, sizeof config, "isa=%s,threads=%u", strcmp(chosen, "default") == 0 ? "" : chosen, n_threads);
    t->device = rtcNewDevice(config);
    t->shared = calloc(s->n_meshes + 1, sizeof *t->shared);
    t->opacities = calloc(s->n_meshes + 1, sizeof *t->opacities);
    if (t->device && t->shared && t->opacities) {
        rtcSetDeviceErrorFunction(t->device, record_error, t);
        t->top = scene_new(t);
        if (build(t)) {
            *result = t;
            return FACET_OK;
        }
    }
    facet_error_set(why, FACET_NO_MEMORY, "", "the acceleration structure cannot be built: %s",
                    t->message[0] ? t->message : "not enough memory");
    embree_scene_destroy(t);
    return FACET_NO_MEMORY;
}

void embree_scene_destroy(embree_scene *t)
{
    if (!t) return;
    if (t->top) rtcReleaseScene(t->top);
    if (t->shared)
        for (size_t i = 0; i < t->scene->n_meshes; i++)
            if (t->shared[i]) rtcReleaseScene(t->shared[i]);
    if (t->device) rtcReleaseDevice(t->device);
    free(t->shared);
    free(t->opacities);
    free(t);
}

const char *embree_scene_isa(const embree_scene *t)
{
    return t->isa;
}

void embree_prepare_thread(void)
{
#if defined(__x86_64__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

/* Embree ends the program on rays with larger coordinates, or NaN; nothing it holds can lie on them. */
static inline int is_small(float coordinate)
{
    return kabs(coordinate) < 1e18f;
}

static inline int is_traceable(rays r, size_t i)
{
    return is_small(r.origin.x[i]) & is_small(r.origin.y[i]) & is_small(r.origin.z[i]) & is_small(r.direction.x[i]) &
           is_small(r.direction.y[i]) & is_small(r.direction.z[i]) & (r.t_min[i] >= 0) & (r.t_max[i] >= r.t_min[i]);
}

/* Rays go to Embree in streams of at most this many, in the arrays that they are in; what is left to add is its own. */
enum { STREAM = 256 };

typedef struct stream {
    float t_far[STREAM], time[STREAM], normal[3][STREAM];
    uint32_t mask[STREAM], flags[STREAM], geometry[STREAM], top[STREAM];
} stream;

/* What all rays have in common. */
static void start_stream(stream *own)
{
    for (size_t i = 0; i < STREAM; i++) {
        own->time[i] = 0;
        own->mask[i] = ~0u;
        own->flags[i] = 0;
    }
}

/* n rays from the first on; one whose end lies before its start is left out. */
static struct RTCRayNp stream_rays(stream *own, rays r, size_t first, size_t n)
{
    for (size_t i = 0; i < n; i++) own->t_far[i] = is_traceable(r, first + i) ? r.t_max[first + i] : -INFINITY;
    return (struct RTCRayNp){.org_x = r.origin.x + first,
                             .org_y = r.origin.y + first,
                             .org_z = r.origin.z + first,
                             .tnear = r.t_min + first,
                             .dir_x = r.direction.x + first,
                             .dir_y = r.direction.y + first,
                             .dir_z = r.direction.z + first,
                             .time = own->time,
                             .tfar = own->t_far,
                             .mask = own->mask,
                             .id = r.seed + first,
                             .flags = own->flags};
}

static void nearest_of_stream(RTCScene tree, struct RTCIntersectContext *context, stream *own, rays r, hits h,
                              size_t first, size_t n)
{
    struct RTCRayHitNp rh = {.ray = stream_rays(own, r, first, n),
                             .hit = {.Ng_x = own->normal[0],
                                     .Ng_y = own->normal[1],
                                     .Ng_z = own->normal[2],
                                     .u = h.u + first,
                                     .v = h.v + first,
                                     .primID = h.primitive + first,
                                     .geomID = own->geometry,
                                     .instID = {own->top}}};
    for (size_t i = 0; i < n; i++) own->geometry[i] = own->top[i] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersectNp(tree, context, &rh, (unsigned)n);
    for (size_t i = 0; i < n; i++) {
        h.t[first + i] = own->t_far[i];
        h.instance[first + i] = own->geometry[i] == RTC_INVALID_GEOMETRY_ID ? NO_HIT
                                : own->top[i] == RTC_INVALID_GEOMETRY_ID    ? own->geometry[i]
                                                                            : own->top[i];
    }
}

void embree_nearest(const embree_scene *t, size_t n, rays r, bool is_coherent, hits h)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (is_coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    stream own;
    start_stream(&own);
    for (size_t first = 0; first < n; first += STREAM)
        nearest_of_stream(t->top, &context, &own, r, h, first, n - first < STREAM ? n - first : STREAM);
}

void embree_blocked(const embree_scene *t, size_t n, rays r, uint32_t *is_blocked)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    stream own;
    start_stream(&own);
    for (size_t first = 0; first < n; first += STREAM) {
        const size_t some = n - first < STREAM ? n - first : STREAM;
        const struct RTCRayNp rs = stream_rays(&own, r, first, some);
        rtcOccludedNp(t->top, &context, &rs, (unsigned)some);
        for (size_t i = 0; i < some; i++) is_blocked[first + i] = own.t_far[i] < 0; /* -inf when something was hit */
    }
}
