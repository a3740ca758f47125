/* test_strategies.c: every way to find light, every sampler and any depth of roulette give the same picture.
 *
 * The scene has a bit of all: an area light, a sky, diffuse, GGX, glass, a mirror, a masked and a blended texture.  Its
 * picture is cut into blocks; each block of one estimate is compared with the same block of the other by the difference
 * over its standard error, at a level that the whole test exceeds by chance once in a hundred seeds (the seeds are
 * fixed).
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/scene_builder.h"
#include "verify/chi_square.h"

enum { SIZE = 32, BLOCKS = 4, SIDE = SIZE/BLOCKS };

static const double pi = 3.14159265358979323846;

/* A box of 2 x 2 x 2 without a front wall, lit by a lamp of .8 x .8 under the ceiling and by the sky. */
static scene *room(void)
{
    scene *s = build_scene();
    build_wall(s, "lambert kd=.7", (const float[3]){-1, 0, 1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, -2});
    build_wall(s, "lambert kd=.7", (const float[3]){-1, 2, -1}, (const float[3]){2, 0, 0}, (const float[3]){0, 0, 2});
    build_wall(s, "ggx alpha=.3 ks=.3 kd=.4", (const float[3]){-1, 0, -1}, (const float[3]){2, 0, 0},
               (const float[3]){0, 2, 0});
    build_wall(s, "lambert kd=.6,.1,.1", (const float[3]){-1, 0, 1}, (const float[3]){0, 0, -2},
               (const float[3]){0, 2, 0});
    build_wall(s, "lambert kd=.1,.6,.1", (const float[3]){1, 0, -1}, (const float[3]){0, 0, 2},
               (const float[3]){0, 2, 0});
    build_quad(s, build_material(s, "lambert kd=.5", 4, false), (const float[3]){-.4f, 1.9f, -.4f},
               (const float[3]){.8f, 0, 0}, (const float[3]){0, 0, .8f});
    build_sphere(s, build_material(s, "glass ior=1.5", 0, false), -.45f, .35f, -.1f, .35f);
    build_sphere(s, build_material(s, "ggx alpha=.15 ks=.9,.7,.4", 0, false), .5f, .3f, -.4f, .3f);
    build_sphere(s, build_material(s, "lambert kd=.3", .8f, true), 0, .15f, .5f, .15f);
    build_veil(s, ALPHA_MASK, -.8f, .5f);
    build_veil(s, ALPHA_BLEND, .3f, .6f);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .7f;
    build_camera(s, (const float[3]){0, 1, 4.2f}, (const float[3]){0, .95f, 0}, .55f);
    return s;
}

typedef struct blocks {
    estimate at[BLOCKS*BLOCKS];
} blocks;

static blocks measure_blocks(const scene *s, render_settings r)
{
    blocks b = {0};
    r.crop_w = r.crop_h = SIDE;
    for (size_t i = 0; i < BLOCKS*BLOCKS; i++) {
        r.crop_x = i%BLOCKS*SIDE;
        r.crop_y = i/BLOCKS*SIDE;
        b.at[i] = measure(s, &r);
    }
    return b;
}

/* Two-sided: P(|Z| > bound) = level, by bisection. */
static double normal_bound(double level)
{
    double low = 0, high = 10;
    for (int i = 0; i < 60; i++) {
        const double middle = (low + high)/2;
        *(erfc(middle/sqrt(2)) > level ? &low : &high) = middle;
    }
    return high;
}

/* Fails if a block differs; also checks that the comparison would find 10 % in a block on average. */
static void compare(const char *what, const blocks *a, const blocks *b, int n_comparisons)
{
    const double bound = normal_bound(sidak_level(0.01, n_comparisons*BLOCKS*BLOCKS));
    double worst = 0, mean_a = 0, mean_b = 0, sensitivity = 0;
    for (int i = 0; i < BLOCKS*BLOCKS; i++) {
        const double error = hypot(a->at[i].error, b->at[i].error);
        const double z = (a->at[i].mean - b->at[i].mean)/error;
        if (fabs(z) > fabs(worst)) worst = z;
        mean_a += a->at[i].mean/(BLOCKS*BLOCKS);
        mean_b += b->at[i].mean/(BLOCKS*BLOCKS);
        sensitivity += error/b->at[i].mean/(BLOCKS*BLOCKS);
    }
    print_message("  %-28s %.5f %.5f, worst block %+.2f sigma of %.2f, sigma %.2f %%\n", what, mean_a, mean_b, worst,
                  bound, 100*sensitivity);
    assert_true(fabs(worst) <= bound);
    assert_true(sensitivity <= 0.02*sqrt(SAMPLE_DIVISOR));
}

static void the_three_strategies_and_two_samplers_agree(void **state)
{
    (void)state;
    scene *s = room();
    render_settings r = random_settings(SIZE, SIZE, 256);
    r.depth = 6;
    blocks by[3];
    for (strategy how = STRATEGY_MIS; how <= STRATEGY_IMPLICIT; how++) {
        r.strategy = how;
        r.seed = 10 + (uint32_t)how;
        if (how == STRATEGY_IMPLICIT) r.spp *= 4;
        by[how] = measure_blocks(s, r);
    }
    /* The error that is reported for Sobol' points is what independent samples would have: never too small. */
    r.strategy = STRATEGY_MIS;
    r.sampler = SAMPLER_SOBOL;
    r.spp /= 4;
    const blocks by_sobol = measure_blocks(s, r);
    scene_destroy(s);
    compare("mis, explicit", &by[STRATEGY_MIS], &by[STRATEGY_EXPLICIT], 4);
    compare("mis, implicit", &by[STRATEGY_MIS], &by[STRATEGY_IMPLICIT], 4);
    compare("explicit, implicit", &by[STRATEGY_EXPLICIT], &by[STRATEGY_IMPLICIT], 4);
    compare("random, sobol", &by[STRATEGY_MIS], &by_sobol, 4);
}

/* The comparison can fail: a depth of 2 instead of 6 loses light that it finds. */
static void a_missing_bounce_is_found(void **state)
{
    (void)state;
    scene *s = room();
    render_settings r = random_settings(SIZE, SIZE, 128);
    r.depth = 6;
    const blocks full = measure_blocks(s, r);
    r.depth = 2;
    const blocks less = measure_blocks(s, r);
    scene_destroy(s);
    int n_found = 0;
    for (int i = 0; i < BLOCKS*BLOCKS; i++)
        n_found += full.at[i].mean - less.at[i].mean > 4*hypot(full.at[i].error, less.at[i].error);
    assert_true(n_found > (SAMPLE_DIVISOR > 1 ? 0 : BLOCKS));
}

/* Roulette decides only when a path ends.  In a closed sphere of albedo a that emits 1, the light of up to n events is
 * (1 - a^(n+1))/(1 - a); paths of 300 events meet the roulette at nearly every one of them. */
static void roulette_neither_adds_nor_takes_light(void **state)
{
    (void)state;
    static const uint32_t depths[] = {0, 1, 3, 6, 20, 300};
    for (size_t i = 0; i < sizeof depths/sizeof depths[0]; i++) {
        scene *s = build_scene();
        build_sphere(s, build_material(s, "lambert kd=.95", 1, true), 0, 0, 0, 1);
        build_camera(s, (const float[3]){0, 0, 0}, (const float[3]){1, .3f, .2f}, 1);
        render_settings r = random_settings(32, 32, depths[i] > 20 ? 640 : depths[i] > 6 ? 200 : 64);
        r.depth = depths[i];
        const estimate e = measure(s, &r);
        scene_destroy(s);
        expect_estimate("albedo .95, up to so many events", e, (1 - pow(.95, depths[i] + 1.0))/(1 - .95));
    }
}

/* Orders of refraction scale radiance by eta^2 and the roulette must not see it: a glass sphere in a furnace stays
 * white through any number of internal reflections. */
static void glass_in_a_furnace_is_white(void **state)
{
    (void)state;
    scene *s = build_scene();
    build_sphere(s, build_material(s, "glass ior=1.5", 0, false), 0, 0, 0, 1);
    for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
    build_camera(s, (const float[3]){0, 0, 4}, (const float[3]){0, 0, 0}, (float)(0.45*pi/2));
    render_settings r = random_settings(64, 64, 64);
    r.depth = 200;
    expect_estimate("glass sphere", measure(s, &r), 1);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_three_strategies_and_two_samplers_agree),
        cmocka_unit_test(a_missing_bounce_is_found),
        cmocka_unit_test(roulette_neither_adds_nor_takes_light),
        cmocka_unit_test(glass_in_a_furnace_is_white),
    };
    return cmocka_run_group_tests_name("strategies", tests, NULL, NULL);
}
