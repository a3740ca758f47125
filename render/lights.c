/* lights.c: emissive triangles and spheres, punctual lights, and the sky.
 *
 * [shirley96] Shirley, Wang and Zimmerman, Monte Carlo techniques for direct lighting calculations, 1996
 *             (points on triangles; cones around spheres).
 * SPDX-License-Identifier: MIT */
#include "render/lights.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"
#include "render/light_tree.h"
#include "render/sampler.h"

typedef enum emitter_kind { EMITTER_TRIANGLE, EMITTER_SPHERE, EMITTER_PUNCTUAL, EMITTER_SKY } emitter_kind;

typedef struct emitter {
    emitter_kind kind;
    uint32_t instance, primitive; /* triangle; primitive alone: sphere or punctual light */
    bool is_double_sided;
    bool is_even;               /* triangle: emits the same radiance everywhere */
    real3 radiance;             /* ... which is this [W/(m^2 sr)] */
    float area;                 /* triangle [m^2] */
    real3 origin, edge1, edge2; /* triangle, world space */
    real3 center;               /* ... of its corners */
    real3 normal;               /* triangle, unit, on the front side */
    float offset;               /* how far shadow rays stop from the surface [m] */
    float strength;             /* mean radiance, or intensity, or irradiance of a directional light (luminances) */
} emitter;

/* Up to this many emitters are weighed one by one for each point that is lit; a tree leads to one of more. */
#define MOST_WEIGHED 32

/* [W/sr]; sums of as many as there may be stay finite. */
#define MOST_INTENSITY 1e28f

/* More than this are refused: 20 GiB of tables, and an index of 32 bits is enough. */
#define MOST_EMITTERS (1u << 26)

struct light_set {
    const scene *scene;
    sky sky;
    emitter *emitters;
    uint32_t n_emitters, capacity;
    uint32_t n_placed;   /* these come first; the rest are equally far from all points */
    light_tree placed;   /* for more than MOST_WEIGHED */
    alias_table distant; /* likewise, over the rest, if there are any */
    float distant_weight;
    size_t *first_of_instance; /* [n_instances] index of the emitter of triangle 0, or NONE */
    size_t *of_sphere;         /* [n_spheres] emitter or NONE */
    size_t sky_emitter;        /* or NONE */
};

static facet_status add_emitter(light_set *set, const emitter *e)
{
    if (set->n_emitters == MOST_EMITTERS) return FACET_UNSUPPORTED;
    if (set->n_emitters == set->capacity) {
        const uint32_t capacity = set->capacity ? 2*set->capacity : 16;
        emitter *larger = realloc(set->emitters, capacity*sizeof *larger);
        if (!larger) return FACET_NO_MEMORY;
        set->emitters = larger;
        set->capacity = capacity;
    }
    emitter *added = &set->emitters[set->n_emitters++];
    *added = *e;
    if (!(isfinite(e->strength) && e->strength > 0)) added->strength = 0;
    return FACET_OK;
}

/* The triangle's mean emitted luminance, from ten points of it; a texture that is black there but perhaps not
 * everywhere keeps a hundredth of the factor. */
static float mean_emission(const scene *s, const mesh *m, uint32_t triangle)
{
    const material *mat = &s->materials[m->material];
    const float full = luminance(vector_of(mat->emission));
    if (mat->emissive_texture.texture == NONE) return full;
    float sum = 0;
    enum { STEPS = 4 };
    const float third = (float)(1.0/3);
    for (int i = 0; i < STEPS; i++)
        for (int j = 0; i + j < STEPS; j++)
            sum += luminance(
                surface_emission(s, m, triangle, ((float)i + third)/(float)STEPS, ((float)j + third)/(float)STEPS));
    return 0.01f*full + sum/10;
}

static facet_status add_instance(light_set *set, size_t index)
{
    const scene *s = set->scene;
    const instance *in = &s->instances[index];
    const mesh *m = &s->meshes[in->mesh];
    const material *mat = &s->materials[m->material];
    set->first_of_instance[index] = NONE;
    if (mat->kind == SURFACE_UNLIT || !(max_of3(vector_of(mat->emission)) > 0)) return FACET_OK;
    set->first_of_instance[index] = set->n_emitters;
    const float sign = map_determinant(in->to_world) < 0 ? -1.0f : 1.0f;
    for (uint32_t i = 0; i < m->n_triangles; i++) {
        const real3 p0 = map_point(in->to_world, vector_of(m->positions[m->triangles[i][0]]));
        const real3 p1 = map_point(in->to_world, vector_of(m->positions[m->triangles[i][1]]));
        const real3 p2 = map_point(in->to_world, vector_of(m->positions[m->triangles[i][2]]));
        emitter e = {.kind = EMITTER_TRIANGLE, .instance = (uint32_t)index, .primitive = i};
        e.origin = p0;
        e.edge1 = sub3(p1, p0);
        e.edge2 = sub3(p2, p0);
        e.center = scale3((real)0.333333333333333, add3(add3(p0, p1), p2));
        e.area = 0.5f*length3(cross3(e.edge1, e.edge2));
        e.normal = scale3(sign, normal_of_edges(e.edge1, e.edge2));
        e.is_double_sided = mat->is_double_sided;
        e.is_even = mat->emissive_texture.texture == NONE;
        e.radiance = vector_of(mat->emission);
        e.offset = RELATIVE_OFFSET*kmax(max_abs3(p0), kmax(max_abs3(p1), max_abs3(p2)));
        if (e.area > 0 && isfinite(e.area)) e.strength = mean_emission(s, m, i);
        const facet_status status = add_emitter(set, &e);
        if (status) return status;
    }
    return FACET_OK;
}

static facet_status add_sphere(light_set *set, size_t index)
{
    const sphere *sp = &set->scene->spheres[index];
    const material *mat = &set->scene->materials[sp->material];
    set->of_sphere[index] = NONE;
    const float L = luminance(vector_of(mat->emission));
    if (mat->kind == SURFACE_UNLIT || !(L > 0)) return FACET_OK;
    set->of_sphere[index] = set->n_emitters;
    const emitter e = {.kind = EMITTER_SPHERE,
                       .primitive = (uint32_t)index,
                       .is_double_sided = mat->is_double_sided,
                       .offset = RELATIVE_OFFSET*kmax(max_abs3(vector_of(sp->center)), sp->radius),
                       .strength = L};
    return add_emitter(set, &e);
}

static facet_status add_punctual(light_set *set, size_t index)
{
    const float intensity = luminance(vector_of(set->scene->lights[index].intensity));
    const emitter e = {.kind = EMITTER_PUNCTUAL, .primitive = (uint32_t)index, .strength = intensity};
    return add_emitter(set, &e);
}

static facet_status collect(light_set *set)
{
    const scene *s = set->scene;
    facet_status status = FACET_OK;
    for (size_t i = 0; i < s->n_instances && !status; i++) status = add_instance(set, i);
    for (size_t i = 0; i < s->n_spheres && !status; i++) status = add_sphere(set, i);
    for (size_t i = 0; i < s->n_lights && !status; i++)
        if (s->lights[i].kind != LIGHT_DIRECTIONAL) status = add_punctual(set, i);
    set->n_placed = set->n_emitters;
    for (size_t i = 0; i < s->n_lights && !status; i++)
        if (s->lights[i].kind == LIGHT_DIRECTIONAL) status = add_punctual(set, i);
    set->sky_emitter = NONE;
    if (!status && set->sky.mean > 0) {
        set->sky_emitter = set->n_emitters;
        const emitter e = {.kind = EMITTER_SKY, .strength = (float)set->sky.mean};
        status = add_emitter(set, &e);
    }
    return status;
}

/* What the tree of lights needs of an emitter. */
static placed_light placed_light_of(const scene *s, const emitter *e)
{
    placed_light light = {.is_double_sided = e->is_double_sided};
    float intensity = e->strength;
    if (e->kind == EMITTER_TRIANGLE) {
        const real3 p1 = add3(e->origin, e->edge1), p2 = add3(e->origin, e->edge2);
        light.low = min3(e->origin, min3(p1, p2));
        light.high = max3(e->origin, max3(p1, p2));
        light.axis = e->normal;
        intensity *= e->area;
    } else if (e->kind == EMITTER_SPHERE) {
        const sphere *sp = &s->spheres[e->primitive];
        light.low = sub3(vector_of(sp->center), splat3(sp->radius));
        light.high = add3(vector_of(sp->center), splat3(sp->radius));
        intensity *= PI*sp->radius*sp->radius;
    } else {
        const punctual_light *punctual = &s->lights[e->primitive];
        light.low = light.high = vector_of(punctual->position);
        if (punctual->kind == LIGHT_SPOT) {
            light.axis = vector_of(punctual->direction);
            light.cos_spread = punctual->cos_outer;
        }
    }
    light.intensity = e->strength > 0 ? kmin(kmax(intensity, REAL_MIN), MOST_INTENSITY) : 0;
    return light;
}

/* About the irradiance that a distant emitter brings. */
static float distant_importance(const emitter *e)
{
    return e->kind == EMITTER_SKY ? e->strength*PI : e->strength;
}

/* The tables by which one of many emitters is chosen. */
static facet_status tabulate(light_set *set)
{
    if (set->n_emitters <= MOST_WEIGHED) return FACET_OK;
    const uint32_t n_distant = set->n_emitters - set->n_placed;
    placed_light *lights = malloc((set->n_placed + 1)*sizeof *lights);
    double *weights = malloc((n_distant + 1)*sizeof *weights);
    facet_status status = lights && weights ? FACET_OK : FACET_NO_MEMORY;
    if (status) goto done;
    for (uint32_t i = 0; i < set->n_placed; i++) lights[i] = placed_light_of(set->scene, &set->emitters[i]);
    for (uint32_t i = 0; i < n_distant; i++) {
        const float weight = distant_importance(&set->emitters[set->n_placed + i]);
        weights[i] = (double)weight;
        set->distant_weight += weight;
    }
    status = light_tree_create(lights, set->n_placed, &set->placed);
    if (!status && n_distant > 0) status = alias_table_create(weights, n_distant, &set->distant);
done:
    free(weights);
    free(lights);
    return status;
}

facet_status light_set_create(const scene *s, bool has_scattered, light_set **result, facet_error *why)
{
    light_set *set = calloc(1, sizeof *set);
    if (!set) return facet_error_set(why, FACET_NO_MEMORY, "lights", "no memory for the light tables");
    set->scene = s;
    set->first_of_instance = malloc((s->n_instances + 1)*sizeof *set->first_of_instance);
    set->of_sphere = malloc((s->n_spheres + 1)*sizeof *set->of_sphere);
    facet_status status = sky_create(&s->environment, has_scattered, &set->sky, why);
    if (status == FACET_OK) {
        status = set->first_of_instance && set->of_sphere ? collect(set) : FACET_NO_MEMORY;
        if (status == FACET_OK) status = tabulate(set);
        if (status == FACET_UNSUPPORTED)
            facet_error_set(why, status, "lights", "more than %u emitting triangles; let fewer emit", MOST_EMITTERS);
        else if (status) facet_error_set(why, status, "lights", "no memory for the light tables");
    }
    if (status) {
        light_set_destroy(set);
        return status;
    }
    *result = set;
    return FACET_OK;
}

void light_set_destroy(light_set *set)
{
    if (!set) return;
    sky_destroy(&set->sky);
    light_tree_destroy(&set->placed);
    alias_table_destroy(&set->distant);
    free(set->emitters);
    free(set->first_of_instance);
    free(set->of_sphere);
    free(set);
}

bool light_set_is_empty(const light_set *set)
{
    return set->n_emitters == 0;
}

const sky *light_set_sky(const light_set *set)
{
    return &set->sky;
}

/* Density of a direction to a point of an area sampled uniformly: d^2/(|cos| area). */
static float area_pdf(real3 to_point, real3 normal, float area)
{
    const float d2 = dot3(to_point, to_point);
    const float cos = kabs(dot3(to_point, normal))/ksqrt(kmax(d2, REAL_MIN));
    return cos > 0 && area > 0 ? d2/(cos*area) : 0;
}

/* A uniform point: [shirley96], the square folded onto the triangle by a square root. */
static light_sample sample_triangle(const light_set *set, const emitter *e, real3 from, float u, float v)
{
    const float root = ksqrt(u);
    const float b1 = 1 - root, b2 = v*root;
    const real3 point = add3(e->origin, add3(scale3(b1, e->edge1), scale3(b2, e->edge2)));
    const real3 to_point = sub3(point, from);
    const float facing = -dot3(to_point, e->normal), d2 = dot3(to_point, to_point);
    light_sample s = {.pdf = 0};
    if (!(facing > 0 || e->is_double_sided) || !(d2 > REAL_MIN)) return s;
    const float inverse = 1/ksqrt(d2), cos_area = kabs(facing)*inverse*e->area;
    s.pdf = cos_area > 0 ? d2/cos_area : 0;
    s.direction = scale3(inverse, to_point);
    s.target = madd3(point, facing > 0 ? e->offset : -e->offset, e->normal);
    s.radiance = e->is_even ? e->radiance
                            : surface_emission(set->scene, &set->scene->meshes[set->scene->instances[e->instance].mesh],
                                               e->primitive, b1, b2);
    return s;
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

/* About the irradiance that an emitter brings to a point, whatever the surface there: what it is chosen by.  0 only
 * where it brings none. */
static float importance(const light_set *set, const emitter *e, real3 from)
{
    switch (e->kind) {
    case EMITTER_TRIANGLE: {
        const real3 to_light = sub3(e->center, from);
        const float d2 = kmax(dot3(to_light, to_light), REAL_MIN), height = -dot3(to_light, e->normal);
        if (!(height > 0 || e->is_double_sided)) return 0;
        /* The area in the denominator bounds the weight near the light; a tenth more cosine, its range. */
        const float d = ksqrt(d2);
        return e->strength*e->area*(0.1f*d + kabs(height))/(d*(d2 + e->area));
    }
    case EMITTER_SPHERE: {
        const sphere *sp = &set->scene->spheres[e->primitive];
        const real3 axis = sub3(vector_of(sp->center), from);
        const float r2 = sp->radius*sp->radius;
        return e->strength*PI*r2/kmax(dot3(axis, axis), r2);
    }
    case EMITTER_PUNCTUAL: {
        const punctual_light *light = &set->scene->lights[e->primitive];
        const real3 to_light = sub3(vector_of(light->position), from);
        return light->kind == LIGHT_DIRECTIONAL ? e->strength : e->strength/kmax(dot3(to_light, to_light), 1e-12f);
    }
    case EMITTER_SKY: break;
    }
    return distant_importance(e);
}

/* The 32 digits of a fraction. */
static uint32_t digits_of(double fraction)
{
    return fraction*0x1p32 < 0x1p32 - 1 ? (uint32_t)(fraction*0x1p32) : UINT32_MAX;
}

/* The probability that one of many emitters is chosen among those with a place. */
static float share_of_placed(const light_set *set, real3 from)
{
    if (!(set->distant_weight > 0)) return 1;
    const float irradiance = light_tree_irradiance(&set->placed, from);
    return irradiance/(irradiance + set->distant_weight);
}

static uint32_t choose_of_many(const light_set *set, real3 from, double *u, float *probability)
{
    const float share = share_of_placed(set, from), shares[2] = {share, 1 - share};
    uint32_t index = 0;
    if (draw_weighted(shares, 2, 1, u) == 0) {
        *probability = (float)((double)share*light_tree_draw(&set->placed, from, u, &index));
        return index;
    }
    uint32_t rest;
    index = alias_table_draw(&set->distant, digits_of(*u), &rest);
    *u = (double)rest*0x1p-32;
    *probability = (1 - share)*set->distant.cells[index].probability;
    return set->n_placed + index;
}

/* Chooses an emitter for a point by *u in [0,1), of which it leaves the rest; *probability of it: 0 for none. */
static uint32_t choose_emitter(const light_set *set, real3 from, double *u, float *probability)
{
    if (set->n_emitters > MOST_WEIGHED) return choose_of_many(set, from, u, probability);
    float weights[MOST_WEIGHED], sum = 0;
    for (uint32_t i = 0; i < set->n_emitters; i++) sum += weights[i] = importance(set, &set->emitters[i], from);
    *probability = 0;
    if (!(sum > 0 && sum < INFINITY)) return 0;
    const uint32_t index = draw_weighted(weights, set->n_emitters, sum, u);
    *probability = weights[index]/sum;
    return index;
}

/* The probability with which choose_emitter chooses this one. */
static float choice_probability(const light_set *set, real3 from, size_t index)
{
    if (set->n_emitters > MOST_WEIGHED) {
        const float share = share_of_placed(set, from);
        if (index >= set->n_placed) return (1 - share)*set->distant.cells[index - set->n_placed].probability;
        return (float)((double)share*light_tree_probability(&set->placed, from, (uint32_t)index));
    }
    float sum = 0;
    for (uint32_t i = 0; i < set->n_emitters; i++) sum += importance(set, &set->emitters[i], from);
    return sum > 0 && sum < INFINITY ? importance(set, &set->emitters[index], from)/sum : 0;
}

light_sample light_set_sample(const light_set *set, real3 from, const uint32_t u[3])
{
    light_sample s = {.pdf = 0};
    if (set->n_emitters == 0) return s;
    /* Choosing among many takes more digits than u[0] has, and the sky's texel what is left of them. */
    double choice = (double)u[0]*0x1p-32 + (double)hash_pair(u[0], u[1] ^ u[2])*0x1p-64;
    float probability;
    const uint32_t index = choose_emitter(set, from, &choice, &probability);
    if (!(probability > 0)) return s;
    const emitter *e = &set->emitters[index];
    const float v = fraction(u[1]), w = fraction(u[2]);
    switch (e->kind) {
    case EMITTER_TRIANGLE: s = sample_triangle(set, e, from, v, w); break;
    case EMITTER_SPHERE: s = sample_sphere(set, e, from, v, w); break;
    case EMITTER_PUNCTUAL: s = sample_punctual(set, e, from); break;
    case EMITTER_SKY:
        s.direction = sky_sample(&set->sky, digits_of(choice), v, w, &s.pdf);
        s.radiance = sky_radiance(&set->sky, s.direction);
        s.is_infinite = true;
        break;
    }
    s.pdf *= probability;
    return s;
}

float light_set_pdf_of_hit(const light_set *set, real3 from, const hit *h, const surface *at)
{
    if (h->instance < set->scene->n_instances) {
        const size_t first = set->first_of_instance[h->instance];
        if (first == NONE) return 0;
        const emitter *e = &set->emitters[first + h->primitive];
        const float pdf = area_pdf(sub3(at->position, from), e->normal, e->area);
        return pdf > 0 ? pdf*choice_probability(set, from, first + h->primitive) : 0;
    }
    const size_t index = set->of_sphere[h->primitive];
    if (index == NONE) return 0;
    const sphere *sp = &set->scene->spheres[h->primitive];
    const float cone = cone_pdf(sp, from);
    const float pdf = cone > 0 ? cone
                               : area_pdf(sub3(at->position, from), at->normal, FOUR_PI*sp->radius*sp->radius);
    return pdf*choice_probability(set, from, index);
}

float light_set_pdf_of_sky(const light_set *set, real3 from, real3 direction)
{
    if (set->sky_emitter == NONE) return 0;
    return choice_probability(set, from, set->sky_emitter)*sky_pdf(&set->sky, direction);
}
