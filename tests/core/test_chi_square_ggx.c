/* test_chi_square_ggx.c: GGX draws visible normals with the density that it reports.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"ggx alpha=.02", .7, .4},
    {"ggx alpha=.3", 1, 0},
    {"ggx alpha=.3", .6, 1},
    {"ggx alpha=.3", .05, 2},
    {"ggx alpha=1", .3, 3},
    {"ggx alpha=4", .8, 2},
    {"ggx alpha=.5 sampling=bounded", .5, 1},
    {"ggx alpha=1 sampling=bounded", .9, 1},
    {"ggx alpha_x=.9 alpha_y=.4 sampling=bounded kd=.2", .3, 4},
    {"ggx alpha_x=.1 alpha_y=.6", .7, .9},
    {"ggx alpha_x=.8 alpha_y=.05", .15, 5},
};

static void ggx_draws_its_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

/* The test can fail: two hundredths more roughness in the density are found. */
static void a_roughness_off_by_2_percent_is_found(void **state)
{
    (void)state;
    const any_bsdf drawn = any_bsdf_of("ggx alpha=.3", 0), claimed = any_bsdf_of("ggx alpha=.306", 1);
    double wo[3];
    any_direction(.6, 1, wo);
    const float view[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
    const chi_square result = sampler_check(draw_from_bsdf, &drawn.single, &claimed.twice, view, 1000000, 1);
    print_message("  alpha .3 against .306: chi^2 %.1f of %d, p %.3g\n", result.statistic, result.degrees, result.p);
    assert_true(result.p < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ggx_draws_its_density),
        cmocka_unit_test(a_roughness_off_by_2_percent_is_found),
    };
    return cmocka_run_group_tests_name("chi_square_ggx", tests, NULL, NULL);
}
