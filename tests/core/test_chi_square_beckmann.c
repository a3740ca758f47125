/* test_chi_square_beckmann.c: Beckmann draws normals with the density that it reports.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"beckmann alpha=.5", .05, 2},
    {"beckmann alpha=.3", .00175, 1},
    {"beckmann alpha_x=.9 alpha_y=.1", .3, 3},
    {"beckmann alpha_x=.1 alpha_y=.4 sampling=ndf", .5, 4},
};

static void beckmann_draws_its_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(beckmann_draws_its_density),
    };
    return cmocka_run_group_tests_name("chi_square_beckmann", tests, NULL, NULL);
}
