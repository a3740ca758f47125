/* gltf_triangles.c: indices and primitive modes into triangles, and the frames at their corners.
 * [gltf, section 3.7.2.1]
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/gltf_internal.h"

enum { MODE_TRIANGLES = 4, MODE_STRIP = 5 };

/* The primitive's indices, or NULL if it draws its vertices in order; n is how many it draws. */
static bool read_indices(gltf *g, const json_place *place, size_t n_vertices, uint32_t **indices, size_t *n)
{
    const gltf_accessor *a;
    *indices = NULL;
    *n = n_vertices;
    if (!place->value) return true;
    if (!gltf_find_accessor(g, place, &a) ||
        !gltf_want_format(place, a, "SCALAR", GLTF_WANT_U8 | GLTF_WANT_U16 | GLTF_WANT_U32) ||
        !gltf_read_uints(g, place, a, indices))
        return false;
    *n = a->count;
    const uint32_t restart = a->component == GLTF_U8 ? UINT8_MAX : a->component == GLTF_U16 ? UINT16_MAX : UINT32_MAX;
    for (size_t i = 0; i < *n; i++) {
        const uint32_t index = (*indices)[i];
        if (index < n_vertices && index != restart) continue;
        free(*indices);
        *indices = NULL;
        if (index == restart)
            return json_fail(place, FACET_BAD_FILE, "index %zu is %u, the restart value, which glTF forbids", i,
                             (unsigned)index);
        return json_fail(place, FACET_BAD_FILE, "index %zu is %u, but there are %zu vertices", i, (unsigned)index,
                         n_vertices);
    }
    return true;
}

/* The three corners of triangle i, as positions in the list of indices. */
static void triangle_corners(size_t mode, size_t i, size_t corners[3])
{
    if (mode == MODE_TRIANGLES) {
        for (size_t k = 0; k < 3; k++) corners[k] = 3*i + k;
    } else if (mode == MODE_STRIP) {
        corners[0] = i;
        corners[1] = i + 1 + i%2;
        corners[2] = i + 2 - i%2;
    } else {
        corners[0] = i + 1;
        corners[1] = i + 2;
        corners[2] = 0;
    }
}

bool gltf_read_triangles(gltf *g, const json_place *primitive, size_t n_vertices, uint32_t (**triangles)[3],
                         size_t *n_triangles)
{
    const json_place place = json_member(primitive, "indices");
    size_t mode = MODE_TRIANGLES, n;
    uint32_t *indices;
    *triangles = NULL;
    *n_triangles = 0;
    if (!json_read_size(primitive, "mode", SIZE_MAX, &mode)) return false;
    if (!read_indices(g, &place, n_vertices, &indices, &n)) return false;
    const size_t count = mode == MODE_TRIANGLES ? n/3 : n >= 3 ? n - 2 : 0;
    if (count == 0 || (mode == MODE_TRIANGLES && n%3 != 0))
        gltf_warn(g, primitive, "%zu corners make no whole number of triangles: the last are left out", n);
    if (count > GLTF_TRIANGLE_CAP - g->n_triangles) {
        free(indices);
        return json_fail(primitive, FACET_UNSUPPORTED, "brings the triangles above %zu", GLTF_TRIANGLE_CAP);
    }
    uint32_t(*out)[3] = gltf_alloc(g, primitive, count, sizeof *out);
    for (size_t i = 0; out && i < count; i++) {
        size_t corners[3];
        triangle_corners(mode, i, corners);
        for (int k = 0; k < 3; k++) out[i][k] = indices ? indices[corners[k]] : (uint32_t)corners[k];
    }
    free(indices);
    g->n_triangles += count;
    *triangles = out;
    *n_triangles = count;
    return out != NULL;
}

/* ---- Normals and tangents ------------------------------------------------------------------------- */

/* Scales v to unit length; false if it has no direction.  In double, so that no square over- or
 * underflows. */
static bool normalize(float v[3])
{
    const double x = v[0], y = v[1], z = v[2], length = sqrt(x*x + y*y + z*z);
    if (!(length > 0) || !isfinite(length)) return false;
    v[0] = (float)(x/length);
    v[1] = (float)(y/length);
    v[2] = (float)(z/length);
    return true;
}

/* (b - a) x (c - a), whose length is twice the area. */
static void face_normal(const mesh *m, const uint32_t corners[3], double n[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        const double a = m->positions[corners[0]][k];
        u[k] = m->positions[corners[1]][k] - a;
        v[k] = m->positions[corners[2]][k] - a;
    }
    for (int k = 0; k < 3; k++) n[k] = u[(k + 1)%3]*v[(k + 2)%3] - u[(k + 2)%3]*v[(k + 1)%3];
}

/* Replaces the normals that are marked by NaN by that of the largest face at their vertex, or by +z if all
 * faces there are flat. */
static bool mend_normals(gltf *g, const json_place *primitive, mesh *m)
{
    double *largest = gltf_alloc(g, primitive, m->n_vertices, sizeof *largest);
    if (!largest) return false;
    for (size_t i = 0; i < m->n_vertices; i++) {
        float *const n = m->normals[i];
        largest[i] = isnan(n[0]) ? 0 : INFINITY;
        if (!isnan(n[0])) continue;
        n[0] = n[1] = 0;
        n[2] = 1;
    }
    for (size_t i = 0; i < m->n_triangles; i++) {
        double n[3];
        face_normal(m, m->triangles[i], n);
        const double size = n[0]*n[0] + n[1]*n[1] + n[2]*n[2];
        for (int corner = 0; corner < 3; corner++) {
            const uint32_t v = m->triangles[i][corner];
            if (!(size > largest[v])) continue;
            largest[v] = size;
            for (int k = 0; k < 3; k++) m->normals[v][k] = (float)(n[k]/sqrt(size));
        }
    }
    free(largest);
    return true;
}

/* A unit vector at right angles to the unit vector n. */
static void perpendicular(const float n[3], float t[3])
{
    /* The cross product with the axis that n is farthest from. */
    const int k = fabsf(n[0]) <= fabsf(n[1]) && fabsf(n[0]) <= fabsf(n[2]) ? 0 : fabsf(n[1]) <= fabsf(n[2]) ? 1 : 2;
    t[k] = 0;
    t[(k + 1)%3] = -n[(k + 2)%3];
    t[(k + 2)%3] = n[(k + 1)%3];
    normalize(t);
}

bool gltf_tidy_frames(gltf *g, const json_place *primitive, mesh *m)
{
    if (!m->normals) return true;
    bool is_broken = false;
    for (size_t i = 0; i < m->n_vertices; i++)
        if (!normalize(m->normals[i])) {
            m->normals[i][0] = NAN;
            is_broken = true;
        }
    if (is_broken && !mend_normals(g, primitive, m)) return false;
    for (size_t i = 0; m->tangents && i < m->n_vertices; i++) {
        float *const t = m->tangents[i];
        if (!normalize(t)) perpendicular(m->normals[i], t);
        t[3] = t[3] < 0 ? -1.0f : 1.0f;
    }
    return true;
}
