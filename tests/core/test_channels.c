/* test_channels.c: a colour is three numbers that have nothing to do with each other.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"

enum { N_DRAWS = 100 };

static void each_channel_is_that_of_a_grey_material(void **state)
{
    (void)state;
    static const struct {
        const char *coloured, *grey[3];
    } cases[] = {
        {"ggx alpha=.6 energy=multi ks=.9,.6,.3 f82=.2,.8,1",
         {"ggx alpha=.6 energy=multi ks=.9 f82=.2", "ggx alpha=.6 energy=multi ks=.6 f82=.8",
          "ggx alpha=.6 energy=multi ks=.3 f82=1"}},
        {"ggx alpha=.6 energy=multi eta=.3,1,2 k=2,.1,.5",
         {"ggx alpha=.6 energy=multi eta=.3 k=2", "ggx alpha=.6 energy=multi eta=1 k=.1",
          "ggx alpha=.6 energy=multi eta=2 k=.5"}},
        {"metallic_roughness metallic=.5 base_color=.9,.5,.1 specular_color=1,.2,.3 diffuse=burley",
         {"metallic_roughness metallic=.5 base_color=.9 specular_color=1 diffuse=burley",
          "metallic_roughness metallic=.5 base_color=.5 specular_color=.2 diffuse=burley",
          "metallic_roughness metallic=.5 base_color=.1 specular_color=.3 diffuse=burley"}},
        {"ward alpha=.3 kd=.5,.1,.3 ks=.2,.4,.6",
         {"ward alpha=.3 kd=.5 ks=.2", "ward alpha=.3 kd=.1 ks=.4", "ward alpha=.3 kd=.3 ks=.6"}},
    };
    draws random = {3};
    for (size_t i = 0; i < sizeof cases/sizeof *cases; i++)
        for (int channel = 0; channel < 3; channel++)
            for (int is_double = 0; is_double < 2; is_double++) {
                const any_bsdf all = any_bsdf_of(cases[i].coloured, is_double);
                const any_bsdf one = any_bsdf_of(cases[i].grey[channel], is_double);
                for (int n = 0; n < N_DRAWS; n++) {
                    double wi[3], wo[3], f[3], g[3];
                    draw_direction(&random, wi);
                    draw_direction(&random, wo);
                    any_eval(&all, wi, wo, f);
                    any_eval(&one, wi, wo, g);
                    if (!(fabs(f[channel] - g[0]) <= 8*any_epsilon(&all)*g[0]))
                        fail_msg("%s, channel %d: %a, alone %a", cases[i].coloured, channel, f[channel], g[0]);
                }
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_channel_is_that_of_a_grey_material),
    };
    return cmocka_run_group_tests_name("channels", tests, NULL, NULL);
}
