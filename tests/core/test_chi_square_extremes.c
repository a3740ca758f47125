/* test_chi_square_extremes.c: samplers at the ends of their parameters and at grazing views draw as claimed.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"ggx alpha=1e-4", .8, 1},
    {"ggx alpha=1", 1e-4, 2},
    {"ggx alpha_x=1 alpha_y=.1", .01, 3},
    {"beckmann alpha=1e-4", .8, 1},
    {"beckmann alpha=1", 1e-4, 2},
    {"phong alpha_x=1e-3 alpha_y=1e-3", .8, 1},
    {"phong alpha_x=1 alpha_y=.1", .01, 3},
    {"gtr alpha=1e-4 gamma=.05", .8, 1},
    {"gtr alpha=1e-4 gamma=1.001", .5, 1},
    {"gtr alpha=1e-4 gamma=20", .8, 1},
    {"gtr alpha=1 gamma=4.5", 1e-4, 2},
    {"gtr alpha_x=1 alpha_y=.1 gamma=.999", .01, 3},
    {"ward alpha=1e-4", .8, 1},
    {"ward alpha=1", .01, 1},
    {"vray sharpness=.7 gamma=1.5", .3, 1},
    {"disney roughness=1 anisotropic=1 clearcoat=1", .05, 1},
};

static void extremes_draw_their_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(extremes_draw_their_density),
    };
    return cmocka_run_group_tests_name("chi_square_extremes", tests, NULL, NULL);
}
