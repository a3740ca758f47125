/* test_vray.c: the model `vray` is gtr by other parameters, and V-Ray's masking is what its paper prints.
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

static void is_gtr_of_the_squared_bluntness(void **state)
{
    (void)state;
    static const double sharpness[] = {0, .25, .8, .995}, gamma[] = {.5, 1, 2, 3.3, 7};
    draws d = {11};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 5; j++) {
            char ours[160], theirs[160];
            const double alpha = fmax((1 - sharpness[i])*(1 - sharpness[i]), 1e-4);
            snprintf(ours, sizeof ours, "vray sharpness=%.17g gamma=%.17g", sharpness[i], gamma[j]);
            snprintf(theirs, sizeof theirs, "gtr alpha=%.17g gamma=%.17g masking=published g2=separable sampling=ndf",
                     alpha, gamma[j]);
            const any_bsdf a = any_bsdf_of(ours, 1), b = any_bsdf_of(theirs, 1);
            for (int k = 0; k < 50; k++) {
                double wi[3], wo[3], f[3], g[3];
                any_direction(draw(&d), 7*draw(&d), wi);
                any_direction(draw(&d), 7*draw(&d), wo);
                any_eval(&a, wi, wo, f);
                any_eval(&b, wi, wo, g);
                /* alpha^2 of the two differs by rounding, 2^-52 by each of four products, raised to gamma in D. */
                if (!(fabs(f[0] - g[0]) <= 64*(1 + gamma[j])*0x1p-52*g[0]))
                    fail_msg("%s: %a, gtr %a", ours, f[0], g[0]);
            }
        }
}

/* The closed forms of G1 as section 3 prints them, in the variable mu. */
static double printed_G1(int gamma, double alpha, double mu)
{
    const double a2 = alpha*alpha, A = sqrt(mu*mu + a2), B = sqrt(mu*mu + 1);
    const double A4 = 8*(a2*a2 + a2 + 1);
    switch (gamma) {
    case 0: return 2*mu/(B + mu);
    case 1: return mu*log(a2)/(A - B + mu*log(a2*(mu + B)/(mu + A)));
    case 2: return 2*mu/(A + mu);
    case 3: return 4*(a2 + 1)*mu*A/(a2*(3*a2 + 1) + 2*mu*(a2 + 1)*(mu + A));
    default:
        return 2*A4*mu*A*A*A/
               (A4*mu*(A*A*A + mu*mu*mu) +
                3*a2*(a2*(5*a2*a2 + 2*a2 + 1) + 4*mu*mu*(2*a2*a2 + a2 + 1)));
    }
}

/* At the knots the spline is the closed form; above 4, that of 4.  The printed form of gamma 1 loses digits: 1e-10. */
static void masks_by_the_closed_forms_at_the_knots(void **state)
{
    (void)state;
    static const double alphas[] = {.02, .2, .7}, cosines[] = {.01, .1, .5, .95};
    for (int gamma = 1; gamma <= 6; gamma++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 4; j++) {
                char spec[160];
                double m[3];
                snprintf(spec, sizeof spec, "vray sharpness=%.17g gamma=%d", 1 - sqrt(alphas[i]), gamma);
                any_direction(cosines[j], .3, m);
                const double mu = cosines[j]/sqrt(1 - cosines[j]*cosines[j]);
                const double want = printed_G1(gamma < 4 ? gamma : 4, alphas[i], mu);
                const any_bsdf bsdf = any_bsdf_of(spec, 1);
                const double got = any_terms(&bsdf, m).G1;
                if (!(fabs(got - want) <= 1e-10))
                    fail_msg("%s, cos %g: G1 %.15g, printed %.15g", spec, cosines[j], got, want);
            }
}

/* Sharpness 1 is alpha 0, where the printed G1 of gamma 1 is 0/0: alpha stops at 1e-4. */
static void the_sharpest_is_finite(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++) {
        const any_bsdf bsdf = any_bsdf_of("vray sharpness=1 gamma=1", is_double);
        double v[3], f[3];
        any_direction(.4, 0, v);
        const double mirrored[3] = {-v[0], -v[1], v[2]};
        any_eval(&bsdf, mirrored, v, f);
        assert_true(isfinite(f[0]) && f[0] > 1e5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_gtr_of_the_squared_bluntness),
        cmocka_unit_test(masks_by_the_closed_forms_at_the_knots),
        cmocka_unit_test(the_sharpest_is_finite),
    };
    return cmocka_run_group_tests_name("vray", tests, NULL, NULL);
}
