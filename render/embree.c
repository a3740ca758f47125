/* embree.c: the tracer, on Embree 3.  The only file that sees its headers.
 *
 * A mesh that one instance uses is put into the scene in world space; a mesh that several use becomes a scene
 * of its own, instanced (one level, Embree's limit here).  Single rays, RTC_SCENE_FLAG_ROBUST: watertight.
 * SPDX-License-Identifier: MIT */
#include "render/tracer.h"

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
    const tracer *owner;
    uint32_t mesh;
} opacity_data;

struct tracer {
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
    tracer *t = user;
    if (t->error != RTC_ERROR_NONE) return;
    t->error = code;
    size_t length = text ? strlen(text) : 0;
    if (length >= sizeof t->message) length = sizeof t->message - 1;
    if (length) memcpy(t->message, text, length);
}

/* Keeps or drops a candidate hit: below the cutoff of a mask, or by chance for blending.  The chance depends on
 * the ray and the triangle alone, so that the order of traversal does not matter. */
static void filter_by_opacity(const struct RTCFilterFunctionNArguments *args)
{
    const opacity_data *data = args->geometryUserPtr;
    const tracer *t = data->owner;
    const struct RTCRay *r = (const struct RTCRay *)args->ray;
    const struct RTCHit *h = (const struct RTCHit *)args->hit;
    if (args->valid[0] == 0) return;
    const float opacity = t->opacity(t->opacity_user, data->mesh, h->primID, h->u, h->v);
    const uint32_t id = hash_pair(hash_pair(r->id, h->instID[0]), hash_pair(h->geomID, h->primID));
    if (!(fraction(id) < opacity)) args->valid[0] = 0;
}

/* The triangles of a mesh as an Embree geometry, in world space when `to_world` is given; NULL on failure. */
static RTCGeometry triangles_create(tracer *t, size_t mesh_index, const float (*to_world)[4])
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

static RTCScene scene_new(tracer *t)
{
    RTCScene s = rtcNewScene(t->device);
    rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
    return s;
}

/* The mesh's own scene, made on first use; NULL on failure. */
static RTCScene shared_scene(tracer *t, size_t mesh_index)
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

static bool add_instance(tracer *t, size_t i, bool is_shared)
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

static bool add_spheres(tracer *t)
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

static bool build(tracer *t)
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

/* AVX2 traces single rays 5 to 20 % faster than AVX-512, and is what most machines have. */
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

facet_status tracer_create(const scene *s, const char *isa, uint32_t n_threads, tracer_opacity *opacity,
                           const void *opacity_user, tracer **result, facet_error *why)
{
    const char *chosen = NULL;
    const facet_status status = choose_isa(isa, &chosen, why);
    if (status) return status;
    tracer *t = calloc(1, sizeof *t);
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
    tracer_destroy(t);
    return FACET_NO_MEMORY;
}

void tracer_destroy(tracer *t)
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

const char *tracer_isa(const tracer *t)
{
    return t->isa;
}

void tracer_prepare_thread(void)
{
#if defined(__x86_64__)
    _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);
    _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
#endif
}

/* Embree ends the program on rays with larger coordinates, or NaN; nothing it holds can lie on them. */
static bool is_traceable(const ray *r)
{
    const float largest = 1e18f;
    for (int k = 0; k < 3; k++)
        if (!(kabs(r->origin[k]) < largest && kabs(r->direction[k]) < largest)) return false;
    return r->t_min >= 0 && r->t_max >= r->t_min;
}

static struct RTCRay ray_for_embree(const ray *r)
{
    return (struct RTCRay){.org_x = r->origin[0],
                           .org_y = r->origin[1],
                           .org_z = r->origin[2],
                           .tnear = r->t_min,
                           .dir_x = r->direction[0],
                           .dir_y = r->direction[1],
                           .dir_z = r->direction[2],
                           .tfar = r->t_max,
                           .mask = ~0u,
                           .id = r->seed};
}

bool tracer_intersect(const tracer *t, const ray *r, hit *found)
{
    if (!is_traceable(r)) return false;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRayHit rh = {.ray = ray_for_embree(r)};
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rh.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(t->top, &context, &rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    const bool is_instanced = rh.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    *found = (hit){.t = rh.ray.tfar,
                   .u = rh.hit.u,
                   .v = rh.hit.v,
                   .instance = is_instanced ? rh.hit.instID[0] : rh.hit.geomID,
                   .primitive = rh.hit.primID};
    return true;
}

bool tracer_occluded(const tracer *t, const ray *r)
{
    if (!is_traceable(r)) return true;
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    struct RTCRay shadow = ray_for_embree(r);
    rtcOccluded1(t->top, &context, &shadow);
    return shadow.tfar < 0; /* -inf when something was hit */
}
