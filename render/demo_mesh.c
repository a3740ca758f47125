/* demo_mesh.c: outlines, and the surfaces made of them.
 * SPDX-License-Identifier: MIT */
#include "render/demo_mesh.h"

#include <assert.h>
#include <stdlib.h>

#include "render/geometry.h"

/* ---- Outlines ------------------------------------------------------------------------------------ */

static void add_point(outline *o, float x, float y, float nx, float ny)
{
    /* A smooth joint of two pieces is one point. */
    if (o->n > 0) {
        const outline_point last = o->at[o->n - 1];
        if (fabsf(last.x - x) + fabsf(last.y - y) < 1e-5f && last.nx*nx + last.ny*ny > 0.9999f) return;
    }
    assert(o->n < OUTLINE_CAP);
    o->at[o->n++] = (outline_point){x, y, nx, ny};
}

void outline_line(outline *o, float x0, float y0, float x1, float y1, unsigned n_steps)
{
    const real3 normal = normalize3(make3(y1 - y0, x0 - x1, 0));
    for (unsigned i = 0; i <= n_steps; i++) {
        const float t = (float)i/(float)n_steps;
        add_point(o, mix(x0, x1, t), mix(y0, y1, t), normal.x, normal.y);
    }
}

void outline_arc(outline *o, float cx, float cy, float radius, float from, float to, unsigned n_steps)
{
    const float side = to > from ? 1.0f : -1.0f;
    for (unsigned i = 0; i <= n_steps; i++) {
        const real2 d = kcossin_turn(mix(from, to, (float)i/(float)n_steps));
        add_point(o, cx + radius*d.x, cy + radius*d.y, side*d.x, side*d.y);
    }
}

/* 0 below 0, 1 above 1, and 6t^5 - 15t^4 + 10t^3 between, whose first two derivatives vanish at both ends. */
static float smooth_step(float t, float *slope)
{
    const float c = kclamp(t, 0, 1);
    *slope = 30*c*c*(1 - c)*(1 - c);
    return c*c*c*(c*(6*c - 15) + 10);
}

/* The point of a grooved arc at an angle. */
static void add_grooved_point(outline *o, const grooved_arc *arc, float angle)
{
    const float side = arc->to > arc->from ? 1.0f : -1.0f;
    float in_slope, out_slope;
    const float in = smooth_step(side*(angle - arc->groove_from)/arc->wall, &in_slope);
    const float out = smooth_step(side*(angle - arc->groove_to)/arc->wall + 1, &out_slope);
    const float r = arc->radius - arc->depth*(in - out);
    /* dr/d(angle), angle in radians: with it the tangent is r' d + r d', and the normal r d - r' d'. */
    const float slope = -arc->depth*side*(in_slope - out_slope)/(arc->wall*TWO_PI);
    const real2 d = kcossin_turn(angle);
    const real3 n = normalize3(make3(r*d.x + slope*d.y, r*d.y - slope*d.x, 0));
    add_point(o, r*d.x, r*d.y, side*n.x, side*n.y);
}

void outline_grooved_arc(outline *o, const grooved_arc *arc)
{
    const float side = arc->to > arc->from ? 1.0f : -1.0f;
    const float stops[6] = {
        arc->from,      arc->groove_from, arc->groove_from + side*arc->wall, arc->groove_to - side*arc->wall,
        arc->groove_to, arc->to};
    for (int k = 0; k < 5; k++) {
        const float share = (stops[k + 1] - stops[k])/(arc->to - arc->from);
        const bool is_wall = k == 1 || k == 3;
        const unsigned n = is_wall ? arc->n_wall_steps : 1 + (unsigned)(share*(float)arc->n_steps);
        for (unsigned i = 0; i <= n; i++) add_grooved_point(o, arc, mix(stops[k], stops[k + 1], (float)i/(float)n));
    }
}

/* ---- Surfaces ------------------------------------------------------------------------------------ */

/* A mesh of n_points by n_across vertices, and room for the two triangles of each cell between them. */
static facet_status allocate_grid(size_t n_points, size_t n_across, size_t i_material, mesh *result)
{
    const size_t n = n_points*n_across;
    mesh m = {.n_vertices = n, .material = i_material};
    m.positions = malloc(n*sizeof *m.positions);
    m.normals = malloc(n*sizeof *m.normals);
    m.tangents = malloc(n*sizeof *m.tangents);
    m.uv[0] = malloc(n*sizeof *m.uv[0]);
    m.triangles = malloc(2*n*sizeof *m.triangles);
    if (!m.positions || !m.normals || !m.tangents || !m.uv[0] || !m.triangles) {
        mesh_destroy(&m);
        return FACET_NO_MEMORY;
    }
    *result = m;
    return FACET_OK;
}

static void set_vertex(mesh *m, size_t i, real3 position, real3 normal, real3 tangent, float u, float v)
{
    const real3 p = position, n = normalize3(normal), t = normalize3(tangent);
    const float values[3][3] = {{p.x, p.y, p.z}, {n.x, n.y, n.z}, {t.x, t.y, t.z}};
    for (int k = 0; k < 3; k++) {
        m->positions[i][k] = values[0][k];
        m->normals[i][k] = values[1][k];
        m->tangents[i][k] = values[2][k];
    }
    m->tangents[i][3] = 1;
    m->uv[0][i][0] = u;
    m->uv[0][i][1] = v;
}

static void add_triangle(mesh *m, size_t a, size_t b, size_t c)
{
    uint32_t *t = m->triangles[m->n_triangles++];
    t[0] = (uint32_t)a;
    t[1] = (uint32_t)b;
    t[2] = (uint32_t)c;
}

/* The two triangles between each pair of neighbouring rows and columns.  Rows that lie on the axis are points, the
 * two rows of a crease coincide: triangles without area are left out. */
static void connect_grid(mesh *m, const outline *o, size_t n_across, bool is_turned)
{
    for (size_t i = 0; i + 1 < o->n; i++) {
        const outline_point p = o->at[i], q = o->at[i + 1];
        if (p.x == q.x && p.y == q.y) continue;
        for (size_t j = 0; j + 1 < n_across; j++) {
            const size_t a = i*n_across + j, b = a + n_across;
            if (!(is_turned && q.x == 0)) add_triangle(m, a, b, b + 1);
            if (!(is_turned && p.x == 0)) add_triangle(m, a, b + 1, a + 1);
        }
    }
}

static float distance(outline_point p, outline_point q)
{
    return ksqrt((q.x - p.x)*(q.x - p.x) + (q.y - p.y)*(q.y - p.y));
}

facet_status mesh_turn(const outline *o, unsigned n_around, size_t i_material, mesh *result)
{
    const size_t n_across = n_around + 1; /* the first meridian twice, with u = 0 and u = 1 */
    const facet_status status = allocate_grid(o->n, n_across, i_material, result);
    if (status) return status;
    float length = 0;
    for (size_t i = 0; i + 1 < o->n; i++) length += distance(o->at[i], o->at[i + 1]);
    float v = 0;
    for (size_t i = 0; i < o->n; i++) {
        const outline_point p = o->at[i];
        if (i > 0) v += distance(o->at[i - 1], p)/length;
        for (size_t j = 0; j < n_across; j++) {
            const float u = (float)j/(float)n_around;
            const real2 d = kcossin_turn(u);
            set_vertex(result, i*n_across + j, make3(p.x*d.x, p.y, p.x*d.y), make3(p.nx*d.x, p.ny, p.nx*d.y),
                       make3(-d.y, 0, d.x), u, v);
        }
    }
    connect_grid(result, o, n_across, true);
    return FACET_OK;
}

facet_status mesh_sweep(const outline *o, float half_width, float uv_size, size_t i_material, mesh *result)
{
    const facet_status status = allocate_grid(o->n, 2, i_material, result);
    if (status) return status;
    for (size_t i = 0; i < o->n; i++)
        for (size_t j = 0; j < 2; j++) {
            const outline_point p = o->at[i];
            const float x = j ? -half_width : half_width; /* the order that puts fronts on the right */
            set_vertex(result, 2*i + j, make3(x, p.y, p.x), make3(0, p.ny, p.nx), make3(1, 0, 0), x/uv_size + 0.5f,
                       p.x/uv_size + 0.5f);
        }
    connect_grid(result, o, 2, false);
    return FACET_OK;
}

facet_status mesh_rectangle(const float center[3], const float half_u[3], const float half_v[3], size_t i_material,
                            mesh *result)
{
    const facet_status status = allocate_grid(2, 2, i_material, result);
    if (status) return status;
    const real3 c = vector_of(center), u = vector_of(half_u), v = vector_of(half_v);
    for (size_t i = 0; i < 4; i++) {
        const float su = i & 1 ? 1.0f : -1.0f, sv = i & 2 ? 1.0f : -1.0f;
        set_vertex(result, i, madd3(madd3(c, su, u), sv, v), cross3(u, v), u, 0.5f + 0.5f*su, 0.5f - 0.5f*sv);
    }
    add_triangle(result, 0, 1, 3);
    add_triangle(result, 0, 3, 2);
    return FACET_OK;
}
