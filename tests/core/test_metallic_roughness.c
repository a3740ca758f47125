/* test_metallic_roughness.c: glTF's material: its diffuse term, its sampler's shares, and its clamp.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"

#define PI 3.14159265358979323846

enum { N_DRAWS = 500 };

/* Without a specular term, Disney's diffuse one alone:
 * kd/pi (1 + (FD90 - 1)(1 - cos_i)^5)(1 + (FD90 - 1)(1 - cos_o)^5), FD90 = 1/2 + 2 roughness cos_d^2, cos_d = wi.wm
 * (Burley 2012, section 5.3). */
static void burley_is_disneys_diffuse_term(void **state)
{
    (void)state;
    const double roughness = .7;
    draws random = {1};
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf bsdf = any_bsdf_of(
            "metallic_roughness base_color=.8,.4,.2 roughness=.7 specular=0 diffuse=burley", is_double);
        for (int n = 0; n < N_DRAWS; n++) {
            double wi[3], wo[3], f[3];
            draw_direction(&random, wi);
            draw_direction(&random, wo);
            wi[2] = fabs(wi[2]);
            wo[2] = fabs(wo[2]);
            const double cos_d2 = (1 + wi[0]*wo[0] + wi[1]*wo[1] + wi[2]*wo[2])/2;
            const double FD90_1 = 2*roughness*cos_d2 - .5;
            const double want = .8/PI*(1 + FD90_1*pow(1 - wi[2], 5))*(1 + FD90_1*pow(1 - wo[2], 5))*wi[2];
            any_eval(&bsdf, wi, wo, f);
            const double bound = 32*any_epsilon(&bsdf);
            if (!(fabs(f[0] - want) <= bound && fabs(f[1] - want/2) <= bound && fabs(f[2] - want/4) <= bound))
                fail_msg("wi %a %a %a wo %a %a %a: %a, not %a", wi[0], wi[1], wi[2], wo[0], wo[1], wo[2], f[0], want);
        }
    }
}

/* However weak a lobe, an eighth of the samples are its own: the density of the other lobe alone is 8/7 of it at most,
 * and the part that it adds is an eighth of its own density. */
static void no_lobe_is_starved(void **state)
{
    (void)state;
    double wo[3], mirror[3];
    any_direction(.5, 0, wo);
    any_direction(.5, PI, mirror);
    const double up[3] = {0, 0, 1};
    const any_bsdf dark = any_bsdf_of("metallic_roughness base_color=1e-3 roughness=.05", 1);
    const any_bsdf dull = any_bsdf_of("metallic_roughness roughness=.05 specular=1e-3", 1);
    const any_bsdf metal = any_bsdf_of("metallic_roughness roughness=.05 metallic=1", 1);
    assert_true(fabs(any_pdf(&dark, up, wo) - .125/PI) < 1e-3);
    const double specular = any_pdf(&metal, mirror, wo);
    assert_true(specular > 1e3);
    assert_true(fabs(any_pdf(&dull, mirror, wo)/specular - .125) < 1e-3);
}

/* A tint that would reflect more than all light counts as the one that reflects all. */
static void reflectance_is_held_at_1(void **state)
{
    (void)state;
    static const float base[3] = {.5f, .5f, .5f}, bright[3] = {50, 60, 70}, exact[3] = {4, 4, 4};
    const facet_bsdf held = facet_bsdf_metallic_roughness(base, 0, .5f, .25f, 1, bright);
    const facet_bsdf full = facet_bsdf_metallic_roughness(base, 0, .5f, .25f, 1, exact);
    draws random = {2};
    for (int n = 0; n < N_DRAWS; n++) {
        double a[3], b[3];
        draw_direction(&random, a);
        draw_direction(&random, b);
        const float wi[3] = {(float)a[0], (float)a[1], (float)a[2]}, wo[3] = {(float)b[0], (float)b[1], (float)b[2]};
        float f[3], g[3];
        facet_bsdf_eval(&held, wi, wo, f);
        facet_bsdf_eval(&full, wi, wo, g);
        assert_memory_equal(f, g, sizeof f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(burley_is_disneys_diffuse_term),
        cmocka_unit_test(no_lobe_is_starved),
        cmocka_unit_test(reflectance_is_held_at_1),
    };
    return cmocka_run_group_tests_name("metallic_roughness", tests, NULL, NULL);
}
