/* fuzz_gltf.c: libFuzzer's way into the glTF reader, by way of a file in a folder of its own.
 *
 * Beyond crashes, it checks what the renderer relies on: in a scene that is read every index is in range
 * and every number finite, and a file that is refused says why.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/gltf.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

static char folder[32] = "/tmp/facet-fuzz-XXXXXX";
static char path[64];

static void remove_folder(void)
{
    unlink(path);
    rmdir(folder);
}

static void require(bool is_true)
{
    if (!is_true) abort();
}

static void require_finite(const void *numbers, size_t n)
{
    for (size_t i = 0; numbers && i < n; i++) require(isfinite(((const float *)numbers)[i]));
}

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

static void check_scene(const scene *s)
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

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    if (!path[0]) {
        require(mkdtemp(folder) != NULL);
        snprintf(path, sizeof path, "%s/input", folder);
        atexit(remove_folder);
    }
    FILE *file = fopen(path, "wb");
    require(file != NULL);
    require(fwrite(bytes, 1, size, file) == size);
    require(fclose(file) == 0);
    scene *s = NULL;
    facet_error why = {0};
    if (gltf_read(path, NULL, NULL, &s, &why)) {
        require(!s && why.status && why.text[0]);
        return 0;
    }
    check_scene(s);
    scene_destroy(s);
    return 0;
}
