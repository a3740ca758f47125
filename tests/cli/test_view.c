/* test_view.c: the view transforms keep their promises, and pictures become linear and back.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "render/texture.h"
#include "render/view.h"

static const view views[] = {VIEW_STANDARD, VIEW_FILMIC, VIEW_AGX};

static void views_are_monotone_and_keep_greys_neutral(void **state)
{
    (void)state;
    for (int v = 0; v < 3; v++) {
        float before[3] = {-1, -1, -1};
        for (double stops = -20; stops <= 20; stops += 1/64.) {
            const float x = (float)(0.18*exp2(stops)), grey[3] = {x, x, x};
            float shown[3];
            view_pixel(views[v], 0, grey, shown);
            assert_true(shown[0] == shown[1] && shown[1] == shown[2]);
            assert_true(shown[0] >= 0 && shown[0] <= 1);
            /* Rounding may step back by an ulp where the curve is flat, no more. */
            if (!(shown[0] >= before[0] - 1.2e-7f)) fail_msg("view %d falls at %a", v, (double)x);
            /* Raising one channel of a colour lowers no channel. */
            const float colour[3] = {x, 0.4f, 0.02f};
            view_pixel(views[v], 0, colour, shown);
            float brighter[3];
            const float more[3] = {x*1.1f, 0.4f, 0.02f};
            view_pixel(views[v], 0, more, brighter);
            for (int k = 0; k < 3; k++) assert_true(brighter[k] >= shown[k] - 1.2e-7f);
            view_pixel(views[v], 0, grey, before);
        }
        assert_true(before[0] >= 0.999f); /* 20 stops above middle grey is white */
    }
}

static void black_stays_black_and_nonsense_counts_as_black(void **state)
{
    (void)state;
    for (int v = 0; v < 3; v++) {
        const float in[3] = {0, -1, NAN};
        float shown[3];
        view_pixel(views[v], 0, in, shown);
        for (int k = 0; k < 3; k++) assert_true(shown[k] == 0);
        const float bright[3] = {INFINITY, INFINITY, INFINITY};
        view_pixel(views[v], 10, bright, shown);
        for (int k = 0; k < 3; k++) assert_true(fabsf(shown[k] - 1) < 1e-6f);
    }
}

static void middle_grey_stays_where_it_is(void **state)
{
    (void)state;
    const float grey[3] = {0.18f, 0.18f, 0.18f};
    for (int v = 0; v < 3; v++) {
        float shown[3];
        view_pixel(views[v], 0, grey, shown);
        /* The curves' constants have 7 digits; sRGB's slope there is 2. */
        assert_true(fabs(srgb_to_linear(shown[0]) - 0.18) < 2e-6);
    }
}

static void exposure_is_in_stops(void **state)
{
    (void)state;
    const float dim[3] = {0.01f, 0.02f, 0.03f}, bright[3] = {0.08f, 0.16f, 0.24f};
    for (int v = 0; v < 3; v++) {
        float a[3], b[3];
        view_pixel(views[v], 3, dim, a);
        view_pixel(views[v], 0, bright, b);
        for (int k = 0; k < 3; k++) assert_true(fabsf(a[k] - b[k]) < 1e-6f);
    }
}

static void filmic_has_its_documented_anchors(void **state)
{
    (void)state;
    const float white[3] = {16, 16, 16}, one[3] = {1, 1, 1};
    float shown[3];
    view_pixel(VIEW_FILMIC, 0, white, shown);
    assert_true(fabsf(shown[0] - 1) < 1e-6f);
    view_pixel(VIEW_FILMIC, 0, one, shown);
    assert_true(fabsf(srgb_to_linear(shown[0]) - 0.64f) < 0.005f); /* the comment gives two digits */
}

static void srgb_is_the_standards_and_decodes_what_it_encodes(void **state)
{
    (void)state;
    assert_true(fabs(srgb_encode(0.5f) - 0.735356983) < 1e-6);    /* 1.055*0.5^(1/2.4) - 0.055 */
    assert_true(fabs(srgb_to_linear(0.5f) - 0.214041140) < 1e-6); /* ((0.5 + 0.055)/1.055)^2.4 */
    for (int i = 0; i <= 255; i++) {
        const float encoded = (float)i/255;
        assert_true(fabsf(srgb_encode(srgb_to_linear(encoded)) - encoded) < 1e-6f);
    }
}

static void eight_bit_pictures_survive_the_round_trip(void **state)
{
    (void)state;
    uint8_t bytes[256][3];
    for (int i = 0; i < 256; i++)
        for (int k = 0; k < 3; k++) bytes[i][k] = (uint8_t)(i + 40*k);
    const image picture = {16, 16, 3, PIXEL_U8, bytes};
    image linear, back;
    assert_int_equal(image_to_linear(&picture, &linear, NULL), FACET_OK);
    assert_int_equal(view_picture(VIEW_STANDARD, 0, &linear, PIXEL_U8, &back, NULL), FACET_OK);
    assert_memory_equal(back.pixels, bytes, sizeof bytes);
    facet_error why;
    assert_int_equal(view_picture(VIEW_STANDARD, 0, &picture, PIXEL_U8, &back, &why), FACET_BAD_ARGUMENT);
    image_destroy(&linear);
    image_destroy(&back);
}

static void grey_and_alpha_become_rgb(void **state)
{
    (void)state;
    float values[2][2] = {{0.25f, 0.5f}, {2, 0}};
    const image picture = {2, 1, 2, PIXEL_F32, values};
    image linear;
    assert_int_equal(image_to_linear(&picture, &linear, NULL), FACET_OK);
    const float expected[6] = {0.25f, 0.25f, 0.25f, 2, 2, 2};
    assert_memory_equal(linear.pixels, expected, sizeof expected);
    image_destroy(&linear);
}

static void views_are_found_by_name(void **state)
{
    (void)state;
    view v = VIEW_STANDARD;
    assert_true(view_find("agx", &v));
    assert_int_equal(v, VIEW_AGX);
    assert_false(view_find("vivid", &v));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_are_monotone_and_keep_greys_neutral),
        cmocka_unit_test(black_stays_black_and_nonsense_counts_as_black),
        cmocka_unit_test(middle_grey_stays_where_it_is),
        cmocka_unit_test(exposure_is_in_stops),
        cmocka_unit_test(filmic_has_its_documented_anchors),
        cmocka_unit_test(srgb_is_the_standards_and_decodes_what_it_encodes),
        cmocka_unit_test(eight_bit_pictures_survive_the_round_trip),
        cmocka_unit_test(grey_and_alpha_become_rgb),
        cmocka_unit_test(views_are_found_by_name),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
