/* stage_meet.c: where rays end: surfaces found, their light gathered.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>
#include <string.h>

static ray get_ray(const ray_array *a, uint32_t i)
{
    return (ray){.origin = {a->origin.x[i], a->origin.y[i], a->origin.z[i]},
                 .direction = {a->direction.x[i], a->direction.y[i], a->direction.z[i]},
                 .t_min = a->t_min[i],
                 .t_max = a->t_max[i],
                 .seed = a->seed[i]};
}

static hit hit_at(const path_batch *batch, uint32_t i)
{
    return (hit){batch->t[i], batch->u[i], batch->v[i], batch->instance[i], batch->primitive[i]};
}

static hits hits_of(path_batch *batch)
{
    return (hits){batch->t, batch->u, batch->v, batch->instance, batch->primitive};
}

/* Sends a camera ray on through surfaces that are not drawn. */
static void pass_culled(path_batch *batch, const path_context *c, path_list *list, uint32_t i, path_counts *counts)
{
    hit h = hit_at(batch, i);
    while (h.instance != NO_HIT && surface_is_hidden(c->surfaces, &h, get3(&list->ray.direction, i))) {
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
void stage_trace(path_batch *batch, const path_context *c, path_list *list, bool is_first, path_counts *counts)
{
    tracer_nearest(c->tracer, list->n, rays_of(&list->ray), is_first, hits_of(batch));
    counts->n_rays += list->n;
    if (is_first)
        for (uint32_t i = 0; i < list->n; i++) pass_culled(batch, c, list, i, counts);
}

/* The weight of light that a scattered ray has met, which a light sample would have had density pdf_light for. */
static float implicit_weight(const path_context *c, const path_list *list, uint32_t i, float pdf_light)
{
    if (!is_of_lobe(list, i) || !(pdf_light > 0)) return 1;
    switch (c->settings->strategy) {
    case STRATEGY_EXPLICIT: return 0;
    case STRATEGY_IMPLICIT: return 1;
    case STRATEGY_MIS: break;
    }
    return power_heuristic(list->pdf_scatter[i], pdf_light);
}

static void gather(path_batch *batch, const path_list *list, uint32_t i, real3 radiance, float weight)
{
    if (weight > 0) add_radiance(batch, list->slot[i], mul3(get3(&list->throughput, i), scale3(weight, radiance)));
}

/* What sent the path's ray, for the lights. */
static light_receiver receiver_of(const path_context *c, const path_list *list, uint32_t i)
{
    if (!light_set_needs_receivers(c->lights)) return receiver_anywhere(get3(&list->previous, i));
    const receiver_array *r = &list->receiver;
    return (light_receiver){get3(&list->previous, i),
                            get3(&r->normal, i),
                            get3(&r->mirror, i),
                            r->around[i],
                            r->broad[i],
                            r->peak[i],
                            r->width[i],
                            r->weight[i]};
}

static void gather_sky(path_batch *batch, const path_context *c, const path_list *list, uint32_t i, real2 place)
{
    const real3 radiance = sky_radiance_at(light_set_sky(c->lights), place);
    if (c->keeps_features) feature_of_sky(batch, list, i, radiance);
    if (!(max_of3(radiance) > 0)) return;
    const light_receiver previous = receiver_of(c, list, i);
    const float pdf = is_of_lobe(list, i) ? light_set_pdf_of_sky(c->lights, &previous, place) : 0;
    gather(batch, list, i, radiance, implicit_weight(c, list, i, pdf));
}

/* Of n paths. */
static void gather_skies(path_batch *batch, const path_context *c, const path_list *list, const uint32_t *paths,
                         uint32_t n)
{
    sky_list *s = &batch->skies;
    for (uint32_t k = 0; k < n; k++) copy3(&s->direction, k, &list->ray.direction, paths[k]);
    render_loops_chosen()->find_sky(n, vectors_of(&s->direction), s->u, s->v);
    enum { AHEAD = 8 };
    for (uint32_t k = 0; k < n; k++) {
        const uint32_t next = k + AHEAD < n ? k + AHEAD : k;
        sky_expect_place(light_set_sky(c->lights), make2(s->u[next], s->v[next]));
        gather_sky(batch, c, list, paths[k], make2(s->u[k], s->v[k]));
    }
}

static void gather_emission(path_batch *batch, const path_context *c, const path_list *list, uint32_t i,
                            const surface *at)
{
    if (list->lobe[i] == 0) gather(batch, list, i, at->unlit, 1);
    if (!(max_of3(at->emission) > 0)) return;
    const hit h = hit_at(batch, i);
    const light_receiver previous = receiver_of(c, list, i);
    const float pdf = is_of_lobe(list, i) ? light_set_pdf_of_hit(c->lights, &previous, &h, at) : 0;
    gather(batch, list, i, at->emission, implicit_weight(c, list, i, pdf));
}

/* The paths that met something, ordered by material, so that neighbours are shaded by the same code; returns their
 * number.  Those that meet the sky come last. */
static uint32_t sort_by_material(path_batch *batch, const path_context *c, const path_list *list)
{
    uint32_t *const place = batch->n_of_material;
    const size_t n_materials = c->scene->n_materials;
    surface_materials(c->surfaces, list->n, hits_of(batch), batch->material);
    memset(place, 0, (n_materials + 2)*sizeof *place);
    for (uint32_t i = 0; i < list->n; i++) place[batch->material[i] + 1]++;
    for (size_t k = 1; k <= n_materials; k++) place[k] += place[k - 1];
    const uint32_t n_hits = place[n_materials];
    for (uint32_t i = 0; i < list->n; i++) batch->order[place[batch->material[i]]++] = i;
    return n_hits;
}

/* All paths in their own order; returns how many meet the sky, which are listed apart. */
static uint32_t list_skies(path_batch *batch, const path_list *list)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < list->n; i++) {
        batch->order[i] = i;
        batch->skies.path[n] = i;
        n += batch->instance[i] == NO_HIT;
    }
    return n;
}

/* Path i goes on from a vertex. */
static uint32_t add_vertex(path_batch *batch, const path_list *list, uint32_t i)
{
    vertex_list *v = batch->vertices;
    const uint32_t k = v->n++;
    v->path[k] = i;
    v->slot[k] = list->slot[i];
    v->pixel[k] = list->pixel[i];
    v->index[k] = list->index[i];
    v->chance[k] = batch->chance[1][i];
    copy3(&v->throughput, k, &list->throughput, i);
    v->eta_scale[k] = list->eta_scale[i];
    return k;
}

/* Vertices of surfaces that loops find, a block of them at once, for the first of n paths: their number, 0 if the very
 * first surface is of another kind. */
static uint32_t add_plain(path_batch *batch, const path_context *c, const path_list *list, const uint32_t *paths,
                          uint32_t n)
{
    vertex_list *v = batch->vertices;
    const uint32_t n_plain = surface_load_plain(c->surfaces, hits_of(batch), n, paths, &batch->plain, v->n%LOOP_LANES,
                                                v->bsdf + v->n, v->transmits + v->n);
    for (uint32_t j = 0; j < n_plain; j++) {
        const uint32_t k = add_vertex(batch, list, paths[j]);
        set3(&v->wi, k, neg3(get3(&list->ray.direction, paths[j])));
    }
    return n_plain;
}

/* A vertex of any other, whose emission is gathered first. */
static void add_surface(path_batch *batch, const path_context *c, const path_list *list, uint32_t i, bool is_last)
{
    vertex_list *v = batch->vertices;
    const hit h = hit_at(batch, i);
    const ray r = get_ray(&list->ray, i);
    const real3 wo = neg3(vector_of(r.direction));
    surface at;
    surface_find(c->surfaces, &r, &h, wo, fraction(batch->chance[0][i]), &v->own[v->n], &at);
    gather_emission(batch, c, list, i, &at);
    if (!at.scatters || is_last) {
        if (c->keeps_features) feature_of_surface(batch, list, i, &at);
        return;
    }
    const uint32_t k = add_vertex(batch, list, i);
    v->bsdf[k] = at.bsdf;
    v->transmits[k] = at.transmits ? UINT32_MAX : 0;
    set3(&v->position, k, at.position);
    set3(&v->normal, k, at.normal);
    v->offset[k] = at.offset;
    set3(&v->t, k, at.shading.t);
    set3(&v->b, k, at.shading.b);
    set3(&v->up, k, at.shading.n);
    v->facing[k] = dot3(at.normal, wo);
    set3(&v->wo, k, to_local(&at.shading, wo));
}

/* Whether batches serve the vertex's bsdf. */
static bool is_batched(const vertex_list *v, uint32_t k)
{
    return v->bsdf[k] != &v->own[k] && !(facet_bsdf_lobes(v->bsdf[k]) & (FACET_DELTA | FACET_TRANSMISSION));
}

static void count_alike(vertex_list *v)
{
    const facet_bsdf *next = NULL;
    uint32_t n = 0;
    for (uint32_t k = v->n; k-- > 0; next = v->bsdf[k]) {
        if (v->bsdf[k] == next) n += n > 0;
        else n = is_batched(v, k);
        v->n_alike[k] = n;
    }
}

/* In place of a vertex for path i: one that is black, and whose rays lie in its surface. */
static void add_nothing(path_batch *batch, const path_list *list, uint32_t i)
{
    vertex_list *v = batch->vertices;
    const uint32_t k = add_vertex(batch, list, i);
    v->path[k] = NO_PATH;
    v->bsdf[k] = k > 0 && is_batched(v, k - 1) ? v->bsdf[k - 1] : &batch->black; /* batches go on */
    v->transmits[k] = 0;
    v->offset[k] = v->facing[k] = 0;
    vector_array *const zero[] = {&v->throughput, &v->position, &v->normal, &v->t, &v->b, &v->up};
    for (size_t j = 0; j < sizeof zero/sizeof zero[0]; j++) set3(zero[j], k, splat3(0));
    set3(&v->wo, k, make3(0, 0, 1));
}

/* The vertices of n paths, as far as their surfaces scatter. */
static void add_vertices(path_batch *batch, const path_context *c, const path_list *list, const uint32_t *paths,
                         uint32_t n, bool is_by_slot, bool is_last)
{
    vertex_list *v = batch->vertices;
    const render_loops *loops = render_loops_chosen();
    v->n = 0;
    for (uint32_t k = 0, some; k < n; k += some) {
        const uint32_t n_before = v->n;
        some = is_last ? 0 : add_plain(batch, c, list, paths + k, n - k);
        if (some == 0) {
            some = 1;
            surface_expect(c->surfaces, hits_of(batch), n - k, paths + k);
            if (batch->instance[paths[k]] != NO_HIT) add_surface(batch, c, list, paths[k], is_last);
            if (is_by_slot && v->n == n_before) add_nothing(batch, list, paths[k]);
        }
        if (v->n > n_before && v->n%LOOP_LANES == 0) loops->meet(v, v->n - LOOP_LANES, &batch->plain);
    }
    if (v->n%LOOP_LANES) loops->meet(v, v->n/LOOP_LANES*LOOP_LANES, &batch->plain);
    count_alike(v);
}

void stage_meet(path_batch *batch, const path_context *c, const path_list *list, bool is_by_slot, bool is_last)
{
    if (is_by_slot) {
        const uint32_t n = list_skies(batch, list);
        gather_skies(batch, c, list, batch->skies.path, n);
        add_vertices(batch, c, list, batch->order, list->n, is_by_slot, is_last);
    } else {
        const uint32_t n = sort_by_material(batch, c, list);
        gather_skies(batch, c, list, batch->order + n, list->n - n);
        add_vertices(batch, c, list, batch->order, n, is_by_slot, is_last);
    }
    if (c->keeps_features)
        for (uint32_t k = 0; k < batch->vertices->n; k++) feature_of_vertex(batch, list, k);
}
