/* test_chi_square_phong.c: Phong draws normals with the density that it reports.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"phong exponent=0", .5, 1},
    {"phong exponent=50", .8, 0},
    {"phong alpha_x=.2 alpha_y=.5", .4, 3},
    {"phong exponent=10 kd=.4 ks=.6", .1, 2},
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
    const any_bsdf bsdf = any_bsdf_of("phong exponent=50", 1);
    const float view[3] = {.6f, 0, .8f};
    const chi_square result = sampler_check(draw_as_printed, &exponent, &bsdf.twice, view, 1000000, 1);
    print_message("  exponent 1/(n + 1): chi^2 %.1f of %d, p %.3g\n", result.statistic, result.degrees, result.p);
    assert_true(result.p < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(phong_draws_its_density),
        cmocka_unit_test(the_printed_exponent_is_found),
    };
    return cmocka_run_group_tests_name("chi_square_phong", tests, NULL, NULL);
}
