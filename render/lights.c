/* lights.c: collecting what emits: triangles and spheres, punctual lights, and the sky.
 * SPDX-License-Identifier: MIT */
#include "render/lights.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"
#include "render/light_set.h"

/* [W/sr]; sums of as many as there may be stay finite. */
#define MOST_INTENSITY 1e28f

/* More than this are refused: 20 GiB of tables, and an index of 32 bits is enough. */
#define MOST_EMITTERS (1u << 26)

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
    added->triangle.strength = added->strength;
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

static float squared_distance(real3 a, real3 b)
{
    const real3 d = sub3(a, b);
    return dot3(d, d);
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
        e.is_double_sided = mat->is_double_sided;
        e.is_even = mat->emissive_texture.texture == NONE;
        light_triangle *t = &e.triangle;
        t->origin = p0;
        t->edge1 = sub3(p1, p0);
        t->edge2 = sub3(p2, p0);
        t->center = scale3((real)0.333333333333333, add3(add3(p0, p1), p2));
        t->radius = ksqrt(kmax(squared_distance(t->center, p0),
                               kmax(squared_distance(t->center, p1), squared_distance(t->center, p2))));
        t->area = 0.5f*length3(cross3(t->edge1, t->edge2));
        t->normal = scale3(sign, normal_of_edges(t->edge1, t->edge2));
        t->lowest = mat->is_double_sided ? -INFINITY : 0;
        t->radiance = vector_of(mat->emission);
        t->offset = RELATIVE_OFFSET*kmax(max_abs3(p0), kmax(max_abs3(p1), max_abs3(p2)));
        if (t->area > 0 && isfinite(t->area)) e.strength = mean_emission(s, m, i);
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
        const light_triangle *t = &e->triangle;
        const real3 p1 = add3(t->origin, t->edge1), p2 = add3(t->origin, t->edge2);
        light.low = min3(t->origin, min3(p1, p2));
        light.high = max3(t->origin, max3(p1, p2));
        light.axis = t->normal;
        intensity *= t->area;
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

/* Few lights, which loops choose from if they are alike. */
static void gather_triangles(light_set *set)
{
    const bool has_sky = set->sky_emitter != NONE;
    set->n_triangles = set->n_emitters - has_sky;
    set->sky_strength = has_sky ? set->emitters[set->sky_emitter].strength : 0;
    set->is_few_triangles = !has_sky || set->sky_emitter == set->n_triangles;
    set->is_plain = !has_sky;
    for (uint32_t i = 0; i < set->n_triangles; i++) {
        const emitter *e = &set->emitters[i];
        set->is_few_triangles &= e->kind == EMITTER_TRIANGLE;
        set->is_plain &= e->is_even;
        set->triangles[i] = e->triangle;
    }
    set->is_plain &= set->is_few_triangles;
}

/* The tables by which one of many emitters is chosen. */
static facet_status tabulate(light_set *set)
{
    set->needs_receivers = set->n_emitters > MOST_ALIKE;
    if (set->n_emitters <= MOST_WEIGHED) {
        gather_triangles(set);
        return FACET_OK;
    }
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
