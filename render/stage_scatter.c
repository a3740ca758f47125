/* stage_scatter.c: directions in which paths go on, and roulette.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

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
            facet_bsdf_sample_batch(v->bsdf[first], n, dirs_at(&v->wo, first), dirs_at(&v->number, first),
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
        const facet_sample s = facet_bsdf_sample(v->bsdf[first], wo, number);
        set3(&v->wi, first, vector_of(s.wi));
        set3(&v->f, first, vector_of(s.weight));
        v->pdf[first] = s.pdf;
        v->lobe[first] = (uint32_t)s.lobe;
        v->eta[first] = s.eta;
    }
}

static void copy_receiver(receiver_array *to, uint32_t i, const receiver_array *from, uint32_t k)
{
    copy3(&to->normal, i, &from->normal, k);
    copy3(&to->mirror, i, &from->mirror, k);
    to->around[i] = from->around[k];
    to->broad[i] = from->broad[k];
    to->peak[i] = from->peak[k];
    to->width[i] = from->width[k];
    to->weight[i] = from->weight[k];
}

/* Extends paths by scattered rays, into the next list.  [cs500, "Extend path"]. */
void stage_scatter(path_batch *batch, const path_context *c, const path_list *list, uint32_t n_events, uint32_t group,
                   path_list *next)
{
    vertex_list *v = batch->vertices;
    sample(c, v, group);
    if (c->keeps_features)
        for (uint32_t k = 0; k < v->n; k++) feature_of_scattering(batch, list, k);
    render_loops_chosen()->scatter(v, n_events >= ROULETTE_START);
    const bool has_receivers = light_set_needs_receivers(c->lights);
    uint32_t n = 0;
    for (uint32_t k = 0; k < v->n; k++) {
        copy3(&next->throughput, n, &v->f, k);
        copy3(&next->previous, n, &v->position, k);
        if (has_receivers) copy_receiver(&next->receiver, n, &v->receiver, k);
        copy_ray(&next->ray, n, &v->ray, k);
        next->slot[n] = v->slot[k];
        next->pixel[n] = v->pixel[k];
        next->index[n] = v->index[k];
        next->eta_scale[n] = v->eta_scale[k];
        next->pdf_scatter[n] = v->pdf[k];
        next->origin[n] = v->lobe[k] & FACET_DELTA ? FROM_DELTA : FROM_LOBE;
        n += v->keeps[k];
    }
    next->n = n;
}
