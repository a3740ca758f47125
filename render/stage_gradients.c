/* stage_gradients.c: light that neighbouring pixels share.
 *
 * [kettunen15] M. Kettunen, M. Manzi, M. Aittala, J. Lehtinen, F. Durand and M. Zwicker, Gradient-domain path tracing,
 * ACM TOG 34(4), 2015.  A path of pixel p is reconnected: its second vertex, with all that comes behind it, is seen
 * from the first vertex of the neighbour q, too.  Let C be the light of p's path from there, T the weight of its first
 * event, f that of q's surface towards the second vertex, cosine included, r how many times brighter C looks from q,
 * cos/d^2 the share of q's sphere that an area at the second vertex fills, and a_p and a_q the densities per area with
 * which p and q find it.  Then
 *     D = a_p/(a_p + a_q) (C' - C),   C' = r C f cos/(d^2 T a_p)
 * is p's part of an estimate of the difference between q's light and p's, and q's paths have the other part: each path
 * counts once in the mean.  With m = C + D, what p passes on, the difference is C_q - C_p + m_p - m_q.
 *
 * The lamp that was chosen for p's first vertex is looked at from q's, too, by the same numbers: the same point of it,
 * but for spheres.  With C' what that brings there, by the ratio of the two probabilities of that lamp, both as if
 * nothing were in the way, and V whether so, the parts of C and C' in each other's estimates are C/(C + C') and
 * C'/(C + C'), and what p passes on is
 *     m = V_p C + C/(C + C') (V_q C' - V_p C) = (V_p + V_q) C C'/(C + C').
 * Both hold the weight of a light that scattered rays could have found, by the rates at which p and q choose the lamp;
 * any rates would do, as long as both pixels take the same.
 *
 * The light of all pixels of a tile is then that which fits best:
 *     sum of w_p (x_p - C_p)^2 + sum over neighbours of w_pq (x_q - x_p - difference)^2,
 * w_pq from the normals of the first vertices, and both the less, the more light there is.  Given these, all estimates
 * have the mean that they should, and the fit is linear in them, so that x has it, too: nothing is blurred.
 *
 * A path is shared if its first vertex sent it by a lobe to a surface that reflects by lobes, and if r is no farther
 * from 1 than MOST_CONTRAST, which q's paths see in the same way.  Others have m = 0: they add C_q - C_p to the
 * difference, which asks for nothing.
 * SPDX-License-Identifier: MIT */
#include "render/stages.h"

#include <math.h>
#include <string.h>

static real3 get_framed(const framed_array *a, uint32_t slot)
{
    return make3(a->x[MARGIN + slot], a->y[MARGIN + slot], a->z[MARGIN + slot]);
}

static void set_framed(framed_array *a, uint32_t slot, real3 v)
{
    a->x[MARGIN + slot] = v.x;
    a->y[MARGIN + slot] = v.y;
    a->z[MARGIN + slot] = v.z;
}

/* What has been gathered so far is not shared. */
static void set_apart(path_batch *batch)
{
    vector_array *apart = &batch->gradients.apart;
    for (uint32_t i = 0; i < PATHS; i++) {
        set3(apart, i, add3(get3(apart, i), get3(&batch->radiance, i)));
        set3(&batch->radiance, i, splat3(0));
    }
}

void gradient_start(path_batch *batch)
{
    gradient_list *g = &batch->gradients;
    const vertex_list *v = &batch->vertex_lists[0];
    const float *const up[3] = {v->up.x, v->up.y, v->up.z}, *const weight[3] = {v->f.x, v->f.y, v->f.z};
    float *const throughput[3] = {g->throughput.x, g->throughput.y, g->throughput.z};
    memset(&g->apart, 0, sizeof g->apart);
    memset(&g->near, 0, sizeof g->near);
    memset(g->density, 0, sizeof g->density);
    set_apart(batch);
    batch->vertex_lists[1].n = 0;
    for (int k = 0; k < 3; k++) {
        memcpy(g->up[k], up[k], v->n*sizeof(float));
        memset(g->up[k] + v->n, 0, (FRAMED - v->n)*sizeof(float));
        memcpy(throughput[k] + MARGIN, weight[k], v->n*sizeof(float));
    }
    for (uint32_t k = 0; k < v->n; k++) g->pdf[k] = v->lobe[k] & FACET_DELTA ? 0 : v->pdf[k];
}

/* Errors grow with the light that there is, of which the sum that lights are chosen by tells without a sample: the dark
 * need not know much of the bright, whose errors they would get. */
static void weigh_pixels(gradient_list *g, const vertex_list *v)
{
    const float *level = v->receiver.weight;
    double sum = 0, n = 0;
    for (uint32_t k = 0; k < v->n; k++) {
        const bool is_there = v->path[k] != NO_PATH;
        sum += is_there ? (double)level[k] : 0;
        n += is_there;
    }
    const float mean = (float)(sum/n);
    if (!(mean > REAL_MIN && mean < INFINITY)) return;
    for (uint32_t k = 0; k < v->n; k++) {
        const float relative = v->path[k] == NO_PATH ? 1 : 1/(level[k]/mean + LEAST_LEVEL);
        g->self[MARGIN + k] = LIGHT_WEIGHT*relative*relative;
    }
}

/* The weight of what a light brings, beside scattered rays, by the rate at which it is chosen, over that by the
 * probability of the choice. */
static float weight_by_rate(const vertex_list *v, uint32_t k, float probability)
{
    const float rate = v->light.probability[k], pdf = v->light.pdf[k], rival = v->light.is_delta[k] ? 0 : v->pdf[k];
    return rate > 0 ? power_heuristic(pdf*(rate/probability), rival)/power_heuristic(pdf, rival) : 0;
}

void gradient_of_first_lights(path_batch *batch, const path_context *c)
{
    gradient_list *g = &batch->gradients;
    vertex_list *v = &batch->vertex_lists[0];
    memset(g->lamp_probability, 0, sizeof g->lamp_probability);
    memset(&g->brought, 0, sizeof g->brought);
    g->has_lamps = false;
    for (int i = 0; i < FRAMED; i++) g->self[i] = LIGHT_WEIGHT;
    if (light_set_is_empty(c->lights)) return;
    weigh_pixels(g, v);
    memcpy(g->lamp + MARGIN, v->light.which, v->n*sizeof *g->lamp);
    memcpy(g->lamp_rest + MARGIN, v->light.rest, v->n*sizeof *g->lamp_rest);
    memcpy(g->is_lit + MARGIN, batch->sights[0].is_open + MARGIN, v->n*sizeof *g->is_lit);
    for (int i = 0; i < 2; i++) memcpy(g->lamp_u[i] + MARGIN, v->u[i + 1], v->n*sizeof *g->lamp_u[i]);
    for (uint32_t k = 0; k < v->n; k++) {
        const real3 light = get3(&v->f, k);
        if (!(max_of3(light) > 0 && is_held(light))) continue;
        g->has_lamps = true;
        g->lamp_probability[MARGIN + k] = v->light.probability[k];
        set_framed(&g->brought, k, light);
    }
    if (c->settings->strategy != STRATEGY_MIS || light_set_rates_exactly(c->lights)) return;
    light_set_rate(c->lights, v->n, receivers_of(&v->position, &v->receiver), choices_of(&v->light));
    for (uint32_t k = 0; k < v->n; k++) {
        const float probability = g->lamp_probability[MARGIN + k];
        if (probability > 0)
            set_framed(&g->brought, k, scale3(weight_by_rate(v, k, probability), get_framed(&g->brought, k)));
    }
}

void gradient_of_second_vertices(path_batch *batch)
{
    gradient_list *g = &batch->gradients;
    const vertex_list *v = &batch->vertex_lists[1];
    set_apart(batch);
    for (uint32_t k = 0; k < v->n; k++) {
        const uint32_t slot = v->slot[k];
        if (facet_bsdf_lobes(v->bsdf[k]) & (FACET_DELTA | FACET_TRANSMISSION)) continue;
        const real3 position = get3(&v->position, k), normal = scale3(v->facing[k] < 0 ? -1 : 1, get3(&v->normal, k));
        const real3 d = sub3(get3(&batch->vertex_lists[0].position, slot), position);
        const float d2 = dot3(d, d);
        const real3 wo = scale3(1/sqrtf(d2), d), up = get3(&v->up, k);
        const float cos = dot3(normal, wo);
        if (!(mirror_cosine(up, normal, wo) >= least_mirror_cosine(cos))) continue; /* bent for this wo alone */
        set_framed(&g->position, slot, position);
        set_framed(&g->normal, slot, normal);
        set_framed(&g->shading, slot, up);
        set_framed(&g->target, slot, madd3(position, v->offset[k], normal));
        g->density[MARGIN + slot] = g->pdf[slot]*cos/d2;
    }
}

void gradient_of_lights(path_batch *batch)
{
    gradient_list *g = &batch->gradients;
    g->to_light = batch->vertex_lists[1].wi;
    g->near = batch->radiance;
    memset(&batch->radiance, 0, sizeof batch->radiance);
}

/* f cos of the second vertices for a direction of each. */
static void evaluate_seconds(vertex_list *v, const vector_array *wi)
{
    v->wi = *wi;
    vertices_evaluate(v);
}

/* f cos of what the paths have done at their second vertices, and the light that it brought. */
static void evaluate_paths(path_batch *batch)
{
    gradient_list *g = &batch->gradients;
    vertex_list *v = &batch->vertex_lists[1];
    g->onward = v->wi;
    for (uint32_t k = 0; k < v->n; k++) {
        const uint32_t slot = v->slot[k];
        v->light.pdf[k] = g->density[MARGIN + slot] > 0; /* else f is not asked for */
        copy3(&g->near_light, k, &g->near, slot);
        copy3(&g->far_light, k, &batch->radiance, slot);
    }
    evaluate_seconds(v, &g->to_light);
    g->near_f = v->f;
    evaluate_seconds(v, &g->onward);
    g->far_f = v->f;
}

/* Which pixels have one a step before: 1, -1, width or -width, in slots; a single column has none. */
static void find_neighbours(sight_list *to, uint32_t width, uint32_t height, int step)
{
    const int n = (int)(width*height), rows = step == 1 || step == -1 ? 0 : step;
    to->step = step;
    for (int i = 0; i < (int)ROOM; i++) to->is_beside[i] = i >= rows && i < n + rows && i < n;
    if (rows) return;
    for (int i = step > 0 ? 0 : (int)width - 1; i < n; i += (int)width) to->is_beside[i] = 0;
}

/* What the pixels a step on see of the paths' light. */
static void look_back(path_batch *batch, int step)
{
    const render_loops *loops = render_loops_chosen();
    gradient_list *g = &batch->gradients;
    vertex_list *v = &batch->vertex_lists[1];
    loops->look_back(v, &batch->vertex_lists[0], step);
    memset(&g->own_light, 0, sizeof g->own_light);
    memset(&g->seen_light, 0, sizeof g->seen_light);
    evaluate_seconds(v, &g->to_light);
    loops->contrast(v, &g->near_f, &g->near_light, g);
    evaluate_seconds(v, &g->onward);
    loops->contrast(v, &g->far_f, &g->far_light, g);
    for (uint32_t k = 0; k < v->n; k++) { /* where nothing is shared, nobody asks for it */
        const uint32_t slot = v->slot[k];
        set_framed(&g->own, slot, get3(&g->own_light, k));
        set_framed(&g->seen, slot, get3(&g->seen_light, k));
    }
}

/* What the second vertices of the pixels a step before are worth. */
static void reach_seconds(path_batch *batch, sight_list *to)
{
    const render_loops *loops = render_loops_chosen();
    vertex_list *v = &batch->vertex_lists[0];
    look_back(batch, to->step);
    loops->reach(v, &batch->gradients, to);
    loops->aim(v, false);
    vertices_connect(v, false, to);
    loops->rate_seconds(v, &batch->gradients, to);
}

/* What the lamps of the pixels a step before are worth, by the same numbers. */
static void reach_lamps(path_batch *batch, const path_context *c, sight_list *to)
{
    const render_loops *loops = render_loops_chosen();
    vertex_list *v = &batch->vertex_lists[0];
    loops->take_lamps(v, &batch->gradients, to);
    light_set_rate(c->lights, v->n, receivers_of(&v->position, &v->receiver), choices_of(&v->light));
    vertices_aim(v, c);
    vertices_connect(v, c->settings->strategy == STRATEGY_MIS, to);
    loops->rate_lamps(v, &batch->gradients, to);
}

/* Looks at those, and hands on what they are worth. */
static void share_light(path_batch *batch, const path_context *c, bool is_of_lamps, path_counts *counts)
{
    const uint32_t n = batch->vertex_lists[0].n;
    sights_trace(batch, c, NEIGHBOURS, n, counts);
    for (int i = 0; i < NEIGHBOURS; i++)
        render_loops_chosen()->give(&batch->gradients, n, &batch->sights[i], is_of_lamps);
}

void gradient_solve(path_batch *batch, const path_context *c, tile where, path_counts *counts)
{
    gradient_list *g = &batch->gradients;
    const uint32_t width = where.x1 - where.x0, height = where.y1 - where.y0;
    const render_loops *loops = render_loops_chosen();
    const bool has_seconds = loops->drop_dark(g, &batch->radiance);
    if (has_seconds || g->has_lamps) {
        if (has_seconds) evaluate_paths(batch);
        memset(g->given, 0, sizeof g->given);
        loops->liken(g, width, height);
        const int steps[NEIGHBOURS] = {1, -1, (int)width, -(int)width};
        for (int i = 0; i < NEIGHBOURS; i++) find_neighbours(&batch->sights[i], width, height, steps[i]);
        if (has_seconds) {
            for (int i = 0; i < NEIGHBOURS; i++) reach_seconds(batch, &batch->sights[i]);
            share_light(batch, c, false, counts);
        }
        if (g->has_lamps) {
            for (int i = 0; i < NEIGHBOURS; i++) reach_lamps(batch, c, &batch->sights[i]);
            share_light(batch, c, true, counts);
        }
        loops->fit(g, width, height, &batch->radiance);
    }
    loops->gather(g, &batch->radiance);
}
