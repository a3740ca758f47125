/* test_textures.c: texels, wrapping, interpolation and decoding.
 * [gltf] glTF 2.0, sampler; [iec61966] IEC 61966-2-1, sRGB.
 * SPDX-License-Identifier: MIT */
#include "render/texture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/surface.h"
#include "tests/draws.h"
#include "tests/scene_builder.h"

/* A scene with one picture of this type; the texture is set by each test. */
static scene *with_picture(size_t w, size_t h, size_t n_channels, pixel_type type, const void *pixels, size_t bytes)
{
    scene *s = build_scene();
    image owned = {w, h, n_channels, type, malloc(bytes)};
    assert_non_null(owned.pixels);
    memcpy(owned.pixels, pixels, bytes);
    assert_int_equal(scene_add_image(s, &owned, NULL), FACET_OK);
    return s;
}

static float red(const scene *s, texture t, float u, float v)
{
    return texture_lookup(s, &t, u, v).c[0];
}

/* The wrapped index by definition: steps along an endless row of texels. */
static int wrapped(int i, int n, texture_wrap wrap)
{
    if (wrap == WRAP_CLAMP) return i < 0 ? 0 : i >= n ? n - 1 : i;
    const int turn = (i%(2*n) + 2*n)%(2*n);
    if (wrap == WRAP_REPEAT) return turn%n;
    return turn < n ? turn : 2*n - 1 - turn;
}

static const float row[4] = {1, 2, 4, 8};

static void nearest_lookups_give_the_texel_under_the_point(void **state)
{
    (void)state;
    scene *s = with_picture(4, 1, 1, PIXEL_F32, row, sizeof row);
    for (texture_wrap wrap = WRAP_REPEAT; wrap <= WRAP_CLAMP; wrap++)
        for (int i = -20; i < 20; i++) {
            const texture t = {.wrap_u = wrap, .wrap_v = wrap, .is_nearest = true};
            for (int part = 0; part < 4; part++) {
                const float u = ((float)i + (float)part*0.25f)/4;
                assert_true(red(s, t, u, .3f) == row[wrapped(i, 4, wrap)]);
            }
        }
    scene_destroy(s);
}

static void bilinear_lookups_give_texels_at_their_centres_and_means_between(void **state)
{
    (void)state;
    scene *s = with_picture(4, 1, 1, PIXEL_F32, row, sizeof row);
    for (texture_wrap wrap = WRAP_REPEAT; wrap <= WRAP_CLAMP; wrap++)
        for (int i = -20; i < 20; i++) {
            const texture t = {.wrap_u = wrap, .wrap_v = wrap};
            const float here = row[wrapped(i, 4, wrap)], next = row[wrapped(i + 1, 4, wrap)];
            /* u, and the fraction from it, are rounded to 2^-24 of |4 u| <= 20. */
            assert_true(fabsf(red(s, t, ((float)i + .5f)/4, .5f) - here) < 2e-5f);
            assert_true(fabsf(red(s, t, ((float)i + 1)/4, .5f) - (here + next)/2) < 2e-5f);
            assert_true(fabsf(red(s, t, ((float)i + .75f)/4, .5f) - (here*.75f + next*.25f)) < 2e-5f);
        }
    scene_destroy(s);
}

static void v_runs_from_the_top_row_and_wraps_on_its_own(void **state)
{
    (void)state;
    static const float column[3] = {1, 2, 4};
    scene *s = with_picture(1, 3, 1, PIXEL_F32, column, sizeof column);
    const texture t = {.wrap_u = WRAP_REPEAT, .wrap_v = WRAP_CLAMP, .is_nearest = true};
    assert_true(red(s, t, 17.3f, 0) == 1);
    assert_true(red(s, t, -5, .5f) == 2);
    assert_true(red(s, t, 0, .99f) == 4);
    assert_true(red(s, t, 0, 7) == 4);
    assert_true(red(s, t, 0, -7) == 1);
    scene_destroy(s);
}

/* All 256 codes of 8 bits against the standard's formula in double: within 1e-6 relative (a power in single precision).
 * Alpha is never decoded. */
static double srgb(double c)
{
    return c <= 0.04045 ? c/12.92 : pow((c + 0.055)/1.055, 2.4);
}

static void srgb_codes_are_decoded(void **state)
{
    (void)state;
    static uint8_t codes[256][4];
    for (int i = 0; i < 256; i++) memset(codes[i], i, 4);
    scene *s = with_picture(256, 1, 4, PIXEL_U8, codes, sizeof codes);
    for (int i = 0; i < 256; i++) {
        texture t = {.is_nearest = true, .is_srgb = true};
        const texel c = texture_lookup(s, &t, ((float)i + .5f)/256, 0);
        for (int k = 0; k < 3; k++) assert_true(fabs((double)c.c[k] - srgb(i/255.0)) <= 1e-6*srgb(i/255.0));
        assert_true(fabs((double)c.c[3] - i/255.0) < 1e-7);
        t.is_srgb = false;
        const texel l = texture_lookup(s, &t, ((float)i + .5f)/256, 0);
        for (int k = 0; k < 4; k++) assert_true(fabs((double)l.c[k] - i/255.0) < 1e-7);
    }
    scene_destroy(s);
}

/* Colours are mixed as light, not as codes: half way between 0 and 255 lies 1/2, not the decoded 127.5. */
static void srgb_texels_are_decoded_before_they_are_mixed(void **state)
{
    (void)state;
    static const uint8_t codes[2] = {0, 255};
    scene *s = with_picture(2, 1, 1, PIXEL_U8, codes, sizeof codes);
    const texture t = {.is_srgb = true};
    assert_true(fabsf(red(s, t, .5f, .5f) - .5f) < 1e-6f);
    scene_destroy(s);
}

static void sixteen_bits_and_floats_keep_their_precision(void **state)
{
    (void)state;
    static const uint16_t codes[4] = {0, 1, 32768, 65535};
    scene *s = with_picture(4, 1, 1, PIXEL_U16, codes, sizeof codes);
    texture t = {.is_nearest = true};
    for (int i = 0; i < 4; i++)
        assert_true(fabs((double)red(s, t, ((float)i + .5f)/4, 0) - codes[i]/65535.0) < 1e-7);
    t.is_srgb = true;
    assert_true(fabs((double)red(s, t, .625f, 0) - srgb(32768/65535.0)) < 1e-6);
    scene_destroy(s);
    static const float values[2] = {1e-3f, 4000};
    s = with_picture(2, 1, 1, PIXEL_F32, values, sizeof values);
    assert_true(red(s, (texture){.is_nearest = true, .is_srgb = true}, .25f, 0) ==
                1e-3f); /* floats are linear already */
    assert_true(red(s, (texture){.is_nearest = true}, .75f, 0) == 4000);
    scene_destroy(s);
}

static void missing_channels_are_grey_and_opaque(void **state)
{
    (void)state;
    static const float values[4] = {.1f, .2f, .3f, .4f};
    static const float expected[4][4] = {
        {.1f, .1f, .1f, 1}, {.1f, .1f, .1f, .2f}, {.1f, .2f, .3f, 1}, {.1f, .2f, .3f, .4f}};
    for (size_t n = 1; n <= 4; n++) {
        scene *s = with_picture(1, 1, n, PIXEL_F32, values, n*sizeof(float));
        const texture t = {.is_nearest = true};
        const texel c = texture_lookup(s, &t, .5f, .5f);
        assert_memory_equal(c.c, expected[n - 1], sizeof c.c);
        scene_destroy(s);
    }
}

/* Any finite coordinate reads inside the picture (sanitizers watch) and gives a value between the texels'. */
static void wild_coordinates_stay_inside(void **state)
{
    (void)state;
    scene *s = with_picture(4, 1, 1, PIXEL_F32, row, sizeof row);
    draws d = {1};
    for (int i = 0; i < 20000; i++) {
        const texture t = {.wrap_u = (texture_wrap)(i%3), .wrap_v = (texture_wrap)(i/3%3), .is_nearest = i & 1};
        const float sign = i & 4 ? -1.0f : 1.0f;
        const float u = sign*(float)draw_log(&d, 1e-38, 3e38), v = -sign*(float)draw_log(&d, 1e-38, 3e38);
        const float c = red(s, t, u, v);
        if (!(c >= 0.99999f && c <= 8.0001f)) fail_msg("(%a, %a): %a", (double)u, (double)v, (double)c);
    }
    scene_destroy(s);
}

/* A normal map turns the shading frame whatever the surface's model; (191, 128, 238)/255 decodes to (.498, .004, .867)
 * up to half a code. */
static void normal_maps_turn_every_scattering_material(void **state)
{
    (void)state;
    static const unsigned char leaning[4] = {191, 128, 238, 255};
    scene *s = build_scene();
    const size_t texture_index = build_texture(s, 1, 1, leaning, true);
    const size_t materials[2] = {build_material(s, "ggx alpha=.2", 0, false), build_gltf_material(s, .5f, 0, .5f)};
    for (size_t i = 0; i < 2; i++) {
        material *m = &s->materials[materials[i]];
        m->normal_texture.texture = texture_index;
        m->normal_scale = 1;
        build_quad(s, materials[i], (const float[3]){0, 0, 0}, (const float[3]){1, 0, 0}, (const float[3]){0, 1, 0});
        const hit h = {.t = 1, .u = .25f, .v = .25f, .instance = (uint32_t)i, .primitive = 0};
        const ray r = {.origin = {.5f, .5f, 1}, .direction = {0, 0, -1}};
        const surface at = surface_of_hit(s, &r, &h, make3(0, 0, 1));
        /* The tangent is the direction of growing u: +x here. */
        const double tolerance = 1.0/255;
        assert_true(fabs((double)at.shading.n.x - .498) < tolerance && fabs((double)at.shading.n.z - .867) < tolerance);
        assert_true(at.normal.z == 1);
    }
    scene_destroy(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_lookups_give_the_texel_under_the_point),
        cmocka_unit_test(bilinear_lookups_give_texels_at_their_centres_and_means_between),
        cmocka_unit_test(v_runs_from_the_top_row_and_wraps_on_its_own),
        cmocka_unit_test(srgb_codes_are_decoded),
        cmocka_unit_test(srgb_texels_are_decoded_before_they_are_mixed),
        cmocka_unit_test(sixteen_bits_and_floats_keep_their_precision),
        cmocka_unit_test(missing_channels_are_grey_and_opaque),
        cmocka_unit_test(wild_coordinates_stay_inside),
        cmocka_unit_test(normal_maps_turn_every_scattering_material),
    };
    return cmocka_run_group_tests_name("textures", tests, NULL, NULL);
}
