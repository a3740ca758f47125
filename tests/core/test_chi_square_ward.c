/* test_chi_square_ward.c: Ward's lobe is drawn with the density that it reports, with and without flipped normals.
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
    {"ward alpha=.1", .9, 1},
    {"ward alpha=.3", .1, 0},
    {"ward alpha_x=.1 alpha_y=.5", .4, 3},
    {"ward alpha_x=.8 alpha_y=.2 variant=duer", .05, 1},
    {"ward alpha=.3 variant=ward92 kd=.4 ks=.6", .3, 5},
    {"ward alpha=.2 sampling=ndf", .7, 1},
    {"ward alpha_x=.2 alpha_y=.5 sampling=ndf kd=.1", .1, 4},
};

static void ward_draws_its_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

/* The printed azimuth, an arc tangent, leaves half of the directions out: errata 25. */
static void draw_as_printed(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to)
{
    draws random = {seed};
    for (int i = 0; i < n; i++) {
        const double u = draw(&random), v = draw(&random), alpha = *(const double *)context;
        const double phi = atan(tan(6.283185307179586*v)), theta = atan(alpha*sqrt(-log(u)));
        double m[3];
        any_direction(cos(theta), phi, m);
        const double wo_m = (double)wo[0]*m[0] + (double)wo[1]*m[1] + (double)wo[2]*m[2];
        to.wi_x[i] = (float)(2*wo_m*m[0] - (double)wo[0]);
        to.wi_y[i] = (float)(2*wo_m*m[1] - (double)wo[1]);
        to.wi_z[i] = (float)(2*wo_m*m[2] - (double)wo[2]);
        to.pdf[i] = wo_m > 0 && to.wi_z[i] > 0;
    }
}

static void the_printed_azimuth_is_found(void **state)
{
    (void)state;
    const double alpha = .2;
    const any_bsdf bsdf = any_bsdf_of("ward alpha=.2 sampling=ndf", 1);
    const float view[3] = {.6f, 0, .8f};
    const chi_square result = sampler_check(draw_as_printed, &alpha, &bsdf.twice, view, SAMPLER_CHECK_COUNT/10, 1);
    print_message("  azimuth by an arc tangent: chi^2 %.1f of %d, p %.3g\n", result.statistic, result.degrees,
                  result.p);
    assert_true(result.p < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ward_draws_its_density),
        cmocka_unit_test(the_printed_azimuth_is_found),
    };
    return cmocka_run_group_tests_name("chi_square_ward", tests, NULL, NULL);
}
