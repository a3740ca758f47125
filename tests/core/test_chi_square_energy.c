/* test_chi_square_energy.c: with the lobe of several bounces samples are drawn as claimed.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/sampler_check.h"

static void mixtures_draw_their_density(void **state)
{
    (void)state;
    static const sampler_case cases[] = {
        {"ggx alpha=1 energy=multi", .8, 1},
        {"ggx alpha=.4 energy=multi", .1, 2},
        {"ggx alpha=.1 ks=.9,.5,.1 kd=.3 energy=multi", .1, 3},
        {"ggx alpha_x=.1 alpha_y=.6 energy=multi", .3, 1},
        {"ggx alpha=.5 ior=1.5 sampling=ndf g2=separable energy=multi", .5, 1},
        {"beckmann alpha=.6 energy=multi", .3, 1},
        {"beckmann alpha=.3 masking=published energy=multi", .2, 1},
        {"phong exponent=5 energy=multi", .4, 1},
        {"ggx alpha=.5 energy=scaled", .5, 1},
    };
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixtures_draw_their_density),
    };
    return cmocka_run_group_tests_name("chi_square_energy", tests, NULL, NULL);
}
