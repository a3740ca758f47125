/* gltf_scene.c: from the nodes of the file's default scene to what the renderer sees.
 * [gltf, section 3.5.1]; EXT_mesh_gpu_instancing; FACET_shape.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

/* How far a sphere's transform may be from a similarity: matrices are often written with six digits. */
#define SIMILARITY_TOLERANCE 1e-4

/* ---- Instances ------------------------------------------------------------------------------------ */

/* One attribute of EXT_mesh_gpu_instancing; all have the same count. */
static bool read_instance_attribute(gltf *g, const json_place *attributes, const char *key, const char *type,
                                    unsigned formats, size_t *n, float **values)
{
    const json_place place = json_member(attributes, key);
    const gltf_accessor *a;
    *values = NULL;
    if (!place.value) return true;
    if (!gltf_find_accessor(g, &place, &a) || !gltf_want_format(&place, a, type, formats)) return false;
    if (*n != NONE && a->count != *n)
        return json_fail(&place, FACET_BAD_FILE, "has %zu elements; the others have %zu", a->count, *n);
    if (a->count > GLTF_INSTANCE_CAP)
        return json_fail(&place, FACET_UNSUPPORTED, "has %zu instances; at most %zu are read", a->count,
                         GLTF_INSTANCE_CAP);
    *n = a->count;
    return gltf_read_floats(g, &place, a, values);
}

static bool compose_instances(gltf *g, const json_place *place, size_t n, const float *translations,
                              const float *rotations, const float *scales, gltf_matrix **list)
{
    *list = gltf_alloc(g, place, n, sizeof **list);
    if (!*list) return false;
    for (size_t i = 0; i < n; i++) {
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        for (size_t k = 0; translations && k < 3; k++) translation[k] = translations[3*i + k];
        for (size_t k = 0; rotations && k < 4; k++) rotation[k] = rotations[4*i + k];
        for (size_t k = 0; scales && k < 3; k++) scale[k] = scales[3*i + k];
        if (gltf_compose(translation, rotation, scale, (*list)[i])) continue;
        free(*list);
        *list = NULL;
        return json_fail(place, FACET_BAD_VALUE, "ROTATION of instance %zu is zero; must be a unit quaternion", i);
    }
    return true;
}

/* The node's instances, relative to the node; *list NULL and n 1 if it is not instanced. */
static bool read_instancing(gltf *g, const json_place *node, gltf_matrix **list, size_t *n)
{
    gltf_extension e;
    json_place attributes;
    float *translations = NULL, *rotations = NULL, *scales = NULL;
    *list = NULL;
    *n = 1;
    if (!gltf_read_extension(node, "EXT_mesh_gpu_instancing", &e)) return false;
    if (!json_read_object(&e.body, "attributes", &attributes)) return false;
    size_t count = NONE;
    const unsigned rotation_formats = GLTF_WANT_F32 | GLTF_WANT_NORM_I8 | GLTF_WANT_NORM_I16;
    bool is_read = read_instance_attribute(g, &attributes, "TRANSLATION", "VEC3", GLTF_WANT_F32, &count,
                                           &translations) &&
                   read_instance_attribute(g, &attributes, "ROTATION", "VEC4", rotation_formats, &count, &rotations) &&
                   read_instance_attribute(g, &attributes, "SCALE", "VEC3", GLTF_WANT_F32, &count, &scales);
    if (is_read && count != NONE) {
        *n = count;
        is_read = compose_instances(g, &attributes, count, translations, rotations, scales, list);
    }
    free(translations);
    free(rotations);
    free(scales);
    return is_read;
}

static bool check_cap(const json_place *node, size_t n)
{
    return n < GLTF_INSTANCE_CAP ||
           json_fail(node, FACET_UNSUPPORTED, "brings the instances above %zu", GLTF_INSTANCE_CAP);
}

static bool add_instances(gltf *g, const json_place *node, const gltf_mesh *m, gltf_matrix world)
{
    for (size_t i = 0; i < m->n_parts; i++) {
        instance in = {.mesh = m->parts[i].mesh};
        for (int r = 0; r < 3; r++) {
            const double reach = m->parts[i].extent*(fabs(world[r][0]) + fabs(world[r][1]) + fabs(world[r][2])) +
                                 fabs(world[r][3]);
            if (!(reach <= GLTF_EXTENT_CAP))
                return json_fail(node, FACET_BAD_VALUE, "reaches %g m; must stay within %g m", reach, GLTF_EXTENT_CAP);
            for (int c = 0; c < 4; c++) in.to_world[r][c] = (float)world[r][c];
            for (int c = 0; c < 4; c++)
                if (!isfinite(in.to_world[r][c]))
                    return json_fail(node, FACET_BAD_VALUE, "its transform is too large for single precision");
        }
        if (!check_cap(node, g->scene->n_instances)) return false;
        if (scene_add_instance(g->scene, &in, NULL)) return gltf_no_memory(node);
    }
    return true;
}

/* ---- FACET_shape ---------------------------------------------------------------------------------- */

/* The scale of a matrix that turns, mirrors and scales evenly; negative if it is no such matrix. */
static double similarity_scale(gltf_matrix m)
{
    double length[3], dot = 0;
    for (int c = 0; c < 3; c++) length[c] = sqrt(m[0][c]*m[0][c] + m[1][c]*m[1][c] + m[2][c]*m[2][c]);
    const double scale = (length[0] + length[1] + length[2])/3;
    for (int c = 0; c < 3; c++) {
        const int d = (c + 1)%3;
        const double product = fabs(m[0][c]*m[0][d] + m[1][c]*m[1][d] + m[2][c]*m[2][d]);
        if (product > dot) dot = product;
        if (fabs(length[c] - scale) > SIMILARITY_TOLERANCE*scale) return -1;
    }
    return dot <= SIMILARITY_TOLERANCE*scale*scale ? scale : -1;
}

static bool add_sphere(gltf *g, const json_place *node, double radius, size_t surface, gltf_matrix world)
{
    const double scale = similarity_scale(world);
    if (scale < 0)
        return json_fail(node, FACET_BAD_VALUE,
                         "a FACET_shape sphere needs the same scale along all axes, without shear");
    sphere s = {.radius = (float)(radius*scale), .material = surface};
    double reach = radius*scale;
    for (int k = 0; k < 3; k++) {
        s.center[k] = (float)world[k][3];
        if (fabs(world[k][3]) + radius*scale > reach) reach = fabs(world[k][3]) + radius*scale;
    }
    if (!(reach <= GLTF_EXTENT_CAP))
        return json_fail(node, FACET_BAD_VALUE, "reaches %g m; must stay within %g m", reach, GLTF_EXTENT_CAP);
    if (!(s.radius > 0)) {
        gltf_warn(g, node, "the sphere's radius in the world is 0: left out");
        return true;
    }
    if (!check_cap(node, g->scene->n_spheres)) return false;
    return !scene_add_sphere(g->scene, &s, NULL) || gltf_no_memory(node);
}

/* {"sphere": {"radius": r}, "material": i} */
static bool read_shape(gltf *g, const json_place *node, bool *is_sphere, double *radius, size_t *surface)
{
    gltf_extension e;
    json_place shape;
    size_t number = NONE;
    *is_sphere = false;
    if (!gltf_read_extension(node, "FACET_shape", &e)) return false;
    if (!e.body.value) return true;
    *radius = 0;
    if (!json_read_object(&e.body, "sphere", &shape) || !json_want_present(&shape) ||
        !json_read_number(&shape, "radius", 0, FLT_MAX, radius) ||
        !json_read_index(&e.body, "material", json_count(&g->materials), "materials", &number))
        return false;
    const json_place radius_place = json_member(&shape, "radius");
    if (!json_want_present(&radius_place)) return false;
    if (!(*radius > 0)) return json_fail(&radius_place, FACET_BAD_VALUE, "is 0; must be above 0");
    *is_sphere = true;
    return gltf_use_material(g, number, surface);
}

/* ---- Nodes ---------------------------------------------------------------------------------------- */

/* Section 3.7.3.3: a skinned mesh is placed by its joints alone. */
static bool add_skinned(gltf *g, const json_place *node, size_t mesh_number, size_t skin)
{
    gltf_pose pose;
    const gltf_mesh *m;
    gltf_matrix identity = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    if (!gltf_read_pose(g, skin, &pose)) return false;
    const bool is_added = gltf_use_mesh(g, mesh_number, node, &pose, &m) && add_instances(g, node, m, identity);
    free(pose.joints);
    return is_added;
}

/* The node's mesh and sphere, once per instance. */
static bool add_surfaces(gltf *g, const json_place *node, gltf_matrix world)
{
    size_t mesh_number = NONE, skin = NONE, n, surface = NONE;
    gltf_matrix *list;
    const gltf_mesh *m = NULL;
    bool is_sphere;
    double radius = 0;
    if (!json_read_index(node, "mesh", g->n_meshes, "meshes", &mesh_number) ||
        !json_read_index(node, "skin", json_count(&g->skins), "skins", &skin) ||
        !read_shape(g, node, &is_sphere, &radius, &surface))
        return false;
    if (mesh_number != NONE && skin != NONE) return add_skinned(g, node, mesh_number, skin);
    if (mesh_number == NONE && !is_sphere) return true;
    if (mesh_number != NONE && !gltf_use_mesh(g, mesh_number, node, NULL, &m)) return false;
    if (!read_instancing(g, node, &list, &n)) return false;
    bool is_added = true;
    for (size_t i = 0; is_added && i < n; i++) {
        gltf_matrix place;
        if (list) gltf_multiply(world, list[i], place);
        else memcpy(place, world, sizeof place);
        if (m) is_added = add_instances(g, node, m, place);
        if (is_added && is_sphere) is_added = add_sphere(g, node, radius, surface, place);
    }
    free(list);
    return is_added;
}

static bool add_node(gltf *g, size_t i)
{
    const json_place place = json_element(&g->nodes, i);
    size_t camera_number = NONE;
    if (!json_read_index(&place, "camera", json_count(&g->cameras), "cameras", &camera_number)) return false;
    if (camera_number != NONE && !gltf_add_camera(g, &place, camera_number, g->node[i].world)) return false;
    return gltf_add_light(g, &place, g->node[i].world) && add_surfaces(g, &place, g->node[i].world);
}

/* Puts the list's nodes on the stack so that the first comes off first. */
static bool push_nodes(gltf *g, const json_place *list, size_t *stack, size_t *depth)
{
    for (size_t i = json_count(list); i-- > 0;) {
        const json_place place = json_element(list, i);
        if (!json_index_here(&place, g->n_nodes, "nodes", &stack[*depth])) return false;
        (*depth)++;
    }
    return true;
}

/* Depth first, children in their order.  Roots are distinct and nodes have one parent, so that no node
 * comes twice and the stack never holds more than all. */
static bool add_trees(gltf *g, size_t *stack, size_t depth)
{
    while (depth > 0) {
        const size_t i = stack[--depth];
        const json_place place = json_element(&g->nodes, i), children = json_member(&place, "children");
        if (!add_node(g, i) || !push_nodes(g, &children, stack, &depth)) return false;
    }
    return true;
}

/* The roots of the default scene: `scene`, else the first scene, else all roots of a file without scenes. */
static bool find_roots(gltf *g, size_t *stack, size_t *depth)
{
    size_t number = NONE;
    json_place roots;
    if (!json_read_index(&g->root, "scene", json_count(&g->scenes), "scenes", &number)) return false;
    if (number == NONE && json_count(&g->scenes) == 0) {
        for (size_t i = g->n_nodes; i-- > 0;)
            if (g->node[i].parent == NONE) stack[(*depth)++] = i;
        return true;
    }
    const json_place place = json_element(&g->scenes, number == NONE ? 0 : number);
    if (!json_read_array(&place, "nodes", &roots)) return false;
    if (json_count(&roots) > g->n_nodes)
        return json_fail(&roots, FACET_BAD_FILE, "lists %zu nodes, but there are %zu", json_count(&roots), g->n_nodes);
    for (size_t i = 0; i < json_count(&roots); i++) {
        const json_place root = json_element(&roots, i);
        size_t node;
        if (!json_index_here(&root, g->n_nodes, "nodes", &node)) return false;
        if (g->node[node].parent != NONE)
            return json_fail(&root, FACET_BAD_FILE, "is %zu, a child of nodes[%zu]; scenes list roots only", node,
                             g->node[node].parent);
        if (g->node[node].is_listed) return json_fail(&root, FACET_BAD_FILE, "lists nodes[%zu] again", node);
        g->node[node].is_listed = true;
    }
    return push_nodes(g, &roots, stack, depth);
}

bool gltf_build_scene(gltf *g)
{
    size_t *stack = malloc((g->n_nodes + 1)*sizeof *stack), depth = 0;
    if (!stack) return gltf_no_memory(&g->root);
    const bool is_built = find_roots(g, stack, &depth) && add_trees(g, stack, depth);
    free(stack);
    return is_built;
}
