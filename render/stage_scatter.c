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
        n = v->n_alike[first];
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

static void pack_receivers(packed_array **end, const receiver_array *from, receiver_array *to)
{
    pack_vectors(end, &from->normal, &to->normal);
    pack_vectors(end, &from->mirror, &to->mirror);
    pack_array(end, from->around, to->around);
    pack_array(end, from->broad, to->broad);
    pack_array(end, from->peak, to->peak);
    pack_array(end, from->width, to->width);
    pack_array(end, from->weight, to->weight);
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
    packed_array arrays[MOST_PACKED], *end = arrays;
    pack_vectors(&end, &v->f, &next->throughput);
    pack_vectors(&end, &v->position, &next->previous);
    pack_vectors(&end, &v->ray.origin, &next->ray.origin);
    pack_vectors(&end, &v->ray.direction, &next->ray.direction);
    pack_array(&end, v->ray.seed, next->ray.seed);
    pack_array(&end, v->slot, next->slot);
    pack_array(&end, v->pixel, next->pixel);
    pack_array(&end, v->index, next->index);
    pack_array(&end, v->eta_scale, next->eta_scale);
    pack_array(&end, v->pdf, next->pdf_scatter);
    pack_array(&end, v->lobe, next->lobe);
    if (light_set_needs_receivers(c->lights)) pack_receivers(&end, &v->receiver, &next->receiver);
    next->n = render_loops_chosen()->pack(v->n, NULL, v->keeps, (size_t)(end - arrays), arrays);
    for (uint32_t i = 0; i < next->n; i++) {
        next->ray.t_min[i] = 0;
        next->ray.t_max[i] = INFINITY;
    }
}
