/* light_points.c: choosing a light, a point on it, and the densities of both.
 *
 * [shirley96] Shirley, Wang and Zimmerman, Monte Carlo techniques for direct lighting calculations, 1996
 *             (points on triangles; cones around spheres).
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "render/light_set.h"
#include "render/loops.h"
#include "render/sampler.h"

bool light_set_is_empty(const light_set *set)
{
    return set->n_emitters == 0;
}

bool light_set_needs_receivers(const light_set *set)
{
    return set->needs_receivers;
}

const sky *light_set_sky(const light_set *set)
{
    return &set->sky;
}

/* A point of a triangle whose emission has a texture. */
static light_sample sample_uneven_triangle(const light_set *set, const emitter *e, real3 from, float u, float v)
{
    const real2 weights = light_triangle_weights(u, v);
    const light_triangle_point point = light_triangle_sample(e->triangle, from, weights);
    const mesh *m = &set->scene->meshes[set->scene->instances[e->instance].mesh];
    return (light_sample){.direction = point.direction,
                          .target = point.target,
                          .pdf = point.pdf,
                          .radiance = surface_emission(set->scene, m, e->primitive, weights.x, weights.y)};
}

/* 1 - cos of the half angle under which a sphere is seen, from sin^2; exact for far spheres. */
static float one_minus_cos(float sin2)
{
    return sin2/(1 + ksqrt(kmax(1 - sin2, 0)));
}

/* The density over the cone of directions to a sphere; 0 from inside and from its surface, where rounding alone
 * would decide which side a point lies on. */
static float cone_pdf(const sphere *sp, real3 from)
{
    const real3 axis = sub3(vector_of(sp->center), from);
    const float d2 = dot3(axis, axis);
    const float clear = sp->radius + 1e-5f*kmax(sp->radius, max_abs3(vector_of(sp->center)));
    return d2 > clear*clear ? 1/(TWO_PI*one_minus_cos(sp->radius*sp->radius/d2)) : 0;
}

/* From outside: a direction uniform in the cone around the sphere, [shirley96].  Elsewhere: a uniform point. */
static light_sample sample_sphere(const light_set *set, const emitter *e, real3 from, float u, float v)
{
    const sphere *sp = &set->scene->spheres[e->primitive];
    const real3 center = vector_of(sp->center), axis = sub3(center, from);
    const real2 azimuth = kcossin_turn(v);
    const float pdf = cone_pdf(sp, from);
    light_sample s = {.radiance = vector_of(set->scene->materials[sp->material].emission)};
    real3 outward;
    bool is_front = true;
    if (pdf > 0) {
        const float d2 = dot3(axis, axis), d = ksqrt(d2);
        const float drop = u*one_minus_cos(sp->radius*sp->radius/d2); /* 1 - cos */
        const float sin2 = drop*(2 - drop);
        const frame cone = frame_around(scale3(1/d, axis), splat3(0), 1);
        const float sin = ksqrt(sin2);
        s.direction = to_world(&cone, make3(sin*azimuth.x, sin*azimuth.y, 1 - drop));
        /* The nearer intersection: sin of the angle at the centre from the law of sines. */
        const float along = d*(1 - drop) - ksqrt(kmax(sp->radius*sp->radius - d2*sin2, 0));
        outward = normalize3(sub3(madd3(from, along, s.direction), center));
        s.pdf = pdf;
    } else {
        const float z = 1 - 2*u, sin = ksqrt(kmax(1 - z*z, 0));
        outward = make3(sin*azimuth.x, sin*azimuth.y, z);
        const real3 to_point = sub3(madd3(center, sp->radius, outward), from);
        s.direction = normalize3(to_point);
        s.pdf = area_pdf(to_point, outward, FOUR_PI*sp->radius*sp->radius);
        is_front = dot3(to_point, outward) < 0;
        if (!is_front && !e->is_double_sided) return (light_sample){.pdf = 0};
    }
    s.target = madd3(center, is_front ? sp->radius + e->offset : sp->radius - e->offset, outward);
    return s;
}

/* [khr-lights] KHR_lights_punctual: inverse square law; a spot falls off as the square of a linear ramp in the cosine
 * between its cones. */
static light_sample sample_punctual(const light_set *set, const emitter *e, real3 from)
{
    const punctual_light *light = &set->scene->lights[e->primitive];
    light_sample s = {.is_delta = true, .pdf = 1, .radiance = vector_of(light->intensity)};
    if (light->kind == LIGHT_DIRECTIONAL) {
        s.is_infinite = true;
        s.direction = neg3(vector_of(light->direction));
        return s;
    }
    s.target = vector_of(light->position);
    const real3 to_light = sub3(s.target, from);
    const float d2 = dot3(to_light, to_light);
    if (!(d2 > 0)) return (light_sample){.pdf = 0};
    s.direction = normalize3(to_light);
    float falloff = 1/d2;
    if (light->kind == LIGHT_SPOT) {
        const float cos = -dot3(s.direction, vector_of(light->direction));
        const float width = kmax(light->cos_inner - light->cos_outer, 1e-4f);
        const float ramp = kmin(kmax((cos - light->cos_outer)/width, 0), 1);
        falloff *= ramp*ramp;
    }
    s.radiance = scale3(falloff, s.radiance);
    return s;
}

/* About what is taken up of an emitter's light at a point: what it is chosen by.  0 only where that is nothing. */
static float importance(const light_set *set, const emitter *e, const light_receiver *to)
{
    switch (e->kind) {
    case EMITTER_TRIANGLE: return light_triangle_importance(e->triangle, *to);
    case EMITTER_SPHERE: {
        const sphere *sp = &set->scene->spheres[e->primitive];
        const real3 away = sub3(to->position, vector_of(sp->center));
        const float r2 = sp->radius*sp->radius, d2 = kmax(dot3(away, away), REAL_MIN);
        return e->strength*PI*r2/kmax(d2, r2)*light_received(*to, away, ksqrt(d2), sp->radius);
    }
    case EMITTER_PUNCTUAL: {
        const punctual_light *light = &set->scene->lights[e->primitive];
        if (light->kind == LIGHT_DIRECTIONAL)
            return e->strength*light_received(*to, vector_of(light->direction), 1, 0);
        const real3 away = sub3(to->position, vector_of(light->position));
        const float d2 = kmax(dot3(away, away), 1e-12f);
        return e->strength/d2*light_received(*to, away, ksqrt(d2), 0);
    }
    case EMITTER_SKY: break;
    }
    return e->strength*light_received_of_all(*to);
}

/* The 32 digits of a fraction. */
static uint32_t digits_of(double fraction)
{
    return fraction*0x1p32 < 0x1p32 - 1 ? (uint32_t)(fraction*0x1p32) : UINT32_MAX;
}

/* Draws an index with probability weights[i]/sum, where sum > 0 is that of the weights in their order, by *u in [0,1),
 * of which it leaves the rest. */
static uint32_t draw_weighted(const float *weights, uint32_t n, float sum, double *u)
{
    double left = *u*(double)sum;
    uint32_t index = 0, last = 0;
    for (; index < n; left -= (double)weights[index++]) {
        if (weights[index] > 0) last = index;
        if (left < (double)weights[index]) break;
    }
    if (index == n) { /* rounding at the upper end */
        index = last;
        left = 0;
    }
    const double rest = left/(double)weights[index];
    *u = rest < 1 ? rest : 0;
    return index;
}

/* About what is taken up of the light of those that are equally far from all points. */
static float weight_of_distant(const light_set *set, const light_receiver *to)
{
    return set->distant_weight*INV_PI*light_received_of_all(*to);
}

/* The probability that one of many emitters is chosen among those with a place. */
static float share_of_placed(const light_set *set, const light_receiver *to)
{
    if (!(set->distant_weight > 0)) return 1;
    const float placed = light_tree_weight(&set->placed, to);
    return placed/(placed + weight_of_distant(set, to));
}

/* One of those that are equally far from all points. */
static uint32_t choose_distant(const light_set *set, double *u, float *probability)
{
    uint32_t rest;
    const uint32_t index = alias_table_draw(&set->distant, digits_of(*u), &rest);
    *u = (double)rest*0x1p-32;
    *probability = set->distant.cells[index].probability;
    return set->n_placed + index;
}

static light_choices choices_from(light_choices c, size_t first)
{
    return (light_choices){c.which + first, c.probability + first, c.rest + first};
}

/* choose_emitter by the tree, for a block of points. */
static void choose_of_many(const light_set *set, size_t n, light_receivers to, light_choices c)
{
    float distant[LOOP_LANES] = {0};
    for (size_t i = 0; i < n && set->distant_weight > 0; i++) {
        const light_receiver at = receiver_at(to, i);
        distant[i] = weight_of_distant(set, &at);
    }
    render_loops_chosen()->walk_light_tree(&set->placed, n, to, distant, c);
    for (size_t i = 0; i < n; i++) {
        float of_distant = 1;
        if (c.which[i] == LIGHT_DISTANT) c.which[i] = choose_distant(set, &c.rest[i], &of_distant);
        c.probability[i] *= of_distant;
    }
}

/* Chooses one of few emitters for a point by *u in [0,1), of which it leaves the rest; *probability of it: 0: none. */
static uint32_t choose_emitter(const light_set *set, light_receiver *to, double *u, float *probability)
{
    float weights[MOST_WEIGHED], sum = 0;
    for (uint32_t i = 0; i < set->n_emitters; i++) sum += weights[i] = importance(set, &set->emitters[i], to);
    to->weight = sum;
    *probability = 0;
    if (!(sum > 0 && sum < INFINITY)) return 0;
    const uint32_t index = draw_weighted(weights, set->n_emitters, sum, u);
    *probability = weights[index]/sum;
    return index;
}

/* The probability with which choose_emitter chooses this one. */
static float choice_probability(const light_set *set, const light_receiver *to, size_t index)
{
    if (set->n_emitters > MOST_WEIGHED) {
        const float share = share_of_placed(set, to);
        if (index >= set->n_placed) return (1 - share)*set->distant.cells[index - set->n_placed].probability;
        return (float)((double)share*light_tree_probability(&set->placed, to, (uint32_t)index));
    }
    const light_receiver at = set->needs_receivers ? *to : receiver_anywhere(to->position);
    float sum = to->weight;
    for (uint32_t i = 0; i < set->n_emitters && !(to->weight > 0); i++) sum += importance(set, &set->emitters[i], &at);
    return sum > 0 && sum < INFINITY ? importance(set, &set->emitters[index], &at)/sum : 0;
}

/* Not an even triangle; texel: of the sky. */
static light_sample sample_other(const light_set *set, const emitter *e, real3 from, uint32_t texel, float v, float w)
{
    switch (e->kind) {
    case EMITTER_TRIANGLE: return sample_uneven_triangle(set, e, from, v, w);
    case EMITTER_SPHERE: return sample_sphere(set, e, from, v, w);
    case EMITTER_PUNCTUAL: return sample_punctual(set, e, from);
    case EMITTER_SKY: break;
    }
    light_sample s = {.is_infinite = true};
    s.direction = sky_sample(&set->sky, texel, v, w, &s.pdf);
    s.radiance = sky_radiance(&set->sky, s.direction);
    return s;
}

static void set_sample(light_samples s, size_t i, const light_sample *light)
{
    const vectors to[3] = {s.direction, s.target, s.radiance};
    const real3 from[3] = {light->direction, light->target, light->radiance};
    for (int k = 0; k < 3; k++) {
        to[k].x[i] = from[k].x;
        to[k].y[i] = from[k].y;
        to[k].z[i] = from[k].z;
    }
    s.pdf[i] = light->pdf;
    s.is_infinite[i] = light->is_infinite;
    s.is_delta[i] = light->is_delta;
}

/* The sky's texel of those that have chosen the sky, by what is left of the numbers that chose. */
static void draw_texels(const light_set *set, size_t n, const uint32_t *which, const double *choice, uint32_t *texels)
{
    for (size_t i = 0; i < n; i++)
        if (which[i] == set->sky_emitter) sky_expect_draw(&set->sky, digits_of(choice[i]));
    for (size_t i = 0; i < n; i++) {
        texels[i] = 0;
        if (which[i] != set->sky_emitter) continue;
        texels[i] = sky_draw_texel(&set->sky, digits_of(choice[i]));
        sky_expect_sample(&set->sky, texels[i]);
    }
}

/* What lights are chosen by at a point of a block. */
static light_receiver block_receiver(const light_set *set, light_receivers to, size_t i)
{
    light_receiver at = set->needs_receivers ? receiver_at(to, i) : receiver_anywhere(position_at(to, i));
    at.weight = to.weight[i];
    return at;
}

/* One of few for each point of a block. */
static void choose_of_few(const light_set *set, size_t n, light_receivers to, light_choices c)
{
    if (set->is_few_triangles) {
        render_loops_chosen()->choose_light(set->n_triangles, set->triangles, set->sky_strength, n, to,
                                            set->needs_receivers, c);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        light_receiver at = block_receiver(set, to, i);
        c.which[i] = choose_emitter(set, &at, &c.rest[i], &c.probability[i]);
        to.weight[i] = at.weight;
    }
}

void light_set_choose(const light_set *set, size_t n, light_receivers to, uint32_t *const u[3], light_choices c)
{
    for (size_t first = 0; first < n; first += LOOP_LANES) {
        const size_t some = n - first < LOOP_LANES ? n - first : LOOP_LANES;
        const light_receivers at = receivers_from(to, first);
        const light_choices block = choices_from(c, first);
        /* Choosing among many takes more digits than u[0] has, and the sky's texel what is left of them. */
        for (size_t i = 0; i < LOOP_LANES; i++) {
            const size_t k = first + i;
            const uint32_t more = set->is_plain ? 0 : hash_pair(u[0][k], u[1][k] ^ u[2][k]);
            block.rest[i] = (double)u[0][k]*0x1p-32 + (double)more*0x1p-64;
        }
        if (set->n_emitters > MOST_WEIGHED) choose_of_many(set, some, at, block);
        else choose_of_few(set, some, at, block);
    }
}

/* light_set_rate among many. */
static void rate_of_many(const light_set *set, size_t n, light_receivers to, light_choices c)
{
    render_loops_chosen()->rate_light_tree(&set->placed, set->n_placed, n, to, c);
    for (size_t i = 0; i < n && set->distant_weight > 0; i++) {
        if (!(c.probability[i] > 0)) continue;
        const light_receiver at = receiver_at(to, i);
        const float share = share_of_placed(set, &at);
        if (c.which[i] < set->n_placed) c.probability[i] *= share;
        else c.probability[i] = (1 - share)*set->distant.cells[c.which[i] - set->n_placed].probability;
    }
}

void light_set_rate(const light_set *set, size_t n, light_receivers to, light_choices c)
{
    if (set->is_few_triangles) {
        render_loops_chosen()->rate_light(set->n_triangles, set->triangles, set->sky_strength, n, to,
                                          set->needs_receivers, c);
        return;
    }
    if (set->n_emitters > MOST_WEIGHED) {
        rate_of_many(set, n, to, c);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        if (!(c.probability[i] > 0)) continue;
        const light_receiver at = block_receiver(set, to, i);
        c.probability[i] = choice_probability(set, &at, c.which[i]);
    }
}

bool light_set_rates_exactly(const light_set *set)
{
    return set->n_emitters <= MOST_WEIGHED;
}

/* A block of no more than LOOP_LANES points. */
static void place_block(const light_set *set, size_t n, vectors from, light_choices c, uint32_t *const u[3],
                        light_samples s)
{
    static const light_triangle dark = {.area = 0};
    const light_triangle *chosen[LOOP_LANES];
    float probability[LOOP_LANES] = {0};
    uint32_t texels[LOOP_LANES];
    for (size_t i = 0; i < LOOP_LANES; i++) {
        const bool is_even = i < n && c.probability[i] > 0 && set->emitters[c.which[i]].is_even;
        chosen[i] = is_even ? &set->emitters[c.which[i]].triangle : &dark;
        if (i < n) probability[i] = c.probability[i];
    }
    draw_texels(set, n, c.which, c.rest, texels);
    render_loops_chosen()->light_any(chosen, probability, n, from, u, s);
    for (size_t i = 0; i < n; i++) {
        if (chosen[i] != &dark || !(probability[i] > 0)) continue;
        light_sample light = sample_other(set, &set->emitters[c.which[i]], make3(from.x[i], from.y[i], from.z[i]),
                                          texels[i], fraction(u[1][i]), fraction(u[2][i]));
        light.pdf *= probability[i];
        set_sample(s, i, &light);
    }
}

void light_set_points(const light_set *set, size_t n, vectors from, light_choices chosen, uint32_t *const u[3],
                      light_samples s)
{
    if (set->is_plain) {
        render_loops_chosen()->light(set->n_triangles, set->triangles, n, from, chosen, u, s);
        return;
    }
    for (size_t first = 0; first < n; first += LOOP_LANES) {
        const size_t some = n - first < LOOP_LANES ? n - first : LOOP_LANES;
        uint32_t *const numbers[3] = {u[0] + first, u[1] + first, u[2] + first};
        const light_samples samples = {.direction = vectors_from(s.direction, first),
                                       .target = vectors_from(s.target, first),
                                       .radiance = vectors_from(s.radiance, first),
                                       .pdf = s.pdf + first,
                                       .is_infinite = s.is_infinite + first,
                                       .is_delta = s.is_delta + first};
        place_block(set, some, vectors_from(from, first), choices_from(chosen, first), numbers, samples);
    }
}

light_sample light_set_sample(const light_set *set, const light_receiver *to, const uint32_t u[3])
{
    float at[14][LOOP_LANES], found[10][LOOP_LANES], probability[LOOP_LANES];
    uint32_t room[3][LOOP_LANES], which[LOOP_LANES], is_infinite[LOOP_LANES], is_delta[LOOP_LANES];
    double rest[LOOP_LANES];
    uint32_t *const numbers[3] = {room[0], room[1], room[2]};
    for (int i = 0; i < LOOP_LANES; i++) {
        const real3 given[3] = {to->position, to->normal, to->mirror};
        for (int k = 0; k < 3; k++) {
            at[3*k][i] = given[k].x;
            at[3*k + 1][i] = given[k].y;
            at[3*k + 2][i] = given[k].z;
        }
        at[9][i] = to->around;
        at[10][i] = to->broad;
        at[11][i] = to->peak;
        at[12][i] = to->width;
        at[13][i] = to->weight;
        for (int k = 0; k < 3; k++) room[k][i] = u[k];
    }
    const light_receivers receivers = {
        {at[0], at[1], at[2]}, {at[3], at[4], at[5]}, {at[6], at[7], at[8]}, at[9], at[10], at[11], at[12], at[13]};
    const light_choices choice = {which, probability, rest};
    light_set_choose(set, 1, receivers, numbers, choice);
    light_set_points(set, 1, receivers.position, choice, numbers,
                     (light_samples){.direction = {found[0], found[1], found[2]},
                                     .target = {found[3], found[4], found[5]},
                                     .radiance = {found[6], found[7], found[8]},
                                     .pdf = found[9],
                                     .is_infinite = is_infinite,
                                     .is_delta = is_delta});
    return (light_sample){.direction = make3(found[0][0], found[1][0], found[2][0]),
                          .target = make3(found[3][0], found[4][0], found[5][0]),
                          .radiance = make3(found[6][0], found[7][0], found[8][0]),
                          .pdf = found[9][0],
                          .is_infinite = is_infinite[0],
                          .is_delta = is_delta[0]};
}

float light_set_pdf_of_hit(const light_set *set, const light_receiver *to, const hit *h, const surface *at)
{
    const real3 from = to->position;
    if (h->instance < set->scene->n_instances) {
        const size_t first = set->first_of_instance[h->instance];
        if (first == NONE) return 0;
        const emitter *e = &set->emitters[first + h->primitive];
        const float pdf = area_pdf(sub3(at->position, from), e->triangle.normal, e->triangle.area);
        return pdf > 0 ? pdf*choice_probability(set, to, first + h->primitive) : 0;
    }
    const size_t index = set->of_sphere[h->primitive];
    if (index == NONE) return 0;
    const sphere *sp = &set->scene->spheres[h->primitive];
    const float cone = cone_pdf(sp, from);
    const float pdf = cone > 0 ? cone
                               : area_pdf(sub3(at->position, from), at->normal, FOUR_PI*sp->radius*sp->radius);
    return pdf*choice_probability(set, to, index);
}

float light_set_pdf_of_sky(const light_set *set, const light_receiver *to, real2 place)
{
    if (set->sky_emitter == NONE) return 0;
    return choice_probability(set, to, set->sky_emitter)*sky_pdf(&set->sky, place);
}
