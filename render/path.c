/* path.c: the stages of the path tracer.
 * SPDX-License-Identifier: MIT */
#include "render/path.h"

#include <math.h>
#include <stdlib.h>

/* Groups of numbers: one for the camera, then these for every scattering event. */
enum { GROUP_CAMERA, GROUP_LIGHT, GROUP_SCATTER, GROUP_CHANCE, GROUPS_PER_EVENT = 3 };

/* Roulette starts at this event.  Starts from 3 to 8 need the same time for the same error within 5 % on the scene
 * `spheres` of bench/renders.c; 4 gives the sooner picture. */
#define ROULETTE_START 4
#define ROULETTE_MOST 0.95f /* the most likely survival, so that even white paths end */

typedef enum path_origin { FROM_CAMERA, FROM_DELTA, FROM_LOBE } path_origin;

typedef struct path {
    uint32_t x, y; /* pixel of the crop */
    sample_stream stream;
    uint32_t n_events;  /* scattering events so far */
    path_origin origin; /* what sent the current ray */
    ray ray;
    hit hit;
    bool has_hit;
    real3 throughput;
    float eta_scale;   /* radiance lost to refraction and got back on leaving: not a reason to end a path */
    real3 radiance;    /* gathered so far */
    real3 previous;    /* where the current ray was scattered */
    float pdf_scatter; /* of the current ray's direction [1/sr] */
    /* A shadow ray that waits for connect, and what it brings if nothing is in its way. */
    bool has_shadow;
    ray shadow_ray;
    real3 shadow_radiance;
} path;

struct path_batch {
    path paths[TILE_SIZE*TILE_SIZE];
    uint16_t active[TILE_SIZE*TILE_SIZE];
    uint32_t n_paths, n_active;
};

path_batch *path_batch_create(void)
{
    return malloc(sizeof(path_batch));
}

void path_batch_destroy(path_batch *batch)
{
    free(batch);
}

static void store_ray(ray *r, real3 origin, real3 direction, float t_max, uint32_t seed)
{
    *r = (ray){.origin = {origin.x, origin.y, origin.z},
               .direction = {direction.x, direction.y, direction.z},
               .t_max = t_max,
               .seed = seed};
}

/* The camera's ray through a point of the picture; x and y in pixels of the whole picture. */
static void camera_ray(const path_context *c, float x, float y, uint32_t seed, ray *r)
{
    const camera *cam = c->camera;
    const float w = (float)c->settings->width, h = (float)c->settings->height;
    const float right = (2*x/w - 1)*w/h, up = 1 - 2*y/h;
    if (cam->is_orthographic) {
        const real3 origin = map_point(cam->to_world, make3(right*cam->ymag, up*cam->ymag, 0));
        store_ray(r, origin, map_vector(cam->to_world, make3(0, 0, -1)), INFINITY, seed);
    } else {
        const float tan = tanf(0.5f*cam->yfov);
        const real3 local = normalize3(make3(right*tan, up*tan, -1));
        store_ray(r, map_column(cam->to_world, 3), map_vector(cam->to_world, local), INFINITY, seed);
    }
}

/* Stage: one path per pixel of the tile. */
static void generate(path_batch *batch, const path_context *c, tile where, uint32_t sample)
{
    batch->n_paths = 0;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++) {
            path *p = &batch->paths[batch->n_paths];
            const uint32_t px = x + (uint32_t)c->settings->crop_x, py = y + (uint32_t)c->settings->crop_y;
            *p = (path){.x = x,
                        .y = y,
                        .stream = sampler_start(&c->sampler, px, py, sample),
                        .origin = FROM_CAMERA,
                        .throughput = {1, 1, 1},
                        .eta_scale = 1};
            const sample_point u = sampler_point(&c->sampler, p->stream, GROUP_CAMERA);
            camera_ray(c, (float)px + fraction(u.u[0]), (float)py + fraction(u.u[1]), u.u[2], &p->ray);
            batch->active[batch->n_paths] = (uint16_t)batch->n_paths;
            batch->n_paths++;
        }
    batch->n_active = batch->n_paths;
}

/* glTF's single-sided surfaces are not drawn from behind; light meets them all the same. */
static bool is_culled(const path_context *c, const path *p)
{
    if (p->hit.instance >= c->scene->n_instances) return false;
    const instance *in = &c->scene->instances[p->hit.instance];
    const mesh *m = &c->scene->meshes[in->mesh];
    const material *mat = &c->scene->materials[m->material];
    if (mat->is_double_sided || mat->transmission > 0 || mat->kind == SURFACE_BSDF) return false;
    const uint32_t *i = m->triangles[p->hit.primitive];
    const real3 p0 = vector_of(m->positions[i[0]]);
    const real3 e1 = map_vector(in->to_world, sub3(vector_of(m->positions[i[1]]), p0));
    const real3 e2 = map_vector(in->to_world, sub3(vector_of(m->positions[i[2]]), p0));
    const float sign = map_determinant(in->to_world) < 0 ? -1.0f : 1.0f;
    return sign*dot3(normal_of_edges(e1, e2), vector_of(p->ray.direction)) > 0;
}

/* Stage: the nearest surface of every active path's ray. */
static void trace(path_batch *batch, const path_context *c, path_counts *counts)
{
    for (uint32_t i = 0; i < batch->n_active; i++) {
        path *p = &batch->paths[batch->active[i]];
        p->has_hit = tracer_intersect(c->tracer, &p->ray, &p->hit);
        counts->n_rays++;
        while (p->origin == FROM_CAMERA && p->has_hit && is_culled(c, p)) {
            p->ray.t_min = nextafterf(p->hit.t, INFINITY);
            p->has_hit = tracer_intersect(c->tracer, &p->ray, &p->hit);
            counts->n_rays++;
        }
    }
}

/* The power heuristic for the technique with density a against the other with density b. */
static float power_heuristic(float a, float b)
{
    const float ratio = b/a; /* squares of densities overflow, squares of their ratio do so harmlessly */
    return 1/(1 + ratio*ratio);
}

/* The weight of light that a scattered ray has met, which a light sample would have had density pdf_light for. */
static float implicit_weight(const path_context *c, const path *p, float pdf_light)
{
    if (p->origin != FROM_LOBE || !(pdf_light > 0)) return 1;
    switch (c->settings->strategy) {
    case STRATEGY_EXPLICIT: return 0;
    case STRATEGY_IMPLICIT: return 1;
    case STRATEGY_MIS: break;
    }
    return power_heuristic(p->pdf_scatter, pdf_light);
}

static void gather(path *p, real3 radiance, float weight)
{
    if (weight > 0) p->radiance = add3(p->radiance, mul3(p->throughput, scale3(weight, radiance)));
}

static void gather_sky(const path_context *c, path *p)
{
    const real3 direction = normalize3(vector_of(p->ray.direction));
    const real3 radiance = sky_radiance(light_set_sky(c->lights), direction);
    if (!(max_of3(radiance) > 0)) return;
    gather(p, radiance,
           implicit_weight(c, p, p->origin == FROM_LOBE ? light_set_pdf_of_sky(c->lights, p->previous, direction) : 0));
}

static void gather_emission(const path_context *c, path *p, const surface *at)
{
    if (p->origin == FROM_CAMERA) gather(p, at->unlit, 1);
    if (!(max_of3(at->emission) > 0)) return;
    const float pdf = p->origin == FROM_LOBE ? light_set_pdf_of_hit(c->lights, p->previous, &p->hit, at) : 0;
    gather(p, at->emission, implicit_weight(c, p, pdf));
}

/* Whether wi and wo lie on the same side of the true surface for a reflection, and on opposite ones for light that
 * goes through; interpolated normals can claim otherwise. */
static bool is_true_side(const surface *at, real3 wi, real3 wo, bool is_through)
{
    return (dot3(at->normal, wi)*dot3(at->normal, wo) > 0) != is_through;
}

/* Explicit light connection: prepares the shadow ray.  [cs500, "Explicit light connection"], corrected: p is a
 * density per solid angle, EvalScattering contains the only cosine at P, and the term is weighted. */
static void prepare_connection(const path_context *c, path *p, const surface *at, real3 wo_local, uint32_t group)
{
    const sample_point u = sampler_point(&c->sampler, p->stream, group + GROUP_LIGHT);
    const light_sample s = light_set_sample(c->lights, at->position, u.u);
    if (!(s.pdf > 0)) return;
    if (c->settings->strategy == STRATEGY_IMPLICIT && !s.is_delta) return;
    const real3 wi_local = to_local(&at->shading, s.direction);
    const float wi[3] = {wi_local.x, wi_local.y, wi_local.z}, wo[3] = {wo_local.x, wo_local.y, wo_local.z};
    const bool is_through = at->transmits && wi_local.z*wo_local.z < 0;
    if (!is_true_side(at, s.direction, to_world(&at->shading, wo_local), is_through)) return;
    float f[3];
    facet_bsdf_eval(&at->bsdf, wi, wo, f);
    if (!(f[0] > 0 || f[1] > 0 || f[2] > 0)) return;
    float weight = 1;
    if (!s.is_delta && c->settings->strategy == STRATEGY_MIS)
        weight = power_heuristic(s.pdf, facet_bsdf_pdf(&at->bsdf, wi, wo));
    p->shadow_radiance = mul3(p->throughput, mul3(vector_of(f), scale3(weight/s.pdf, s.radiance)));
    const real3 origin = surface_leave(at, s.direction);
    if (s.is_infinite) store_ray(&p->shadow_ray, origin, s.direction, INFINITY, u.u[0] ^ u.u[1]);
    else store_ray(&p->shadow_ray, origin, sub3(s.target, origin), 1, u.u[0] ^ u.u[1]);
    p->has_shadow = true;
}

/* Extends the path by a scattered ray; false if it ends here.  [cs500, "Extend path"]. */
static bool scatter(const path_context *c, path *p, const surface *at, real3 wo_local, uint32_t group)
{
    const sample_point u = sampler_point(&c->sampler, p->stream, group + GROUP_SCATTER);
    const float v[3] = {fraction(u.u[0]), fraction(u.u[1]), fraction(u.u[2])};
    const float wo[3] = {wo_local.x, wo_local.y, wo_local.z};
    const facet_sample s = facet_bsdf_sample(&at->bsdf, wo, v);
    if (!(s.pdf > 0)) return false;
    const real3 wi = normalize3(to_world(&at->shading, vector_of(s.wi)));
    const bool is_through = s.lobe & FACET_TRANSMISSION;
    if (!(is_through && s.lobe & FACET_DELTA) && !is_true_side(at, wi, to_world(&at->shading, wo_local), is_through))
        return false;
    p->throughput = mul3(p->throughput, vector_of(s.weight));
    if (!(max_of3(p->throughput) > 0)) return false;
    p->eta_scale *= s.eta*s.eta;
    p->origin = s.lobe & FACET_DELTA ? FROM_DELTA : FROM_LOBE;
    p->pdf_scatter = s.pdf;
    p->previous = at->position;
    store_ray(&p->ray, surface_leave(at, wi), wi, INFINITY, u.u[0] ^ u.u[2]);
    return true;
}

/* Russian roulette on the throughput; false if the path ends. */
static bool survives(path *p, uint32_t chance)
{
    if (p->n_events < ROULETTE_START) return true;
    const float q = kmin(ROULETTE_MOST, max_of3(p->throughput)*p->eta_scale);
    if (fraction(chance) >= q) return false;
    p->throughput = scale3(1/q, p->throughput);
    return true;
}

/* Stage, for one path: emission, a light to connect to, and the next ray; false if the path ends. */
static bool shade_path(const path_context *c, path *p)
{
    p->has_shadow = false;
    if (!p->has_hit) {
        gather_sky(c, p);
        return false;
    }
    const uint32_t group = 1 + p->n_events*GROUPS_PER_EVENT;
    const bool needs_chance = c->has_mixed_surfaces || p->n_events + 1 >= ROULETTE_START;
    const sample_point u = needs_chance ? sampler_point(&c->sampler, p->stream, group + GROUP_CHANCE)
                                        : (sample_point){{0}};
    const real3 wo = neg3(normalize3(vector_of(p->ray.direction)));
    const surface at = surface_at(c->scene, &p->ray, &p->hit, wo, fraction(u.u[0]));
    gather_emission(c, p, &at);
    if (!at.scatters || p->n_events >= c->settings->depth) return false;
    const real3 wo_local = to_local(&at.shading, wo);
    if (!(at.transmits && facet_bsdf_lobes(&at.bsdf) & FACET_DELTA)) prepare_connection(c, p, &at, wo_local, group);
    p->n_events++;
    return scatter(c, p, &at, wo_local, group) && survives(p, u.u[1]);
}

/* Stage: all active paths; those that end leave the list, but keep their shadow ray for connect. */
static void shade(path_batch *batch, const path_context *c, uint16_t *shadowed, uint32_t *n_shadowed)
{
    uint32_t n = 0;
    *n_shadowed = 0;
    for (uint32_t i = 0; i < batch->n_active; i++) {
        const uint16_t index = batch->active[i];
        if (shade_path(c, &batch->paths[index])) batch->active[n++] = index;
        if (batch->paths[index].has_shadow) shadowed[(*n_shadowed)++] = index;
    }
    batch->n_active = n;
}

/* Stage: adds the light of those shadow rays that nothing blocks. */
static void connect(path_batch *batch, const path_context *c, const uint16_t *shadowed, uint32_t n_shadowed,
                    path_counts *counts)
{
    for (uint32_t i = 0; i < n_shadowed; i++) {
        path *p = &batch->paths[shadowed[i]];
        counts->n_shadow_rays++;
        if (!tracer_occluded(c->tracer, &p->shadow_ray)) p->radiance = add3(p->radiance, p->shadow_radiance);
    }
}

/* Hands the radiance to the film; what is not finite is counted and black. */
static void deposit(const path_context *c, const path *p, uint32_t sample, film *to, path_counts *counts)
{
    float rgb[3] = {p->radiance.x, p->radiance.y, p->radiance.z};
    if (!(isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]))) {
        counts->n_bad++;
        if (counts->n_reported < RENDER_MAX_REPORTED)
            counts->bad[counts->n_reported++] = (bad_sample){p->x + (uint32_t)c->settings->crop_x,
                                                             p->y + (uint32_t)c->settings->crop_y, sample};
        rgb[0] = rgb[1] = rgb[2] = 0;
    }
    film_add(to, p->x, p->y, rgb);
}

void path_batch_run(path_batch *batch, const path_context *context, tile where, uint32_t sample, film *to,
                    path_counts *counts)
{
    uint16_t shadowed[TILE_SIZE*TILE_SIZE];
    uint32_t n_shadowed;
    generate(batch, context, where, sample);
    while (batch->n_active) {
        trace(batch, context, counts);
        shade(batch, context, shadowed, &n_shadowed);
        connect(batch, context, shadowed, n_shadowed, counts);
    }
    for (uint32_t i = 0; i < batch->n_paths; i++) deposit(context, &batch->paths[i], sample, to, counts);
    counts->n_paths += batch->n_paths;
}
