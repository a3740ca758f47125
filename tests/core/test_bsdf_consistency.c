/* test_bsdf_consistency.c: eval, pdf and sample of one material agree with each other, in both precisions.
 *
 * Directions and numbers come from a seeded generator; where float and double are compared they are exact in float.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/weight_check.h"

static const char *const specs[] = {
    "lambert kd=.1,.5,.9",
    "phong exponent=0",
    "phong exponent=50 g2=separable",
    "phong alpha_x=.1 alpha_y=.4 kd=.3",
    "phong exponent=20 masking=published",
    "phong exponent=20 sampling=ndf",
    "beckmann alpha=.05",
    "beckmann alpha=.6 g2=separable",
    "beckmann alpha_x=.1 alpha_y=.5 masking=published",
    "beckmann alpha=.3 sampling=ndf kd=.5 ks=.2,.4,.6",
    "ggx alpha=.05",
    "ggx alpha=1",
    "ggx alpha=.5 g2=separable masking=published",
    "ggx alpha_x=.4 alpha_y=.1 ior=1.5",
    "ggx alpha_x=.9 alpha_y=.3 sampling=bounded",
    "ggx alpha=.5 sampling=bounded kd=.5 energy=multi",
    "ggx alpha=.3 sampling=ndf kd=.5 ior=.7",
    "ggx alpha_x=.1 alpha_y=.3 metal=Au",
    "beckmann alpha=.3 eta=.3,1,2 k=2,.1,.5 kd=.2 sampling=ndf g2=separable",
    "ggx alpha=.5 ks=.9,.6,.3 f82=.2,.8,1",
    "metallic_roughness roughness=.3",
    "metallic_roughness roughness=.7 metallic=.5 base_color=.9,.5,.1 specular=.5 specular_color=1,.2,.3",
    "metallic_roughness roughness=.5 diffuse=burley",
    "gtr alpha=.1 gamma=1.5",
    "gtr alpha_x=.1 alpha_y=.4 gamma=.7 kd=.3 ks=.5",
    "gtr alpha=.4 gamma=6 g2=separable masking=published",
    "gtr alpha_x=.4 alpha_y=.1 gamma=3 anisotropy=disney sampling=ndf",
    "ward alpha=.3",
    "ward alpha_x=.1 alpha_y=.4 variant=duer kd=.5 ks=.2,.4,.6",
    "ward alpha=.2 variant=ward92 sampling=ndf",
    "ward alpha=.2 ks=0 kd=.5",
    "cs500 kd=.5 ks=0",
    "cs500 ndf=phong exponent=12 kd=.5 ior=1.5",
    "disney roughness=.3 subsurface=.5 sheen=1 specular_tint=1 clearcoat=1 clearcoat_gloss=.5",
    "disney metallic=.5 anisotropic=.8 clearcoat=.5 clearcoat_gloss=0 coat_masking=exact g2=correlated",
};
enum { N_SPECS = sizeof specs/sizeof specs[0], N_DRAWS = 2000 };

/* A direction whose components are floats.  volatile: gcc 12 at -O2 drops the rounding where it vectorises it. */
static void draw_float_direction(draws *d, double v[3])
{
    draw_direction(d, v);
    for (int k = 0; k < 3; k++) {
        const volatile float rounded = (float)v[k];
        v[k] = (double)rounded;
    }
}

static void draw_three(draws *d, double u[3])
{
    for (int k = 0; k < 3; k++) u[k] = draw(d);
}

/* |a - b| in units of eps max(|a|, |b|); numbers below the smallest normal float count as 0. */
static double distance(double a, double b, double epsilon)
{
    const double largest = fmax(fabs(a), fabs(b));
    return largest < 0x1p-126 ? 0 : fabs(a - b)/(largest*epsilon);
}

static void each_sample(void (*check)(const any_bsdf *bsdf, const double wo[3], const double u[3]))
{
    for (int i = 0; i < N_SPECS; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(specs[i], is_double);
            draws random = {(uint64_t)i};
            for (int k = 0; k < N_DRAWS; k++) {
                double wo[3], u[3];
                draw_float_direction(&random, wo);
                draw_three(&random, u);
                check(&bsdf, wo, u);
            }
        }
}

static void check_weight(const any_bsdf *bsdf, const double wo[3], const double u[3])
{
    /* A component of wi is off by 3 eps at most: a product, a difference of numbers up to 2, a quotient. */
    weight_check(bsdf, wo, u, 3);
}

static void weight_is_eval_over_pdf(void **state)
{
    (void)state;
    each_sample(check_weight);
}

/* Mirroring keeps lengths: 2 (wo.wm) wm - wo has relative errors of eps in each of five operations, and wm has a length
 * of 1 to 2 eps, which counts four times. */
static void check_direction(const any_bsdf *bsdf, const double wo[3], const double u[3])
{
    const facet_sample64 s = any_sample(bsdf, wo, u);
    const double length = sqrt(s.wi[0]*s.wi[0] + s.wi[1]*s.wi[1] + s.wi[2]*s.wi[2]);
    /* The viewer's own length is rounded in float. */
    if (!(fabs(length - 1) <= 16*any_epsilon(bsdf) + 0x1p-23))
        fail_msg("%s, wo (%a, %a, %a), u (%a, %a, %a): |wi| - 1 = %g", bsdf->spec, wo[0], wo[1], wo[2], u[0], u[1],
                 u[2], length - 1);
    assert_true(s.pdf == 0 || s.wi[2] > 0);
    assert_true(s.lobe & FACET_REFLECTION);
    assert_true(!(s.lobe & (FACET_TRANSMISSION | FACET_DELTA)));
}

static void sampled_directions_are_unit_vectors_above(void **state)
{
    (void)state;
    each_sample(check_direction);
}

/* Roundings that may differ between f(wi,wo) and f(wo,wi), in eps.  The half vector is the same sum, bit for bit;
 * wi.wm and wo.wm differ by 6 eps at most, which Fresnel's term takes times its condition number, at most 10, and
 * times 2 c^2/radicand where the radicand c^2 - (1 - ior^2) of total reflection is nearly 0. */
static double reciprocity_bound(const any_bsdf *bsdf, const double wi[3], const double wo[3])
{
    if (!strstr(bsdf->spec, "ior=.7")) return 64;
    const double c2 = 0.5*(1 + wi[0]*wo[0] + wi[1]*wo[1] + wi[2]*wo[2]);
    return 64 + 12*c2/fmax(fabs(c2 - 0.51), any_epsilon(bsdf));
}

static void eval_is_reciprocal(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < N_SPECS; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(specs[i], is_double);
            draws random = {(uint64_t)i};
            for (int n = 0; n < N_DRAWS; n++) {
                double wi[3], wo[3], forth[3], back[3];
                draw_direction(&random, wi);
                draw_direction(&random, wo);
                any_eval(&bsdf, wi, wo, forth);
                any_eval(&bsdf, wo, wi, back);
                for (int k = 0; k < 3; k++) {
                    const double ulps = distance(forth[k]*wo[2], back[k]*wi[2], any_epsilon(&bsdf));
                    worst = fmax(worst, ulps);
                    if (!(ulps <= reciprocity_bound(&bsdf, wi, wo)))
                        fail_msg("%s, wi (%a, %a, %a), wo (%a, %a, %a): f %a and %a", specs[i], wi[0], wi[1], wi[2],
                                 wo[0], wo[1], wo[2], forth[k]/wi[2], back[k]/wo[2]);
                }
            }
        }
    print_message("  largest difference of f(wi,wo) and f(wo,wi): %.1f eps\n", worst);
}

/* With F = 1 the weight of a visible normal is G2/G1(wo) <= 1; 8 roundings. */
static void visible_normals_never_weigh_more_than_one(void **state)
{
    (void)state;
    static const char *const white[] = {"ggx alpha=1e-4",
                                        "ggx alpha=.3",
                                        "ggx alpha=4",
                                        "ggx alpha=1 g2=separable",
                                        "phong exponent=0",
                                        "phong exponent=1e6 g2=separable",
                                        "phong alpha_x=.9 alpha_y=.01",
                                        "beckmann alpha=1e-4",
                                        "beckmann alpha=.5",
                                        "beckmann alpha_x=4 alpha_y=.01 g2=separable"};
    for (size_t i = 0; i < sizeof white/sizeof white[0]; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(white[i], is_double);
            draws random = {(uint64_t)i};
            double sum = 0;
            for (int n = 0; n < N_DRAWS; n++) {
                double wo[3], u[3];
                draw_float_direction(&random, wo);
                draw_three(&random, u);
                const facet_sample64 s = any_sample(&bsdf, wo, u);
                sum += s.weight[0];
                if (!(s.weight[0] <= 1 + 8*any_epsilon(&bsdf)))
                    fail_msg("%s, wo (%a, %a, %a), u (%a, %a, %a): weight %a", white[i], wo[0], wo[1], wo[2], u[0],
                             u[1], u[2], s.weight[0]);
            }
            assert_true(sum > 0);
        }
}

/* The two builds of the kernels at the same inputs.  The error is relative to the value, and grows with the exponent
 * of D, at most 40 where the value is above 1e-15 of D at the normal, and like 1/cos at grazing angles of alpha .05. */
static void float_agrees_with_double(void **state)
{
    (void)state;
    double worst = 0;
    for (int i = 0; i < N_SPECS; i++) {
        const any_bsdf single = any_bsdf_of(specs[i], 0), twice = any_bsdf_of(specs[i], 1);
        draws random = {(uint64_t)(100 + i)};
        for (int n = 0; n < N_DRAWS; n++) {
            double wi[3], wo[3], f[3], exact[3];
            draw_float_direction(&random, wi);
            draw_float_direction(&random, wo);
            any_eval(&single, wi, wo, f);
            any_eval(&twice, wi, wo, exact);
            const double values[2][4] = {{f[0], f[1], f[2], any_pdf(&single, wi, wo)},
                                         {exact[0], exact[1], exact[2], any_pdf(&twice, wi, wo)}};
            for (int k = 0; k < 4; k++) {
                if (values[1][k] < 1e-12) continue;
                const double error = fabs(values[0][k]/values[1][k] - 1);
                worst = fmax(worst, error);
                if (!(error <= 2e-5))
                    fail_msg("%s, wi (%a, %a, %a), wo (%a, %a, %a), value %d: float %a, double %a", specs[i], wi[0],
                             wi[1], wi[2], wo[0], wo[1], wo[2], k, values[0][k], values[1][k]);
            }
        }
    }
    print_message("  largest relative difference of float and double: %.2g\n", worst);
}

/* facet_bsdf_D is the D of facet_bsdf_terms, to the last bit, in both builds. */
static void D_alone_is_that_of_the_terms(void **state)
{
    (void)state;
    for (int i = 0; i < N_SPECS; i++) {
        const any_bsdf bsdf = any_bsdf_of(specs[i], 1);
        const facet_bsdf single = single_bsdf_of(specs[i]);
        draws random = {(uint64_t)(200 + i)};
        for (int n = 0; n < 20; n++) {
            double m[3];
            draw_float_direction(&random, m);
            const float rounded[3] = {(float)m[0], (float)m[1], (float)m[2]};
            assert_true(facet_bsdf64_D(&bsdf.twice, m) == facet_bsdf64_terms(&bsdf.twice, m).D);
            assert_true(facet_bsdf_D(&single, rounded) == facet_bsdf_terms(&single, rounded).D);
        }
    }
}

/* Every sample's lobe is one that the material announces, and each announced one occurs. */
static void lobes_are_those_of_the_samples(void **state)
{
    (void)state;
    static const char *const glasses[] = {"glass",
                                          "glass wall=thin ior=2",
                                          "glass alpha=.3",
                                          "glass ndf=phong exponent=20 wall=thin",
                                          "glass alpha=.2 ndf=gtr",
                                          "glass alpha=5e-5"};
    enum { N_GLASSES = sizeof glasses/sizeof glasses[0] };
    for (int i = 0; i < N_SPECS + N_GLASSES; i++) {
        const any_bsdf bsdf = any_bsdf_of(i < N_SPECS ? specs[i] : glasses[i - N_SPECS], 0);
        const int announced = facet_bsdf_lobes(&bsdf.single);
        assert_int_equal(announced, facet_bsdf64_lobes(&bsdf.twice));
        draws random = {(uint64_t)i};
        int seen = 0;
        for (int k = 0; k < N_DRAWS; k++) {
            double wo[3], u[3];
            draw_direction(&random, wo);
            draw_three(&random, u);
            const facet_sample64 s = any_sample(&bsdf, wo, u);
            if (s.pdf > 0) seen |= s.lobe;
        }
        if (seen != announced) fail_msg("%s: lobes %d, announced %d", bsdf.spec, seen, announced);
    }
}

/* The short ways to a prepared material give the bits of the long one. */
static void materials_straight_from_values_are_the_same(void **state)
{
    (void)state;
    const any_bsdf gltf = any_bsdf_of("metallic_roughness base_color=.75,.5,.25 metallic=.25 roughness=.5 ior=3 "
                                      "specular=.5 specular_color=1,.5,.25",
                                      0);
    const facet_bsdf fast = facet_bsdf_metallic_roughness((float[]){.75f, .5f, .25f}, .25f, .5f, .25f, .5f,
                                                          (float[]){1, .5f, .25f});
    const any_bsdf glass = any_bsdf_of("glass ior=2 tint=.5,.25,1 wall=thin", 0);
    const facet_bsdf fast_glass = facet_bsdf_glass(2, 0, (float[]){.5f, .25f, 1}, 1);
    const any_bsdf rough = any_bsdf_of("glass ior=2 tint=.5,.25,1 alpha=.25", 0);
    const facet_bsdf fast_rough = facet_bsdf_glass(2, .25f, (float[]){.5f, .25f, 1}, 0);
    draws random = {1};
    for (int k = 0; k < N_DRAWS; k++) {
        double v[3];
        draw_direction(&random, v);
        const float wo[3] = {(float)v[0], (float)v[1], (float)v[2]};
        const float u[3] = {(float)draw(&random), (float)draw(&random), (float)draw(&random)};
        const facet_sample a = facet_bsdf_sample(&gltf.single, wo, u), b = facet_bsdf_sample(&fast, wo, u);
        const facet_sample c = facet_bsdf_sample(&glass.single, wo, u), d = facet_bsdf_sample(&fast_glass, wo, u);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(&c, &d, sizeof c);
        const facet_sample e = facet_bsdf_sample(&rough.single, wo, u), f = facet_bsdf_sample(&fast_rough, wo, u);
        assert_memory_equal(&e, &f, sizeof e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(weight_is_eval_over_pdf),
        cmocka_unit_test(sampled_directions_are_unit_vectors_above),
        cmocka_unit_test(eval_is_reciprocal),
        cmocka_unit_test(visible_normals_never_weigh_more_than_one),
        cmocka_unit_test(float_agrees_with_double),
        cmocka_unit_test(D_alone_is_that_of_the_terms),
        cmocka_unit_test(lobes_are_those_of_the_samples),
        cmocka_unit_test(materials_straight_from_values_are_the_same),
    };
    return cmocka_run_group_tests_name("bsdf_consistency", tests, NULL, NULL);
}
