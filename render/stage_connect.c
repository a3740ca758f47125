/* stage_connect.c: light found by rays towards lights.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <string.h>

/* The density of scattering at the directions wi. */
static void find_pdf(vertex_list *v)
{
    for (uint32_t first = 0, n; first < v->n; first += n) {
        n = v->n_alike[first];
        if (n > 0) {
            facet_bsdf_pdf_batch(v->bsdf[first], n, dirs_at(&v->wi, first), dirs_at(&v->wo, first), v->pdf + first);
            continue;
        }
        n = 1;
        const float wi[3] = {v->wi.x[first], v->wi.y[first], v->wi.z[first]},
                    wo[3] = {v->wo.x[first], v->wo.y[first], v->wo.z[first]};
        v->pdf[first] = facet_bsdf_pdf(v->bsdf[first], wi, wo);
    }
}

/* How the surfaces take light up (light_receiver.h). */
static void describe_receivers(vertex_list *v)
{
    const render_loops *loops = render_loops_chosen();
    loops->look_aside(v);
    find_pdf(v);
    loops->look_at_mirror(v);
    find_pdf(v);
    loops->receive(v);
}

void vertices_aim(vertex_list *v, const path_context *c)
{
    uint32_t *const u[3] = {v->u[0], v->u[1], v->u[2]};
    light_array *to = &v->light;
    light_set_points(c->lights, v->n, vectors_of(&v->position), choices_of(to), u,
                     (light_samples){.direction = vectors_of(&to->direction),
                                     .target = vectors_of(&to->target),
                                     .radiance = vectors_of(&to->radiance),
                                     .pdf = to->pdf,
                                     .is_infinite = to->is_infinite,
                                     .is_delta = to->is_delta});
    render_loops_chosen()->aim(v, c->settings->strategy == STRATEGY_IMPLICIT);
}

void vertices_evaluate(vertex_list *v)
{
    for (uint32_t first = 0, n; first < v->n; first += n) {
        n = v->n_alike[first];
        if (n > 0) {
            facet_bsdf_eval_pdf_batch(v->bsdf[first], n, dirs_at(&v->wi, first), dirs_at(&v->wo, first),
                                      (facet_rgb){v->f.x + first, v->f.y + first, v->f.z + first}, v->pdf + first);
            continue;
        }
        n = 1;
        if (!(v->light.pdf[first] > 0)) continue;
        const float wi[3] = {v->wi.x[first], v->wi.y[first], v->wi.z[first]},
                    wo[3] = {v->wo.x[first], v->wo.y[first], v->wo.z[first]};
        float f[3];
        v->pdf[first] = facet_bsdf_eval_pdf(v->bsdf[first], wi, wo, f);
        set3(&v->f, first, vector_of(f));
    }
}

void vertices_connect(vertex_list *v, bool is_mis, sight_list *to)
{
    vertices_evaluate(v);
    render_loops_chosen()->connect(v, is_mis, to);
    memset(to->is_open + MARGIN + v->n, 0, (FRAMED - MARGIN - v->n)*sizeof *to->is_open);
}

/* Where the rays from vertex p on stand, PACKED of each list in turn: their number. */
static uint32_t find_starts(const sight_list *sights, uint32_t n_lists, uint32_t first, uint32_t end, uint32_t *starts)
{
    uint32_t n = 0;
    for (uint32_t p = first; p < end; p += PACKED)
        for (uint32_t i = 0; i < n_lists; i++)
            starts[n++] = (uint32_t)(i*sizeof *sights/sizeof(uint32_t)) + MARGIN + p + (uint32_t)sights[i].step;
    return PACKED*n;
}

/* Those of n that are to be traced. */
static void collect(shadow_list *s, const sight_list *sights, uint32_t n, const uint32_t *starts)
{
    packed_array arrays[MOST_PACKED], *end = arrays;
    ray_array *to = &s->ray;
    pack_framed(&end, &sights->origin, &to->origin);
    pack_framed(&end, &sights->direction, &to->direction);
    pack_array(&end, sights->t_max, to->t_max);
    pack_array(&end, sights->seed, to->seed);
    s->n = render_loops_chosen()->pack(n, starts, sights->is_open, (size_t)(end - arrays), arrays);
}

void sights_trace(path_batch *batch, const path_context *c, uint32_t n_lists, uint32_t n, path_counts *counts)
{
    shadow_list *s = &batch->shadows;
    const uint32_t at_once = PATHS/n_lists;
    for (uint32_t first = 0; first < n; first += at_once) {
        uint32_t starts[PATHS/PACKED];
        const uint32_t end = n - first < at_once ? n : first + at_once;
        const uint32_t n_rays = find_starts(batch->sights, n_lists, first, end, starts);
        collect(s, batch->sights, n_rays, starts);
        counts->n_shadow_rays += s->n;
        tracer_blocked(c->tracer, s->n, rays_of(&s->ray), s->is_blocked);
        for (uint32_t k = 0; k < s->n; k++) s->is_blocked[k] ^= 1; /* keeps what is open */
        render_loops_chosen()->unpack(n_rays, starts, s->is_blocked, batch->sights[0].is_open);
    }
}

/* Explicit light connection.  [cs500, "Explicit light connection"], corrected: p is a density per solid angle,
 * EvalScattering contains the only cosine at P, and the term is weighted. */
void stage_connect(path_batch *batch, const path_context *c, uint32_t group, path_counts *counts)
{
    vertex_list *v = batch->vertices;
    uint32_t *const u[3] = {v->u[0], v->u[1], v->u[2]};
    if (light_set_is_empty(c->lights)) return;
    render_loops_chosen()->points(&c->sampler, v->n, v->pixel, v->index, group + GROUP_LIGHT, u);
    if (light_set_needs_receivers(c->lights)) describe_receivers(v);
    light_set_choose(c->lights, v->n, receivers_of(&v->position, &v->receiver), u, choices_of(&v->light));
    vertices_aim(v, c);
    sight_list *lights = &batch->sights[0];
    lights->step = 0;
    vertices_connect(v, c->settings->strategy == STRATEGY_MIS, lights);
    sights_trace(batch, c, 1, v->n, counts);
    for (uint32_t k = 0; k < v->n; k++)
        if (lights->is_open[MARGIN + k]) add_radiance(batch, v->slot[k], get3(&v->f, k));
}
