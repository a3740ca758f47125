/* gltf_node.c: the node hierarchy.  [gltf, sections 3.5.2, 3.5.3, 5.25]
 *
 * Every node has at most one parent, so that the nodes form trees: a second parent, a cycle, and the
 * exponential graphs that both allow are errors.  Nothing recurses; a chain may be as deep as it likes.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

/* The last row of an affine matrix may be off by what six decimal digits leave. */
#define AFFINE_TOLERANCE 1e-4

void gltf_multiply(gltf_matrix a, gltf_matrix b, gltf_matrix product)
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++)
            product[r][c] = a[r][0]*b[0][c] + a[r][1]*b[1][c] + a[r][2]*b[2][c] + (c == 3 ? a[r][3] : 0);
}

bool gltf_compose(const double translation[3], const double rotation[4], const double scale[3], gltf_matrix m)
{
    const double length = sqrt(rotation[0]*rotation[0] + rotation[1]*rotation[1] + rotation[2]*rotation[2] +
                               rotation[3]*rotation[3]);
    if (!(length > 0) || !isfinite(length)) return false;
    const double x = rotation[0]/length, y = rotation[1]/length, z = rotation[2]/length, w = rotation[3]/length;
    const double turn[3][3] = {
        {1 - 2*(y*y + z*z), 2*(x*y - z*w), 2*(x*z + y*w)},
        {2*(x*y + z*w), 1 - 2*(x*x + z*z), 2*(y*z - x*w)},
        {2*(x*z - y*w), 2*(y*z + x*w), 1 - 2*(x*x + y*y)},
    };
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) m[r][c] = turn[r][c]*scale[c];
        m[r][3] = translation[r];
    }
    return true;
}

/* A node's own transform: matrix, or translation, rotation and scale. */
static bool read_local(gltf *g, const json_place *place, gltf_matrix m)
{
    const json_place matrix = json_member(place, "matrix"), turn = json_member(place, "rotation");
    double values[16], translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    if (!json_read_numbers(place, "matrix", 16, -FLT_MAX, FLT_MAX, values) ||
        !json_read_numbers(place, "translation", 3, -FLT_MAX, FLT_MAX, translation) ||
        !json_read_numbers(place, "rotation", 4, -FLT_MAX, FLT_MAX, rotation) ||
        !json_read_numbers(place, "scale", 3, -FLT_MAX, FLT_MAX, scale))
        return false;
    if (!matrix.value)
        return gltf_compose(translation, rotation, scale, m) ||
               json_fail(&turn, FACET_BAD_VALUE, "is zero; must be a unit quaternion");
    if (turn.value || json_member(place, "translation").value || json_member(place, "scale").value)
        gltf_warn(g, place, "has both a matrix and translation, rotation or scale: the matrix is used");
    for (int c = 0; c < 4; c++)
        if (fabs(values[4*c + 3] - (c == 3)) > AFFINE_TOLERANCE)
            return json_fail(&matrix, FACET_BAD_VALUE, "is not affine: its last row must be 0, 0, 0, 1");
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) m[r][c] = values[4*c + r];
    return true;
}

static bool read_children(gltf *g, size_t parent)
{
    const json_place place = json_element(&g->nodes, parent);
    json_place children;
    if (!json_read_array(&place, "children", &children)) return false;
    for (size_t i = 0; i < json_count(&children); i++) {
        const json_place child_place = json_element(&children, i);
        size_t child;
        if (!json_index_here(&child_place, g->n_nodes, "nodes", &child)) return false;
        if (child == parent) return json_fail(&child_place, FACET_BAD_FILE, "makes the node its own child");
        if (g->node[child].parent != NONE)
            return json_fail(&child_place, FACET_BAD_FILE, "is %zu, which is already a child of nodes[%zu]", child,
                             g->node[child].parent);
        g->node[child].parent = parent;
    }
    return true;
}

/* Turns local matrices into world matrices, parents first, and finds cycles: no root leads to them. */
static bool place_nodes(gltf *g, size_t *stack)
{
    size_t depth = 0, n_placed = 0;
    for (size_t i = 0; i < g->n_nodes; i++)
        if (g->node[i].parent == NONE) stack[depth++] = i;
    while (depth > 0) {
        const size_t i = stack[--depth];
        gltf_node *const node = &g->node[i];
        const json_place place = json_element(&g->nodes, i), children = json_member(&place, "children");
        if (node->parent != NONE) {
            gltf_matrix local;
            memcpy(local, node->world, sizeof local);
            gltf_multiply(g->node[node->parent].world, local, node->world);
        }
        for (int k = 0; k < 12; k++)
            if (!(fabs(node->world[k/4][k%4]) <= FLT_MAX))
                return json_fail(&place, FACET_BAD_VALUE,
                                 "its transform in the world is too large for single precision");
        node->is_placed = true;
        n_placed++;
        for (size_t k = 0; k < json_count(&children); k++) {
            const json_place child = json_element(&children, k);
            if (!json_index_here(&child, g->n_nodes, "nodes", &stack[depth])) return false;
            depth++;
        }
    }
    for (size_t i = 0; n_placed < g->n_nodes && i < g->n_nodes; i++) {
        const json_place place = json_element(&g->nodes, i);
        if (!g->node[i].is_placed) return json_fail(&place, FACET_BAD_FILE, "is its own ancestor");
    }
    return true;
}

bool gltf_declare_nodes(gltf *g)
{
    g->n_nodes = json_count(&g->nodes);
    g->node = calloc(g->n_nodes + 1, sizeof *g->node);
    if (!g->node) return gltf_no_memory(&g->root);
    for (size_t i = 0; i < g->n_nodes; i++) g->node[i].parent = NONE;
    for (size_t i = 0; i < g->n_nodes; i++) {
        const json_place place = json_element(&g->nodes, i);
        if (!read_local(g, &place, g->node[i].world) || !read_children(g, i)) return false;
    }
    size_t *stack = malloc((g->n_nodes + 1)*sizeof *stack);
    if (!stack) return gltf_no_memory(&g->root);
    const bool is_placed = place_nodes(g, stack);
    free(stack);
    return is_placed;
}
