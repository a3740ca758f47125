/* test_film_scene_camera.c: sums of samples, the noise estimate, questions to a scene, and cameras.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "render/film.h"
#include "render/geometry.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

/* ---- Film ---------------------------------------------------------------------------------------------------- */

static void a_film_develops_means(void **state)
{
    (void)state;
    film f;
    image picture;
    assert_int_equal(film_create(3, 2, &f), FACET_OK);
    for (int i = 0; i < 1000; i++) {
        film_add(&f, 2, 1, (const float[3]){i & 1 ? 1e8f : 1.0f, 2, 0.1f});
        film_add(&f, 0, 0, (const float[3]){1, 0, 0});
    }
    assert_int_equal(film_develop(&f, &picture), FACET_OK);
    const float *p = picture.pixels;
    assert_true(p[15] == 50000000.5f && p[16] == 2 && p[17] == 0.1f);
    assert_true(p[0] == 1 && p[1] == 0 && p[3] == 0); /* a pixel without samples is black */
    image_destroy(&picture);
    film_destroy(&f);
}

/* A sample: most are ordinary light, the others what a float can hold. */
static void draw_sample(draws *d, float rgb[3])
{
    static const float extremes[] = {0,        -0.f, 1e-45f,  FLT_MIN,   0x1p-52f,  0x1p-53f, 0x1.8p-52f,
                                     2047.9f,  2048, 0x1p11f, 1e9f,      FILM_MOST, 0x1p51f,  FLT_MAX,
                                     -FLT_MAX, -1,   -1e6f,   -0x1p-52f, -FILM_MOST};
    for (int k = 0; k < 3; k++)
        rgb[k] = draw(d) < .7 ? (float)draw_log(d, 1e-12, 1e12)
                              : extremes[(size_t)(draw(d)*(double)(sizeof extremes/sizeof *extremes))];
}

static bool films_are_equal(const film *a, const film *b)
{
    return a->n_clamped == b->n_clamped && memcmp(a->pixels, b->pixels, a->width*a->height*sizeof *a->pixels) == 0;
}

/* Two pixels; the samples dealt in random order to a random number of films, which are then merged in random order. */
static void sums_depend_on_neither_order_nor_partition(void **state)
{
    (void)state;
    enum { N = 400, MOST_PARTS = 9 };
    static float samples[N][3];
    draws d = {5};
    film whole;
    assert_int_equal(film_create(2, 1, &whole), FACET_OK);
    for (size_t i = 0; i < N; i++) {
        draw_sample(&d, samples[i]);
        film_add(&whole, i%2, 0, samples[i]);
    }
    assert_true(whole.n_clamped > 0 && whole.n_clamped < N);
    for (int round = 0; round < 200; round++) {
        film parts[MOST_PARTS];
        size_t order[N];
        const size_t n_parts = 1 + (size_t)(draw(&d)*MOST_PARTS);
        for (size_t i = 0; i < n_parts; i++) assert_int_equal(film_create(2, 1, &parts[i]), FACET_OK);
        for (size_t i = 0; i < N; i++) { /* Fisher and Yates' shuffle */
            const size_t k = (size_t)(draw(&d)*(double)(i + 1));
            order[i] = order[k];
            order[k] = i;
        }
        for (size_t i = 0; i < N; i++)
            film_add(&parts[(size_t)(draw(&d)*(double)n_parts)], order[i]%2, 0, samples[order[i]]);
        for (size_t left = n_parts; left > 1; left--) {
            const size_t from = (size_t)(draw(&d)*(double)left);
            film *to = &parts[from == left - 1 ? 0 : left - 1];
            film_merge(to, &parts[from]);
            film_destroy(&parts[from]);
            parts[from] = parts[left - 1];
        }
        assert_true(films_are_equal(&parts[0], &whole));
        film_destroy(&parts[0]);
    }
    film_destroy(&whole);
}

/* 2^24 samples of the largest magnitude on either side: the sum of the most that a render can ask for. */
static void the_longest_sums_do_not_overflow(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        film f, other;
        image picture;
        assert_int_equal(film_create(1, 1, &f), FACET_OK);
        film_add(&f, 0, 0, (const float[3]){(float)sign*FILM_MOST, (float)sign*FLT_MAX, (float)sign});
        for (int i = 0; i < 24; i++) { /* doubles itself */
            assert_int_equal(film_create(1, 1, &other), FACET_OK);
            film_merge(&other, &f);
            film_merge(&f, &other);
            film_destroy(&other);
        }
        assert_int_equal(f.pixels[0].n, 1 << 24);
        assert_int_equal(f.n_clamped, 1 << 24);
        assert_int_equal(film_develop(&f, &picture), FACET_OK);
        const float *p = picture.pixels;
        assert_true(p[0] == (float)sign*FILM_MOST && p[1] == p[0] && p[2] == (float)sign);
        image_destroy(&picture);
        film_destroy(&f);
    }
}

/* The mean of n samples is theirs to half a unit each, and to a float's last bit where they are not minute. */
static void means_are_those_of_long_doubles(void **state)
{
    (void)state;
    draws d = {8};
    for (int round = 0; round < 300; round++) {
        film f;
        image picture;
        long double sum = 0;
        const double scale = draw_log(&d, 1e-16, 1e12);
        const int n = 1 + (int)(draw(&d)*50);
        assert_int_equal(film_create(1, 1, &f), FACET_OK);
        for (int i = 0; i < n; i++) {
            const float x = (float)(scale*draw_between(&d, -.1, 1));
            sum += (long double)x;
            film_add(&f, 0, 0, (const float[3]){x, x, x});
        }
        assert_int_equal(film_develop(&f, &picture), FACET_OK);
        const double expected = (double)(sum/n), got = (double)((const float *)picture.pixels)[0];
        if (!(fabs(got - expected) <= 0x1p-53 + 0x1p-24*fabs(expected))) fail_msg("%a is not %a", got, expected);
        image_destroy(&picture);
        film_destroy(&f);
    }
}

/* 64 x 64 pixels of n independent uniform numbers: the error of a pixel's mean is 1/sqrt(12 n), of a mean of 1/2. */
static void noise_is_the_standard_error(void **state)
{
    (void)state;
    for (int n = 2; n <= 128; n *= 4) {
        film f;
        draws d = {(uint64_t)n};
        assert_int_equal(film_create(64, 64, &f), FACET_OK);
        assert_true(film_noise(&f) < 0);
        for (size_t i = 0; i < 64*64; i++)
            for (int k = 0; k < n; k++) {
                const float x = (float)draw(&d);
                film_add(&f, i%64, i/64, (const float[3]){x, x, x});
            }
        const double expected = sqrt(1/(12.0*n))/0.5;
        /* 4096 (n - 1) degrees of freedom: 4 sigma are 4/sqrt(2 4096 (n - 1)) <= 4.5 %. */
        assert_true(fabs(film_noise(&f)/expected - 1) < 4/sqrt(2*4096.0*(n - 1)));
        film_destroy(&f);
    }
}

/* Samples of 10 +- 1 on the left and 10 +- 3 on the right; then one pixel that a rare bright path hits. */
static void noise_is_a_mean_over_blocks(void **state)
{
    (void)state;
    film f;
    film_error e;
    assert_int_equal(film_create(128, 40, &f), FACET_OK);
    for (size_t i = 0; i < 128*40; i++) {
        const float deviation = i%128 < 64 ? 1 : 3;
        for (int k = 0; k < 16; k++) {
            const float x = 10 + (k & 1 ? deviation : -deviation);
            film_add(&f, i%128, i/128, (const float[3]){x, x, x});
        }
    }
    /* The variance of a mean of 16: deviation^2 / 15. */
    assert_true(fabs(film_noise(&f)/(0.5*(1 + 3)/sqrt(15)/10) - 1) < 1e-6);
    assert_true(film_measure(&f, 0, 0, 128, 40, &e));
    assert_true(fabs(e.luminance/10 - 1) < 1e-6 && fabs(e.deviation/sqrt((1 + 9)/2.0/15) - 1) < 1e-6);
    const double before = film_noise(&f);
    film_add(&f, 3, 3, (const float[3]){1e6f, 1e6f, 1e6f});
    film_error block;
    assert_true(film_measure(&f, 0, 0, 32, 32, &block));
    assert_true(film_measure(&f, 0, 0, 128, 40, &e));
    const double bright = block.deviation*32*32/(128*40)/e.luminance;
    assert_true(film_noise(&f) > bright && film_noise(&f) < bright + before);
    assert_true(fabs(film_mean_samples(&f) - (16 + 1/(128*40.0))) < 1e-9);
    film_destroy(&f);
}

/* ---- Features ------------------------------------------------------------------------------------------------ */

static void expect_layer(const film *f, film_layer layer, size_t n_channels, const float *expected, float tolerance)
{
    image picture;
    assert_int_equal(film_develop_layer(f, layer, &picture), FACET_OK);
    assert_int_equal(picture.n_channels, n_channels);
    for (size_t k = 0; k < n_channels; k++) {
        const float got = ((const float *)picture.pixels)[k];
        if (!(fabsf(got - expected[k]) <= tolerance || got == expected[k]))
            fail_msg("%a is not %a", (double)got, (double)expected[k]);
    }
    image_destroy(&picture);
}

static void features_are_means_within_their_range(void **state)
{
    (void)state;
    film f, other;
    const feature first = {{.25f, 0, 7}, {0, 0, -1}, 2}, second = {{.75f, -1, NAN}, {0, 1, 0}, 5},
                  sky = {{0, 0, 0}, {NAN, INFINITY, 0}, INFINITY};
    assert_int_equal(film_create(1, 1, &f), FACET_OK);
    assert_int_equal(film_keep_features(&f), FACET_OK);
    expect_layer(&f, FILM_ALBEDO, 3, (const float[3]){0, 0, 0}, 0);
    expect_layer(&f, FILM_DISTANCE, 1, (const float[1]){INFINITY}, 0);
    const feature *const seen[] = {&first, &second, &sky, &sky};
    for (int i = 0; i < 4; i++) {
        film_add(&f, 0, 0, (const float[3]){0, 0, 0});
        film_add_feature(&f, 0, 0, seen[i]);
    }
    assert_int_equal(film_create(1, 1, &other), FACET_OK);
    assert_int_equal(film_keep_features(&other), FACET_OK);
    film_merge(&other, &f);
    film_merge(&other, &f);
    const film *const films[] = {&f, &other};
    for (int i = 0; i < 2; i++) { /* in units of 2^-32 */
        expect_layer(films[i], FILM_ALBEDO, 3, (const float[3]){.25f, 0, .25f}, 0x1p-31f);
        expect_layer(films[i], FILM_NORMAL, 3, (const float[3]){0, .75f, -.25f}, 0x1p-31f);
        expect_layer(films[i], FILM_DISTANCE, 1, (const float[1]){3.5f}, 0);
        expect_layer(films[i], FILM_SAMPLES, 1, (const float[1]){i ? 8 : 4}, 0);
    }
    film_destroy(&other);
    film_destroy(&f);
}

static void a_black_film_has_no_noise_estimate(void **state)
{
    (void)state;
    film f;
    assert_int_equal(film_create(1, 1, &f), FACET_OK);
    for (int i = 0; i < 4; i++) film_add(&f, 0, 0, (const float[3]){0, 0, 0});
    assert_true(film_noise(&f) < 0);
    film_destroy(&f);
}

/* ---- Scene --------------------------------------------------------------------------------------------------- */

static void bounds_take_in_instances_and_spheres(void **state)
{
    (void)state;
    scene *s = build_scene();
    float low[3], high[3];
    assert_false(scene_bounds(s, low, high));
    const size_t m = build_material(s, "lambert kd=.5", 0, false);
    const size_t box = build_box(s, m, (const float[3]){0, 0, 0}, (const float[3]){1, 2, 3});
    assert_false(scene_bounds(s, low, high)); /* nobody uses the mesh */
    const float turned[3][4] = {{0, -1, 0, 10}, {1, 0, 0, 0}, {0, 0, 1, 0}};
    build_instance(s, box, turned);
    assert_true(scene_bounds(s, low, high));
    assert_true(low[0] == 8 && high[0] == 10 && low[1] == 0 && high[1] == 1 && low[2] == 0 && high[2] == 3);
    build_sphere(s, m, -5, 0, 0, 2);
    assert_true(scene_bounds(s, low, high));
    assert_true(low[0] == -7 && high[0] == 10 && low[1] == -2 && high[1] == 2);
    scene_destroy(s);
    scene_destroy(NULL);
}

static void things_are_found_by_name(void **state)
{
    (void)state;
    scene *s = build_scene();
    const size_t a = build_material(s, "lambert kd=.5", 0, false), b = build_material(s, "ggx alpha=.5", 0, false);
    build_camera(s, (const float[3]){0, 0, 1}, (const float[3]){0, 0, 0}, 1);
    assert_int_equal(scene_find_material(s, "lambert kd=.5"), a);
    assert_int_equal(scene_find_material(s, "ggx alpha=.5"), b);
    assert_int_equal(scene_find_material(s, "ggx"), NONE);
    assert_int_equal(scene_find_camera(s, "camera"), 0);
    assert_int_equal(scene_find_camera(s, ""), NONE);
    scene_destroy(s);
}

/* Where a world point lies in the picture, by the camera's matrix: x, y in [-1,1]. */
static void project(const camera *c, size_t w, size_t h, const float p[3], double ndc[2], double *depth)
{
    float to_camera[16], to_ndc[16];
    camera_matrices(c, w, h, to_camera, to_ndc);
    double out[4], inside[4];
    for (int j = 0; j < 4; j++) {
        out[j] = (double)to_ndc[12 + j];
        inside[j] = (double)to_camera[12 + j];
        for (int i = 0; i < 3; i++) {
            out[j] += (double)p[i]*(double)to_ndc[4*i + j];
            inside[j] += (double)p[i]*(double)to_camera[4*i + j];
        }
    }
    for (int k = 0; k < 2; k++) ndc[k] = out[k]/out[3];
    *depth = -inside[2];
}

static void the_framing_camera_sees_everything(void **state)
{
    (void)state;
    draws d = {4};
    for (int i = 0; i < 200; i++) {
        scene *s = build_scene();
        float low[3], high[3];
        for (int k = 0; k < 3; k++) {
            const double center = draw_between(&d, -100, 100), half = draw_log(&d, 1e-3, 1e3);
            low[k] = (float)(center - half);
            high[k] = (float)(center + half);
        }
        build_instance(s, build_box(s, build_material(s, "lambert kd=.5", 0, false), low, high), NULL);
        size_t index;
        assert_int_equal(scene_add_framing_camera(s, &index), FACET_OK);
        for (int corner = 0; corner < 8; corner++) {
            const float p[3] = {corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1],
                                corner & 4 ? high[2] : low[2]};
            double ndc[2], depth;
            project(&s->cameras[index], 160, 90, p, ndc, &depth);
            assert_true(depth > 0 && fabs(ndc[0]) < 1 && fabs(ndc[1]) < 1);
        }
        scene_destroy(s);
    }
}

/* ---- Cameras ------------------------------------------------------------------------------------------------- */

/* A small glowing sphere shows up in the pixel that the matrices say, in pictures of several shapes. */
static void matrices_and_rays_agree(void **state)
{
    (void)state;
    static const size_t sizes[3][2] = {{40, 30}, {30, 40}, {64, 16}};
    draws d = {6};
    for (int i = 0; i < 60; i++) {
        const bool is_orthographic = i & 1;
        scene *s = build_scene();
        const float eye[3] = {(float)draw_between(&d, -3, 3), (float)draw_between(&d, -3, 3), 5};
        if (is_orthographic) build_orthographic(s, eye, (const float[3]){0, 0, 0}, 2);
        else build_camera(s, eye, (const float[3]){0, 0, 0}, .8f);
        const size_t w = sizes[i%3][0], h = sizes[i%3][1];
        const float p[3] = {(float)draw_between(&d, -.7, .7), (float)draw_between(&d, -.4, .4),
                            (float)draw_between(&d, -1, 1)};
        double ndc[2], depth;
        project(&s->cameras[0], w, h, p, ndc, &depth);
        if (fabs(ndc[0]) < .9 && fabs(ndc[1]) < .9) {
            build_sphere(s, build_material(s, "lambert kd=0", 1, false), p[0], p[1], p[2], .1f);
            render_settings r = random_settings(w, h, 64*SAMPLE_DIVISOR);
            render_result result = {0};
            assert_int_equal(render(s, &r, &result, NULL), FACET_OK);
            double x = 0, y = 0, sum = 0;
            for (size_t k = 0; k < w*h; k++) {
                const double L = (double)((const float *)result.picture.pixels)[3*k];
                x += L*((double)(k%w) + .5);
                y += L*((double)(k/w) + .5);
                sum += L;
            }
            assert_true(sum > 0);
            assert_true(fabs(x/sum - (ndc[0] + 1)/2*(double)w) < .75 &&
                        fabs(y/sum - (1 - ndc[1])/2*(double)h) < .75);
            render_result_destroy(&result);
        }
        scene_destroy(s);
    }
}

/* Pixels are square whatever the picture's shape: yfov spans the height. */
static void the_vertical_field_of_view_spans_the_height(void **state)
{
    (void)state;
    const camera c = {.to_world = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, .yfov = 1};
    double ndc[2], depth;
    for (size_t w = 10; w <= 1000; w *= 10) {
        const float tan = tanf(.5f);
        project(&c, w, 100, (const float[3]){0, 2*tan, -2}, ndc, &depth);
        assert_true(fabs(ndc[1] - 1) < 1e-6 && fabs(depth - 2) < 1e-6);
        project(&c, w, 100, (const float[3]){2*tan*(float)w/100, 0, -2}, ndc, &depth);
        assert_true(fabs(ndc[0] - 1) < 1e-6);
    }
}

/* glTF's single-sided surfaces are not seen from behind, but cast shadows and scatter light on both sides. */
static void single_sided_surfaces_are_hidden_from_behind_and_still_block(void **state)
{
    (void)state;
    for (int is_double_sided = 0; is_double_sided < 2; is_double_sided++) {
        scene *s = build_scene();
        const size_t m = build_gltf_material(s, .5f, 0, 1);
        s->materials[m].is_double_sided = is_double_sided;
        /* A ceiling that faces up above a floor; seen from below the ceiling, looking up, and the floor beneath it. */
        build_quad(s, m, (const float[3]){-5, 1, 5}, (const float[3]){10, 0, 0}, (const float[3]){0, 0, -10});
        build_quad(s, build_material(s, "lambert kd=.5", 0, false), (const float[3]){-5, 0, 5},
                   (const float[3]){10, 0, 0}, (const float[3]){0, 0, -10});
        const punctual_light sun = {.kind = LIGHT_DIRECTIONAL, .direction = {0, -1, 0}, .intensity = {1, 1, 1}};
        assert_int_equal(scene_add_light(s, &sun, NULL), FACET_OK);
        build_camera(s, (const float[3]){0, .5f, 0}, (const float[3]){.01f, 2, 0}, .1f);  /* up */
        build_camera(s, (const float[3]){0, .5f, 0}, (const float[3]){.01f, -2, 0}, .1f); /* down */
        for (int k = 0; k < 3; k++) s->environment.scale[k] = 1;
        render_settings r = random_settings(8, 8, 16*SAMPLE_DIVISOR);
        r.depth = 1;
        const double up = measure(s, &r).mean;
        r.camera = 1;
        const double down = measure(s, &r).mean;
        if (is_double_sided) assert_true(up < .9); /* the ceiling's dark side */
        else assert_true(fabs(up - 1) < 1e-6);     /* the sky behind it */
        assert_true(down < .1);                    /* shadow in either case: neither sun nor zenith reach the floor */
        scene_destroy(s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_film_develops_means),
        cmocka_unit_test(sums_depend_on_neither_order_nor_partition),
        cmocka_unit_test(the_longest_sums_do_not_overflow),
        cmocka_unit_test(means_are_those_of_long_doubles),
        cmocka_unit_test(noise_is_the_standard_error),
        cmocka_unit_test(noise_is_a_mean_over_blocks),
        cmocka_unit_test(features_are_means_within_their_range),
        cmocka_unit_test(a_black_film_has_no_noise_estimate),
        cmocka_unit_test(bounds_take_in_instances_and_spheres),
        cmocka_unit_test(things_are_found_by_name),
        cmocka_unit_test(the_framing_camera_sees_everything),
        cmocka_unit_test(matrices_and_rays_agree),
        cmocka_unit_test(the_vertical_field_of_view_spans_the_height),
        cmocka_unit_test(single_sided_surfaces_are_hidden_from_behind_and_still_block),
    };
    return cmocka_run_group_tests_name("film_scene_camera", tests, NULL, NULL);
}
