/* test_plain_surfaces.c: the loops that find plain surfaces find what surface_find finds, and all the same bits.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/stages.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

enum { N = LOOP_LANES };

static real3 draw3(draws *d)
{
    return make3((float)draw_between(d, -1, 1), (float)draw_between(d, -1, 1), (float)draw_between(d, -1, 1));
}

/* A mesh of separate triangles, one of them without area, whose normals lean away from the true ones. */
static size_t add_triangles(scene *s, size_t mat, bool has_normals, draws *d)
{
    float positions[3*N][3], normals[3*N][3];
    uint32_t triangles[N][3];
    for (uint32_t i = 0; i < 3*N; i++) {
        const real3 p = draw3(d), n = normalize3(draw3(d));
        memcpy(positions[i], &p, sizeof p);
        memcpy(normals[i], &n, sizeof n);
        triangles[i/3][i%3] = i;
    }
    memcpy(positions[2], positions[1], sizeof positions[1]);
    const size_t index = build_mesh(s, mat, (const float(*)[3])positions, 3*N, (const uint32_t(*)[3])triangles, N);
    if (has_normals) {
        s->meshes[index].normals = malloc(sizeof normals);
        assert_non_null(s->meshes[index].normals);
        memcpy(s->meshes[index].normals, normals, sizeof normals);
    }
    return index;
}

/* Four meshes, flat and smooth, of an opaque and a transmitting material; each in place, and mirrored and stretched. */
static scene *four_meshes(draws *d)
{
    scene *s = build_scene();
    const size_t opaque = build_material(s, "ggx alpha=.3", 0, false),
                 glass = build_material(s, "glass ior=1.5", 0, false);
    const float map[3][4] = {{-2, .3f, 0, 5}, {0, .5f, .1f, -3}, {.2f, 0, 3, 40}};
    for (int k = 0; k < 4; k++) {
        const size_t index = add_triangles(s, k & 1 ? glass : opaque, k & 2, d);
        build_instance(s, index, NULL);
        build_instance(s, index, map);
    }
    return s;
}

static const render_loops *const tables[] = {
    &render_loops_base,
#if defined(__x86_64__)
    &render_loops_avx2,
    &render_loops_avx512,
#endif
};

/* Those that this processor has: the chosen one and all before it. */
static size_t n_tables(void)
{
    size_t n = 1;
    while (tables[n - 1] != render_loops_chosen()) n++;
    return n;
}

/* Roundings of a few 1e-7, which a thin triangle's normal and a bent normal's angle magnify. */
static void assert_near(real3 a, real3 b, float tolerance, const char *what)
{
    if (!(max_abs3(sub3(a, b)) <= tolerance))
        fail_msg("%s: %a %a %a in place of %a %a %a", what, (double)a.x, (double)a.y, (double)a.z, (double)b.x,
                 (double)b.y, (double)b.z);
}

static void compare(const vertex_list *v, uint32_t k, const surface *at, real3 wo)
{
    const float tolerance = 1e-4f;
    assert_near(get3(&v->position, k), at->position, 1e-5f, "position");
    assert_near(get3(&v->normal, k), at->normal, tolerance, "normal");
    assert_near(get3(&v->up, k), at->shading.n, tolerance, "shading normal");
    assert_near(get3(&v->t, k), at->shading.t, tolerance, "tangent");
    assert_near(get3(&v->b, k), at->shading.b, tolerance, "bitangent");
    assert_near(get3(&v->wo, k), to_local(&at->shading, wo), tolerance, "wo");
    assert_true(fabsf(v->offset[k] - at->offset) <= 1e-6f*at->offset);
    assert_true((v->facing[k] > 0) == at->is_front);
}

static void the_loops_find_what_surface_find_finds(void **state)
{
    (void)state;
    draws d = {7};
    scene *s = four_meshes(&d);
    surface_set *set = NULL;
    assert_int_equal(surface_set_create(s, &set), FACET_OK);
    vertex_list *lists[sizeof tables/sizeof *tables];
    plain_block *const block = calloc(1, sizeof *block);
    for (size_t i = 0; i < n_tables(); i++)
        assert_non_null(lists[i] = aligned_alloc(64, (sizeof(vertex_list) + 63)/64*64));
    for (int round = 0; round < 100; round++) {
        float t[N], weights[2][N];
        uint32_t which[2][N], order[N];
        const hits met = {t, weights[0], weights[1], which[0], which[1]};
        real3 wo[N];
        for (uint32_t k = 0; k < N; k++) {
            met.t[k] = 1;
            met.u[k] = (float)draw_between(&d, 0, 1);
            met.v[k] = (float)draw_between(&d, 0, 1)*(1 - met.u[k]);
            met.instance[k] = (uint32_t)(draw_bits(&d)%s->n_instances);
            met.primitive[k] = (k + (uint32_t)round)%N;
            order[k] = k;
            wo[k] = normalize3(draw3(&d));
        }
        for (size_t i = 0; i < n_tables(); i++) {
            memset(lists[i], 0, sizeof *lists[i]);
            lists[i]->n = N;
            for (uint32_t k = 0; k < N; k += 16) { /* a lane after each 15 that another kind of surface has filled */
                assert_int_equal(
                    surface_load_plain(set, met, 15, order + k, block, k, lists[i]->bsdf + k, lists[i]->transmits + k),
                    15);
                for (uint32_t j = k; j < k + 15; j++) {
                    assert_non_null(lists[i]->bsdf[j]);
                    set3(&lists[i]->wi, j, wo[j]);
                }
            }
            tables[i]->meet(lists[i], 0, block);
            assert_memory_equal(lists[i], lists[0], sizeof *lists[i]);
        }
        for (uint32_t k = 0; k < N; k++) {
            const ray r = {.direction = {-wo[k].x, -wo[k].y, -wo[k].z}};
            facet_bsdf own;
            surface at;
            if (k%16 == 15) {
                assert_true(lists[0]->offset[k] == 0 && max_abs3(get3(&lists[0]->up, k)) == 0);
                continue;
            }
            const hit h = {met.t[k], met.u[k], met.v[k], met.instance[k], met.primitive[k]};
            surface_find(set, &r, &h, wo[k], 0, &own, &at);
            compare(lists[0], k, &at, wo[k]);
        }
    }
    for (size_t i = 0; i < n_tables(); i++) free(lists[i]);
    free(block);
    surface_set_destroy(set);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_loops_find_what_surface_find_finds)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
