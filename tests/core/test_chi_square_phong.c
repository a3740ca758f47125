/* test_chi_square_phong.c: Phong draws normals with the density that it reports.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"phong exponent=0", .3, 1},
    {"phong exponent=1", .0175, 1},
    {"phong exponent=50", .8, 0},
    {"phong exponent=1000", .0175, 5},
    {"phong exponent=1e5", .0175, 2},
    {"phong alpha_x=.2 alpha_y=.5", .1, 3},
    {"phong exponent=10 kd=.4 ks=.6 masking=published", .1, 2},
    {"phong exponent=50 sampling=ndf", .8, 0},
};

static void phong_draws_its_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

/* The Phong sampler as printed in CS500 Project 3, cos = xi^(1/(n + 1)): errata 4. */
static void draw_as_printed(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to)
{
    const double exponent = *(const double *)context;
    draws random = {seed};
    for (int i = 0; i < n; i++) {
        double m[3];
        any_direction(pow(draw(&random), 1/(exponent + 1)), 6.283185307179586*draw(&random), m);
        const double wo_m = (double)wo[0]*m[0] + (double)wo[1]*m[1] + (double)wo[2]*m[2];
        to.wi_x[i] = (float)(2*wo_m*m[0] - (double)wo[0]);
        to.wi_y[i] = (float)(2*wo_m*m[1] - (double)wo[1]);
        to.wi_z[i] = (float)(2*wo_m*m[2] - (double)wo[2]);
        to.pdf[i] = wo_m > 0 && to.wi_z[i] > 0;
    }
}

static void the_printed_exponent_is_found(void **state)
{
    (void)state;
    const double exponent = 50;
    const any_bsdf bsdf = any_bsdf_of("phong exponent=50 sampling=ndf", 1);
    const float view[3] = {.6f, 0, .8f};
    const chi_square result = sampler_check(draw_as_printed, &exponent, &bsdf.twice, view, 1000000, 1);
    print_message("  exponent 1/(n + 1): chi^2 %.1f of %d, p %.3g\n", result.statistic, result.degrees, result.p);
    assert_true(result.p < 1e-6);
}

typedef struct moments {
    double mean, variance;
} moments;

static moments weights(double exponent, const char *sampling, double cos_o, int n)
{
    char spec[160];
    snprintf(spec, sizeof spec, "phong exponent=%g sampling=%s", exponent, sampling);
    const any_bsdf bsdf = any_bsdf_of(spec, 0);
    draws random = {7};
    double wo[3], sum = 0, squares = 0;
    any_direction(cos_o, .5, wo);
    for (int i = 0; i < n; i++) {
        const double u[3] = {draw(&random), draw(&random), draw(&random)};
        const double w = any_sample(&bsdf, wo, u).weight[0];
        sum += w;
        squares += w*w;
    }
    return (moments){.mean = sum/n, .variance = squares/n - (sum/n)*(sum/n)};
}

/* Both estimate the same albedo, visible normals with less noise. */
static void visible_normals_are_less_noisy(void **state)
{
    (void)state;
    static const double exponents[] = {1, 5, 50, 1000, 1e5}, views[] = {.98, .5, .087, .0175};
    enum { N = 8000 };
    for (int e = 0; e < 5; e++)
        for (int c = 0; c < 4; c++) {
            const moments a = weights(exponents[e], "vndf", views[c], N), b = weights(exponents[e], "ndf", views[c], N);
            const double error = sqrt((a.variance + b.variance)/N);
            print_message("  n %6g cos_o %.4f: albedo %.4f %.4f, variance %.2g, ndf %.2g (%.1f times)\n", exponents[e],
                          views[c], a.mean, b.mean, a.variance, b.variance, b.variance/a.variance);
            /* Five sigma, or the roundings of float where there is hardly any noise. */
            if (!(fabs(a.mean - b.mean) <= 5*error + 1e-5)) fail_msg("means differ by more than %g", 5*error);
            assert_true(a.variance < b.variance);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phong_draws_its_density),
        cmocka_unit_test(the_printed_exponent_is_found),
        cmocka_unit_test(visible_normals_are_less_noisy),
    };
    return cmocka_run_group_tests_name("chi_square_phong", tests, NULL, NULL);
}
