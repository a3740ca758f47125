/* test_features.c: albedo, normal and distance of what paths see first.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/scene_builder.h"

enum { SIZE = 33, CENTER = SIZE/2*SIZE + SIZE/2 };

typedef struct feature_pictures {
    render_state state;
    render_result result;
    image albedo, normal, distance;
} feature_pictures;

static feature_pictures render_shared(const scene *s, uint32_t spp, gradients way)
{
    feature_pictures p = {0};
    render_settings r;
    render_settings_defaults(&r);
    r.width = r.height = SIZE;
    r.spp = spp;
    r.n_threads = 1;
    r.keeps_features = true;
    r.gradients = way;
    assert_int_equal(render_continue(s, &r, &p.state, &p.result, NULL), FACET_OK);
    assert_int_equal(film_develop_layer(&p.state.film, FILM_ALBEDO, &p.albedo), FACET_OK);
    assert_int_equal(film_develop_layer(&p.state.film, FILM_NORMAL, &p.normal), FACET_OK);
    assert_int_equal(film_develop_layer(&p.state.film, FILM_DISTANCE, &p.distance), FACET_OK);
    for (size_t i = 0; i < SIZE*SIZE; i++) { /* in range, everywhere */
        const float *a = (const float *)p.albedo.pixels + 3*i, *n = (const float *)p.normal.pixels + 3*i;
        for (int k = 0; k < 3; k++) assert_true(a[k] >= 0 && a[k] <= 1);
        assert_true(n[0]*n[0] + n[1]*n[1] + n[2]*n[2] <= 1 + 1e-5f);
        assert_true(((const float *)p.distance.pixels)[i] > 0);
    }
    return p;
}

static feature_pictures render_features(const scene *s, uint32_t spp)
{
    return render_shared(s, spp, GRADIENTS_AUTO);
}

static void features_destroy(feature_pictures *p)
{
    image_destroy(&p->distance);
    image_destroy(&p->normal);
    image_destroy(&p->albedo);
    render_result_destroy(&p->result);
    render_state_destroy(&p->state);
}

static const float *at(const image *picture, size_t pixel)
{
    return (const float *)picture->pixels + pixel*picture->n_channels;
}

static void expect_near(const float *got, float x, float y, float z, float tolerance)
{
    const float expected[3] = {x, y, z};
    for (int k = 0; k < 3; k++)
        if (!(fabsf(got[k] - expected[k]) <= tolerance))
            fail_msg("channel %d is %g, not %g", k, (double)got[k], (double)expected[k]);
}

/* A wall across the view at distance 3 behind the origin, with what `build` puts in front of it. */
static scene *wall_behind(const char *spec)
{
    scene *s = build_scene();
    build_quad(s, build_material(s, spec, 0, true), (const float[3]){-9, -9, -3}, (const float[3]){18, 0, 0},
               (const float[3]){0, 18, 0});
    for (int k = 0; k < 3; k++) s->environment.scale[k] = .5f;
    build_camera(s, (const float[3]){0, 0, 5}, (const float[3]){0, 0, 0}, .2f);
    return s;
}

static void a_diffuse_wall_has_its_albedo(void **state)
{
    (void)state;
    scene *s = wall_behind("lambert kd=.2,.5,.9");
    feature_pictures p = render_features(s, 4);
    for (size_t i = 0; i < SIZE*SIZE; i++) {
        expect_near(at(&p.albedo, i), .2f, .5f, .9f, 1e-6f); /* the weight of every sample */
        expect_near(at(&p.normal, i), 0, 0, 1, 1e-6f);
    }
    assert_true(fabsf(*at(&p.distance, CENTER) - 8) < 8*.005f); /* the middle pixel's rays are within .1 degree */
    features_destroy(&p);
    scene_destroy(s);
}

/* A metal's albedo is the integral that libfacet gives, seen along the normal. */
static void a_metal_wall_has_its_directional_albedo(void **state)
{
    (void)state;
    facet_material copper;
    facet_bsdf64 bsdf;
    double expected[3], transmitted[3], error;
    scene *s = wall_behind("ggx alpha=.5 metal=Cu");
    feature_pictures p = render_features(s, 1024/SAMPLE_DIVISOR);
    assert_int_equal(facet_material_parse("ggx alpha=.5 metal=Cu", &copper, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&copper, &bsdf, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_albedo(&bsdf, (const double[3]){0, 0, 1}, expected, transmitted, &error), FACET_OK);
    /* weights of visible normals lie in [0,1]: a sigma of at most .5/sqrt(n), an eighth of that with this alpha */
    expect_near(at(&p.albedo, CENTER), (float)expected[0], (float)expected[1], (float)expected[2],
                5*.5f/8/sqrtf(1024.0f/(float)SAMPLE_DIVISOR));
    features_destroy(&p);
    scene_destroy(s);
}

static void mirrors_show_what_they_reflect(void **state)
{
    (void)state;
    scene *s = wall_behind("lambert kd=.5");
    /* a smooth pane before the wall: what goes through sees the wall, what it reflects the sky */
    build_quad(s, build_material(s, "glass ior=1.5", 0, true), (const float[3]){-9, -9, 0}, (const float[3]){18, 0, 0},
               (const float[3]){0, 18, 0});
    feature_pictures p = render_features(s, 4096/SAMPLE_DIVISOR);
    /* Fresnel's .04 of the sky's .5 behind the camera, and .96 of the wall's .5 over the index squared, as radiance is
     * in glass: between .22 and .5, chosen with a chance of .04. */
    const float expected = .04f*.5f + .96f*.5f/(1.5f*1.5f),
                sigma = (.5f - .22f)*.2f/sqrtf(4096.0f/(float)SAMPLE_DIVISOR);
    expect_near(at(&p.albedo, CENTER), expected, expected, expected, 5*sigma);
    assert_true(at(&p.normal, CENTER)[2] > .9f); /* the wall's, or the pane's before the sky */
    assert_true(fabsf(*at(&p.distance, CENTER) - 5) < 5*.005f);
    features_destroy(&p);
    scene_destroy(s);
}

static void what_emits_has_its_radiance_up_to_one(void **state)
{
    (void)state;
    scene *s = build_scene();
    const float radiance[3] = {.25f, 3, 0};
    for (int k = 0; k < 3; k++) s->environment.scale[k] = radiance[k];
    build_camera(s, (const float[3]){0, 0, 5}, (const float[3]){0, 0, 0}, .2f);
    feature_pictures p = render_features(s, 2);
    expect_near(at(&p.albedo, CENTER), .25f, 1, 0, 1e-6f);
    expect_near(at(&p.normal, CENTER), 0, 0, 0, 0);
    assert_true(isinf(*at(&p.distance, CENTER)));
    features_destroy(&p);
    scene_destroy(s);
}

static void the_picture_does_not_depend_on_features(void **state)
{
    (void)state;
    scene *s = wall_behind("ggx alpha=.3 ks=.8 kd=.1");
    render_settings r;
    render_settings_defaults(&r);
    r.width = r.height = SIZE;
    r.spp = 3;
    render_result plain = {0};
    assert_int_equal(render(s, &r, &plain, NULL), FACET_OK);
    feature_pictures p = render_features(s, 3);
    assert_memory_equal(p.result.picture.pixels, plain.picture.pixels, 3*sizeof(float)*SIZE*SIZE);
    features_destroy(&p);
    render_result_destroy(&plain);
    scene_destroy(s);
}

/* Where light is shared, first vertices lie in another order, with gaps where paths meet the sky. */
static void features_do_not_depend_on_shared_light(void **state)
{
    (void)state;
    scene *s = wall_behind("ggx alpha=.3 ks=.8 kd=.1");
    build_sphere(s, build_material(s, "lambert kd=.2,.5,.9", 0, true), -.3f, 0, 0, .25f);
    build_sphere(s, build_material(s, "glass ior=1.5", 0, true), .3f, 0, 0, .25f);
    build_sphere(s, build_gltf_material(s, .5f, 1, .2f), 0, .35f, 0, .15f);
    build_sphere(s, build_material(s, "lambert kd=0", 2, true), 0, -.35f, 0, .15f);
    s->instances[0].to_world[0][3] = 9; /* the wall is half as wide as the view */
    feature_pictures shared = render_shared(s, 4, GRADIENTS_ON), alone = render_shared(s, 4, GRADIENTS_OFF);
    assert_true(shared.result.has_gradients && !alone.result.has_gradients);
    const size_t n = sizeof(float)*SIZE*SIZE;
    assert_memory_equal(shared.albedo.pixels, alone.albedo.pixels, 3*n);
    assert_memory_equal(shared.normal.pixels, alone.normal.pixels, 3*n);
    assert_memory_equal(shared.distance.pixels, alone.distance.pixels, n);
    features_destroy(&alone);
    features_destroy(&shared);
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_diffuse_wall_has_its_albedo),
        cmocka_unit_test(a_metal_wall_has_its_directional_albedo),
        cmocka_unit_test(mirrors_show_what_they_reflect),
        cmocka_unit_test(what_emits_has_its_radiance_up_to_one),
        cmocka_unit_test(the_picture_does_not_depend_on_features),
        cmocka_unit_test(features_do_not_depend_on_shared_light),
    };
    return cmocka_run_group_tests_name("features", tests, NULL, NULL);
}
