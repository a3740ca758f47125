/* test_chi_square_mixtures.c: all normals, the Lambertian lobe, and mixtures are drawn as claimed.
 * SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/sampler_check.h"

static const sampler_case cases[] = {
    {"lambert", .5, 1},
    {"ggx alpha=.3 sampling=ndf", .6, 1},
    {"ggx alpha=.6 sampling=ndf", .1, 2},
    {"ggx alpha_x=.1 alpha_y=.6 sampling=ndf", .4, 3},
    {"ggx alpha=.2 kd=.5 ks=.3,.5,.7", .5, 4},
    {"ggx alpha=.4 kd=.2 ior=1.5 sampling=ndf", .3, 5},
    {"ggx alpha=.3 kd=.5,.4,.3 metal=Cu", .4, 6},
    {"ggx alpha=.5 kd=.5 ks=.2 f82=.1 g2=separable", .6, 7},
    {"cs500 ndf=phong exponent=5 kd=.2 ks=.5", .3, 6},
    {"cs500 ndf=beckmann alpha=.3 kd=.8 ks=.04", .7, 2},
    {"metallic_roughness roughness=.3", .8, 1},
    {"metallic_roughness roughness=.6 diffuse=burley", .2, 2},
    {"metallic_roughness metallic=1 roughness=.7", .5, 3},
};

static void mixtures_draw_their_density(void **state)
{
    (void)state;
    check_samplers(cases, sizeof cases/sizeof cases[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mixtures_draw_their_density),
    };
    return cmocka_run_group_tests_name("chi_square_mixtures", tests, NULL, NULL);
}
