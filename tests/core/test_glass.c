/* test_glass.c: the smooth dielectric: directions, probabilities and weights, on both sides.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "verify/quadrature.h"

/* u[2] that reflects whenever anything is reflected, and that transmits whenever anything is transmitted. */
static const double reflecting[3] = {0.5, 0.5, 0}, transmitting[3] = {0.5, 0.5, 1 - 0x1p-24};

static any_bsdf glass_of(double ior, const char *extra, int is_double)
{
    char spec[160];
    snprintf(spec, sizeof spec, "glass ior=%.17g %s", ior, extra);
    return any_bsdf_of(spec, is_double);
}

/* The probability of reflection at the cosine c, on the outside (side 1) or inside (-1). */
static double reflectance(const any_bsdf *bsdf, double c, int side)
{
    double wo[3];
    any_direction(side*c, 0.3, wo);
    const facet_sample64 s = any_sample(bsdf, wo, reflecting);
    return s.lobe & FACET_REFLECTION ? s.pdf : 0;
}

static void probabilities_add_to_one(void **state)
{
    (void)state;
    draws d = {1};
    for (int n = 0; n < 4000; n++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = glass_of(draw_log(&d, 0.2, 5), n%2 ? "wall=thin" : "", is_double);
            double wo[3];
            any_direction(2*draw(&d) - 1, 6*draw(&d), wo);
            if (wo[2] == 0) continue;
            const facet_sample64 r = any_sample(&bsdf, wo, reflecting), t = any_sample(&bsdf, wo, transmitting);
            if (t.lobe & FACET_REFLECTION) { /* F is within 2^-24 of 1 */
                assert_true(t.pdf > 1 - 0x1p-23);
                continue;
            }
            if (!(fabs(r.pdf + t.pdf - 1) <= any_epsilon(&bsdf)))
                fail_msg("%s, wo (%a, %a, %a): F %a, T %a", bsdf.spec, wo[0], wo[1], wo[2], r.pdf, t.pdf);
        }
}

/* Averages 2 Int F c dc known to nine digits, and Int F inside = 1 - (1 - Int F outside)/n^2. */
static void average_reflectance(void **state)
{
    (void)state;
    static const double known[][2] = {{1.33, .065930849}, {1.5, .091777959}, {2, .160596637}};
    const quadrature rule = unit_interval(1.0/32);
    for (int i = 0; i < 3; i++) {
        const double ior = known[i][0];
        const any_bsdf bsdf = glass_of(ior, "", 1);
        const double critical = sqrt(1 - 1/(ior*ior)); /* the cosine below which all is reflected inside */
        double outside = 0, inside = critical*critical;
        for (int k = 0; k < rule.n; k++) {
            const double c = critical + (1 - critical)*rule.x[k];
            outside += rule.w[k]*2*rule.x[k]*reflectance(&bsdf, rule.x[k], 1);
            inside += rule.w[k]*(1 - critical)*2*c*reflectance(&bsdf, c, -1);
        }
        if (!(fabs(outside - known[i][1]) <= 6e-10)) fail_msg("ior %g: outside %.12f", ior, outside);
        /* sqrt(c - critical) at the critical angle is what the rule integrates to 1e-8 only. */
        const double want = 1 - (1 - known[i][1])/(ior*ior);
        if (!(fabs(inside - want) <= 2e-8)) fail_msg("ior %g: inside %.12f, not %.12f", ior, inside, want);
    }
}

static void light_beyond_the_critical_angle_is_reflected(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf bsdf = glass_of(1.5, "", is_double);
        const double critical = .74535599249992989880; /* sqrt(1 - 1/1.5^2) */
        for (int i = 0; i <= 100; i++) {
            double wo[3];
            any_direction(-(critical - 1e-5)*(i + 0.5)/100.5, i, wo);
            const facet_sample64 s = any_sample(&bsdf, wo, transmitting);
            if (!(s.pdf == 1 && s.lobe == (FACET_DELTA | FACET_REFLECTION) && s.wi[2] < 0 && s.weight[0] == 1))
                fail_msg("cos %a inside: pdf %a, wi.z %a", wo[2], s.pdf, s.wi[2]);
        }
        double wo[3];
        any_direction(-(critical + 1e-3), 0, wo);
        const facet_sample64 s = any_sample(&bsdf, wo, transmitting);
        assert_true(s.lobe == (FACET_DELTA | FACET_TRANSMISSION) && s.wi[2] > 0 && s.pdf > 0 && s.pdf < 1);
    }
}

/* Snell: the tangential parts are in the ratio of the indices; length 1; the other side.  8 eps: one division each,
 * and the normalisation; the tangential part of float inputs is off by another. */
static void refraction_obeys_snell(void **state)
{
    (void)state;
    draws d = {3};
    for (int n = 0; n < 4000; n++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const double ior = draw_log(&d, 0.2, 5);
            const any_bsdf bsdf = glass_of(ior, "tint=.25,.5,1", is_double);
            double wo[3];
            any_direction(2*draw(&d) - 1, 6*draw(&d), wo);
            const facet_sample64 s = any_sample(&bsdf, wo, transmitting);
            if (wo[2] == 0 || !(s.lobe & FACET_TRANSMISSION)) continue;
            const double eta = wo[2] > 0 ? ior : 1/ior, bound = 8*any_epsilon(&bsdf);
            const double length = sqrt(s.wi[0]*s.wi[0] + s.wi[1]*s.wi[1] + s.wi[2]*s.wi[2]);
            const double error = fmax(fabs(s.wi[0]*eta + wo[0]), fabs(s.wi[1]*eta + wo[1]));
            if (!(error <= bound*fmax(eta, 1) && fabs(length - 1) <= bound && s.wi[2]*wo[2] < 0))
                fail_msg("%s, wo (%a, %a, %a): wi (%a, %a, %a)", bsdf.spec, wo[0], wo[1], wo[2], s.wi[0], s.wi[1],
                         s.wi[2]);
            for (int k = 0; k < 3; k++) {
                const double want = (double[3]){.25, .5, 1}[k]/(eta*eta);
                if (!(fabs(s.weight[k]/want - 1) <= bound))
                    fail_msg("%s: weight %a, not %a", bsdf.spec, s.weight[k], want);
            }
        }
}

/* In and out again: the direction is restored and the two factors of the index cancel. */
static void refraction_is_reversible(void **state)
{
    (void)state;
    const any_bsdf bsdf = glass_of(1.5, "", 1);
    for (int i = 1; i <= 50; i++) {
        double wo[3];
        any_direction(i/50.0, i, wo);
        const facet_sample64 in = any_sample(&bsdf, wo, transmitting);
        const facet_sample64 out = any_sample(&bsdf, in.wi, transmitting);
        assert_true(in.lobe & out.lobe & FACET_TRANSMISSION);
        /* Near grazing incidence cos_o is recovered from 1 - sin^2: 4 eps/cos_o, and T as
         * much more sensitive. */
        for (int k = 0; k < 3; k++)
            if (!(fabs(out.wi[k] - wo[k]) <= 4*0x1p-52/wo[2]))
                fail_msg("cos %a: %a, not %a", wo[2], out.wi[k], wo[k]);
        if (!(fabs(in.weight[0]*out.weight[0] - 1) <= 4*0x1p-52))
            fail_msg("weights %a, %a", in.weight[0], out.weight[0]);
        if (!(fabs(in.pdf - out.pdf) <= 4*0x1p-52/(wo[2]*wo[2])))
            fail_msg("cos %a: T %a and %a", wo[2], in.pdf, out.pdf);
    }
}

static void a_thin_wall_does_not_bend_light(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf thin = glass_of(1.5, "wall=thin tint=.3", is_double), solid = glass_of(1.5, "", is_double);
        for (int i = 1; i <= 50; i++)
            for (int side = -1; side <= 1; side += 2) {
                double wo[3];
                any_direction(side*i/50.0, i, wo);
                const facet_sample64 s = any_sample(&thin, wo, transmitting);
                const double F = reflectance(&solid, i/50.0, 1), both = 2*F/(1 + F);
                for (int k = 0; k < 3; k++) {
                    const double straight = is_double ? -wo[k] : -(double)(float)wo[k];
                    if (s.wi[k] != straight) fail_msg("wi %a, not %a", s.wi[k], straight);
                    assert_true(fabs(s.weight[k] - .3) <= any_epsilon(&thin));
                }
                if (!(fabs(s.pdf - (1 - both)) <= 8*any_epsilon(&thin))) fail_msg("T %a, F %a", s.pdf, both);
            }
    }
}

static void mirrors_keep_the_side_and_weigh_one(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf bsdf = glass_of(1.5, "tint=.1", is_double);
        for (int side = -1; side <= 1; side += 2) {
            const double wo[3] = {0.6, 0, 0.8*side};
            const facet_sample64 s = any_sample(&bsdf, wo, reflecting);
            assert_true(s.lobe == (FACET_DELTA | FACET_REFLECTION));
            assert_true(s.wi[0] == (is_double ? -0.6 : -(double)0.6f) && s.wi[1] == 0 && s.wi[2]*side > 0);
            for (int k = 0; k < 3; k++) assert_true(s.weight[k] == 1);
        }
        const double tangent[3] = {1, 0, 0};
        assert_true(any_sample(&bsdf, tangent, reflecting).pdf == 0);
        double f[3];
        any_eval(&bsdf, (double[3]){-0.6, 0, 0.8}, (double[3]){0.6, 0, 0.8}, f);
        assert_true(f[0] == 0 && f[1] == 0 && f[2] == 0);
        assert_true(any_pdf(&bsdf, (double[3]){-0.6, 0, 0.8}, (double[3]){0.6, 0, 0.8}) == 0);
    }
}

/* eta tells which index the sample went to, over which it came from: what transmitted radiance is divided by twice. */
static void samples_tell_the_index_ratio(void **state)
{
    (void)state;
    facet_material material;
    facet_bsdf64 solid, thin;
    assert_int_equal(facet_material_parse("glass ior=1.5 tint=.25", &material, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&material, &solid, NULL), FACET_OK);
    assert_int_equal(facet_material_parse("glass ior=1.5 tint=.25 wall=thin", &material, NULL), FACET_OK);
    assert_int_equal(facet_bsdf64_prepare(&material, &thin, NULL), FACET_OK);
    const double outside[3] = {0.6, 0, 0.8}, inside[3] = {0.28, 0, -0.96}, reflects[3] = {0.5, 0.5, 0},
                 refracts[3] = {0.5, 0.5, 0.9};
    assert_true(facet_bsdf64_sample(&solid, outside, refracts).eta == 1.5);
    assert_true(facet_bsdf64_sample(&solid, inside, refracts).eta == 1/1.5);
    assert_true(facet_bsdf64_sample(&solid, outside, reflects).eta == 1);
    assert_true(facet_bsdf64_sample(&thin, outside, refracts).eta == 1);
    const facet_sample64 s = facet_bsdf64_sample(&solid, outside, refracts);
    assert_true(s.weight[0] == 0.25*(1/(1.5*1.5)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(probabilities_add_to_one),
        cmocka_unit_test(average_reflectance),
        cmocka_unit_test(light_beyond_the_critical_angle_is_reflected),
        cmocka_unit_test(refraction_obeys_snell),
        cmocka_unit_test(refraction_is_reversible),
        cmocka_unit_test(a_thin_wall_does_not_bend_light),
        cmocka_unit_test(mirrors_keep_the_side_and_weigh_one),
        cmocka_unit_test(samples_tell_the_index_ratio),
    };
    return cmocka_run_group_tests_name("glass", tests, NULL, NULL);
}
