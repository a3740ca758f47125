/* test_lights.c: lights are drawn with the density that is claimed, and the density of a hit is that of the draw.
 * SPDX-License-Identifier: MIT */
#include "render/lights.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/light_set.h"
#include "render/loop_lanes.h"
#include "render/tracer.h"
#include "tests/draws.h"
#include "tests/receiver_block.h"
#include "tests/scene_builder.h"
#include "verify/chi_square.h"

static const double pi = 3.14159265358979323846;

/* As light_set_create asks; false in all tests but one. */
static bool has_scattered;

static light_set *lights_of(const scene *s)
{
    light_set *set = NULL;
    facet_error why = {0};
    if (light_set_create(s, has_scattered, &set, &why)) fail_msg("%s: %s", why.place, why.text);
    return set;
}

/* receiver_anywhere(splat3(0)) */
static const light_receiver origin = {.around = 1, .width = 1};

static light_sample draw_light(const light_set *set, const light_receiver *to, draws *d)
{
    const uint32_t u[3] = {(uint32_t)draw_bits(d), (uint32_t)draw_bits(d), (uint32_t)draw_bits(d)};
    return light_set_sample(set, to, u);
}

/* ---- Alias tables -------------------------------------------------------------------------------------------- */

/* Exact: what index i keeps of its own cell and gets from others adds up to its probability. */
static void alias_tables_hold_their_probabilities(void **state)
{
    (void)state;
    draws d = {1};
    for (uint32_t n = 1; n < 300; n = n*3/2 + 1) {
        double weights[512], sum = 0, held[512] = {0}, total = 0;
        for (uint32_t i = 0; i < n; i++) sum += weights[i] = i%5 == 3 ? 0 : draw_log(&d, 1e-6, 1e3);
        alias_table t;
        assert_int_equal(alias_table_create(weights, n, &t), FACET_OK);
        for (uint32_t i = 0; i < n; i++) {
            held[i] += (double)t.cells[i].threshold/n;
            held[t.cells[i].alias] += (1 - (double)t.cells[i].threshold)/n;
            total += (double)t.cells[i].probability;
        }
        assert_true(fabs(total - 1) < 1e-6);
        for (uint32_t i = 0; i < n; i++) {
            /* Thresholds are floats: 2^-24 of each of the cells that meet here. */
            assert_true(fabs(held[i] - weights[i]/sum) < 1e-7);
            assert_true(fabs((double)t.cells[i].probability - weights[i]/sum) <= 1e-7*weights[i]/sum);
        }
        alias_table_destroy(&t);
    }
}

static void alias_tables_draw_their_probabilities_and_leave_a_uniform_rest(void **state)
{
    (void)state;
    enum { CELLS = 7, COUNT = 200000 };
    static const double weights[CELLS] = {1, 0, 5, 0.01, 2, 2, 90};
    alias_table t;
    assert_int_equal(alias_table_create(weights, CELLS, &t), FACET_OK);
    draws d = {5};
    double expected[CELLS*8], observed[CELLS*8] = {0};
    for (int i = 0; i < COUNT; i++) {
        uint32_t rest;
        const uint32_t index = alias_table_draw(&t, (uint32_t)draw_bits(&d), &rest);
        observed[index*8 + (rest >> 29)]++;
    }
    for (int i = 0; i < CELLS*8; i++) expected[i] = weights[i/8]/100.01*COUNT/8;
    const chi_square c = chi_square_test(expected, observed, CELLS*8);
    assert_true(c.forbidden == 0);
    assert_true(c.p > 1e-3);
    alias_table_destroy(&t);

    static const double nothing[3] = {0, 0, 0}; /* all equal */
    assert_int_equal(alias_table_create(nothing, 3, &t), FACET_OK);
    for (int i = 0; i < 3; i++) assert_true(fabsf(t.cells[i].probability - 1/3.0f) < 1e-7f);
    alias_table_destroy(&t);
}

/* ---- Densities over directions ------------------------------------------------------------------------------- */

/* Draws n directions to the scene's lights from a point; checks that
 *   - the fraction of draws in each of 24 x 48 cells of directions is the integral of the claimed density over it,
 *     which is found by tracing a grid of directions and asking light_set_pdf_of_hit or light_set_pdf_of_sky;
 *   - a ray to the drawn target meets the emitter with the same density and radiance that the draw reports. */
enum { ROWS = 24, COLUMNS = 48, FINE = SAMPLE_DIVISOR > 1 ? 16 : 32 };

/* The error of the grid's integral, of a cell that an outline crosses and of the whole of a light as small as a cell:
 * it falls with the power 3/2 of FINE. */
#define GRID_ERROR (FINE == 32 ? 0.01 : 0.03)

static int cell_of(real3 w)
{
    const int row = (int)fmin((1 - (double)w.z)/2*ROWS, ROWS - 1);
    const int column = (int)fmin((atan2((double)w.y, (double)w.x)/(2*pi) + 0.5)*COLUMNS, COLUMNS - 1);
    return row*COLUMNS + column;
}

/* The claimed density in a direction, 0 where nothing emits towards `from`. */
static double claimed(const scene *s, const tracer *t, const light_set *set, const light_receiver *to, real3 w,
                      real3 *radiance)
{
    const real3 from = to->position;
    const ray r = {.origin = {from.x, from.y, from.z}, .direction = {w.x, w.y, w.z}, .t_min = 1e-4f, .t_max = INFINITY};
    hit h;
    *radiance = splat3(0);
    if (!tracer_intersect(t, &r, &h)) {
        *radiance = sky_radiance(light_set_sky(set), w);
        return (double)light_set_pdf_of_sky(set, to, sky_place(w));
    }
    const surface at = surface_of_hit(s, &r, &h, neg3(w));
    *radiance = at.emission;
    return max_of3(at.emission) > 0 ? (double)light_set_pdf_of_hit(set, to, &h, &at) : 0;
}

/* The scene is destroyed.  lost: the share of draws that may come without a light (from behind, from inside). */
static void check_densities_to(const char *what, scene *s, const light_receiver *to, double lost)
{
    const real3 from = to->position;
    const uint32_t n = 200000/SAMPLE_DIVISOR;
    light_set *set = lights_of(s);
    tracer *t = NULL;
    assert_int_equal(tracer_create(s, NULL, 1, surface_opacity, s, &t, NULL), FACET_OK);
    static double expected[ROWS*COLUMNS + 1], observed[ROWS*COLUMNS + 1];
    memset(expected, 0, sizeof expected);
    memset(observed, 0, sizeof observed);
    double whole = 0;
    real3 radiance;
    for (int i = 0; i < ROWS*FINE; i++)
        for (int j = 0; j < COLUMNS*FINE; j++) {
            const double z = 1 - 2*(i + .5)/(ROWS*FINE), phi = 2*pi*((j + .5)/(COLUMNS*FINE) - .5),
                         r = sqrt(1 - z*z);
            const real3 w = make3((float)(r*cos(phi)), (float)(r*sin(phi)), (float)z);
            const double pdf = claimed(s, t, set, to, w, &radiance)*4*pi/(ROWS*FINE)/(COLUMNS*FINE);
            expected[cell_of(w)] += pdf;
            whole += pdf;
        }
    draws d = {42};
    double n_none = 0, n_different = 0;
    for (uint32_t i = 0; i < n; i++) {
        const light_sample l = draw_light(set, to, &d);
        if (!(l.pdf > 0)) {
            n_none++;
            continue;
        }
        assert_true(fabsf(length3(l.direction) - 1) < 1e-5f);
        const real3 way = l.is_infinite ? l.direction : normalize3(sub3(l.target, from));
        const double pdf = claimed(s, t, set, to, way, &radiance);
        /* A draw whose target something else hides is fine: the shadow ray will say so.  Rounding may show the ray a
         * neighbouring triangle, or move the hit noticeably at grazing incidence: one in five hundred may differ. */
        ray shadow = {.origin = {from.x, from.y, from.z}, .t_min = 1e-4f, .t_max = 1};
        const real3 along = l.is_infinite ? l.direction : sub3(l.target, from);
        memcpy(shadow.direction, &along, sizeof shadow.direction);
        if (l.is_infinite) shadow.t_max = INFINITY;
        if (tracer_occluded(t, &shadow)) {
            n_none++;
            continue;
        }
        observed[cell_of(l.direction)]++;
        n_different += pdf > 0 && fabs(pdf - (double)l.pdf) > 2e-3*(double)l.pdf;
        if (pdf > 0) assert_true(length3(sub3(radiance, l.radiance)) <= 1e-3f*length3(l.radiance));
    }
    /* The grid's integral has an error of its own, largest for cells that an outline crosses: that share of each cell's
     * own count is added to its variance. */
    double statistic = 0, none = n_none/n;
    int degrees = 0;
    for (int i = 0; i < ROWS*COLUMNS; i++) {
        const double e = expected[i]*n;
        if (e < 5) continue;
        statistic += (observed[i] - e)*(observed[i] - e)/(e + GRID_ERROR*GRID_ERROR*e*e);
        degrees++;
    }
    if (n_different > n/500.0) fail_msg("%s: %g of %u draws have another density", what, n_different, n);
    print_message("  %-32s integral %.4f, without light %.4f, chi^2 %.0f of %d\n", what, whole, none, statistic,
                  degrees);
    assert_true(fabs(whole + none - 1) < GRID_ERROR);
    assert_true(none <= lost);
    assert_true(chi_square_p(statistic, degrees) > 1e-4);
    tracer_destroy(t);
    light_set_destroy(set);
    scene_destroy(s);
}

static void check_densities(const char *what, scene *s, real3 from, double lost)
{
    const light_receiver to = receiver_anywhere(from);
    check_densities_to(what, s, &to, lost);
}

static size_t glow(scene *s, float emission, bool is_double_sided)
{
    return build_material(s, "lambert kd=0", emission, is_double_sided);
}

static void triangles_are_drawn_by_their_solid_angle(void **state)
{
    (void)state;
    static const float corner[3] = {-1, 2, 1}, u[3] = {2, 0, 0}, v[3] = {0, 0, -2};
    scene *s = build_scene();
    build_quad(s, glow(s, 1, true), corner, u, v);
    check_densities("quad, two-sided", s, make3(.2f, 0, .1f), 0);
    s = build_scene(); /* faces up, seen from below: nothing */
    build_quad(s, glow(s, 1, false), corner, u, v);
    check_densities("quad, from behind", s, make3(.2f, 0, .1f), 1);
    s = build_scene();
    build_quad(s, glow(s, 1, false), corner, v, u); /* faces down */
    build_quad(s, glow(s, 9, true), (const float[3]){-3, -1, 0}, (const float[3]){0, 1, .5f},
               (const float[3]){.3f, 0, 1});
    check_densities("two quads", s, make3(.2f, 0, .1f), 0);
    s = build_scene();
    build_quad(s, glow(s, 1, true), corner, u, v);
    check_densities("quad, aslant", s, make3(3, 1.2f, .1f), 0);
}

static void a_scaled_and_mirrored_instance_is_drawn_where_it_is(void **state)
{
    (void)state;
    static const float mirrored[3][4] = {{-2, 0, 0, 1}, {0, 1, 0.2f, 0.5f}, {0, 0, 0.5f, 0}};
    scene *s = build_scene();
    const size_t index = build_box(s, glow(s, 1, false), (const float[3]){-.5f, -.5f, -.5f},
                                   (const float[3]){.5f, .5f, .5f});
    build_instance(s, index, mirrored);
    /* Half of a box's faces look away, and two thirds of the light is on them at most. */
    check_densities("mirrored box", s, make3(-2, 1.5f, 1), 0.7);
}

static void spheres_are_drawn_by_their_cone(void **state)
{
    (void)state;
    scene *s = build_scene();
    build_sphere(s, glow(s, 1, false), 0, 3, 0, 1);
    check_densities("sphere, outside", s, make3(.5f, 0, 0), 0.001);
    s = build_scene();
    build_sphere(s, glow(s, 1, false), 0, 3, 0, 1);
    check_densities("sphere, close", s, make3(0, 1.99f, 0), 0.001);
    s = build_scene();
    build_sphere(s, glow(s, 1, true), 0, .5f, 0, 2);
    check_densities("sphere, inside", s, make3(.5f, 0, 0), 0);
    s = build_scene();
    build_sphere(s, glow(s, 1, false), 0, .5f, 0, 2);
    check_densities("sphere, dark inside", s, make3(.5f, 0, 0), 1);
    s = build_scene();
    build_sphere(s, glow(s, 1, true), 0, 0, 0, 1);
    check_densities("sphere, from its own surface", s, make3(.6f, .8f, 0), 0.001);
}

static scene *ball_scene(void)
{
    scene *s = build_scene();
    const size_t ball = build_zone(s, glow(s, 2, false), 1, -1, 8, 12, false);
    build_instance(s, ball, (const float[3][4]){{1, 0, 0, 3}, {0, 1, 0, 0}, {0, 0, 1, 0}});
    return s;
}

/* All of radiance 1, so that rays that pass an edge by rounding see what the draw says. */
static scene *mixed_scene(int n)
{
    scene *s = build_scene();
    for (int i = 0; i < n; i++) {
        const float angle = (float)(2*pi*i/n), cos = cosf(angle), sin = sinf(angle);
        const float x = 3*cos, y = (float)(i%5 - 2), z = 3*sin, size = .1f + .4f/(float)n*(float)i;
        if (i%4 == 0) build_sphere(s, glow(s, 1, false), x, y, z, .2f);
        else
            build_quad(s, glow(s, 1, i%3 == 0), (const float[3]){x, y, z}, (const float[3]){0, size, .1f},
                       (const float[3]){.3f*sin, 0, -.3f*cos});
    }
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    return s;
}

/* More emitters than are weighed one by one. */
static void many_emitters_are_drawn_as_claimed(void **state)
{
    (void)state;
    check_densities("ball", ball_scene(), make3(.2f, 0, .1f), 0.7);
    check_densities("spheres, quads and sky", mixed_scene(40), make3(.2f, 0, .1f), 0.5);
}

/* ... few and many, by surfaces that prefer some of the directions. */
static void surfaces_draw_emitters_as_claimed(void **state)
{
    (void)state;
    static const float corner[3] = {-1, 2, 1}, u[3] = {2, 0, 0}, v[3] = {0, 0, -2}, other[3] = {-1, -2, 1};
    light_receiver glossy = receiver_anywhere(make3(.2f, 0, .1f));
    glossy.normal = normalize3(make3(1, .5f, .2f));
    glossy.mirror = normalize3(make3(1, .6f, 0));
    glossy.around = RECEIVED_AROUND;
    glossy.broad = 0.1f;
    glossy.width = 0.05f;
    glossy.peak = 1;
    scene *s = build_scene();
    build_quad(s, glow(s, 1, true), corner, u, v);
    build_quad(s, glow(s, 1, true), other, u, v);
    check_densities_to("two quads and a surface", s, &glossy, 0);
    check_densities_to("a few and a surface", mixed_scene(8), &glossy, 0.5);
    check_densities_to("many and a surface", mixed_scene(40), &glossy, 0.5);
}

/* Over all lights they are 1, where any is chosen. */
static void check_sum_of_rates(const light_set *set, light_receivers to, const float *chosen)
{
    uint32_t which[LOOP_LANES];
    float rated[LOOP_LANES];
    double rest[LOOP_LANES], sum[LOOP_LANES] = {0};
    for (uint32_t light = 0; light < set->n_emitters; light++) {
        for (size_t i = 0; i < LOOP_LANES; i++) {
            which[i] = light;
            rated[i] = 1;
        }
        light_set_rate(set, LOOP_LANES, to, (light_choices){which, rated, rest});
        for (size_t i = 0; i < LOOP_LANES; i++) sum[i] += (double)rated[i];
    }
    for (size_t i = 0; i < LOOP_LANES; i++) {
        assert_true(sum[i] < 1 + 1e-5);
        if (chosen[i] > 0) assert_true(sum[i] > 1 - 1e-5);
    }
}

/* They are the probabilities for gloss, and about them for matte surfaces; and the same whatever the lights were chosen
 * with, which matters most. */
static void check_rough_rates(const light_set *set, light_receivers to, uint32_t *which, const float *chosen,
                              const float *rated)
{
    float again[LOOP_LANES];
    double rest[LOOP_LANES], off = 0;
    size_t n = 0;
    for (size_t i = 0; i < LOOP_LANES; i++) again[i] = i == 7 ? 0 : 0.25f;
    light_set_rate(set, LOOP_LANES, to, (light_choices){which, again, rest});
    assert_memory_equal(again, rated, sizeof again);
    for (size_t i = 0; i < LOOP_LANES; i++) {
        if (i == 7 || !(chosen[i] > 0)) continue;
        assert_true(rated[i] > 0 && rated[i] <= 1);
        if (to.peak[i] > 0) assert_true(fabsf(rated[i] - chosen[i]) <= 1e-5f*chosen[i]);
        off += fabs(log((double)(rated[i]/chosen[i])));
        n++;
    }
    print_message("  off by %g on average\n", exp(off/(double)n));
    assert_true(off < (double)n*log(1.5));
}

/* Those that are chosen have the probability that is told of them afterwards, and all of few have 1 together: to a part
 * in 10^7 for each of the products' and sums' rounding. */
static void check_rates(scene *s, draws *d)
{
    light_set *set = lights_of(s);
    static receiver_block block;
    uint32_t u[3][LOOP_LANES], which[LOOP_LANES], *const numbers[3] = {u[0], u[1], u[2]};
    float chosen[LOOP_LANES], rated[LOOP_LANES];
    double rest[LOOP_LANES];
    for (size_t i = 0; i < LOOP_LANES; i++) {
        light_receiver to = receiver_anywhere(
            make3((float)draw_between(d, -.5, .5), (float)draw_between(d, -.5, .5), (float)draw_between(d, -.5, .5)));
        if (set->needs_receivers && i%2) {
            to.normal = to.mirror = normalize3(to.position);
            to.around = RECEIVED_AROUND;
            to.broad = 0.2f;
            to.width = (float)draw_log(d, 1e-4, 1);
            to.peak = 0.1f/to.width;
        }
        put_receiver(&block, i, &to);
        for (int k = 0; k < 3; k++) u[k][i] = (uint32_t)draw_bits(d);
    }
    const light_receivers to = receivers_in(&block);
    light_set_choose(set, LOOP_LANES, to, numbers, (light_choices){which, chosen, rest});
    for (size_t i = 0; i < LOOP_LANES; i++) rated[i] = i == 7 ? 0 : 1;
    light_set_rate(set, LOOP_LANES, to, (light_choices){which, rated, rest});
    assert_true(rated[7] == 0);
    if (light_set_rates_exactly(set)) {
        for (size_t i = 0; i < LOOP_LANES; i++) assert_true(i == 7 || fabsf(rated[i] - chosen[i]) <= 1e-5f*chosen[i]);
        check_sum_of_rates(set, to, chosen);
    } else check_rough_rates(set, to, which, chosen, rated);
    light_set_destroy(set);
    scene_destroy(s);
}

static void lights_are_rated_as_they_are_chosen(void **state)
{
    (void)state;
    static const float corner[3] = {-1, 2, 1}, u[3] = {2, 0, 0}, v[3] = {0, 0, -2};
    draws d = {21};
    for (int round = 0; round < 20; round++)
        for (int n_quads = 0; n_quads <= 3; n_quads++)
            for (int has_sky = n_quads == 0; has_sky < 2; has_sky++) {
                scene *s = build_scene();
                for (int k = 0; k < n_quads; k++)
                    build_quad(s, glow(s, (float)(k + 1), k == 1), (const float[3]){corner[0] + (float)k, 2, 1}, v, u);
                for (int k = 0; k < 3; k++) s->environment.scale[k] = (float)has_sky;
                check_rates(s, &d);
            }
    for (int round = 0; round < 20; round++) {
        check_rates(mixed_scene(8), &d);
        check_rates(mixed_scene(40), &d);
    }
    for (int round = 0; round < 3; round++) check_rates(mixed_scene(1000), &d); /* lights below the top of the tree */
}

/* The mean of what draws bring, each over its probability, is the sum over the lights. */
static void punctual_lights_among_many_bring_their_light(void **state)
{
    (void)state;
    enum { PLACED = 60, DISTANT = 5, COUNT = 200000/SAMPLE_DIVISOR };
    scene *s = build_scene();
    draws d = {9};
    const real3 from = make3(.3f, -.2f, .1f);
    double truth = 0;
    for (int i = 0; i < PLACED + DISTANT; i++) {
        punctual_light light = {.kind = i >= PLACED ? LIGHT_DIRECTIONAL
                                        : i%3     ? LIGHT_SPOT
                                                  : LIGHT_POINT,
                                .direction = {0, -1, 0}};
        for (int k = 0; k < 3; k++) light.position[k] = (float)draw_between(&d, -2, 2);
        for (int k = 0; k < 3; k++) light.intensity[k] = (float)(i + 1);
        light.cos_outer = .3f;
        light.cos_inner = .3001f;
        const real3 way = sub3(from, vector_of(light.position));
        const double d2 = (double)dot3(way, way);
        if (light.kind == LIGHT_DIRECTIONAL) truth += i + 1;
        else if (light.kind == LIGHT_POINT || -(double)way.y > .3002*sqrt(d2)) truth += (i + 1)/d2;
        assert_int_equal(scene_add_light(s, &light, NULL), FACET_OK);
    }
    light_set *set = lights_of(s);
    const light_receiver to = receiver_anywhere(from);
    double sum = 0, squares = 0;
    for (int i = 0; i < COUNT; i++) {
        const light_sample l = draw_light(set, &to, &d);
        if (!(l.pdf > 0)) continue;
        assert_true(l.is_delta);
        const double value = (double)l.radiance.x/(double)l.pdf;
        sum += value;
        squares += value*value;
    }
    const double mean = sum/COUNT, error = sqrt((squares/COUNT - mean*mean)/COUNT);
    print_message("  irradiance %g +- %g, truth %g\n", mean, error, truth);
    assert_true(fabs(mean - truth) < 5*error);
    light_set_destroy(set);
    scene_destroy(s);
}

/* A sphere of 1e-3 at a distance of 1e3 subtends pi 1e-12 sr: the density must be 1 over that although 1 - cos
 * vanishes in single precision, and all draws must hit it. */
static void far_small_spheres_keep_their_solid_angle(void **state)
{
    (void)state;
    scene *s = build_scene();
    build_sphere(s, glow(s, 1, false), 0, 1000, 0, 1e-3f);
    light_set *set = lights_of(s);
    draws d = {1};
    for (int i = 0; i < 1000; i++) {
        const light_sample l = draw_light(set, &origin, &d);
        assert_true(fabs((double)l.pdf*pi*1e-12 - 1) < 1e-5);
        assert_true(l.direction.y > 0.999999f);
        assert_true(fabsf(l.target.y - 1000) < 0.01f);
    }
    light_set_destroy(set);
    scene_destroy(s);
}

/* ---- The sky ------------------------------------------------------------------------------------------------- */

enum { W = 32, H = 16 };

static void sky_maps_are_drawn_by_their_radiance(void **state)
{
    (void)state;
    static float texels[H][W][3];
    draws d = {8};
    for (int i = 0; i < H*W*3; i++) (&texels[0][0][0])[i] = (float)draw_log(&d, .1, 10);
    scene *s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    check_densities("sky, noise", s, splat3(0), 0);

    memset(texels, 0, sizeof texels);
    for (int k = 0; k < 3; k++) texels[5][20][k] = 1000;
    s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    check_densities("sky, a sun of one texel", s, splat3(0), 0);

    memset(texels, 0, sizeof texels);
    for (int k = 0; k < 3; k++) texels[0][0][k] = texels[H - 1][W - 1][k] = 1000; /* at the poles and the seam */
    s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    check_densities("sky, poles and seam", s, splat3(0), 0);

    s = build_scene();
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 2;
    check_densities("sky, constant", s, splat3(0), 0);

    s = build_scene();
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .1f;
    build_quad(s, glow(s, 1, true), (const float[3]){-1, 2, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
    build_sphere(s, glow(s, 3, false), 3, 0, 1, .5f);
    /* Draws of the sky behind the quad or the sphere are hidden: no more than their solid angles, a tenth. */
    check_densities("sky, quad and sphere", s, splat3(0), 0.1);
}

/* The light on a plane that faces +z under the sky, in units of its exact value: from draws of lights and as many
 * uniform directions above it, weighted by the balance heuristic. */
static double irradiance_by_both(const light_set *set, int n, draws *d, double *error)
{
    double sum = 0, squares = 0;
    for (int i = 0; i < n; i++) {
        double v[3], x = 0;
        const light_sample l = draw_light(set, &origin, d);
        if (l.pdf > 0 && l.direction.z > 0)
            x += (double)(luminance(l.radiance)*l.direction.z)/((double)l.pdf + 1/(2*pi));
        draw_direction(d, v);
        const real3 w = make3((float)v[0], (float)v[1], (float)v[2]);
        const double radiance = (double)luminance(sky_radiance(light_set_sky(set), w));
        x += radiance*v[2]/((double)light_set_pdf_of_sky(set, &origin, sky_place(w)) + 1/(2*pi));
        sum += x;
        squares += x*x;
    }
    *error = sqrt((squares/n - sum*sum/n/n)/n);
    return sum/n;
}

static void a_compensated_sky_is_drawn_by_what_exceeds_its_mean(void **state)
{
    (void)state;
    static float texels[H][W][3];
    draws d = {8};
    for (int i = 0; i < H*W; i++)
        for (int k = 0; k < 3; k++) texels[i/W][i%W][k] = i%7 ? .5f : 9;
    has_scattered = true;
    scene *s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    check_densities("sky, compensated", s, splat3(0), 0);
    s = build_scene(); /* nothing exceeds the mean: as without */
    for (int i = 0; i < H*W*3; i++) (&texels[0][0][0])[i] = 2;
    build_sky(s, W, H, &texels[0][0][0]);
    check_densities("sky, even and compensated", s, splat3(0), 0);

    for (int i = 0; i < H*W; i++)
        for (int k = 0; k < 3; k++) texels[i/W][i%W][k] = i%7 ? .5f : 9;
    s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    light_set *compensated = lights_of(s);
    has_scattered = false;
    light_set *plain = lights_of(s);
    int n_undrawn = 0;
    double error, plain_error;
    for (int i = 0; i < 1000; i++) {
        double v[3];
        draw_direction(&d, v);
        const real3 w = make3((float)v[0], (float)v[1], (float)v[2]);
        assert_true(light_set_pdf_of_sky(plain, &origin, sky_place(w)) > 0);
        n_undrawn += light_set_pdf_of_sky(compensated, &origin, sky_place(w)) == 0;
    }
    assert_true(n_undrawn > 100);
    const double a = irradiance_by_both(compensated, 200000, &d, &error),
                 b = irradiance_by_both(plain, 200000, &d, &plain_error);
    assert_true(fabs(a - b) < 5*sqrt(error*error + plain_error*plain_error) && error < plain_error);
    light_set_destroy(plain);
    light_set_destroy(compensated);
    scene_destroy(s);
}

/* Inside every texel with light its density is positive wherever the interpolated radiance is: otherwise light would
 * be found by scattered rays alone and explicit connection would lose it. */
static void no_lit_direction_has_density_zero(void **state)
{
    (void)state;
    static float texels[H][W][3];
    texels[7][3][1] = 5; /* green alone counts as well */
    scene *s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    light_set *set = lights_of(s);
    draws d = {2};
    int n_lit = 0;
    for (int i = 0; i < 200000; i++) {
        double v[3];
        draw_direction(&d, v);
        const real3 w = make3((float)v[0], (float)v[2]*(i & 1 ? 1.0f : -1.0f), (float)v[1]);
        if (!(max_of3(sky_radiance(light_set_sky(set), w)) > 0)) continue;
        n_lit++;
        assert_true(light_set_pdf_of_sky(set, &origin, sky_place(w)) > 0);
    }
    assert_true(n_lit > 500);
    light_set_destroy(set);
    scene_destroy(s);
}

static void a_black_sky_is_no_light_and_bad_texels_are_black(void **state)
{
    (void)state;
    static float texels[H][W][3];
    scene *s = build_scene();
    build_sky(s, W, H, &texels[0][0][0]);
    light_set *set = lights_of(s);
    assert_true(light_set_is_empty(set));
    draws d = {1};
    assert_true(draw_light(set, &origin, &d).pdf == 0);
    assert_true(light_set_pdf_of_sky(set, &origin, sky_place(make3(0, 1, 0))) == 0);
    light_set_destroy(set);

    float *map = s->environment.map.pixels;
    for (int i = 0; i < H*W*3; i++) map[i] = 1;
    map[0] = NAN;
    map[3*W + 1] = INFINITY;
    map[3*2*W + 2] = -1;
    set = lights_of(s);
    assert_int_equal(light_set_sky(set)->n_dropped, 3);
    for (int i = 0; i < 20000; i++) {
        const light_sample l = draw_light(set, &origin, &d);
        assert_true(l.pdf > 0 && l.pdf < 10);
        assert_true(max_of3(l.radiance) <= 1.00001f && l.radiance.x >= 0 && l.radiance.y >= 0 && l.radiance.z >= 0);
    }
    light_set_destroy(set);
    scene_destroy(s);
}

/* u = 0.5 looks to +x, u = 0.75 to +z, v = 0 up. */
static void the_map_is_turned_as_documented(void **state)
{
    (void)state;
    static float texels[H][W][3];
    static const struct {
        int x, y;
        real3 way;
    } spots[] = {{W/2, H/2, {1, 0, 0}},  {W*3/4, H/2, {0, 0, 1}},
                 {W/4, H/2, {0, 0, -1}}, {0, H/2, {-1, 0, 0}},
                 {0, 0, {0, 1, 0}},          {0, H, {0, -1, 0}}};
    for (size_t i = 0; i < sizeof spots/sizeof spots[0]; i++) {
        memset(texels, 0, sizeof texels);
        /* The direction lies on a corner of four texels, or on a pole: light them all. */
        for (int x = 0; x < W; x++)
            for (int y = 0; y < H; y++) {
                const bool is_pole = spots[i].y == 0 || spots[i].y == H;
                const bool is_near_x = is_pole || x == spots[i].x || x == (spots[i].x + W - 1)%W;
                if (is_near_x && (y == spots[i].y || y == spots[i].y - 1)) texels[y][x][0] = 1;
            }
        scene *s = build_scene();
        build_sky(s, W, H, &texels[0][0][0]);
        light_set *set = lights_of(s);
        assert_true(fabsf(sky_radiance(light_set_sky(set), spots[i].way).x - 1) < 1e-4f);
        assert_true(sky_radiance(light_set_sky(set), neg3(spots[i].way)).x < 1e-4f);
        light_set_destroy(set);
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alias_tables_hold_their_probabilities),
        cmocka_unit_test(alias_tables_draw_their_probabilities_and_leave_a_uniform_rest),
        cmocka_unit_test(triangles_are_drawn_by_their_solid_angle),
        cmocka_unit_test(a_scaled_and_mirrored_instance_is_drawn_where_it_is),
        cmocka_unit_test(spheres_are_drawn_by_their_cone),
        cmocka_unit_test(many_emitters_are_drawn_as_claimed),
        cmocka_unit_test(surfaces_draw_emitters_as_claimed),
        cmocka_unit_test(lights_are_rated_as_they_are_chosen),
        cmocka_unit_test(punctual_lights_among_many_bring_their_light),
        cmocka_unit_test(far_small_spheres_keep_their_solid_angle),
        cmocka_unit_test(sky_maps_are_drawn_by_their_radiance),
        cmocka_unit_test(a_compensated_sky_is_drawn_by_what_exceeds_its_mean),
        cmocka_unit_test(no_lit_direction_has_density_zero),
        cmocka_unit_test(a_black_sky_is_no_light_and_bad_texels_are_black),
        cmocka_unit_test(the_map_is_turned_as_documented),
    };
    return cmocka_run_group_tests_name("lights", tests, NULL, NULL);
}
