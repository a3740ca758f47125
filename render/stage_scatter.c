/* stage_scatter.c: directions in which paths go on, and roulette.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>

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
void stage_scatter(path_batch *batch, const path_context *c, const path_list *list, uint32_t n_events, uint32_t group,
                   path_list *next)
{
    vertex_list *v = &batch->vertices;
    sample(c, v, group);
    uint32_t n = 0;
    for (uint32_t k = 0; k < v->n; k++) {
        if (c->keeps_features) feature_of_scattering(batch, list, k);
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
