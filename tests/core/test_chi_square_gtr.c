/* test_chi_square_gtr.c: GTR draws visible normals, and all normals, with the density that it reports.
 *
 * The density in double comes from other code than the sampler: D and the polynomials of A.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/sampler_check.h"

/* Each gamma of either form of the polynomial, both ends of alpha, from the normal to 89 degrees. */
static const sampler_case visible[] = {
    {"gtr alpha=1e-3 gamma=1", .5, 1},
    {"gtr alpha=.01 gamma=1.001", .3, 2},
    {"gtr alpha=.1 gamma=.05", .3, 3},
    {"gtr alpha=.3 gamma=.3", .02, 4},
    {"gtr alpha=.1 gamma=.999", .1, 5},
    {"gtr alpha=.05 gamma=1.5", .017, 6},
    {"gtr alpha=.3 gamma=1.5", 1, 0},
    {"gtr alpha=.3 gamma=2", .1, .5},
    {"gtr alpha=.5 gamma=3", .2, 1.5},
    {"gtr alpha=.7 gamma=4.5", .05, 2.5},
    {"gtr alpha=1 gamma=10", .3, 3.5},
    {"gtr alpha=.9 gamma=20", .1, 4.5},
    {"gtr alpha_x=.1 alpha_y=.6 gamma=1.3", .3, .9},
    {"gtr alpha_x=.8 alpha_y=.05 gamma=.7", .15, 5.5},
    {"gtr alpha_x=.5 alpha_y=.1 gamma=6", .2, 1},
};

static const sampler_case all_normals[] = {
    {"gtr alpha=.1 gamma=1 sampling=ndf", .5, 1},
    {"gtr alpha=.3 gamma=.3 sampling=ndf", .3, 2},
    {"gtr alpha_x=.2 alpha_y=.5 gamma=3 kd=.3 sampling=ndf", .4, 3},
    {"gtr alpha_x=.2 alpha_y=.5 gamma=1.2 kd=.3 ks=.5", .2, 4},
    {"gtr alpha_x=.2 alpha_y=.5 gamma=1.2 anisotropy=disney", .3, 5},
};

static void visible_normals_have_their_density(void **state)
{
    (void)state;
    check_samplers(visible, sizeof visible/sizeof visible[0]);
}

static void all_normals_and_mixtures_have_their_density(void **state)
{
    (void)state;
    check_samplers(all_normals, sizeof all_normals/sizeof all_normals[0]);
}

/* The test can fail: three hundredths of gamma are found. */
static void a_gamma_off_by_3_hundredths_is_found(void **state)
{
    (void)state;
    const any_bsdf drawn = any_bsdf_of("gtr alpha=.3 gamma=1.5", 0);
    const any_bsdf claimed = any_bsdf_of("gtr alpha=.3 gamma=1.53", 1);
    double wo[3];
    any_direction(.2, 1, wo);
    const float view[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    const chi_square result = sampler_check(draw_from_bsdf, &drawn.single, &claimed.twice, view, 1000000, 1);
    print_message("  gamma 1.5 against 1.53: chi^2 %.1f of %d, p %.3g\n", result.statistic, result.degrees, result.p);
    assert_true(result.p < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(visible_normals_have_their_density),
        cmocka_unit_test(all_normals_and_mixtures_have_their_density),
        cmocka_unit_test(a_gamma_off_by_3_hundredths_is_found),
    };
    return cmocka_run_group_tests_name("chi_square_gtr", tests, NULL, NULL);
}
