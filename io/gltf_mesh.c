/* gltf_mesh.c: mesh primitives into scene meshes.  [gltf, sections 3.7.2, 5.23, 5.24]; KHR_mesh_quantization.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

enum {
    FORMAT_NORMALIZED = GLTF_WANT_NORM_U8 | GLTF_WANT_NORM_U16 | GLTF_WANT_NORM_I8 | GLTF_WANT_NORM_I16,
    FORMAT_PLAIN = GLTF_WANT_U8 | GLTF_WANT_U16 | GLTF_WANT_I8 | GLTF_WANT_I16,
    /* What KHR_mesh_quantization allows beside float; read with or without the extension. */
    FORMAT_POSITION = GLTF_WANT_F32 | FORMAT_NORMALIZED | FORMAT_PLAIN,
    FORMAT_UV = FORMAT_POSITION,
    FORMAT_DIRECTION = GLTF_WANT_F32 | GLTF_WANT_NORM_I8 | GLTF_WANT_NORM_I16,
    FORMAT_COLOUR = GLTF_WANT_F32 | GLTF_WANT_NORM_U8 | GLTF_WANT_NORM_U16
};

void gltf_mesh_destroy(gltf_mesh *m)
{
    free(m->parts);
    *m = (gltf_mesh){0};
}

/* Finds an optional attribute, checked for format and count; *a is NULL if there is none. */
static bool find_attribute(gltf *g, const json_place *place, const char *types, unsigned formats, size_t n_vertices,
                           const gltf_accessor **a)
{
    *a = NULL;
    if (!place->value) return true;
    if (!gltf_find_accessor(g, place, a) || !gltf_want_format(place, *a, types, formats)) return false;
    if ((*a)->count != n_vertices)
        return json_fail(place, FACET_BAD_FILE, "has %zu elements, but POSITION has %zu", (*a)->count, n_vertices);
    return true;
}

static bool read_positions(gltf *g, const json_place *attributes, mesh *m)
{
    const json_place place = json_member(attributes, "POSITION");
    const gltf_accessor *a;
    float *values;
    if (!gltf_find_accessor(g, &place, &a) || !gltf_want_format(&place, a, "VEC3", FORMAT_POSITION)) return false;
    if (a->count >= UINT32_MAX) return json_fail(&place, FACET_UNSUPPORTED, "has %zu vertices", a->count);
    if (!gltf_read_floats(g, &place, a, &values)) return false;
    m->n_vertices = a->count;
    m->positions = (float(*)[3])(void *)values;
    return true;
}

/* Directions may be not finite here; gltf_tidy_frames mends them. */
static bool read_frames(gltf *g, const json_place *attributes, mesh *m)
{
    const json_place normal = json_member(attributes, "NORMAL"), tangent = json_member(attributes, "TANGENT");
    const gltf_accessor *a;
    float *values = NULL;
    if (!find_attribute(g, &normal, "VEC3", FORMAT_DIRECTION, m->n_vertices, &a)) return false;
    if (a && !gltf_read_any_floats(g, &normal, a, &values)) return false;
    m->normals = (float(*)[3])(void *)values;
    values = NULL;
    if (!find_attribute(g, &tangent, "VEC4", FORMAT_DIRECTION, m->n_vertices, &a)) return false;
    /* Section 3.7.2.1: without normals, tangents are ignored. */
    if (a && m->normals && !gltf_read_any_floats(g, &tangent, a, &values)) return false;
    m->tangents = (float(*)[4])(void *)values;
    return true;
}

static bool read_uv(gltf *g, const json_place *attributes, mesh *m)
{
    static const char *const names[] = {"TEXCOORD_0", "TEXCOORD_1"};
    for (int i = 0; i < 2; i++) {
        const json_place place = json_member(attributes, names[i]);
        const gltf_accessor *a;
        float *values = NULL;
        if (!find_attribute(g, &place, "VEC2", FORMAT_UV, m->n_vertices, &a)) return false;
        if (a && !gltf_read_floats(g, &place, a, &values)) return false;
        for (size_t k = 0; a && k < 2*m->n_vertices; k++)
            values[k] = fmaxf(-GLTF_UV_CAP, fminf(values[k], GLTF_UV_CAP));
        m->uv[i] = (float(*)[2])(void *)values;
    }
    return true;
}

/* COLOR_0 as RGBA in [0,1]; the specification has no other colours. */
static bool read_colors(gltf *g, const json_place *attributes, mesh *m)
{
    const json_place place = json_member(attributes, "COLOR_0");
    const gltf_accessor *a;
    float *values;
    if (!find_attribute(g, &place, "VEC3 VEC4", FORMAT_COLOUR, m->n_vertices, &a)) return false;
    if (!a) return true;
    if (!gltf_read_floats(g, &place, a, &values)) return false;
    m->colors = gltf_alloc(g, &place, m->n_vertices, sizeof *m->colors);
    for (size_t i = 0; m->colors && i < m->n_vertices; i++) {
        const float *const in = values + i*a->n_components;
        m->colors[i][3] = 1;
        for (size_t k = 0; k < a->n_components; k++) m->colors[i][k] = in[k] < 0 ? 0 : in[k] > 1 ? 1 : in[k];
    }
    free(values);
    return m->colors != NULL;
}

/* Section 3.7.2.1: modes 0 to 3 are points and lines, which have no surface. */
static bool check_mode(gltf *g, const json_place *primitive, bool *is_shown)
{
    static const char *const names[] = {"points", "lines", "a line loop", "a line strip"};
    size_t mode = 4;
    const json_place place = json_member(primitive, "mode");
    if (!json_read_size(primitive, "mode", SIZE_MAX, &mode)) return false;
    if (mode > 6) return json_fail(&place, FACET_BAD_VALUE, "is %zu; must be from 0 to 6", mode);
    *is_shown = mode >= 4;
    if (!*is_shown) gltf_warn(g, primitive, "%s cannot be rendered: left out", names[mode]);
    return true;
}

/* Compressed primitives may keep plain accessors beside them. */
static bool check_compression(gltf *g, const json_place *primitive, const json_place *position)
{
    gltf_extension draco;
    const gltf_accessor *a;
    if (!gltf_read_extension(primitive, "KHR_draco_mesh_compression", &draco)) return false;
    if (!draco.body.value) return true;
    if (!gltf_find_accessor(g, position, &a)) return false;
    if (a->view == NONE && a->n_sparse == 0)
        return json_fail(primitive, FACET_UNSUPPORTED,
                         "KHR_draco_mesh_compression is not supported; export the mesh without compression");
    gltf_warn(g, primitive, "KHR_draco_mesh_compression is not supported: the uncompressed fallback is read");
    return true;
}

static bool check_positions(const json_place *primitive, const mesh *m, float *extent)
{
    float largest = 0;
    for (size_t i = 0; i < m->n_vertices; i++)
        for (int k = 0; k < 3; k++) {
            const float size = fabsf(m->positions[i][k]);
            if (!(size <= (float)GLTF_EXTENT_CAP))
                return json_fail(primitive, FACET_BAD_VALUE, "vertex %zu lies at %g m; must be within %g m", i,
                                 (double)m->positions[i][k], GLTF_EXTENT_CAP);
            if (size > largest) largest = size;
        }
    *extent = largest;
    return true;
}

/* Fills *m; is_shown false if there is nothing to show. */
static bool build_primitive(gltf *g, const json_place *primitive, const json_place *weights, const gltf_pose *pose,
                            mesh *m, float *extent, bool *is_shown)
{
    json_place attributes;
    size_t material_number = NONE;
    *m = (mesh){0};
    if (!json_want_object(primitive) || !json_read_object(primitive, "attributes", &attributes) ||
        !json_want_present(&attributes) || !check_mode(g, primitive, is_shown))
        return false;
    if (!*is_shown) return true;
    const json_place position = json_member(&attributes, "POSITION");
    if (!position.value) {
        gltf_warn(g, primitive, "has no POSITION: left out");
        *is_shown = false;
        return true;
    }
    if (!json_read_index(primitive, "material", json_count(&g->materials), "materials", &material_number) ||
        !check_compression(g, primitive, &position) || !read_positions(g, &attributes, m) ||
        !gltf_read_triangles(g, primitive, m->n_vertices, &m->triangles, &m->n_triangles))
        return false;
    *is_shown = m->n_triangles > 0;
    if (!*is_shown) return true;
    if (!read_frames(g, &attributes, m) || !read_uv(g, &attributes, m) || !read_colors(g, &attributes, m) ||
        !gltf_apply_morph(g, primitive, weights, m) || (pose && !gltf_apply_skin(g, &attributes, pose, m)) ||
        !check_positions(primitive, m, extent) || !gltf_tidy_frames(g, primitive, m))
        return false;
    return gltf_use_material(g, material_number, &m->material);
}

/* Adds the primitive to the scene and to the parts, if it shows anything. */
static bool add_primitive(gltf *g, const json_place *primitive, const json_place *weights, const gltf_pose *pose,
                          gltf_mesh *result)
{
    mesh m;
    gltf_part *const part = &result->parts[result->n_parts];
    bool is_shown = false;
    bool is_built = build_primitive(g, primitive, weights, pose, &m, &part->extent, &is_shown);
    if (is_built && is_shown) {
        if (!scene_add_mesh(g->scene, &m, &part->mesh)) {
            result->n_parts++;
            return true;
        }
        is_built = gltf_no_memory(primitive);
    }
    mesh_destroy(&m);
    return is_built;
}

static bool build_mesh(gltf *g, size_t mesh_number, const json_place *node, const gltf_pose *pose, gltf_mesh *result)
{
    const json_place place = json_element(&g->meshes, mesh_number);
    json_place primitives, weights, node_weights;
    if (!json_read_array(&place, "primitives", &primitives) || !json_want_present(&primitives) ||
        !json_read_array(&place, "weights", &weights) || !json_read_array(node, "weights", &node_weights))
        return false;
    if (node_weights.value) weights = node_weights;
    const size_t n = json_count(&primitives);
    /* Empty primitives cost time too: many nodes may rebuild many of them. */
    if (!gltf_charge(g, &place, n, sizeof(mesh))) return false;
    result->parts = gltf_alloc(g, &place, n, sizeof *result->parts);
    if (!result->parts) return false;
    for (size_t i = 0; i < n; i++) {
        const json_place primitive = json_element(&primitives, i);
        if (!add_primitive(g, &primitive, &weights, pose, result)) return false;
    }
    result->is_built = true;
    return true;
}

bool gltf_use_mesh(gltf *g, size_t mesh_number, const json_place *node, const gltf_pose *pose, const gltf_mesh **result)
{
    const json_place node_weights = json_member(node, "weights");
    const bool is_shared = !pose && !node_weights.value;
    gltf_mesh *const m = is_shared ? &g->mesh[mesh_number] : &g->deformed;
    if (!is_shared) gltf_mesh_destroy(m);
    *result = m;
    return m->is_built || build_mesh(g, mesh_number, node, pose, m);
}
