/* surface.c: interpolation over triangles and spheres, textures, normal maps, and the material at a point.
 * SPDX-License-Identifier: MIT */
#include "render/surface.h"

#include <math.h>
#include <stdlib.h>

#include "render/expect.h"
#include "render/texture.h"

typedef struct placement {
    float sign;   /* of the determinant */
    float column; /* the largest factor by which a coordinate grows */
    float offset; /* the largest coordinate of its origin */
    const mesh *mesh;
    bool is_plain;     /* surface.h */
    bool is_one_sided; /* not drawn from behind */
} placement;

typedef struct shared_shading {
    bool is_uniform; /* one bsdf for all points, but for vertex colours */
    bool transmits;  /* the bsdf does */
    facet_bsdf bsdf;
} shared_shading;

struct surface_set {
    const scene *scene;
    placement *placements;    /* [n_instances] */
    shared_shading *shadings; /* [n_materials] */
};

static facet_bsdf reflection_of(const material *mat, const float base_color[3], float metallic, float roughness)
{
    const float root_F0 = (mat->ior - 1)/(mat->ior + 1);
    return facet_bsdf_metallic_roughness(base_color, metallic, roughness, root_F0*root_F0, mat->specular,
                                         mat->specular_color);
}

static shared_shading shading_of(const material *mat)
{
    if (mat->kind == SURFACE_BSDF)
        return (shared_shading){true, facet_bsdf_lobes(&mat->bsdf) & FACET_TRANSMISSION, mat->bsdf};
    const bool has_texture = mat->base_color_texture.texture != NONE || mat->metallic_roughness_texture.texture != NONE;
    if (mat->kind != SURFACE_METALLIC_ROUGHNESS || has_texture || mat->transmission > 0)
        return (shared_shading){.transmits = false};
    float base[3];
    for (int k = 0; k < 3; k++) base[k] = kmin(kmax(mat->base_color[k], 0), 1);
    return (shared_shading){.is_uniform = true, .bsdf = reflection_of(mat, base, mat->metallic, mat->roughness)};
}

/* Reflection of glTF's own materials is the same all around the normal, wherever tangents point. */
static bool is_plain(const mesh *m, const material *mat, const shared_shading *shading)
{
    const bool has_tangents = mat->kind == SURFACE_BSDF && (m->tangents || m->uv[0]);
    return shading->is_uniform && mat->normal_texture.texture == NONE && !(max_of3(vector_of(mat->emission)) > 0) &&
           !has_tangents && !m->colors;
}

static placement placement_of(const surface_set *set, const instance *in)
{
    const mesh *m = &set->scene->meshes[in->mesh];
    const material *mat = &set->scene->materials[m->material];
    const real3 x = map_column(in->to_world, 0), y = map_column(in->to_world, 1), z = map_column(in->to_world, 2);
    return (placement){.sign = map_determinant(in->to_world) < 0 ? -1.0f : 1.0f,
                       .column = kmax(max_abs3(x), kmax(max_abs3(y), max_abs3(z))),
                       .offset = max_abs3(map_column(in->to_world, 3)),
                       .mesh = m,
                       .is_plain = is_plain(m, mat, &set->shadings[m->material]),
                       .is_one_sided = !mat->is_double_sided && !(mat->transmission > 0) && mat->kind != SURFACE_BSDF};
}

facet_status surface_set_create(const scene *s, surface_set **result)
{
    surface_set *set = calloc(1, sizeof *set);
    if (!set) return FACET_NO_MEMORY;
    set->scene = s;
    set->placements = malloc((s->n_instances + 1)*sizeof *set->placements);
    set->shadings = calloc(s->n_materials + 1, sizeof *set->shadings);
    if (!set->placements || !set->shadings) {
        surface_set_destroy(set);
        return FACET_NO_MEMORY;
    }
    for (size_t i = 0; i < s->n_materials; i++) set->shadings[i] = shading_of(&s->materials[i]);
    for (size_t i = 0; i < s->n_instances; i++) set->placements[i] = placement_of(set, &s->instances[i]);
    *result = set;
    return FACET_OK;
}

void surface_set_destroy(surface_set *set)
{
    if (!set) return;
    free(set->placements);
    free(set->shadings);
    free(set);
}

void surface_materials(const surface_set *set, uint32_t n, hits h, uint32_t *materials)
{
    const scene *s = set->scene;
    for (uint32_t i = 0; i < n; i++) {
        const uint32_t index = h.instance[i];
        if (index < s->n_instances) materials[i] = (uint32_t)set->placements[index].mesh->material;
        else materials[i] = (uint32_t)(index == NO_HIT ? s->n_materials : s->spheres[h.primitive[i]].material);
    }
}

/* Weights of the three vertices. */
typedef struct weights {
    float w[3];
    const uint32_t *vertex;
} weights;

static weights weights_at(const mesh *m, uint32_t triangle, float u, float v)
{
    return (weights){.w = {1 - u - v, u, v}, .vertex = m->triangles[triangle]};
}

static real3 mix_vertices3(const weights *at, const float (*values)[3])
{
    return add3(
        add3(scale3(at->w[0], vector_of(values[at->vertex[0]])), scale3(at->w[1], vector_of(values[at->vertex[1]]))),
        scale3(at->w[2], vector_of(values[at->vertex[2]])));
}

static float mix_component(const weights *at, const float *values, size_t stride)
{
    return at->w[0]*values[at->vertex[0]*stride] + at->w[1]*values[at->vertex[1]*stride] +
           at->w[2]*values[at->vertex[2]*stride];
}

/* The texture's value where it is used, at a point of the triangle. */
static texel look_up(const scene *s, const mesh *m, const texture_use *use, const weights *at)
{
    const float(*uv)[2] = (const float(*)[2])m->uv[use->uv_set];
    float u = 0, v = 0;
    if (uv) {
        const float u0 = mix_component(at, &uv[0][0], 2), v0 = mix_component(at, &uv[0][1], 2);
        u = use->transform[0][0]*u0 + use->transform[0][1]*v0 + use->transform[0][2];
        v = use->transform[1][0]*u0 + use->transform[1][1]*v0 + use->transform[1][2];
    }
    return texture_lookup(s, &s->textures[use->texture], u, v);
}

static texel base_color_at(const scene *s, const mesh *m, const material *mat, const weights *at)
{
    texel base = {{mat->base_color[0], mat->base_color[1], mat->base_color[2], mat->base_color[3]}};
    if (mat->base_color_texture.texture != NONE) {
        const texel t = look_up(s, m, &mat->base_color_texture, at);
        for (int k = 0; k < 4; k++) base.c[k] *= t.c[k];
    }
    if (m->colors)
        for (int k = 0; k < 4; k++) base.c[k] *= mix_component(at, &m->colors[0][k], 4);
    for (int k = 0; k < 4; k++) base.c[k] = kmin(kmax(base.c[k], 0), 1);
    return base;
}

float surface_opacity(const void *user, uint32_t mesh_index, uint32_t triangle, float u, float v)
{
    const scene *s = user;
    const mesh *m = &s->meshes[mesh_index];
    const material *mat = &s->materials[m->material];
    const weights at = weights_at(m, triangle, u, v);
    const float alpha = base_color_at(s, m, mat, &at).c[3];
    if (mat->alpha == ALPHA_MASK) return alpha >= mat->alpha_cutoff ? 1.0f : 0.0f;
    return alpha;
}

static real3 emission_at(const scene *s, const mesh *m, const material *mat, const weights *at)
{
    real3 emission = vector_of(mat->emission);
    if (mat->emissive_texture.texture != NONE && max_of3(emission) > 0) {
        const texel t = look_up(s, m, &mat->emissive_texture, at);
        emission = mul3(emission, make3(t.c[0], t.c[1], t.c[2]));
    }
    return emission;
}

real3 surface_emission(const scene *s, const mesh *m, uint32_t triangle, float u, float v)
{
    const weights at = weights_at(m, triangle, u, v);
    return emission_at(s, m, &s->materials[m->material], &at);
}

/* The direction in which the texture's u grows on the triangle (and the sign of n . (du x dv)), from positions and
 * coordinates; 0 where the coordinates are degenerate. */
static real3 uv_tangent(const mesh *m, const weights *at, unsigned uv_set, real3 normal, float *handedness)
{
    const float(*uv)[2] = (const float(*)[2])m->uv[uv_set];
    *handedness = 1;
    if (!uv) return splat3(0);
    const uint32_t *i = at->vertex;
    const real3 p0 = vector_of(m->positions[i[0]]);
    const real3 e1 = sub3(vector_of(m->positions[i[1]]), p0), e2 = sub3(vector_of(m->positions[i[2]]), p0);
    const float du1 = uv[i[1]][0] - uv[i[0]][0], dv1 = uv[i[1]][1] - uv[i[0]][1];
    const float du2 = uv[i[2]][0] - uv[i[0]][0], dv2 = uv[i[2]][1] - uv[i[0]][1];
    const float det = du1*dv2 - du2*dv1;
    if (det == 0) return splat3(0);
    const float sign = det > 0 ? 1.0f : -1.0f;
    const real3 along = scale3(sign, sub3(scale3(dv2, e1), scale3(dv1, e2)));
    /* v runs downwards in glTF's textures, upwards in normal maps: the bitangent is -dP/dv. */
    const real3 down = scale3(sign, sub3(scale3(du1, e2), scale3(du2, e1)));
    *handedness = dot3(cross3(normal, along), down) > 0 ? -1.0f : 1.0f;
    return along;
}

/* Fills material, bsdf and emission from texture and vertex values. */
static void set_material(surface *at, const surface_set *set, size_t index, const mesh *m, const weights *w,
                         float choice, facet_bsdf *own)
{
    const scene *s = set->scene;
    const material *mat = &s->materials[index];
    const shared_shading *common = &set->shadings[index];
    at->scatters = mat->kind != SURFACE_UNLIT;
    const bool emits = at->is_front || mat->is_double_sided;
    if (emits) at->emission = m ? emission_at(s, m, mat, w) : vector_of(mat->emission);
    if (mat->kind == SURFACE_BSDF || (common->is_uniform && !(m && m->colors))) {
        at->bsdf = &common->bsdf;
        at->transmits = common->transmits;
        return;
    }
    texel base = {{mat->base_color[0], mat->base_color[1], mat->base_color[2], 1}};
    if (m) base = base_color_at(s, m, mat, w);
    if (mat->kind == SURFACE_UNLIT) {
        at->unlit = make3(base.c[0], base.c[1], base.c[2]);
        return;
    }
    float metallic = mat->metallic, roughness = mat->roughness;
    if (m && mat->metallic_roughness_texture.texture != NONE) {
        const texel t = look_up(s, m, &mat->metallic_roughness_texture, w);
        roughness *= t.c[1];
        metallic *= t.c[2];
    }
    at->transmits = choice < mat->transmission*(1 - metallic);
    at->bsdf = own;
    *own = at->transmits ? facet_bsdf_glass(mat->ior, roughness*roughness, base.c, mat->is_thin)
                         : reflection_of(mat, base.c, metallic, roughness);
}

/* In the plane of g and n, with n at the angle t from g and wo = c g + s x + ..., the mirror image has the cosine
 *     2 (n.wo)(n.g) - c = c cos 2t + s sin 2t = r cos(2t - phi)
 * with g. */
real3 surface_bend_normal(real3 n, real3 g, real3 wo)
{
    const real3 x = normalize3(madd3(n, -dot3(n, g), g));
    const float c = dot3(wo, g), s = dot3(wo, x), r = ksqrt(c*c + s*s);
    const float t = 0.5f*(katan2(s, c) + kacos(kmin(least_mirror_cosine(c)/r, 1)));
    return normalize3(add3(scale3(kcos(t), g), scale3(ksin(t), x)));
}

/* A shading normal that reflection can use. */
static real3 usable_normal(real3 n, real3 g, real3 wo)
{
    if (dot3(n, g) < 0) n = neg3(n);
    return mirror_cosine(n, g, wo) >= least_mirror_cosine(dot3(wo, g)) ? n : surface_bend_normal(n, g, wo);
}

/* The frame: n given on the front side, `true` where it is the geometric normal.  Reflecting surfaces are turned to the
 * viewer. */
static void set_frame(surface *at, real3 n, bool is_true, real3 tangent, float handedness, real3 wo)
{
    const bool flips = !at->is_front && !at->transmits;
    real3 up = flips ? neg3(n) : n;
    if (!at->transmits && !is_true) up = usable_normal(up, flips ? neg3(at->normal) : at->normal, wo);
    at->shading = frame_around(up, tangent, handedness);
}

/* The normal of the normal map in the frame (t, b, n) of the vertices.  [gltf, normalTexture]. */
static real3 mapped_normal(const scene *s, const mesh *m, const material *mat, const weights *w, frame vertices)
{
    const texel t = look_up(s, m, &mat->normal_texture, w);
    const real3 local = make3((2*t.c[0] - 1)*mat->normal_scale, (2*t.c[1] - 1)*mat->normal_scale,
                              2*t.c[2] - 1);
    const real3 n = to_world(&vertices, local);
    return dot3(n, n) > 0 ? normalize3(n) : vertices.n;
}

static void find_on_triangle(const surface_set *set, const hit *h, real3 wo, float choice, facet_bsdf *own, surface *at)
{
    const scene *s = set->scene;
    const placement *placed = &set->placements[h->instance];
    const instance *in = &s->instances[h->instance];
    const mesh *m = placed->mesh;
    const material *mat = &s->materials[m->material];
    const weights w = weights_at(m, h->primitive, h->u, h->v);
    const float sign = placed->sign;
    const real3 p0 = vector_of(m->positions[w.vertex[0]]), p1 = vector_of(m->positions[w.vertex[1]]),
                p2 = vector_of(m->positions[w.vertex[2]]);
    *at = (surface){.position = map_point(in->to_world, mix_vertices3(&w, (const float(*)[3])m->positions))};
    at->normal = scale3(
        sign, normal_of_edges(map_vector(in->to_world, sub3(p1, p0)), map_vector(in->to_world, sub3(p2, p0))));
    at->is_front = dot3(at->normal, wo) > 0;
    const float local = kmax(max_abs3(p0), kmax(max_abs3(p1), max_abs3(p2)));
    at->offset = RELATIVE_OFFSET*kmax(max_abs3(at->position), kmax(placed->column*local, placed->offset));
    set_material(at, set, m->material, m, &w, choice, own);

    const bool is_mapped = mat->normal_texture.texture != NONE && mat->kind != SURFACE_UNLIT;
    if (!m->normals && !m->tangents && !m->uv[0] && !is_mapped) {
        set_frame(at, at->normal, true, splat3(0), 1, wo);
        return;
    }
    real3 n = at->normal;
    if (m->normals) {
        const real3 mixed = map_normal(in->to_world, sign, mix_vertices3(&w, (const float(*)[3])m->normals));
        if (dot3(mixed, mixed) > 0) n = normalize3(mixed);
    }
    real3 tangent;
    float handedness = 1;
    if (m->tangents) {
        tangent = make3(mix_component(&w, &m->tangents[0][0], 4), mix_component(&w, &m->tangents[0][1], 4),
                        mix_component(&w, &m->tangents[0][2], 4));
        handedness = sign*m->tangents[w.vertex[0]][3];
        tangent = map_vector(in->to_world, tangent);
    } else {
        const unsigned uv_set = mat->normal_texture.texture != NONE ? mat->normal_texture.uv_set : 0;
        tangent = map_vector(in->to_world, uv_tangent(m, &w, uv_set, cross3(sub3(p1, p0), sub3(p2, p0)), &handedness));
        handedness *= sign;
    }
    if (is_mapped) n = mapped_normal(s, m, mat, &w, frame_around(n, tangent, handedness));
    set_frame(at, n, !m->normals && !is_mapped, tangent, handedness, wo);
}

static void find_on_sphere(const surface_set *set, const hit *h, real3 wo, real3 near, float choice, facet_bsdf *own,
                           surface *at)
{
    const sphere *sp = &set->scene->spheres[h->primitive];
    const real3 center = vector_of(sp->center);
    const real3 outward = normalize3(sub3(near, center));
    *at = (surface){.position = madd3(center, sp->radius, outward), .normal = outward};
    at->is_front = dot3(outward, wo) > 0;
    at->offset = RELATIVE_OFFSET*kmax(max_abs3(at->position), sp->radius);
    set_material(at, set, sp->material, NULL, NULL, choice, own);
    /* Tangents run around the y axis. */
    set_frame(at, outward, true, make3(outward.z, 0, -outward.x), 1, wo);
}

void surface_find(const surface_set *set, const ray *r, const hit *h, real3 wo, float choice, facet_bsdf *own,
                  surface *at)
{
    if (h->instance < set->scene->n_instances) {
        find_on_triangle(set, h, wo, choice, own, at);
    } else {
        const real3 near = madd3(vector_of(r->origin), h->t, vector_of(r->direction));
        find_on_sphere(set, h, wo, near, choice, own, at);
    }
}

static void load_instance(const surface_set *set, uint32_t index, plain_block *block, uint32_t lane)
{
    if (block->instance[lane] == index + 1) return;
    block->instance[lane] = index + 1;
    const placement *placed = &set->placements[index];
    const instance *in = &set->scene->instances[index];
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 4; k++) block->to_world[row][k][lane] = in->to_world[row][k];
    block->sign[lane] = placed->sign;
    block->column[lane] = placed->column;
    block->offset[lane] = placed->offset;
}

static inline void load_corners(float to[3][3][LOOP_LANES], uint32_t lane, const uint32_t triangle[3],
                                const float (*values)[3])
{
    for (int corner = 0; corner < 3; corner++)
        for (int k = 0; k < 3; k++) to[corner][k][lane] = values[triangle[corner]][k];
}

static inline const placement *placement_at(const surface_set *set, hits h, uint32_t i)
{
    return h.instance[i] < set->scene->n_instances ? &set->placements[h.instance[i]] : NULL;
}

/* The triangle is fetched twice as far ahead as its vertices, which it must be known for. */
EXPECTING void expect_hit(const surface_set *set, hits h, uint32_t n, const uint32_t *order)
{
    enum { AHEAD = 12 };
    if (2*AHEAD < n) {
        const placement *placed = placement_at(set, h, order[2*AHEAD]);
        if (placed) __builtin_prefetch(placed->mesh->triangles[h.primitive[order[2*AHEAD]]]);
    }
    if (AHEAD < n) {
        const placement *placed = placement_at(set, h, order[AHEAD]);
        if (!placed) return;
        const mesh *m = placed->mesh;
        const uint32_t *triangle = m->triangles[h.primitive[order[AHEAD]]];
        for (int k = 0; k < 3; k++) __builtin_prefetch(m->positions[triangle[k]]);
        for (int k = 0; k < 3 && m->normals; k++) __builtin_prefetch(m->normals[triangle[k]]);
    }
}

void surface_expect(const surface_set *set, hits h, uint32_t n, const uint32_t *order)
{
    expect_hit(set, h, n, order);
}

uint32_t surface_load_plain(const surface_set *set, hits h, uint32_t n, const uint32_t *order, plain_block *block,
                            uint32_t lane, const facet_bsdf **bsdfs, uint32_t *transmits)
{
    const uint32_t room = LOOP_LANES - lane, end = n < room ? n : room;
    for (uint32_t k = 0; k < end; k++, lane++) {
        const uint32_t i = order[k];
        const placement *placed = placement_at(set, h, i);
        if (!placed || !placed->is_plain) return k;
        expect_hit(set, h, n - k, order + k);
        const mesh *m = placed->mesh;
        const uint32_t *triangle = m->triangles[h.primitive[i]];
        load_corners(block->corners, lane, triangle, (const float(*)[3])m->positions);
        if (m->normals) load_corners(block->normals, lane, triangle, (const float(*)[3])m->normals);
        block->u[lane] = h.u[i];
        block->v[lane] = h.v[i];
        block->is_there[lane] = UINT32_MAX;
        block->is_smooth[lane] = m->normals ? UINT32_MAX : 0;
        block->has_smooth |= m->normals != NULL;
        load_instance(set, h.instance[i], block, lane);
        bsdfs[k] = &set->shadings[m->material].bsdf;
        transmits[k] = set->shadings[m->material].transmits ? UINT32_MAX : 0;
    }
    return end;
}

bool surface_is_hidden(const surface_set *set, const hit *h, real3 direction)
{
    if (h->instance >= set->scene->n_instances || !set->placements[h->instance].is_one_sided) return false;
    const placement *placed = &set->placements[h->instance];
    const mesh *m = placed->mesh;
    const instance *in = &set->scene->instances[h->instance];
    const uint32_t *i = m->triangles[h->primitive];
    const real3 p0 = vector_of(m->positions[i[0]]);
    const real3 e1 = map_vector(in->to_world, sub3(vector_of(m->positions[i[1]]), p0));
    const real3 e2 = map_vector(in->to_world, sub3(vector_of(m->positions[i[2]]), p0));
    return placed->sign*dot3(normal_of_edges(e1, e2), direction) > 0;
}
