/* test_axis.c: ranges and ticks of axes.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "plot/axis.h"

static const axis_scale scales[] = {AXIS_LINEAR, AXIS_LOG, AXIS_DEGREES};

/* 1, 2 or 5 times a power of ten. */
static int is_round(double step)
{
    const double power = pow(10, floor(log10(step) + 1e-9)), digit = step/power;
    return fabs(digit - 1) < 1e-6 || fabs(digit - 2) < 1e-6 || fabs(digit - 5) < 1e-6;
}

static size_t count_labels(const axis_ticks *t)
{
    size_t n = 0;
    for (size_t i = 0; i < t->n; i++) n += t->ticks[i].label[0] != 0;
    return n;
}

static void check_axis(const axis *a)
{
    if (!(isfinite(a->low) && isfinite(a->high) && a->low < a->high && isfinite(a->high - a->low)))
        fail_msg("scale %d: from %a to %a", a->scale, a->low, a->high);
    for (int most = 2; most <= 12; most++) {
        const axis_ticks t = axis_make_ticks(a, most);
        if (t.n == 0 || count_labels(&t) > (size_t)most || count_labels(&t) == 0)
            fail_msg("from %a to %a: %zu labels, at most %d", a->low, a->high, count_labels(&t), most);
        for (size_t i = 0; i < t.n; i++) {
            const double place = axis_place(a, t.ticks[i].value);
            if (!(place >= -1e-6 && place <= 1 + 1e-6))
                fail_msg("from %a to %a: tick %a is at %g", a->low, a->high, t.ticks[i].value, place);
            assert_true(i == 0 || t.ticks[i].value > t.ticks[i - 1].value);
        }
    }
}

static void fitted_axes_hold_the_data_and_have_few_ticks_at_round_numbers(void **state)
{
    (void)state;
    srand(1);
    for (int i = 0; i < 2000; i++) {
        const double size = pow(10, rand()%600 - 300), u = (double)rand()/RAND_MAX, v = (double)rand()/RAND_MAX;
        const double low = size*(u - 0.5), high = low + size*(v + 1e-3);
        const axis a = axis_fit((axis){.scale = AXIS_LINEAR}, low, high);
        check_axis(&a);
        if (fabs(low) < 1e290 && fabs(high) < 1e290 && size > 1e-280) {
            /* Within 0.2 % of a step, which is at most the whole. */
            assert_true(axis_place(&a, low) >= -2.1e-3 && axis_place(&a, high) <= 1 + 2.1e-3);
            const axis_ticks t = axis_make_ticks(&a, 8);
            assert_true(t.n < 2 || is_round(t.ticks[1].value - t.ticks[0].value));
        }
        const axis b = axis_fit((axis){.scale = AXIS_LOG}, fabs(high)/1e3, fabs(high));
        check_axis(&b);
        if (fabs(high) < 1e290 && fabs(high) > 1e-280)
            assert_true(axis_place(&b, fabs(high)/1e3) >= -1e-6 && axis_place(&b, fabs(high)) <= 1 + 1e-6);
    }
}

static void data_without_a_range_give_one(void **state)
{
    (void)state;
    static const double cases[][2] = {
        {0, 0},
        {5, 5},
        {-5, -5},
        {1e300, 1e300},
        {-DBL_MAX, DBL_MAX},
        {INFINITY, -INFINITY},
        {NAN, NAN},
        {-INFINITY, 1},
        {0, INFINITY},
        {DBL_MIN, DBL_MIN},
        {0, 5e-324},
        {1, 1 + DBL_EPSILON},
        {-1e-320, 0},
        {1e-320, 1e-320},
        {1e17, 1e17 + 16},
        {-3, 0},
        {0, 1},
        {DBL_MAX, DBL_MAX},
    };
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++)
        for (int k = 0; k < 3; k++) {
            const axis a = axis_fit((axis){.scale = scales[k]}, cases[i][0], cases[i][1]);
            check_axis(&a);
        }
}

static void only_what_an_axis_can_show_counts(void **state)
{
    (void)state;
    const axis linear = {.scale = AXIS_LINEAR}, logarithmic = {.scale = AXIS_LOG};
    double low = INFINITY, high = -INFINITY;
    static const double values[] = {NAN, INFINITY, -INFINITY, 0, -2, 3};
    for (size_t i = 0; i < 6; i++) axis_include(&linear, values[i], &low, &high);
    assert_true(low == -2 && high == 3);
    low = INFINITY;
    high = -INFINITY;
    for (size_t i = 0; i < 6; i++) axis_include(&logarithmic, values[i], &low, &high);
    assert_true(low == 3 && high == 3);
    const axis a = {.scale = AXIS_LOG, .low = 1, .high = 100};
    assert_true(axis_place(&a, 0) == -INFINITY && axis_place(&a, -1) == -INFINITY && isnan(axis_place(&a, NAN)));
    assert_true(fabs(axis_place(&a, 10) - 0.5) < 1e-15);
}

static void a_range_that_is_given_stays(void **state)
{
    (void)state;
    const axis a = axis_fit((axis){.scale = AXIS_LINEAR, .low = -0.123, .high = 0.77}, -5, 5);
    assert_true(a.low == -0.123 && a.high == 0.77);
    /* A logarithmic axis cannot begin at 0. */
    const axis b = axis_fit((axis){.scale = AXIS_LOG, .low = 0, .high = 10}, 1, 10);
    assert_true(b.low == 1 && b.high == 10);
}

/* The labels from left to right, with spaces between. */
static void expect_labels(axis a, double low, double high, int most, const char *expected)
{
    a = axis_fit(a, low, high);
    const axis_ticks t = axis_make_ticks(&a, most);
    char all[1024] = "";
    for (size_t i = 0; i < t.n; i++)
        if (t.ticks[i].label[0]) strcat(strcat(all, *all ? " " : ""), t.ticks[i].label);
    assert_string_equal(all, expected);
}

static void labels_are_short_and_exact(void **state)
{
    (void)state;
    const axis linear = {.scale = AXIS_LINEAR}, logarithmic = {.scale = AXIS_LOG}, degrees = {.scale = AXIS_DEGREES};
    expect_labels(linear, 0, 1, 6, "0 0.2 0.4 0.6 0.8 1.0");
    expect_labels(linear, -3, 3, 7, "−3 −2 −1 0 1 2 3");
    expect_labels(linear, 0, 4e6, 5, "0 1×10^{6} 2×10^{6} 3×10^{6} 4×10^{6}");
    expect_labels(linear, 0, 2e-7, 3, "0 1×10^{−7} 2×10^{−7}");
    expect_labels(logarithmic, 1e-4, 1e3, 10, "10^{−4} 10^{−3} 10^{−2} 0.1 1 10 100 10^{3}");
    expect_labels(logarithmic, 1e-300, 1, 10, "10^{−8} 10^{−7} 10^{−6} 10^{−5} 10^{−4} 10^{−3} 10^{−2} 0.1 1");
    expect_labels(degrees, 0, 90, 8, "0 15 30 45 60 75 90");
    expect_labels((axis){.scale = AXIS_DEGREES, .low = -180, .high = 180}, 0, 0, 9,
                  "−180 −135 −90 −45 0 45 90 135 180");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fitted_axes_hold_the_data_and_have_few_ticks_at_round_numbers),
        cmocka_unit_test(data_without_a_range_give_one),
        cmocka_unit_test(only_what_an_axis_can_show_counts),
        cmocka_unit_test(a_range_that_is_given_stays),
        cmocka_unit_test(labels_are_short_and_exact),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
