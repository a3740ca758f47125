/* test_demo_scene.c: the built-in scene, as the plain data that it is.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "render/demo_mesh.h"
#include "render/demo_scene.h"
#include "render/geometry.h"
#include "render/render.h"

/* Unit vectors and right angles come from one normalisation in float: a few ulp, and a hundred to spare. */
#define UNIT_TOLERANCE 1e-5f

static scene *demo;

static int create_demo(void **state)
{
    (void)state;
    return demo_scene_create(&demo, NULL) != FACET_OK;
}

static int destroy_demo(void **state)
{
    (void)state;
    scene_destroy(demo);
    return 0;
}

/* ---- The checks of one mesh ---------------------------------------------------------------------- */

static real3 corner(const mesh *m, size_t triangle, int k)
{
    return vector_of(m->positions[m->triangles[triangle][k]]);
}

static real3 triangle_normal(const mesh *m, size_t i)
{
    const real3 p = corner(m, i, 0);
    return cross3(sub3(corner(m, i, 1), p), sub3(corner(m, i, 2), p));
}

static void check_vertices(const mesh *m)
{
    for (size_t i = 0; i < m->n_vertices; i++) {
        const real3 n = vector_of(m->normals[i]), t = vector_of(m->tangents[i]);
        assert_float_equal(length3(n), 1, UNIT_TOLERANCE);
        assert_float_equal(length3(t), 1, UNIT_TOLERANCE);
        assert_float_equal(dot3(n, t), 0, UNIT_TOLERANCE);
        assert_true(m->tangents[i][3] == 1 || m->tangents[i][3] == -1);
        assert_true(isfinite(length3(vector_of(m->positions[i]))));
        for (int k = 0; k < 2; k++) assert_true(isfinite(m->uv[0][i][k]));
    }
}

static void check_triangles(const mesh *m)
{
    for (size_t i = 0; i < m->n_triangles; i++) {
        for (int k = 0; k < 3; k++) assert_true(m->triangles[i][k] < m->n_vertices);
        const real3 front = normalize3(triangle_normal(m, i));
        assert_true(length3(triangle_normal(m, i)) > 0);
        /* A facet of the finest curve, the rim's half circle in 20 steps, leans 5 degrees from its vertices'
         * normals; at the poles half a sector is added. */
        for (int k = 0; k < 3; k++) assert_true(dot3(front, vector_of(m->normals[m->triangles[i][k]])) > 0.9f);
    }
}

/* ---- Closed surfaces ----------------------------------------------------------------------------- */

typedef struct edge {
    float ends[6]; /* in the order in which one triangle runs along it */
    int direction; /* of that triangle: 1 from the smaller end to the larger, -1 back */
} edge;

static int compare_points(const float *a, const float *b)
{
    for (int k = 0; k < 3; k++)
        if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const edge *x = a, *y = b;
    const int first = compare_points(x->ends, y->ends);
    return first ? first : compare_points(x->ends + 3, y->ends + 3);
}

/* Whether every edge, by the positions of its ends, is run along as often one way as the other. */
static bool is_closed(const mesh *m)
{
    const size_t n = 3*m->n_triangles;
    edge *edges = malloc(n*sizeof *edges);
    assert_non_null(edges);
    for (size_t i = 0; i < n; i++) {
        const float *from = m->positions[m->triangles[i/3][i%3]],
                    *to = m->positions[m->triangles[i/3][(i + 1)%3]];
        const bool is_forward = compare_points(from, to) < 0;
        memcpy(edges[i].ends, is_forward ? from : to, 3*sizeof *from);
        memcpy(edges[i].ends + 3, is_forward ? to : from, 3*sizeof *from);
        edges[i].direction = is_forward ? 1 : -1;
    }
    qsort(edges, n, sizeof *edges, compare_edges);
    bool balanced = true;
    for (size_t i = 0; i < n;) {
        int sum = 0;
        const size_t i0 = i;
        for (; i < n && compare_edges(&edges[i0], &edges[i]) == 0; i++) sum += edges[i].direction;
        balanced = balanced && sum == 0 && i - i0 == 2;
    }
    free(edges);
    return balanced;
}

/* The volume inside a closed mesh, by the divergence theorem; positive if its fronts look outwards. */
static double volume(const mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->n_triangles; i++) sum += (double)dot3(corner(m, i, 0), triangle_normal(m, i))/6;
    return sum;
}

/* ---- Tests --------------------------------------------------------------------------------------- */

static void turned_ball_is_closed_and_has_its_volume(void **state)
{
    (void)state;
    enum { STEPS = 96 };
    outline o = {0};
    mesh m;
    outline_arc(&o, 0, 0, 2, -0.25f, 0.25f, STEPS);
    assert_int_equal(mesh_turn(&o, STEPS, 0, &m), FACET_OK);
    check_vertices(&m);
    check_triangles(&m);
    assert_true(is_closed(&m));
    /* An inscribed polyhedron: short of the ball by less than (pi/STEPS)^2 = 0.11 % in each direction. */
    const double ball = 4*(double)PI*8/3;
    assert_true(volume(&m) < ball && volume(&m) > ball*(1 - 2*0.0011));
    mesh_destroy(&m);
}

static void missing_triangle_opens_a_surface(void **state)
{
    (void)state;
    outline o = {0};
    mesh m;
    outline_arc(&o, 0, 0, 1, -0.25f, 0.25f, 8);
    assert_int_equal(mesh_turn(&o, 8, 0, &m), FACET_OK);
    assert_true(is_closed(&m));
    m.n_triangles--;
    assert_false(is_closed(&m));
    mesh_destroy(&m);
}

static void groove_has_its_depth_and_smooth_walls(void **state)
{
    (void)state;
    outline o = {0};
    const grooved_arc a = {.radius = 1,
                           .from = -0.25f,
                           .to = 0.1f,
                           .groove_from = 0,
                           .groove_to = 0.05f,
                           .wall = 0.01f,
                           .depth = 0.1f,
                           .n_steps = 50,
                           .n_wall_steps = 40};
    outline_grooved_arc(&o, &a);
    float least = 1, most = 0;
    for (size_t i = 0; i < o.n; i++) {
        const outline_point p = o.at[i];
        least = fminf(least, sqrtf(p.x*p.x + p.y*p.y));
        most = fmaxf(most, sqrtf(p.x*p.x + p.y*p.y));
        if (i == 0) continue;
        /* The normal is across the curve: a chord leans from the tangents at its ends by at most the turn between
         * them, below 0.2 radians at these steps. */
        const outline_point q = o.at[i - 1];
        const real3 chord = normalize3(make3(p.x - q.x, p.y - q.y, 0));
        assert_true(fabsf(dot3(chord, make3(p.nx, p.ny, 0))) < 0.2f);
        assert_true(p.nx*q.nx + p.ny*q.ny > 0.98f);
    }
    assert_float_equal(most, 1, UNIT_TOLERANCE);
    assert_float_equal(least, 0.9f, UNIT_TOLERANCE);
}

static void swept_line_looks_up(void **state)
{
    (void)state;
    outline o = {0};
    mesh m;
    outline_line(&o, 3, 0, -3, 0, 2);
    assert_int_equal(mesh_sweep(&o, 2, 10, 0, &m), FACET_OK);
    check_vertices(&m);
    check_triangles(&m);
    for (size_t i = 0; i < m.n_vertices; i++) assert_true(m.normals[i][1] == 1);
    mesh_destroy(&m);
}

static void meshes_are_sound(void **state)
{
    (void)state;
    assert_true(demo->n_meshes > 0);
    for (size_t i = 0; i < demo->n_meshes; i++) {
        check_vertices(&demo->meshes[i]);
        check_triangles(&demo->meshes[i]);
    }
}

/* Glass refracts rightly only in closed bodies. */
static void balls_are_closed(void **state)
{
    (void)state;
    size_t n_closed = 0;
    for (size_t i = 0; i < demo->n_meshes; i++) {
        const mesh *m = &demo->meshes[i];
        const material *mat = &demo->materials[m->material];
        if (mat->kind != SURFACE_BSDF) continue;
        assert_true(is_closed(m));
        assert_true(volume(m) > 0);
        n_closed++;
    }
    assert_int_equal(n_closed, 6); /* five shells and the foot that they share */
}

static void indices_are_in_range_and_everything_is_used(void **state)
{
    (void)state;
    bool material_used[64] = {0}, mesh_used[64] = {0};
    assert_true(demo->n_materials <= 64 && demo->n_meshes <= 64);
    for (size_t i = 0; i < demo->n_meshes; i++) {
        assert_true(demo->meshes[i].material < demo->n_materials);
        material_used[demo->meshes[i].material] = true;
    }
    for (size_t i = 0; i < demo->n_spheres; i++) {
        assert_true(demo->spheres[i].radius > 0);
        assert_true(demo->spheres[i].material < demo->n_materials);
        material_used[demo->spheres[i].material] = true;
    }
    for (size_t i = 0; i < demo->n_instances; i++) {
        assert_true(demo->instances[i].mesh < demo->n_meshes);
        mesh_used[demo->instances[i].mesh] = true;
        /* Turned and moved, not scaled: five products and sums of numbers up to 1. */
        assert_float_equal(map_determinant((const float(*)[4])demo->instances[i].to_world), 1, UNIT_TOLERANCE);
    }
    for (size_t i = 0; i < demo->n_materials; i++) assert_true(material_used[i]);
    for (size_t i = 0; i < demo->n_meshes; i++) assert_true(mesh_used[i]);
}

static void materials_have_names_of_their_own(void **state)
{
    (void)state;
    for (size_t i = 0; i < demo->n_materials; i++)
        assert_int_equal(scene_find_material(demo, demo->materials[i].name), i);
}

static void camera_is_rigid(void **state)
{
    (void)state;
    assert_int_equal(demo->n_cameras, 1);
    const float(*m)[4] = (const float(*)[4])demo->cameras[0].to_world;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            assert_float_equal(dot3(map_column(m, i), map_column(m, j)), i == j ? 1 : 0, UNIT_TOLERANCE);
    assert_float_equal(map_determinant(m), 1, UNIT_TOLERANCE);
}

static void two_scenes_are_the_same(void **state)
{
    (void)state;
    scene *other;
    assert_int_equal(demo_scene_create(&other, NULL), FACET_OK);
    assert_int_equal(other->n_meshes, demo->n_meshes);
    for (size_t i = 0; i < demo->n_meshes; i++) {
        const mesh *a = &demo->meshes[i], *b = &other->meshes[i];
        assert_int_equal(a->n_vertices, b->n_vertices);
        assert_memory_equal(a->positions, b->positions, a->n_vertices*sizeof *a->positions);
        assert_memory_equal(a->normals, b->normals, a->n_vertices*sizeof *a->normals);
    }
    assert_memory_equal(demo->images[0].pixels, other->images[0].pixels,
                        demo->images[0].width*demo->images[0].height*demo->images[0].n_channels);
    scene_destroy(other);
}

static void renders_without_bad_samples(void **state)
{
    (void)state;
    render_settings settings;
    render_settings_defaults(&settings);
    settings.width = 96;
    settings.height = 54;
    settings.spp = 4;
    settings.n_threads = 1;
    render_result result;
    assert_int_equal(render(demo, &settings, &result, NULL), FACET_OK);
    assert_int_equal(result.n_bad, 0);
    /* Exposed for the screen without a correction: the mean lies within two stops of middle grey. */
    double sum = 0;
    const float *pixels = result.picture.pixels;
    const size_t n = 3*result.picture.width*result.picture.height;
    for (size_t i = 0; i < n; i++) sum += (double)pixels[i];
    assert_true(sum/(double)n > 0.18/4 && sum/(double)n < 0.18*4);
    render_result_destroy(&result);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turned_ball_is_closed_and_has_its_volume),
        cmocka_unit_test(missing_triangle_opens_a_surface),
        cmocka_unit_test(groove_has_its_depth_and_smooth_walls),
        cmocka_unit_test(swept_line_looks_up),
        cmocka_unit_test(meshes_are_sound),
        cmocka_unit_test(balls_are_closed),
        cmocka_unit_test(indices_are_in_range_and_everything_is_used),
        cmocka_unit_test(materials_have_names_of_their_own),
        cmocka_unit_test(camera_is_rigid),
        cmocka_unit_test(two_scenes_are_the_same),
        cmocka_unit_test(renders_without_bad_samples),
    };
    return cmocka_run_group_tests(tests, create_demo, destroy_demo);
}
