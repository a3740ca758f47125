/* test_tracer.c: rays neither leak through closed surfaces nor meet the surface they leave; instances are what they
 * stand for; veils let through the share that their opacity says.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/surface.h"
#include "render/tracer.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

static const uint32_t n_rays = 1000000/SAMPLE_DIVISOR;

/* NULL: small scenes by the list; a name: all by the tree. */
static const char *isa;

static tracer *trace_with(const scene *s, const char *name)
{
    tracer *t = NULL;
    facet_error why = {0};
    if (tracer_create(s, name, 1, surface_opacity, s, &t, &why)) fail_msg("%s: %s", why.place, why.text);
    return t;
}

static tracer *trace(const scene *s)
{
    return trace_with(s, isa);
}

/* Embree's best for single rays. */
static const char *tree_isa(void)
{
    scene *s = build_scene();
    const size_t mat = build_material(s, "lambert kd=.5", 0, false);
    build_instance(s, build_zone(s, mat, 1, -1, 8, 8, false), NULL); /* too many triangles for the list */
    tracer *t = trace_with(s, NULL);
    const char *name = tracer_isa(t);
    tracer_destroy(t);
    scene_destroy(s);
    return name;
}

static real3 direction_of(draws *d)
{
    double v[3];
    draw_direction(d, v);
    const float sign = draw(d) < 0.5 ? -1.0f : 1.0f;
    return make3((float)v[0], (float)v[1], sign*(float)v[2]);
}

static ray ray_of(real3 from, real3 towards)
{
    return (ray){.origin = {from.x, from.y, from.z}, .direction = {towards.x, towards.y, towards.z}, .t_max = INFINITY};
}

static int setup(void **state)
{
    (void)state;
    tracer_prepare_thread();
    return 0;
}

static int setup_tree(void **state)
{
    isa = tree_isa();
    return setup(state);
}

/* ---- Leaving a surface --------------------------------------------------------------------------------------- */

/* A random triangle and sphere of this size this far from the origin; every ray that leaves one of them, by
 * surface_leave, must not meet it again. */
static uint32_t self_hits(double scale, double distance, bool is_shared, uint64_t seed, uint32_t n)
{
    draws d = {seed};
    uint32_t n_hits = 0;
    enum { RAYS = 500 }; /* from each scene */
    for (uint32_t made = 0; made < n; made += RAYS) {
        scene *s = build_scene();
        const size_t mat = build_material(s, "lambert kd=.5", 0, false);
        const float offset[3] = {(float)(distance*draw_between(&d, -1, 1)),
                                 (float)(distance*draw_between(&d, -1, 1)),
                                 (float)(distance*draw_between(&d, -1, 1))};
        float corners[3][3];
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                corners[i][k] = (float)(scale*draw_between(&d, -1, 1)) + (is_shared ? 0 : offset[k]);
        static const uint32_t triangle[1][3] = {{0, 1, 2}};
        const size_t mesh_index = build_mesh(s, mat, (const float(*)[3])corners, 3, triangle, 1);
        const float move[3][4] = {{1, 0, 0, offset[0]}, {0, 1, 0, offset[1]}, {0, 0, 1, offset[2]}};
        const float away[3][4] = {{1, 0, 0, 1e9f}, {0, 1, 0, 0}, {0, 0, 1, 0}};
        build_instance(s, mesh_index, is_shared ? move : NULL);
        if (is_shared) build_instance(s, mesh_index, away); /* a second user makes it an instance */
        build_sphere(s, mat, offset[0] + (float)(5*scale), offset[1], offset[2], (float)scale);
        tracer *t = trace(s);
        for (int i = 0; i < RAYS; i++) {
            /* From outside at a random point of the triangle or at the sphere. */
            const float u = (float)draw(&d), v = (float)draw(&d)*(1 - u);
            const real3 target =
                i & 1 ? make3(s->spheres[0].center[0], s->spheres[0].center[1], s->spheres[0].center[2])
                      : add3(make3(move[0][3], move[1][3], move[2][3]),
                             add3(add3(scale3(1 - u - v, vector_of(corners[0])), scale3(u, vector_of(corners[1]))),
                                  sub3(scale3(v, vector_of(corners[2])),
                                       is_shared ? make3(0, 0, 0) : vector_of(offset))));
            const real3 way = direction_of(&d);
            const ray in = ray_of(madd3(target, -3*(float)scale, way), way);
            hit h;
            if (!tracer_intersect(t, &in, &h)) continue;
            const surface at = surface_of_hit(s, &in, &h, neg3(way));
            const real3 out = direction_of(&d);
            const ray next = ray_of(surface_leave(&at, out), out);
            hit again;
            if (!tracer_intersect(t, &next, &again) || again.instance != h.instance || again.primitive != h.primitive)
                continue;
            /* A ray into a sphere rightly meets its far side, 2 r cos away. */
            const float cos_inward = -dot3(out, at.normal);
            if (h.instance < s->n_instances || again.t < (float)scale*cos_inward || cos_inward < 0) n_hits++;
        }
        tracer_destroy(t);
        scene_destroy(s);
    }
    return n_hits;
}

static void rays_that_leave_a_surface_do_not_meet_it(void **state)
{
    (void)state;
    static const double scales[] = {1e-3, 1, 1e5}, distances[] = {0, 10, 1e4};
    uint32_t n_hits = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            for (int is_shared = 0; is_shared < 2; is_shared++) {
                const uint32_t some = self_hits(scales[i], distances[j]*scales[i], is_shared, (uint64_t)(i*3 + j),
                                                n_rays/18);
                if (some)
                    print_message("  scale %g, distance %g, shared %d: %u\n", scales[i], distances[j]*scales[i],
                                  is_shared, some);
                n_hits += some;
            }
    assert_int_equal(n_hits, 0);
}

/* ---- Watertight ---------------------------------------------------------------------------------------------- */

/* Every ray from inside a closed, bumpy mesh meets it; half of the rays are aimed at points of its edges. */
static void nothing_leaks_out_of_a_closed_mesh(void **state)
{
    (void)state;
    scene *s = build_scene();
    const size_t mat = build_material(s, "lambert kd=.5", 0, false);
    const size_t index = build_zone(s, mat, 1, -1, 40, 60, true);
    mesh *m = &s->meshes[index];
    for (size_t i = 0; i < m->n_vertices; i++)
        for (int k = 0; k < 3; k++) m->positions[i][k] *= 1 + 0.05f*(float)((i*2654435761u >> 8)%100)/100;
    /* The poles are rings of one radius-zero circle each: their vertices must stay together. */
    for (size_t i = 0; i < 60; i++)
        for (int k = 0; k < 3; k++) {
            m->positions[i][k] = k == 1 ? 1.0f : 0.0f;
            m->positions[m->n_vertices - 1 - i][k] = k == 1 ? -1.0f : 0.0f;
        }
    build_instance(s, index, NULL);
    tracer *t = trace(s);
    draws d = {7};
    uint32_t leaked = 0;
    for (uint32_t i = 0; i < n_rays; i++) {
        const real3 from = scale3(0.3f*(float)draw(&d), direction_of(&d));
        real3 way = direction_of(&d);
        if (i & 1) {
            const uint32_t *v = m->triangles[draw_bits(&d)%m->n_triangles];
            const float along = (float)draw(&d);
            way = sub3(
                add3(scale3(along, vector_of(m->positions[v[0]])), scale3(1 - along, vector_of(m->positions[v[1]]))),
                from);
        }
        const ray r = ray_of(from, way);
        hit h;
        leaked += !tracer_intersect(t, &r, &h);
    }
    assert_int_equal(leaked, 0);
    tracer_destroy(t);
    scene_destroy(s);
}

/* ---- Instances ----------------------------------------------------------------------------------------------- */

static const float placements[3][3][4] = {
    {{1, 0, 0, -2}, {0, 1, 0, 0}, {0, 0, 1, 0}},
    {{-1, 0, 0, 2}, {0, 1, 0, 0.5f}, {0, 0, 1, 0}},                /* mirrored */
    {{0.6f, -0.8f, 0, 0}, {1.6f, 1.2f, 0.3f, 2}, {0, 0, 0.5f, 1}}, /* turned, stretched, sheared */
};

/* A tetrahedron-like zone with flat faces: fronts outside. */
static scene *placed(bool is_shared)
{
    scene *s = build_scene();
    const size_t mat = build_material(s, "lambert kd=.5", 0, false);
    size_t index = build_zone(s, mat, 1, -1, 5, 7, false);
    for (int i = 0; i < 3; i++) {
        if (!is_shared && i) index = build_zone(s, mat, 1, -1, 5, 7, false);
        build_instance(s, index, placements[i]);
    }
    return s;
}

static void instances_are_their_flattened_copies(void **state)
{
    (void)state;
    scene *shared = placed(true), *flat = placed(false);
    tracer *a = trace(shared), *b = trace(flat);
    draws d = {3};
    uint32_t n_hits = 0, differ = 0, backs = 0;
    for (uint32_t i = 0; i < n_rays/5; i++) {
        const real3 way = direction_of(&d);
        const ray r = ray_of(madd3(scale3(3, direction_of(&d)), -10, way), way);
        hit ha, hb;
        const bool is_a = tracer_intersect(a, &r, &ha), is_b = tracer_intersect(b, &r, &hb);
        if (is_a != is_b) differ++;
        if (!is_a || !is_b) continue;
        n_hits++;
        /* Edges and grazing rays may fall to a neighbour; the distance tells 1e-4 of the ray's length. */
        if (kabs(ha.t - hb.t) > 2e-3f) differ++;
        if (ha.instance != hb.instance || ha.primitive != hb.primitive) continue;
        const surface sa = surface_of_hit(shared, &r, &ha, neg3(way)), sb = surface_of_hit(flat, &r, &hb, neg3(way));
        backs += !sa.is_front || !sb.is_front;
        assert_true(length3(sub3(sa.position, sb.position)) < 1e-3f);
        assert_true(dot3(sa.normal, sb.normal) > 0.9999f);
    }
    print_message("  %u hits, %u differ, %u from behind\n", n_hits, differ, backs);
    assert_true(n_hits > n_rays/100);
    assert_true(differ <= n_hits/5000);
    assert_int_equal(backs, 0); /* closed meshes seen from outside, the mirrored one too */
    tracer_destroy(a);
    tracer_destroy(b);
    scene_destroy(shared);
    scene_destroy(flat);
}

static void a_singular_instance_is_not_there(void **state)
{
    (void)state;
    static const float flat[3][4] = {{1, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 1, 0}};
    scene *s = build_scene();
    const size_t index = build_zone(s, build_material(s, "lambert kd=.5", 0, false), 1, -1, 5, 7, false);
    build_instance(s, index, flat);
    build_instance(s, index, placements[0]);
    tracer *t = trace(s);
    const ray r = ray_of(make3(0, 5, 0.1f), make3(0, -1, 0));
    hit h;
    assert_false(tracer_intersect(t, &r, &h));
    tracer_destroy(t);
    scene_destroy(s);
}

/* ---- Spheres ------------------------------------------------------------------------------------------------- */

static void spheres_are_met_from_outside_and_from_inside(void **state)
{
    (void)state;
    draws d = {11};
    for (int i = 0; i < 2000/SAMPLE_DIVISOR; i++) {
        const float radius = (float)draw_log(&d, 1e-3, 1e4), x = radius*(float)draw_between(&d, -3, 3);
        scene *s = build_scene();
        build_sphere(s, build_material(s, "lambert kd=.5", 0, false), x, 0, 0, radius);
        tracer *t = trace(s);
        const real3 way = direction_of(&d), center = make3(x, 0, 0);
        const ray out = ray_of(center, way), in = ray_of(madd3(center, -4*radius, way), way);
        hit h;
        assert_true(tracer_intersect(t, &out, &h));
        assert_int_equal(h.instance, 0);
        assert_true(kabs(h.t - radius) <= 1e-4f*radius);
        surface at = surface_of_hit(s, &out, &h, neg3(way));
        assert_false(at.is_front);
        assert_true(dot3(at.normal, way) > 0.999f);
        assert_true(tracer_intersect(t, &in, &h));
        assert_true(kabs(h.t - 3*radius) <= 1e-4f*radius);
        at = surface_of_hit(s, &in, &h, neg3(way));
        assert_true(at.is_front);
        assert_true(dot3(at.normal, way) < -0.999f);
        assert_true(tracer_occluded(t, &in));
        ray early = in;
        early.t_max = 2.9f*radius;
        assert_false(tracer_occluded(t, &early));
        tracer_destroy(t);
        scene_destroy(s);
    }
}

/* ---- Veils --------------------------------------------------------------------------------------------------- */

/* n rays with different seeds through a quad of constant alpha: met with a frequency within 4.5 standard deviations of
 * it, by intersection and by occlusion alike, and always the same for the same seed. */
static void a_veil_is_met_as_often_as_it_is_opaque(void **state)
{
    (void)state;
    static const unsigned char alphas[] = {0, 1, 64, 128, 200, 254, 255};
    const uint32_t n = 100000/SAMPLE_DIVISOR;
    for (size_t i = 0; i < sizeof alphas; i++) {
        const unsigned char texel[4] = {255, 255, 255, alphas[i]};
        scene *s = build_scene();
        const size_t mat = build_gltf_material(s, 1, 0, 1);
        s->materials[mat].alpha = ALPHA_BLEND;
        s->materials[mat].base_color_texture.texture = build_texture(s, 1, 1, texel, true);
        build_quad(s, mat, (const float[3]){-1, 0, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
        tracer *t = trace(s);
        draws d = {i};
        uint32_t met = 0;
        for (uint32_t k = 0; k < n; k++) {
            ray r = ray_of(make3((float)draw_between(&d, -.9, .9), 1, (float)draw_between(&d, -.9, .9)),
                           make3(0, -1, 0));
            r.seed = (uint32_t)draw_bits(&d);
            hit h;
            const bool is_met = tracer_intersect(t, &r, &h);
            met += is_met;
            assert_int_equal(is_met, tracer_occluded(t, &r));
        }
        const double p = alphas[i]/255.0, sigma = sqrt(p*(1 - p)*n);
        if (fabs(met - p*n) > 4.5*sigma) fail_msg("alpha %d: %u of %u", alphas[i], met, n);
        tracer_destroy(t);
        scene_destroy(s);
    }
}

/* ---- Many rays ----------------------------------------------------------------------------------------------- */

enum { MANY = 4096 };

typedef struct many_rays {
    float of[8][MANY];
    uint32_t seed[MANY];
} many_rays;

typedef struct many_hits {
    float t[MANY], u[MANY], v[MANY];
    uint32_t instance[MANY], primitive[MANY], is_blocked[MANY];
} many_hits;

static rays rays_in(many_rays *r, size_t first)
{
    return (rays){.origin = {r->of[0] + first, r->of[1] + first, r->of[2] + first},
                  .direction = {r->of[3] + first, r->of[4] + first, r->of[5] + first},
                  .t_min = r->of[6] + first,
                  .t_max = r->of[7] + first,
                  .seed = r->seed + first};
}

/* Groups of `width` rays, from the first on. */
static void trace_many(const tracer *t, many_rays *r, size_t width, bool is_coherent, many_hits *h)
{
    for (size_t first = 0; first < MANY; first += width) {
        static float t_of[MANY], u[MANY], v[MANY];
        static uint32_t instances[MANY], primitives[MANY], is_blocked[MANY];
        tracer_nearest(t, width, rays_in(r, first), is_coherent, (hits){t_of, u, v, instances, primitives});
        tracer_blocked(t, width, rays_in(r, first), is_blocked);
        for (size_t i = 0; i < width; i++) {
            const size_t k = first + i;
            const bool is_met = instances[i] != NO_HIT;
            h->t[k] = is_met ? t_of[i] : 0;
            h->u[k] = is_met ? u[i] : 0;
            h->v[k] = is_met ? v[i] : 0;
            h->instance[k] = instances[i];
            h->primitive[k] = is_met ? primitives[i] : 0;
            h->is_blocked[k] = is_blocked[i];
        }
    }
}

static void aim(many_rays *r, draws *d)
{
    for (size_t i = 0; i < MANY; i++) {
        const real3 way = direction_of(d), from = madd3(scale3(1.5f, direction_of(d)), -3, way);
        const float fields[8] = {from.x, from.y, from.z, way.x, way.y, way.z, i%5 ? 0 : 2.5f, i%3 ? INFINITY : 3};
        for (int k = 0; k < 8; k++) r->of[k][i] = fields[k];
        r->seed[i] = (uint32_t)draw_bits(d);
    }
}

static void a_ray_meets_the_same_whoever_is_in_its_packet(void **state)
{
    (void)state;
    static many_rays r, shuffled;
    static many_hits alone, together, mixed;
    static const char *const sets[] = {NULL, "sse2", "avx2", "avx512"};
    for (size_t set = 0; set < sizeof sets/sizeof sets[0]; set++)
        for (int is_small = 0; is_small < 2; is_small++) {
            scene *s = build_scene();
            const size_t mat = build_material(s, "lambert kd=.5", 0, false);
            build_instance(s, build_zone(s, mat, 1, -1, is_small ? 3 : 40, is_small ? 5 : 60, false), placements[1]);
            build_sphere(s, mat, 1, .5f, 0, .4f);
            tracer *t = NULL;
            if (tracer_create(s, sets[set], 1, surface_opacity, s, &t, NULL) == FACET_OK) {
                draws d = {set};
                aim(&r, &d);
                trace_many(t, &r, 1, false, &alone);
                trace_many(t, &r, 256, false, &together);
                assert_memory_equal(&alone, &together, sizeof alone);
                trace_many(t, &r, 1024, true, &together);
                assert_memory_equal(&alone, &together, sizeof alone);
                for (size_t i = 0; i < MANY; i++) { /* 1733 is prime to MANY */
                    const size_t from = i*1733%MANY;
                    for (int k = 0; k < 8; k++) shuffled.of[k][i] = r.of[k][from];
                    shuffled.seed[i] = r.seed[from];
                }
                trace_many(t, &shuffled, 128, false, &mixed);
                uint32_t n_met = 0;
                for (size_t i = 0; i < MANY; i++) {
                    const size_t from = i*1733%MANY;
                    n_met += alone.instance[from] != NO_HIT;
                    assert_true(mixed.t[i] == alone.t[from] && mixed.u[i] == alone.u[from] &&
                                mixed.v[i] == alone.v[from] && mixed.instance[i] == alone.instance[from] &&
                                mixed.primitive[i] == alone.primitive[from] &&
                                mixed.is_blocked[i] == alone.is_blocked[from]);
                }
                assert_true(n_met > MANY/10);
            }
            tracer_destroy(t);
            scene_destroy(s);
        }
}

static void the_list_and_the_tree_meet_the_same(void **state)
{
    (void)state;
    static many_rays r;
    static many_hits by_list, by_tree;
    scene *s = build_scene();
    const size_t mat = build_material(s, "lambert kd=.5", 0, false);
    build_instance(s, build_zone(s, mat, 1, -1, 4, 7, false), placements[2]);
    build_sphere(s, mat, 1, .5f, 0, .4f);
    build_sphere(s, mat, -1, 2.5f, .3f, .9f);
    tracer *list = trace_with(s, NULL), *tree = trace_with(s, tree_isa());
    assert_string_equal(tracer_isa(list), "any");
    draws d = {7};
    uint32_t n_met = 0, n_differ = 0;
    for (int round = 0; round < 50/SAMPLE_DIVISOR + 1; round++) {
        aim(&r, &d);
        trace_many(list, &r, MANY, false, &by_list);
        trace_many(tree, &r, MANY, false, &by_tree);
        for (size_t i = 0; i < MANY; i++) {
            n_met += by_tree.instance[i] != NO_HIT;
            const bool is_same = by_list.instance[i] == by_tree.instance[i] &&
                                 by_list.primitive[i] == by_tree.primitive[i] &&
                                 by_list.is_blocked[i] == by_tree.is_blocked[i];
            /* Rounding decides at edges and outlines alone: 1e-6 of the size, by the lines that rays could meet. */
            if (!is_same) n_differ++;
            else if (by_tree.instance[i] != NO_HIT)
                assert_true(kabs(by_list.t[i] - by_tree.t[i]) <= 1e-4f &&
                            (by_list.instance[i] == s->n_instances || (kabs(by_list.u[i] - by_tree.u[i]) <= 1e-4f &&
                                                                       kabs(by_list.v[i] - by_tree.v[i]) <= 1e-4f)));
        }
    }
    print_message("  %u met, %u differ\n", n_met, n_differ);
    assert_true(n_met > 1000 && n_differ <= n_met/20000);
    tracer_destroy(list);
    tracer_destroy(tree);
    scene_destroy(s);
}

static void all_instruction_sets_meet_the_same_of_a_list(void **state)
{
    (void)state;
    static many_rays r;
    static many_hits first, other;
    scene *s = build_scene();
    const size_t mat = build_material(s, "lambert kd=.5", 0, false);
    build_instance(s, build_zone(s, mat, 1, -1, 4, 7, false), placements[2]);
    build_sphere(s, mat, 1, .5f, 0, .4f);
    tracer *t = trace_with(s, NULL);
    draws d = {8};
    aim(&r, &d);
    for (int k = 0; k < 8; k++) r.of[k][k*64] = k & 1 ? NAN : INFINITY; /* such rays meet nothing */
    for (size_t i = 0; facet_isa_name(i); i++) {
        assert_int_equal(facet_isa_force(facet_isa_name(i)), FACET_OK);
        trace_many(t, &r, MANY, false, i ? &other : &first);
        if (i) assert_memory_equal(&first, &other, sizeof first);
    }
    facet_isa_force(NULL);
    for (int k = 0; k < 6; k++) {
        assert_int_equal(first.instance[k*64], NO_HIT);
        assert_true(first.is_blocked[k*64]);
    }
    tracer_destroy(t);
    scene_destroy(s);
}

static void unknown_instruction_sets_are_refused(void **state)
{
    (void)state;
    scene *s = build_scene();
    tracer *t = NULL;
    facet_error why = {0};
    assert_int_equal(tracer_create(s, "mmx", 1, surface_opacity, s, &t, &why), FACET_UNKNOWN_NAME);
    assert_null(t);
    assert_string_equal(why.place, "isa");
    assert_int_equal(tracer_create(s, NULL, 1, surface_opacity, s, &t, &why), FACET_OK); /* an empty scene is fine */
    const ray r = ray_of(make3(0, 0, 0), make3(0, 0, 1));
    hit h;
    assert_false(tracer_intersect(t, &r, &h));
    tracer_destroy(t);
    tracer_destroy(NULL);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_that_leave_a_surface_do_not_meet_it),
        cmocka_unit_test(nothing_leaks_out_of_a_closed_mesh),
        cmocka_unit_test(instances_are_their_flattened_copies),
        cmocka_unit_test(a_singular_instance_is_not_there),
        cmocka_unit_test(spheres_are_met_from_outside_and_from_inside),
        cmocka_unit_test(a_veil_is_met_as_often_as_it_is_opaque),
    };
    const struct CMUnitTest both[] = {
        cmocka_unit_test(a_ray_meets_the_same_whoever_is_in_its_packet),
        cmocka_unit_test(the_list_and_the_tree_meet_the_same),
        cmocka_unit_test(all_instruction_sets_meet_the_same_of_a_list),
        cmocka_unit_test(unknown_instruction_sets_are_refused),
    };
    const int n_failed = cmocka_run_group_tests_name("the list", tests, setup, NULL) +
                         cmocka_run_group_tests_name("the tree", tests, setup_tree, NULL);
    return n_failed + cmocka_run_group_tests_name("tracer", both, setup, NULL);
}
