/* stage_connect.c: light found by rays towards lights.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>

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
void stage_connect(path_batch *batch, const path_context *c, const path_list *list, uint32_t group, path_counts *counts)
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
