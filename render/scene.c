/* scene.c: the scene's arrays, and questions about it.
 * SPDX-License-Identifier: MIT */
#include "render/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

facet_status material_default(const char *name, material *m)
{
    char *copy = malloc(strlen(name) + 1);
    if (!copy) return FACET_NO_MEMORY;
    memcpy(copy, name, strlen(name) + 1);
    const texture_use unused = {.texture = NONE, .transform = {{1, 0, 0}, {0, 1, 0}}};
    *m = (material){
        .name = copy,
        .base_color = {1, 1, 1, 1},
        .metallic = 1,
        .roughness = 1,
        .ior = 1.5f,
        .specular = 1,
        .specular_color = {1, 1, 1},
        .normal_scale = 1,
        .base_color_texture = unused,
        .metallic_roughness_texture = unused,
        .normal_texture = unused,
        .emissive_texture = unused,
        .alpha_cutoff = 0.5f,
    };
    return FACET_OK;
}

scene *scene_create(void)
{
    scene *s = calloc(1, sizeof *s);
    if (s) s->hash = 14695981039346656037u; /* FNV's offset basis */
    return s;
}

void scene_hash_bytes(scene *s, const void *bytes, size_t n)
{
    const unsigned char *const b = bytes;
    uint64_t hash = s->hash;
    for (size_t i = 0; i < n; i++) hash = (hash ^ b[i])*1099511628211u;
    s->hash = hash;
}

void mesh_destroy(mesh *m)
{
    free(m->positions);
    free(m->normals);
    free(m->tangents);
    free(m->uv[0]);
    free(m->uv[1]);
    free(m->colors);
    free(m->triangles);
    *m = (mesh){0};
}

void material_destroy(material *m)
{
    free(m->name);
    *m = (material){0};
}

void scene_destroy(scene *s)
{
    if (!s) return;
    for (size_t i = 0; i < s->n_images; i++) image_destroy(&s->images[i]);
    for (size_t i = 0; i < s->n_materials; i++) material_destroy(&s->materials[i]);
    for (size_t i = 0; i < s->n_meshes; i++) mesh_destroy(&s->meshes[i]);
    for (size_t i = 0; i < s->n_cameras; i++) free(s->cameras[i].name);
    image_destroy(&s->environment.map);
    free(s->images);
    free(s->textures);
    free(s->materials);
    free(s->meshes);
    free(s->instances);
    free(s->spheres);
    free(s->lights);
    free(s->cameras);
    free(s);
}

/* Appends one item to a growing array whose capacity is the next power of two above its count. */
static facet_status append(void **array, size_t *n, size_t item_size, const void *item, size_t *index)
{
    if ((*n & (*n - 1)) == 0) {
        void *larger = realloc(*array, (*n ? 2**n : 1)*item_size);
        if (!larger) return FACET_NO_MEMORY;
        *array = larger;
    }
    memcpy((char *)*array + *n*item_size, item, item_size);
    if (index) *index = *n;
    (*n)++;
    return FACET_OK;
}

facet_status scene_add_image(scene *s, const image *item, size_t *index)
{
    return append((void **)&s->images, &s->n_images, sizeof *item, item, index);
}
facet_status scene_add_texture(scene *s, const texture *item, size_t *index)
{
    return append((void **)&s->textures, &s->n_textures, sizeof *item, item, index);
}
facet_status scene_add_material(scene *s, const material *item, size_t *index)
{
    return append((void **)&s->materials, &s->n_materials, sizeof *item, item, index);
}
facet_status scene_add_mesh(scene *s, const mesh *item, size_t *index)
{
    return append((void **)&s->meshes, &s->n_meshes, sizeof *item, item, index);
}
facet_status scene_add_instance(scene *s, const instance *item, size_t *index)
{
    return append((void **)&s->instances, &s->n_instances, sizeof *item, item, index);
}
facet_status scene_add_sphere(scene *s, const sphere *item, size_t *index)
{
    return append((void **)&s->spheres, &s->n_spheres, sizeof *item, item, index);
}
facet_status scene_add_light(scene *s, const punctual_light *item, size_t *index)
{
    return append((void **)&s->lights, &s->n_lights, sizeof *item, item, index);
}
facet_status scene_add_camera(scene *s, const camera *item, size_t *index)
{
    return append((void **)&s->cameras, &s->n_cameras, sizeof *item, item, index);
}

size_t scene_find_material(const scene *s, const char *name)
{
    for (size_t i = 0; i < s->n_materials; i++)
        if (strcmp(s->materials[i].name, name) == 0) return i;
    return NONE;
}

size_t scene_find_camera(const scene *s, const char *name)
{
    for (size_t i = 0; i < s->n_cameras; i++)
        if (strcmp(s->cameras[i].name, name) == 0) return i;
    return NONE;
}

/* Widens a box by a point. */
static void include_point(float low[3], float high[3], const float p[3])
{
    for (int k = 0; k < 3; k++) {
        if (p[k] < low[k]) low[k] = p[k];
        if (p[k] > high[k]) high[k] = p[k];
    }
}

/* The box around a mesh's vertices, in the mesh's own space. */
static void mesh_bounds(const mesh *m, float low[3], float high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (size_t i = 0; i < m->n_vertices; i++) include_point(low, high, m->positions[i]);
}

bool scene_bounds(const scene *s, float low[3], float high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (size_t i = 0; i < s->n_instances; i++) {
        const instance *in = &s->instances[i];
        float box[2][3];
        mesh_bounds(&s->meshes[in->mesh], box[0], box[1]);
        if (!(box[0][0] <= box[1][0])) continue;
        for (int corner = 0; corner < 8; corner++) {
            const float c[3] = {box[corner & 1][0], box[corner >> 1 & 1][1], box[corner >> 2][2]};
            float p[3];
            for (int k = 0; k < 3; k++)
                p[k] = in->to_world[k][0]*c[0] + in->to_world[k][1]*c[1] + in->to_world[k][2]*c[2] +
                       in->to_world[k][3];
            include_point(low, high, p);
        }
    }
    for (size_t i = 0; i < s->n_spheres; i++) {
        const sphere *sp = &s->spheres[i];
        const float a[3] = {sp->center[0] - sp->radius, sp->center[1] - sp->radius, sp->center[2] - sp->radius};
        const float b[3] = {sp->center[0] + sp->radius, sp->center[1] + sp->radius, sp->center[2] + sp->radius};
        include_point(low, high, a);
        include_point(low, high, b);
    }
    return low[0] <= high[0] && low[1] <= high[1] && low[2] <= high[2];
}

facet_status scene_add_framing_camera(scene *s, size_t *index)
{
    float low[3], high[3];
    if (!scene_bounds(s, low, high))
        for (int k = 0; k < 3; k++) {
            low[k] = -1;
            high[k] = 1;
        }
    const float center[3] = {(low[0] + high[0])/2, (low[1] + high[1])/2, (low[2] + high[2])/2};
    float radius = sqrtf((high[0] - low[0])*(high[0] - low[0]) + (high[1] - low[1])*(high[1] - low[1]) +
                         (high[2] - low[2])*(high[2] - low[2]))/
                   2;
    if (!(radius > 0)) radius = 1;
    /* Looks down by 15 degrees; 40 degrees of view take in the sphere around the box. */
    const float yfov = 0.6981317f, tilt = 0.2617994f;
    const float distance = 1.05f*radius/sinf(yfov/2);
    const float sn = sinf(tilt), cs = cosf(tilt);
    camera c = {
        .yfov = yfov,
        .to_world = {{1, 0, 0, center[0]},
                     {0, cs, sn, center[1] + distance*sn},
                     {0, -sn, cs, center[2] + distance*cs}},
    };
    static const char name[] = "framing";
    c.name = malloc(sizeof name);
    if (!c.name) return FACET_NO_MEMORY;
    memcpy(c.name, name, sizeof name);
    const facet_status status = scene_add_camera(s, &c, index);
    if (status) free(c.name);
    return status;
}
