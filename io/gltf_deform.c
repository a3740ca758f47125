/* gltf_deform.c: morph targets and skins, in the state that the file itself describes (animations are not
 * played).  [gltf, sections 3.7.2.2, 3.7.3]
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

/* ---- Morph targets -------------------------------------------------------------------------------- */

/* base[i][0..2] += weight*target[i], base having n_components per vertex; nothing if either is absent. */
static bool add_target(gltf *g, const json_place *place, float weight, size_t n_vertices, size_t n_components,
                       float *base)
{
    const gltf_accessor *a;
    float *offsets;
    if (!place->value || !base) return true;
    if (!gltf_find_accessor(g, place, &a) ||
        !gltf_want_format(place, a, "VEC3",
                          GLTF_WANT_F32 | GLTF_WANT_I8 | GLTF_WANT_I16 | GLTF_WANT_U8 | GLTF_WANT_U16 |
                              GLTF_WANT_NORM_I8 | GLTF_WANT_NORM_I16 | GLTF_WANT_NORM_U8 | GLTF_WANT_NORM_U16))
        return false;
    if (a->count != n_vertices)
        return json_fail(place, FACET_BAD_FILE, "has %zu elements, but POSITION has %zu", a->count, n_vertices);
    if (!gltf_read_floats(g, place, a, &offsets)) return false;
    for (size_t i = 0; i < n_vertices; i++)
        for (size_t k = 0; k < 3; k++) base[i*n_components + k] += weight*offsets[3*i + k];
    free(offsets);
    return true;
}

bool gltf_apply_morph(gltf *g, const json_place *primitive, const json_place *weights, mesh *m)
{
    json_place targets;
    if (!json_read_array(primitive, "targets", &targets)) return false;
    const size_t n = json_count(&targets);
    if (n == 0 || !weights->value) return true;
    /* Targets without weight cost time too: many skinned nodes may rebuild a mesh that has many. */
    if (!gltf_charge(g, &targets, n, sizeof(float[4]))) return false;
    if (json_count(weights) != n)
        return json_fail(weights, FACET_BAD_FILE, "has %zu weights for %zu morph targets", json_count(weights), n);
    for (size_t i = 0; i < n; i++) {
        const json_place target = json_element(&targets, i), weight_place = json_element(weights, i);
        double weight;
        if (!json_want_object(&target) || !json_number_here(&weight_place, -FLT_MAX, FLT_MAX, &weight)) return false;
        if (weight == 0) continue;
        const json_place position = json_member(&target, "POSITION"), normal = json_member(&target, "NORMAL"),
                         tangent = json_member(&target, "TANGENT");
        const float w = (float)weight;
        if (!add_target(g, &position, w, m->n_vertices, 3, (float *)(void *)m->positions) ||
            !add_target(g, &normal, w, m->n_vertices, 3, (float *)(void *)m->normals) ||
            !add_target(g, &tangent, w, m->n_vertices, 4, (float *)(void *)m->tangents))
            return false;
    }
    return true;
}

/* ---- Skins ---------------------------------------------------------------------------------------- */

/* The inverse bind matrices, 16 numbers each by columns; NULL if there are none, which means identities. */
static bool read_inverse_binds(gltf *g, const json_place *skin, size_t n_joints, float **matrices)
{
    const json_place place = json_member(skin, "inverseBindMatrices");
    const gltf_accessor *a;
    *matrices = NULL;
    if (!place.value) return true;
    if (!gltf_find_accessor(g, &place, &a) || !gltf_want_format(&place, a, "MAT4", GLTF_WANT_F32)) return false;
    if (a->count < n_joints)
        return json_fail(&place, FACET_BAD_FILE, "has %zu matrices for %zu joints", a->count, n_joints);
    return gltf_read_floats(g, &place, a, matrices);
}

bool gltf_read_pose(gltf *g, size_t skin, gltf_pose *pose)
{
    const json_place place = json_element(&g->skins, skin);
    json_place joints;
    float *binds;
    *pose = (gltf_pose){0};
    if (!json_read_array(&place, "joints", &joints) || !json_want_present(&joints)) return false;
    const size_t n = json_count(&joints);
    if (!read_inverse_binds(g, &place, n, &binds)) return false;
    gltf_matrix *const matrices = gltf_alloc(g, &place, n, sizeof *matrices);
    bool is_read = matrices != NULL;
    for (size_t j = 0; is_read && j < n; j++) {
        const json_place joint = json_element(&joints, j);
        size_t node;
        is_read = json_index_here(&joint, g->n_nodes, "nodes", &node);
        if (!is_read) break;
        gltf_matrix bind = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
        for (int r = 0; binds && r < 3; r++)
            for (int c = 0; c < 4; c++) bind[r][c] = binds[16*j + 4*(size_t)c + (size_t)r];
        gltf_multiply(g->node[node].world, bind, matrices[j]);
    }
    free(binds);
    if (!is_read) {
        free(matrices);
        return false;
    }
    pose->joints = matrices;
    pose->n_joints = n;
    return true;
}

/* A vertex's joint matrices, summed with their weights, and the sum of the weights. */
typedef struct blend {
    gltf_matrix matrix;
    double weight;
} blend;

/* Adds the joints of one set (JOINTS_n, WEIGHTS_n); is_present false if the primitive has no such set. */
static bool add_joints(gltf *g, const json_place *attributes, int set, const gltf_pose *pose, size_t n_vertices,
                       blend *blends, bool *is_present)
{
    char names[2][24];
    snprintf(names[0], sizeof names[0], "JOINTS_%d", set);
    snprintf(names[1], sizeof names[1], "WEIGHTS_%d", set);
    const json_place joint_place = json_member(attributes, names[0]), weight_place = json_member(attributes, names[1]);
    *is_present = joint_place.value || weight_place.value;
    if (!*is_present) return true;
    const gltf_accessor *joint_accessor, *weight_accessor;
    if (!json_want_present(&joint_place) || !json_want_present(&weight_place) ||
        !gltf_find_accessor(g, &joint_place, &joint_accessor) ||
        !gltf_find_accessor(g, &weight_place, &weight_accessor) ||
        !gltf_want_format(&joint_place, joint_accessor, "VEC4", GLTF_WANT_U8 | GLTF_WANT_U16) ||
        !gltf_want_format(&weight_place, weight_accessor, "VEC4",
                          GLTF_WANT_F32 | GLTF_WANT_NORM_U8 | GLTF_WANT_NORM_U16))
        return false;
    if (joint_accessor->count != n_vertices || weight_accessor->count != n_vertices)
        return json_fail(&joint_place, FACET_BAD_FILE, "joints and weights must be as many as positions, %zu",
                         n_vertices);
    uint32_t *joints = NULL;
    float *weights = NULL;
    bool is_read = gltf_read_uints(g, &joint_place, joint_accessor, &joints) &&
                   gltf_read_floats(g, &weight_place, weight_accessor, &weights);
    for (size_t i = 0; is_read && i < 4*n_vertices; i++) {
        if (!(weights[i] > 0)) continue;
        if (joints[i] >= pose->n_joints) {
            is_read = json_fail(&joint_place, FACET_BAD_FILE, "vertex %zu uses joint %u of %zu", i/4,
                                (unsigned)joints[i], pose->n_joints);
            break;
        }
        blend *const b = &blends[i/4];
        b->weight += weights[i];
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 4; c++) b->matrix[r][c] += weights[i]*pose->joints[joints[i]][r][c];
    }
    free(joints);
    free(weights);
    return is_read;
}

/* v' = M v for a direction. */
static void turn_direction(gltf_matrix m, float v[3])
{
    const double in[3] = {v[0], v[1], v[2]};
    for (int r = 0; r < 3; r++) v[r] = (float)(m[r][0]*in[0] + m[r][1]*in[1] + m[r][2]*in[2]);
}

/* Normals go with the cofactors, the inverse transpose up to scale, which exists for singular matrices too. */
static void turn_normal(gltf_matrix m, float v[3])
{
    gltf_matrix cofactors;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            cofactors[r][c] = m[(r + 1)%3][(c + 1)%3]*m[(r + 2)%3][(c + 2)%3] -
                              m[(r + 1)%3][(c + 2)%3]*m[(r + 2)%3][(c + 1)%3];
    const double det = m[0][0]*cofactors[0][0] + m[0][1]*cofactors[0][1] + m[0][2]*cofactors[0][2];
    turn_direction(cofactors, v);
    for (int k = 0; det < 0 && k < 3; k++) v[k] = -v[k];
}

/* Weights need not add up to 1 exactly: they are divided by their sum.  A vertex without weight stays. */
static void apply_blend(const blend *b, mesh *m, size_t i)
{
    if (!(b->weight > 0)) return;
    gltf_matrix t;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 4; c++) t[r][c] = b->matrix[r][c]/b->weight;
    turn_direction(t, m->positions[i]);
    for (int r = 0; r < 3; r++) m->positions[i][r] += (float)t[r][3];
    if (m->normals) turn_normal(t, m->normals[i]);
    if (m->tangents) turn_direction(t, m->tangents[i]);
}

bool gltf_apply_skin(gltf *g, const json_place *attributes, const gltf_pose *pose, mesh *m)
{
    blend *const blends = gltf_alloc(g, attributes, m->n_vertices, sizeof *blends);
    if (!blends) return false;
    bool is_present = true, is_applied = true;
    int set = 0;
    while (is_applied && is_present)
        is_applied = add_joints(g, attributes, set++, pose, m->n_vertices, blends, &is_present);
    if (is_applied && set == 1)
        is_applied = json_fail(attributes, FACET_BAD_FILE, "the node has a skin, but there is no JOINTS_0");
    for (size_t i = 0; is_applied && i < m->n_vertices; i++) apply_blend(&blends[i], m, i);
    free(blends);
    return is_applied;
}
