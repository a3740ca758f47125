/* test_energy_grid.c: white surfaces over a grid of extremes: nothing is made of one bounce, nothing lost of all.
 *
 * By the library's quadrature of albedos (test_albedo_quadrature.c); test_energy.c has a second one.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "facet/facet.h"
#include "tests/any_bsdf.h"
#include "tests/extremes.h"
#include "verify/quadrature.h"

#define PI 3.14159265358979323846

static double power_of(const any_bsdf *bsdf, const double wo[3], double ior)
{
    double r[3], t[3], error;
    assert_int_equal(facet_bsdf64_albedo(&bsdf->twice, wo, r, t, &error), FACET_OK);
    return r[0] + (wo[2] > 0 ? ior*ior : 1/(ior*ior))*t[0];
}

static any_bsdf with_energy(const extreme *s, const char *energy)
{
    char spec[160];
    snprintf(spec, sizeof spec, "%s energy=%s", s->spec, energy);
    return any_bsdf_of(spec, 1);
}

/* What the lobe of several bounces adds: smooth, but steep near the horizon.  The azimuths are off the view's plane by
 * 0.01, where the specular lobe may be too high to be taken off. */
static double added_albedo(const any_bsdf *multi, const any_bsdf *single, const double wo[3], double azimuth)
{
    const quadrature cosine = unit_interval(1.0/16);
    enum { AZIMUTHS = 32 };
    double sum = 0;
    for (int i = 0; i < cosine.n; i++)
        for (int j = 0; j < AZIMUTHS; j++) {
            double wi[3], with[3], without[3];
            any_direction(cosine.x[i], azimuth + PI + 0.01 + 2*PI*j/AZIMUTHS, wi);
            any_eval(multi, wi, wo, with);
            any_eval(single, wi, wo, without);
            sum += cosine.w[i]*2*PI/AZIMUTHS*(with[0] - without[0]);
        }
    return sum;
}

/* Of white facets: at most 1 + 1e-4 in one bounce, 1 within 1e-3 in all. */
static void white_furnace_is_white_with_all_bounces(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < N_EXTREMES; i++) {
        const extreme s = extreme_shape(i);
        const int is_isotropic = s.x == s.y;
        if (s.gamma > 0 && s.gamma != 2 && s.x == 1 && s.y == 1) continue; /* the same for every gamma */
        const any_bsdf single = any_bsdf_of(s.spec, 1), multi = with_energy(&s, "multi");
        const any_bsdf scaled = with_energy(&s, "scaled");
        for (int c = 0; c < (is_isotropic ? 3 : 1); c++) {
            static const double cosines[] = {.3, 1, 1e-4};
            double wo[3], f[3], g[3];
            any_direction(cosines[c], 0.7, wo);
            if (cosines[c] < 1e-3 && s.gamma > .5 && s.gamma < 20) continue; /* takes time */
            const double E = power_of(&single, wo, 1), all = E + added_albedo(&multi, &single, wo, 0.7);
            const double wi[3] = {-.36, .48, .8};
            any_eval(&single, wi, wo, f);
            any_eval(&scaled, wi, wo, g);
            const double total = f[0] > 1e-200 ? E*g[0]/f[0] : 1;
            worst = fmax(worst, fmax(fabs(all - 1), fabs(total - 1)));
            if (!(E <= 1 + 1e-4 && fabs(all - 1) <= 1e-3 && fabs(total - 1) <= 1e-3))
                fail_msg("%s, cos %g: single %.6f, multi %.6f, scaled %.6f", s.spec, cosines[c], E, all, total);
        }
    }
    print_message("  largest deviation: %.2g\n", worst);
}

/* No other model makes light where it claims not to, at either end of the cosine. */
static void no_model_makes_light(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double ior;
    } honest[] = {{"lambert kd=1", 1},
                  {"ward alpha=1", 1},
                  {"ward alpha=1e-4", 1},
                  {"ward alpha_x=1 alpha_y=.1", 1},
                  {"glass ior=1.5", 1.5},
                  {"glass alpha=1 ior=1.5", 1.5},
                  {"glass alpha=.01 ior=1.5", 1.5},
                  {"glass alpha_x=1 alpha_y=.1 ior=1.5 g2=separable", 1.5},
                  {"glass alpha=1 ndf=beckmann ior=1.5", 1.5},
                  {"glass alpha=.3 wall=thin", 1},
                  {"metallic_roughness metallic=1 base_color=1 roughness=0", 1},
                  {"metallic_roughness metallic=1 base_color=1 roughness=1", 1},
                  {"disney metallic=1 base_color=1 roughness=1", 1},
                  {"disney metallic=1 base_color=1 roughness=.3 anisotropic=1", 1},
                  {"cs500 alpha=1 masking=exact", 1},
                  {"cs500 ndf=phong exponent=0 masking=exact", 1},
                  {"cs500 ndf=beckmann alpha=.3 masking=exact", 1},
                  {"vray sharpness=0 gamma=20 masking=exact", 1},
                  {"vray sharpness=.7 gamma=.05 masking=exact g2=correlated", 1},
                  {"vray sharpness=.7 gamma=1", 1},
                  {"beckmann alpha=.5 masking=published", 1}};
    static const double cosines[] = {1, .3, 1e-4};
    for (size_t i = 0; i < sizeof honest/sizeof honest[0]; i++) {
        const any_bsdf bsdf = any_bsdf_of(honest[i].spec, 1);
        for (int c = 0; c < 3; c++) {
            double wo[3];
            any_direction(cosines[c], 0.7, wo);
            const double E = power_of(&bsdf, wo, honest[i].ior);
            if (!(E > 0 && E <= 1 + 1e-4)) fail_msg("%s, cos %g: %.6f", honest[i].spec, cosines[c], E);
        }
    }
}

/* Those that do by construction, as their pages say, to the digits there: lobes that are added, Ward's two first
 * normalisations, the fit of Beckmann's masking taken for Phong. */
static void who_makes_light_is_known(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double cos_o, albedo;
    } known[] = {{"metallic_roughness metallic=0 base_color=1 roughness=.2", .1, 1.43},
                 {"disney base_color=1", .1, 1.18},
                 {"cs500 kd=1 ks=.04 alpha=.3", .2, 1.10},
                 {"ward alpha=.3 variant=duer", .1, 1.161},
                 {"ward alpha=.3 variant=ward92", .001, 1.364},
                 {"phong exponent=1 g2=separable masking=published", .1, 1.137}};
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++) {
        const any_bsdf bsdf = any_bsdf_of(known[i].spec, 1);
        double wo[3];
        any_direction(known[i].cos_o, 0, wo);
        const double E = power_of(&bsdf, wo, 1);
        if (!(fabs(E - known[i].albedo) <= 0.006)) fail_msg("%s: %.6f, not %g", known[i].spec, E, known[i].albedo);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_is_white_with_all_bounces),
        cmocka_unit_test(no_model_makes_light),
        cmocka_unit_test(who_makes_light_is_known),
    };
    return cmocka_run_group_tests_name("energy_grid", tests, NULL, NULL);
}
