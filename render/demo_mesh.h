/* demo_mesh.h: generators of the demo scene's meshes: outlines of lines and arcs, turned or swept into surfaces.
 *
 * An outline is a curve in a plane (x, y) with a unit normal at every point, on the right of the direction of
 * travel.  Where two pieces meet at an angle the corner is kept twice, once with each normal: a crease.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct outline_point {
    float x, y, nx, ny;
} outline_point;

enum { OUTLINE_CAP = 640 };

typedef struct outline {
    size_t n;
    outline_point at[OUTLINE_CAP];
} outline;

/* A straight piece in n_steps steps. */
void outline_line(outline *o, float x0, float y0, float x1, float y1, unsigned n_steps);

/* A piece of a circle, from one angle to another [turns, counter-clockwise from +x], in n_steps steps. */
void outline_arc(outline *o, float cx, float cy, float radius, float from, float to, unsigned n_steps);

/* A circle around the origin with a rounded groove of the given depth between two angles; its walls take up
 * `wall` at either end [turns].  from < groove_from + wall < groove_to - wall < to, or all reversed. */
typedef struct grooved_arc {
    float radius, from, to;
    float groove_from, groove_to, wall, depth;
    unsigned n_steps, n_wall_steps;
} grooved_arc;
void outline_grooved_arc(outline *o, const grooved_arc *arc);

/* The surface that the outline describes when turned around the y axis, x >= 0 being the radius.  Tangents and u
 * run around the axis, v along the outline.  Points on the axis (x = 0) become poles, so that an outline from pole
 * to pole gives a closed surface; fronts are on the outline's right.  FACET_NO_MEMORY. */
facet_status mesh_turn(const outline *o, unsigned n_around, size_t i_material, mesh *result);

/* The surface that the outline, in the plane of z and y, leaves when swept along x from -half_width to half_width.
 * Tangents run along x; (u, v) = (x, z)/uv_size + 1/2. */
facet_status mesh_sweep(const outline *o, float half_width, float uv_size, size_t i_material, mesh *result);

/* A rectangle with corners center +- half_u +- half_v; its front is where half_u x half_v points. */
facet_status mesh_rectangle(const float center[3], const float half_u[3], const float half_v[3], size_t i_material,
                            mesh *result);

#ifdef __cplusplus
}
#endif
