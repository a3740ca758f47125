/* test_chi_square_glass.c: rough glass is drawn as claimed, over the whole sphere, from either side.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"glass alpha=.3", -.8, 2},
    {"glass alpha=.7", .2, 3},
    {"glass alpha_x=.1 alpha_y=.5 ior=2.5", -.9, 1},
    {"glass alpha=.3 sampling=ndf g2=separable", -.7, 2},
    {"glass alpha=.4 ndf=beckmann ior=.6", .5, 3},
    {"glass exponent=20 ndf=phong", .4, 4},
    {"glass alpha=.3 ndf=gtr gamma=1.5", -.8, 2},
    {"glass alpha=.3 wall=thin", -.5, 1},
};

static void glass_draws_its_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(glass_draws_its_density),
    };
    return cmocka_run_group_tests_name("chi_square_glass", tests, NULL, NULL);
}
