/* scene_checks.c: see scene_checks.h.
 * SPDX-License-Identifier: MIT */
#include "tests/fuzz/parts/scene_checks.h"

#include "io/gltf.h"
#include "tests/fuzz/parts/harness.h"

static void check_mesh(const scene *s, const mesh *m)
{
    require(m->n_triangles > 0 && m->material < s->n_materials);
    for (size_t i = 0; i < 3*m->n_triangles; i++) require(m->triangles[i/3][i%3] < m->n_vertices);
    require_finite(m->positions, 3*m->n_vertices);
    require_finite(m->normals, 3*m->n_vertices);
    require_finite(m->tangents, 4*m->n_vertices);
    require_finite(m->uv[0], 2*m->n_vertices);
    require_finite(m->uv[1], 2*m->n_vertices);
    require_finite(m->colors, 4*m->n_vertices);
}

static void check_texture(const scene *s, const texture_use *use)
{
    require(use->texture == NONE || use->texture < s->n_textures);
    require(use->uv_set <= 1);
    require_finite(use->transform, 6);
}

static void check_material(const scene *s, const material *m)
{
    const float numbers[] = {m->metallic, m->roughness, m->ior, m->specular, m->transmission, m->normal_scale};
    require(m->name != NULL && m->ior >= 1);
    require_finite(numbers, sizeof numbers/sizeof *numbers);
    require_finite(m->base_color, 4);
    require_finite(m->specular_color, 3);
    require_finite(m->emission, 3);
    check_texture(s, &m->base_color_texture);
    check_texture(s, &m->metallic_roughness_texture);
    check_texture(s, &m->normal_texture);
    check_texture(s, &m->emissive_texture);
}

void check_scene(const scene *s)
{
    for (size_t i = 0; i < s->n_meshes; i++) check_mesh(s, &s->meshes[i]);
    for (size_t i = 0; i < s->n_materials; i++) check_material(s, &s->materials[i]);
    for (size_t i = 0; i < s->n_textures; i++) require(s->textures[i].image < s->n_images);
    for (size_t i = 0; i < s->n_instances; i++) {
        require(s->instances[i].mesh < s->n_meshes);
        require_finite(s->instances[i].to_world, 12);
    }
    for (size_t i = 0; i < s->n_spheres; i++) {
        require(s->spheres[i].material < s->n_materials && s->spheres[i].radius > 0);
        require_finite(&s->spheres[i].radius, 1);
        require_finite(s->spheres[i].center, 3);
    }
    for (size_t i = 0; i < s->n_lights; i++) {
        require_finite(s->lights[i].position, 3);
        require_finite(s->lights[i].direction, 3);
        require_finite(s->lights[i].intensity, 3);
    }
    for (size_t i = 0; i < s->n_cameras; i++) require_finite(s->cameras[i].to_world, 12);
}

void check_scene_file(const char *path)
{
    const gltf_options options = {.most_memory = (size_t)256 << 20};
    scene *s = NULL;
    facet_error why = {0};
    if (gltf_read_with(path, &options, &s, &why)) {
        require(s == NULL && why.status && why.text[0]);
        return;
    }
    check_scene(s);
    scene_destroy(s);
}
