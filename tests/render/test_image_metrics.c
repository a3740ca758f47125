/* test_image_metrics.c: differences of pictures, FLIP against its authors' program.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "render/image_metrics.h"

enum { W = 64, H = 48 };

static float a[H][W][3], b[H][W][3];
static const image picture_a = {W, H, 3, PIXEL_F32, a}, picture_b = {W, H, 3, PIXEL_F32, b};

/* Bytes 0..255 of two patterns, as display values. */
static void fill(float picture[H][W][3], int (*value)(int x, int y, int k))
{
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int k = 0; k < 3; k++) picture[y][x][k] = (float)value(x, y, k)/255;
}

static int busy(int x, int y, int k)
{
    return k == 0 ? (x*37 + y*11)%256 : k == 1 ? (x*x + y*3)%256 : (x*5 + y*y)%256;
}

static int busy_changed(int x, int y, int k)
{
    return k == 0 ? (x*37 + y*11 + 20)%256 : k == 1 ? (x*x + y*3)%256 : (x*5 + y*y)%250;
}

static int ramp(int x, int y, int k)
{
    return k == 0 ? x*4 : k == 1 ? y*5 : (x + y)*2;
}

static int ramp_striped(int x, int y, int k)
{
    const int value = ramp(x, y, k) + (x%7 == 0)*40;
    return value < 255 ? value : 255;
}

static int green(int x, int y, int k)
{
    (void)x;
    (void)y;
    return 255*(k == 1);
}

static int blue(int x, int y, int k)
{
    (void)x;
    (void)y;
    return 255*(k == 2);
}

static double flip(void)
{
    static float errors[H*W];
    double mean;
    assert_int_equal(image_flip(&picture_a, &picture_b, errors, &mean, NULL), FACET_OK);
    for (int i = 0; i < H*W; i++) assert_true(errors[i] >= 0 && errors[i] <= 1);
    return mean;
}

/* Means printed by flip-evaluator 1.7 (PyPI), the authors' program:
 *   evaluate(b, a, "LDR", applyMagma=False, parameters={"ppd": 67.0})
 * with these patterns as float arrays.  Both compute in float: 2e-6 is 10 times their difference here. */
static void flip_agrees_with_its_authors_program(void **state)
{
    (void)state;
    fill(a, busy);
    fill(b, busy_changed);
    assert_true(fabs(flip() - 0.23104959726333618) < 2e-6);
    fill(a, ramp);
    fill(b, ramp_striped);
    assert_true(fabs(flip() - 0.1616915762424469) < 2e-6);
    fill(a, green);
    fill(b, blue);
    assert_true(fabs(flip() - 1) < 2e-6);
}

static void flip_of_equal_pictures_is_zero(void **state)
{
    (void)state;
    fill(a, busy);
    fill(b, busy);
    assert_true(flip() == 0);
}

static void flip_refuses_other_sizes(void **state)
{
    (void)state;
    const image narrow = {W - 1, H, 3, PIXEL_F32, b};
    float errors[1];
    double mean;
    facet_error why;
    assert_int_equal(image_flip(&picture_a, &narrow, errors, &mean, &why), FACET_BAD_ARGUMENT);
}

static void differences_of_constant_pictures_are_exact(void **state)
{
    (void)state;
    for (int i = 0; i < H*W; i++)
        for (int k = 0; k < 3; k++) {
            (&a[0][0][0])[3*i + k] = 0.5f*(float)(k + 1);
            (&b[0][0][0])[3*i + k] = 0.5f;
        }
    a[3][5][2] = 4;
    const image_difference d = image_compare(&picture_a, &picture_b);
    assert_true(d.mean_a[0] == 0.5 && d.mean_a[1] == 1 && d.mean_b[2] == 0.5);
    assert_true(d.mse[0] == 0 && d.mse[1] == 0.25);
    assert_true(fabs(d.rel_mse[1] - 0.25/0.26) < 1e-12);
    assert_true(d.largest[0] == 0 && d.largest[1] == 0.5 && d.largest[2] == 3.5);
    assert_int_equal(d.n_different, W*H);
    assert_int_equal(d.n_bad, 0);
}

static void bad_pixels_are_counted_and_spoil_the_means(void **state)
{
    (void)state;
    memset(a, 0, sizeof a);
    memset(b, 0, sizeof b);
    a[1][1][1] = NAN;
    b[2][2][2] = INFINITY;
    const image_difference d = image_compare(&picture_a, &picture_b);
    assert_int_equal(d.n_bad, 2);
    assert_int_equal(d.n_different, 2);
    assert_true(isnan(d.mse[1]) && isinf(d.mse[2]) && d.mse[0] == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flip_agrees_with_its_authors_program),
        cmocka_unit_test(flip_of_equal_pictures_is_zero),
        cmocka_unit_test(flip_refuses_other_sizes),
        cmocka_unit_test(differences_of_constant_pictures_are_exact),
        cmocka_unit_test(bad_pixels_are_counted_and_spoil_the_means),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
