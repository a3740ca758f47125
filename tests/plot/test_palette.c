/* test_palette.c: colours stay apart for those who confuse some, and maps are even.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "plot/palette.h"

static double decode(double encoded)
{
    return encoded <= 0.04045 ? encoded/12.92 : pow((encoded + 0.055)/1.055, 2.4);
}

/* CIE L*a*b* (D65) of linear Rec.709. */
static void to_lab(const double rgb[3], double lab[3])
{
    static const double to_xyz[3][3] = {
        {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
    static const double white[3] = {0.95047, 1, 1.08883};
    double f[3];
    for (int i = 0; i < 3; i++) {
        const double t = (to_xyz[i][0]*rgb[0] + to_xyz[i][1]*rgb[1] + to_xyz[i][2]*rgb[2])/white[i];
        f[i] = t > 216.0/24389 ? cbrt(t) : (24389.0/27*t + 16)/116;
    }
    lab[0] = 116*f[1] - 16;
    lab[1] = 500*(f[0] - f[1]);
    lab[2] = 200*(f[1] - f[2]);
}

/* Full deficiency of one kind of cones: Machado, Oliveira and Fernandes 2009, table 1, severity 1. */
static const double protanopia[3][3] = {
    {0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}};
static const double deuteranopia[3][3] = {
    {0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}};
static const double normal_sight[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

static void seen_lab(colour c, const double sight[3][3], double lab[3])
{
    const double rgb[3] = {decode(c.r), decode(c.g), decode(c.b)};
    double seen[3];
    for (int i = 0; i < 3; i++)
        seen[i] = fmin(fmax(sight[i][0]*rgb[0] + sight[i][1]*rgb[1] + sight[i][2]*rgb[2], 0), 1);
    to_lab(seen, lab);
}

static double difference(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

/* 10 is several just noticeable differences (2.3), which lines thinner than a patch need; dashes help, too. */
static void lines_differ_for_every_kind_of_sight(void **state)
{
    (void)state;
    const double(*const sights[])[3] = {normal_sight, protanopia, deuteranopia};
    for (int s = 0; s < 3; s++)
        for (size_t i = 0; i < PALETTE_COLOURS; i++) {
            double a[3], b[3];
            seen_lab(palette_colour(i), sights[s], a);
            assert_true(a[0] < 78); /* it stands out from white */
            for (size_t k = 0; k < i; k++) {
                seen_lab(palette_colour(k), sights[s], b);
                if (difference(a, b) < 10)
                    fail_msg("sight %d: colours %zu and %zu differ by %g", s, i, k, difference(a, b));
            }
        }
}

static void the_sequential_map_gets_lighter_in_even_steps(void **state)
{
    (void)state;
    enum { N = 32 };
    const double(*const sights[])[3] = {normal_sight, protanopia, deuteranopia};
    for (int s = 0; s < 3; s++) {
        double previous[3], now[3];
        seen_lab(sequential_colour(0), sights[s], previous);
        assert_true(previous[0] < 25);
        for (int i = 1; i <= N; i++) {
            seen_lab(sequential_colour((double)i/N), sights[s], now);
            const double step = now[0] - previous[0];
            /* From about 18 to about 90 in 32 steps: 2.2 each. */
            if (!(step > 1 && step < 4)) fail_msg("sight %d: lightness grows by %g at step %d", s, step, i);
            for (int k = 0; k < 3; k++) previous[k] = now[k];
        }
        assert_true(now[0] > 80);
    }
}

static void the_diverging_map_is_white_at_zero_and_as_dark_at_both_ends(void **state)
{
    (void)state;
    double zero[3], low[3], high[3];
    seen_lab(diverging_colour(0), normal_sight, zero);
    assert_true(zero[0] > 96 && fabs(zero[1]) < 1 && fabs(zero[2]) < 1);
    for (double t = 0.25; t <= 1; t += 0.25) {
        seen_lab(diverging_colour(-t), deuteranopia, low);
        seen_lab(diverging_colour(t), deuteranopia, high);
        assert_true(fabs(low[0] - high[0]) < 12 && difference(low, high) > 60*t);
    }
}

static void values_outside_are_clipped_and_nan_is_grey(void **state)
{
    (void)state;
    const colour ends[][2] = {{sequential_colour(-5), sequential_colour(0)},
                              {sequential_colour(INFINITY), sequential_colour(1)},
                              {diverging_colour(-INFINITY), diverging_colour(-1)},
                              {sequential_colour(NAN), LIGHT_GREY},
                              {diverging_colour(NAN), LIGHT_GREY}};
    for (size_t i = 0; i < sizeof ends/sizeof *ends; i++)
        assert_true(ends[i][0].r == ends[i][1].r && ends[i][0].g == ends[i][1].g && ends[i][0].b == ends[i][1].b);
    const double bright[3] = {-1, 0.5, 7};
    const colour c = tone(bright);
    assert_true(c.r == 0 && fabs(c.g - pow(0.5, 1/2.2)) < 1e-15 && c.b == 1);
    assert_true(tone((double[3]){NAN, 0, 0}).r == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_differ_for_every_kind_of_sight),
        cmocka_unit_test(the_sequential_map_gets_lighter_in_even_steps),
        cmocka_unit_test(the_diverging_map_is_white_at_zero_and_as_dark_at_both_ends),
        cmocka_unit_test(values_outside_are_clipped_and_nan_is_grey),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
