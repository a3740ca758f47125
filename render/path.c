/* path.c: the stages of the path tracer, each over all paths of a tile.
 * SPDX-License-Identifier: MIT */
#include "render/path.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "render/loops.h"
#include "render/surface.h"

/* Groups of numbers: one for the camera, then these for every scattering event. */
enum { GROUP_CAMERA, GROUP_LIGHT, GROUP_SCATTER, GROUP_CHANCE, GROUPS_PER_EVENT = 3 };

/* Roulette starts at this event, and ends paths that carry less than this share of the light (docs/performance.md). */
#define ROULETTE_START 2
#define ROULETTE_BELOW 0.5f

/* Arrays of a power of two would lie at equal offsets in their pages, and evict each other from the first cache. */
enum { PATHS = TILE_SIZE*TILE_SIZE, ROOM = PATHS + 16 };
_Static_assert(PATHS%LOOP_LANES == 0, "arrays hold whole vectors");

/* What sent a ray. */
typedef enum path_origin { FROM_CAMERA, FROM_DELTA, FROM_LOBE } path_origin;

typedef struct vector_array {
    float x[ROOM], y[ROOM], z[ROOM];
} vector_array;

typedef struct ray_array {
    vector_array origin, direction;
    float t_min[ROOM], t_max[ROOM];
    uint32_t seed[ROOM];
} ray_array;

/* Paths that go on, and the ray that each follows, of unit direction.  Those that end are left out of the next list. */
typedef struct path_list {
    uint32_t n;
    uint32_t slot[ROOM];               /* pixel of the tile */
    uint32_t pixel[ROOM], index[ROOM]; /* sample_stream */
    ray_array ray;
    vector_array throughput;
    float eta_scale[ROOM];   /* radiance lost to refraction and got back on leaving: not a reason to end a path */
    vector_array previous;   /* where the ray was scattered */
    float pdf_scatter[ROOM]; /* of its direction [1/sr] */
    uint8_t origin[ROOM];    /* path_origin */
} path_list;

/* Where paths meet surfaces that scatter, ordered by material. */
typedef struct vertex_list {
    uint32_t n;
    uint32_t path[ROOM]; /* index into the list of paths */
    uint32_t pixel[ROOM], index[ROOM];
    uint32_t u[3][ROOM];
    vector_array wo, wi, number; /* local; number: the sampler's, as floats */
    vector_array f;              /* or weight of a sample */
    float pdf[ROOM];
    int lobe[ROOM];
    float eta[ROOM];
    light_sample light[ROOM];
    surface at[ROOM];
    facet_bsdf own[ROOM];
} vertex_list;

typedef struct shadow_list {
    uint32_t n;
    uint32_t slot[ROOM];
    ray_array ray;
    vector_array radiance; /* what it brings if nothing is in its way */
    uint32_t is_blocked[ROOM];
} shadow_list;

struct path_batch {
    path_list lists[2];
    vector_array radiance; /* gathered so far, by slot */
    float t[ROOM], u[ROOM], v[ROOM];
    uint32_t instance[ROOM], primitive[ROOM];
    uint32_t chance[3][ROOM];
    vertex_list vertices;
    shadow_list shadows;
    uint32_t material[ROOM], order[ROOM]; /* of what the paths met; the paths by it */
    uint32_t *n_of_material;              /* counts, then places, of one more than the scene's materials */
};

path_batch *path_batch_create(const scene *s)
{
    path_batch *batch = aligned_alloc(64, (sizeof *batch + 63)/64*64);
    if (!batch) return NULL;
    memset(batch, 0, sizeof *batch); /* loops run over whole vectors, over lanes that nothing was put in */
    batch->n_of_material = malloc((s->n_materials + 1)*sizeof *batch->n_of_material);
    if (!batch->n_of_material) {
        free(batch);
        return NULL;
    }
    return batch;
}

void path_batch_destroy(path_batch *batch)
{
    if (batch) free(batch->n_of_material);
    free(batch);
}

static vectors vectors_of(vector_array *a)
{
    return (vectors){a->x, a->y, a->z};
}

static rays rays_of(ray_array *a)
{
    return (rays){vectors_of(&a->origin), vectors_of(&a->direction), a->t_min, a->t_max, a->seed};
}

static facet_dirs dirs_at(const vector_array *a, uint32_t first)
{
    return (facet_dirs){a->x + first, a->y + first, a->z + first};
}

static real3 get3(const vector_array *a, uint32_t i)
{
    return make3(a->x[i], a->y[i], a->z[i]);
}

static void set3(vector_array *a, uint32_t i, real3 v)
{
    a->x[i] = v.x;
    a->y[i] = v.y;
    a->z[i] = v.z;
}

static void set_ray(ray_array *a, uint32_t i, real3 origin, real3 direction, float t_max, uint32_t seed)
{
    set3(&a->origin, i, origin);
    set3(&a->direction, i, direction);
    a->t_min[i] = 0;
    a->t_max[i] = t_max;
    a->seed[i] = seed;
}

static ray get_ray(const ray_array *a, uint32_t i)
{
    return (ray){.origin = {a->origin.x[i], a->origin.y[i], a->origin.z[i]},
                 .direction = {a->direction.x[i], a->direction.y[i], a->direction.z[i]},
                 .t_min = a->t_min[i],
                 .t_max = a->t_max[i],
                 .seed = a->seed[i]};
}

/* ---- Camera rays --------------------------------------------------------------------------------------------- */

/* The camera's ray through a point of the picture; x and y in pixels of the whole picture.  tan: of half the field of
 * view. */
static void camera_ray(const path_context *c, float tan, float x, float y, uint32_t seed, ray_array *r, uint32_t i)
{
    const camera *cam = c->camera;
    const float w = (float)c->settings->width, h = (float)c->settings->height;
    const float right = (2*x/w - 1)*w/h, up = 1 - 2*y/h;
    if (cam->is_orthographic) {
        const real3 origin = map_point(cam->to_world, make3(right*cam->ymag, up*cam->ymag, 0));
        set_ray(r, i, origin, normalize3(map_vector(cam->to_world, make3(0, 0, -1))), INFINITY, seed);
    } else {
        const real3 local = make3(right*tan, up*tan, -1);
        set_ray(r, i, map_column(cam->to_world, 3), normalize3(map_vector(cam->to_world, local)), INFINITY, seed);
    }
}

/* One path per pixel of the tile. */
static void generate(path_batch *batch, const path_context *c, tile where, uint32_t sample)
{
    path_list *list = &batch->lists[0];
    uint32_t n = 0;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++, n++) {
            const uint32_t px = x + (uint32_t)c->settings->crop_x, py = y + (uint32_t)c->settings->crop_y;
            const sample_stream stream = sampler_start(&c->sampler, px, py, sample);
            list->slot[n] = n;
            list->pixel[n] = stream.pixel;
            list->index[n] = stream.index;
            list->eta_scale[n] = 1;
            list->origin[n] = FROM_CAMERA;
            set3(&list->throughput, n, splat3(1));
            set3(&batch->radiance, n, splat3(0));
        }
    list->n = n;
    uint32_t *const u[3] = {batch->chance[0], batch->chance[1], batch->chance[2]};
    render_loops_chosen()->points(&c->sampler, n, list->pixel, list->index, GROUP_CAMERA, u);
    const float tan = tanf(0.5f*c->camera->yfov);
    const uint32_t width = where.x1 - where.x0;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t px = where.x0 + i%width + (uint32_t)c->settings->crop_x,
                       py = where.y0 + i/width + (uint32_t)c->settings->crop_y;
        camera_ray(c, tan, (float)px + fraction(u[0][i]), (float)py + fraction(u[1][i]), u[2][i], &list->ray, i);
    }
}

/* ---- Surfaces ------------------------------------------------------------------------------------------------ */

static hit hit_at(const path_batch *batch, uint32_t i)
{
    return (hit){batch->t[i], batch->u[i], batch->v[i], batch->instance[i], batch->primitive[i]};
}

/* glTF's single-sided surfaces are not drawn from behind; light meets them all the same. */
static bool is_culled(const path_context *c, const hit *h, real3 direction)
{
    if (h->instance >= c->scene->n_instances) return false;
    const instance *in = &c->scene->instances[h->instance];
    const mesh *m = &c->scene->meshes[in->mesh];
    const material *mat = &c->scene->materials[m->material];
    if (mat->is_double_sided || mat->transmission > 0 || mat->kind == SURFACE_BSDF) return false;
    const uint32_t *i = m->triangles[h->primitive];
    const real3 p0 = vector_of(m->positions[i[0]]);
    const real3 e1 = map_vector(in->to_world, sub3(vector_of(m->positions[i[1]]), p0));
    const real3 e2 = map_vector(in->to_world, sub3(vector_of(m->positions[i[2]]), p0));
    const float sign = map_determinant(in->to_world) < 0 ? -1.0f : 1.0f;
    return sign*dot3(normal_of_edges(e1, e2), direction) > 0;
}

/* Sends a camera ray on through surfaces that are not drawn. */
static void pass_culled(path_batch *batch, const path_context *c, path_list *list, uint32_t i, path_counts *counts)
{
    hit h = hit_at(batch, i);
    while (h.instance != NO_HIT && is_culled(c, &h, get3(&list->ray.direction, i))) {
        list->ray.t_min[i] = nextafterf(h.t, INFINITY);
        const ray r = get_ray(&list->ray, i);
        if (!tracer_intersect(c->tracer, &r, &h)) h.instance = NO_HIT;
        counts->n_rays++;
    }
    batch->t[i] = h.t;
    batch->u[i] = h.u;
    batch->v[i] = h.v;
    batch->instance[i] = h.instance;
    batch->primitive[i] = h.primitive;
}

/* The nearest surface of every path's ray. */
static void trace(path_batch *batch, const path_context *c, path_list *list, bool is_first, path_counts *counts)
{
    tracer_nearest(c->tracer, list->n, rays_of(&list->ray), is_first,
                   (hits){batch->t, batch->u, batch->v, batch->instance, batch->primitive});
    counts->n_rays += list->n;
    if (is_first)
        for (uint32_t i = 0; i < list->n; i++) pass_culled(batch, c, list, i, counts);
}

/* The power heuristic for the technique with density a against the other with density b. */
static float power_heuristic(float a, float b)
{
    const float ratio = b/a; /* squares of densities overflow, squares of their ratio do so harmlessly */
    return 1/(1 + ratio*ratio);
}

/* The weight of light that a scattered ray has met, which a light sample would have had density pdf_light for. */
static float implicit_weight(const path_context *c, const path_list *list, uint32_t i, float pdf_light)
{
    if (list->origin[i] != FROM_LOBE || !(pdf_light > 0)) return 1;
    switch (c->settings->strategy) {
    case STRATEGY_EXPLICIT: return 0;
    case STRATEGY_IMPLICIT: return 1;
    case STRATEGY_MIS: break;
    }
    return power_heuristic(list->pdf_scatter[i], pdf_light);
}

static void add_radiance(path_batch *batch, uint32_t slot, real3 radiance)
{
    set3(&batch->radiance, slot, add3(get3(&batch->radiance, slot), radiance));
}

static void gather(path_batch *batch, const path_list *list, uint32_t i, real3 radiance, float weight)
{
    if (weight > 0) add_radiance(batch, list->slot[i], mul3(get3(&list->throughput, i), scale3(weight, radiance)));
}

static void gather_sky(path_batch *batch, const path_context *c, const path_list *list, uint32_t i)
{
    const real3 direction = get3(&list->ray.direction, i);
    const real3 radiance = sky_radiance(light_set_sky(c->lights), direction);
    if (!(max_of3(radiance) > 0)) return;
    const bool is_lobe = list->origin[i] == FROM_LOBE;
    const float pdf = is_lobe ? light_set_pdf_of_sky(c->lights, get3(&list->previous, i), direction) : 0;
    gather(batch, list, i, radiance, implicit_weight(c, list, i, pdf));
}

static void gather_emission(path_batch *batch, const path_context *c, const path_list *list, uint32_t i,
                            const surface *at)
{
    if (list->origin[i] == FROM_CAMERA) gather(batch, list, i, at->unlit, 1);
    if (!(max_of3(at->emission) > 0)) return;
    const hit h = hit_at(batch, i);
    const bool is_lobe = list->origin[i] == FROM_LOBE;
    const float pdf = is_lobe ? light_set_pdf_of_hit(c->lights, get3(&list->previous, i), &h, at) : 0;
    gather(batch, list, i, at->emission, implicit_weight(c, list, i, pdf));
}

/* The paths that met something, ordered by material, so that neighbours are shaded by the same code; returns their
 * number.  The others meet the sky. */
static uint32_t sort_by_material(path_batch *batch, const path_context *c, const path_list *list)
{
    uint32_t *const place = batch->n_of_material;
    memset(place, 0, (c->scene->n_materials + 1)*sizeof *place);
    for (uint32_t i = 0; i < list->n; i++) {
        if (batch->instance[i] == NO_HIT) {
            gather_sky(batch, c, list, i);
            continue;
        }
        const hit h = hit_at(batch, i);
        batch->material[i] = (uint32_t)surface_material(c->surfaces, &h);
        place[batch->material[i] + 1]++;
    }
    for (size_t k = 1; k <= c->scene->n_materials; k++) place[k] += place[k - 1];
    const uint32_t n = place[c->scene->n_materials];
    for (uint32_t i = 0; i < list->n; i++)
        if (batch->instance[i] != NO_HIT) batch->order[place[batch->material[i]]++] = i;
    return n;
}

/* Asks for the memory of hits that come next. */
static void expect(const path_batch *batch, const path_context *c, uint32_t k, uint32_t n)
{
    enum { AHEAD = 8 };
    if (k + 2*AHEAD < n) {
        const hit h = hit_at(batch, batch->order[k + 2*AHEAD]);
        surface_expect_triangle(c->surfaces, &h);
    }
    if (k + AHEAD < n) {
        const hit h = hit_at(batch, batch->order[k + AHEAD]);
        surface_expect_vertices(c->surfaces, &h);
    }
}

/* The surfaces that paths have met: their emission is gathered, and those that scatter become vertices. */
static void meet_surfaces(path_batch *batch, const path_context *c, const path_list *list, bool is_last)
{
    vertex_list *v = &batch->vertices;
    const uint32_t n_hits = sort_by_material(batch, c, list);
    uint32_t n = 0;
    for (uint32_t k = 0; k < n_hits; k++) {
        const uint32_t i = batch->order[k];
        const ray r = get_ray(&list->ray, i);
        const hit h = hit_at(batch, i);
        const real3 wo = neg3(vector_of(r.direction));
        surface *at = &v->at[n];
        expect(batch, c, k, n_hits);
        surface_find(c->surfaces, &r, &h, wo, fraction(batch->chance[0][i]), &v->own[n], at);
        gather_emission(batch, c, list, i, at);
        if (!at->scatters || is_last) continue;
        set3(&v->wo, n, to_local(&at->shading, wo));
        v->path[n] = i;
        v->pixel[n] = list->pixel[i];
        v->index[n] = list->index[i];
        n++;
    }
    v->n = n;
}

/* Vertices from `first` on that share a bsdf which batches serve: their number, 0 if the first is none. */
static uint32_t batch_from(const vertex_list *v, uint32_t first)
{
    const facet_bsdf *bsdf = v->at[first].bsdf;
    if (bsdf == &v->own[first] || facet_bsdf_lobes(bsdf) & (FACET_DELTA | FACET_TRANSMISSION)) return 0;
    uint32_t n = 1;
    while (first + n < v->n && v->at[first + n].bsdf == bsdf) n++;
    return n;
}

/* Whether wi and wo lie on the same side of the true surface for a reflection, and on opposite ones for light that
 * goes through; interpolated normals can claim otherwise. */
static bool is_true_side(const surface *at, real3 wi, real3 wo, bool is_through)
{
    return (dot3(at->normal, wi)*dot3(at->normal, wo) > 0) != is_through;
}

/* ---- Explicit light ------------------------------------------------------------------------------------------ */

/* A light for every vertex, or none: pdf 0. */
static void choose_lights(const path_context *c, vertex_list *v, uint32_t group)
{
    uint32_t *const u[3] = {v->u[0], v->u[1], v->u[2]};
    render_loops_chosen()->points(&c->sampler, v->n, v->pixel, v->index, group + GROUP_LIGHT, u);
    for (uint32_t k = 0; k < v->n; k++) {
        const surface *at = &v->at[k];
        light_sample *light = &v->light[k];
        light->pdf = 0;
        set3(&v->wi, k, make3(0, 0, -1));
        if (at->transmits && facet_bsdf_lobes(at->bsdf) & FACET_DELTA) continue;
        *light = light_set_sample(c->lights, at->position, (const uint32_t[3]){u[0][k], u[1][k], u[2][k]});
        if (!(light->pdf > 0)) continue;
        const real3 wi = to_local(&at->shading, light->direction);
        const bool is_through = at->transmits && wi.z*v->wo.z[k] < 0;
        if ((c->settings->strategy == STRATEGY_IMPLICIT && !light->is_delta) ||
            !is_true_side(at, light->direction, to_world(&at->shading, get3(&v->wo, k)), is_through)) {
            light->pdf = 0;
            continue;
        }
        set3(&v->wi, k, wi);
    }
}

/* f cos and pdf at the directions wi. */
static void evaluate(vertex_list *v)
{
    for (uint32_t first = 0, n; first < v->n; first += n) {
        n = batch_from(v, first);
        if (n > 0) {
            facet_bsdf_eval_pdf_batch(v->at[first].bsdf, n, dirs_at(&v->wi, first), dirs_at(&v->wo, first),
                                      (facet_rgb){v->f.x + first, v->f.y + first, v->f.z + first}, v->pdf + first);
            continue;
        }
        n = 1;
        if (!(v->light[first].pdf > 0)) continue;
        const float wi[3] = {v->wi.x[first], v->wi.y[first], v->wi.z[first]},
                    wo[3] = {v->wo.x[first], v->wo.y[first], v->wo.z[first]};
        float f[3];
        v->pdf[first] = facet_bsdf_eval_pdf(v->at[first].bsdf, wi, wo, f);
        set3(&v->f, first, vector_of(f));
    }
}

/* Explicit light connection.  [cs500, "Explicit light connection"], corrected: p is a density per solid angle,
 * EvalScattering contains the only cosine at P, and the term is weighted. */
static void connect(path_batch *batch, const path_context *c, const path_list *list, uint32_t group,
                    path_counts *counts)
{
    vertex_list *v = &batch->vertices;
    shadow_list *s = &batch->shadows;
    choose_lights(c, v, group);
    evaluate(v);
    uint32_t n = 0;
    for (uint32_t k = 0; k < v->n; k++) {
        const light_sample *light = &v->light[k];
        const real3 f = get3(&v->f, k);
        if (!(light->pdf > 0 && max_of3(f) > 0)) continue;
        float weight = 1;
        if (!light->is_delta && c->settings->strategy == STRATEGY_MIS) weight = power_heuristic(light->pdf, v->pdf[k]);
        const uint32_t i = v->path[k];
        set3(&s->radiance, n, mul3(get3(&list->throughput, i), mul3(f, scale3(weight/light->pdf, light->radiance))));
        const real3 origin = surface_leave(&v->at[k], light->direction);
        const uint32_t seed = v->u[0][k] ^ v->u[1][k];
        if (light->is_infinite) set_ray(&s->ray, n, origin, light->direction, INFINITY, seed);
        else set_ray(&s->ray, n, origin, sub3(light->target, origin), 1, seed);
        s->slot[n++] = list->slot[i];
    }
    s->n = n;
    counts->n_shadow_rays += n;
    tracer_blocked(c->tracer, n, rays_of(&s->ray), s->is_blocked);
    for (uint32_t k = 0; k < n; k++)
        if (!s->is_blocked[k]) add_radiance(batch, s->slot[k], get3(&s->radiance, k));
}

/* ---- Scattering ---------------------------------------------------------------------------------------------- */

/* A direction wi for every vertex, with its weight and density; pdf 0: none. */
static void sample(const path_context *c, vertex_list *v, uint32_t group)
{
    uint32_t *const u[3] = {v->u[0], v->u[1], v->u[2]};
    render_loops_chosen()->points(&c->sampler, v->n, v->pixel, v->index, group + GROUP_SCATTER, u);
    for (uint32_t k = 0; k < v->n; k++)
        set3(&v->number, k, make3(fraction(u[0][k]), fraction(u[1][k]), fraction(u[2][k])));
    for (uint32_t first = 0, n; first < v->n; first += n) {
        n = batch_from(v, first);
        if (n > 0) {
            facet_bsdf_sample_batch(v->at[first].bsdf, n, dirs_at(&v->wo, first), dirs_at(&v->number, first),
                                    (facet_samples){v->wi.x + first, v->wi.y + first, v->wi.z + first, v->pdf + first,
                                                    v->f.x + first, v->f.y + first, v->f.z + first});
            for (uint32_t k = first; k < first + n; k++) {
                v->lobe[k] = FACET_REFLECTION;
                v->eta[k] = 1;
            }
            continue;
        }
        n = 1;
        const float wo[3] = {v->wo.x[first], v->wo.y[first], v->wo.z[first]},
                    number[3] = {v->number.x[first], v->number.y[first], v->number.z[first]};
        const facet_sample s = facet_bsdf_sample(v->at[first].bsdf, wo, number);
        set3(&v->wi, first, vector_of(s.wi));
        set3(&v->f, first, vector_of(s.weight));
        v->pdf[first] = s.pdf;
        v->lobe[first] = s.lobe;
        v->eta[first] = s.eta;
    }
}

/* Russian roulette on the throughput; false if the path ends. */
static bool survives(real3 *throughput, float eta_scale, uint32_t n_events, uint32_t chance)
{
    const float q = max_of3(*throughput)*eta_scale/ROULETTE_BELOW;
    if (n_events < ROULETTE_START || q >= 1) return true;
    if (fraction(chance) >= q) return false;
    *throughput = scale3(1/q, *throughput);
    return true;
}

/* Extends paths by scattered rays, into the next list.  [cs500, "Extend path"]. */
static void scatter(path_batch *batch, const path_context *c, const path_list *list, uint32_t n_events, uint32_t group,
                    path_list *next)
{
    vertex_list *v = &batch->vertices;
    sample(c, v, group);
    uint32_t n = 0;
    for (uint32_t k = 0; k < v->n; k++) {
        if (!(v->pdf[k] > 0)) continue;
        const surface *at = &v->at[k];
        const uint32_t i = v->path[k];
        const real3 wi = normalize3(to_world(&at->shading, get3(&v->wi, k)));
        const bool is_through = v->lobe[k] & FACET_TRANSMISSION, is_delta = v->lobe[k] & FACET_DELTA;
        if (!(is_through && is_delta) && !is_true_side(at, wi, to_world(&at->shading, get3(&v->wo, k)), is_through))
            continue;
        real3 throughput = mul3(get3(&list->throughput, i), get3(&v->f, k));
        if (!(max_of3(throughput) > 0)) continue;
        const float eta_scale = list->eta_scale[i]*v->eta[k]*v->eta[k];
        if (!survives(&throughput, eta_scale, n_events, batch->chance[1][i])) continue;
        set3(&next->throughput, n, throughput);
        set3(&next->previous, n, at->position);
        set_ray(&next->ray, n, surface_leave(at, wi), wi, INFINITY, v->u[0][k] ^ v->u[2][k]);
        next->slot[n] = list->slot[i];
        next->pixel[n] = list->pixel[i];
        next->index[n] = list->index[i];
        next->eta_scale[n] = eta_scale;
        next->pdf_scatter[n] = v->pdf[k];
        next->origin[n] = is_delta ? FROM_DELTA : FROM_LOBE;
        n++;
    }
    next->n = n;
}

/* ---- The whole tile ------------------------------------------------------------------------------------------ */

/* Hands the radiance to the film; what is not finite is counted and black. */
static void deposit(const path_batch *batch, const path_context *c, tile where, uint32_t sample_index, film *to,
                    path_counts *counts)
{
    uint32_t slot = 0;
    for (uint32_t y = where.y0; y < where.y1; y++)
        for (uint32_t x = where.x0; x < where.x1; x++, slot++) {
            float rgb[3] = {batch->radiance.x[slot], batch->radiance.y[slot], batch->radiance.z[slot]};
            if (!(isfinite(rgb[0]) && isfinite(rgb[1]) && isfinite(rgb[2]))) {
                counts->n_bad++;
                if (counts->n_reported < RENDER_MAX_REPORTED)
                    counts->bad[counts->n_reported++] = (bad_sample){x + (uint32_t)c->settings->crop_x,
                                                                     y + (uint32_t)c->settings->crop_y, sample_index};
                rgb[0] = rgb[1] = rgb[2] = 0;
            }
            film_add(to, x, y, rgb);
        }
}

void path_batch_run(path_batch *batch, const path_context *c, tile where, uint32_t sample_index, film *to,
                    path_counts *counts)
{
    generate(batch, c, where, sample_index);
    counts->n_paths += batch->lists[0].n;
    for (uint32_t event = 0; batch->lists[event & 1].n > 0; event++) {
        path_list *list = &batch->lists[event & 1], *next = &batch->lists[~event & 1];
        const uint32_t group = 1 + event*GROUPS_PER_EVENT;
        if (c->has_mixed_surfaces || event + 1 >= ROULETTE_START) {
            uint32_t *const u[3] = {batch->chance[0], batch->chance[1], batch->chance[2]};
            render_loops_chosen()->points(&c->sampler, list->n, list->pixel, list->index, group + GROUP_CHANCE, u);
        }
        trace(batch, c, list, event == 0, counts);
        meet_surfaces(batch, c, list, event >= c->settings->depth);
        connect(batch, c, list, group, counts);
        scatter(batch, c, list, event + 1, group, next);
    }
    deposit(batch, c, where, sample_index, to, counts);
}
