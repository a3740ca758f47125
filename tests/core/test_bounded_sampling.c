/* test_bounded_sampling.c: GGX's bounded visible normals waste the samples that they are said to, and lose no light.
 *
 * The shares of lost samples are Monte Carlo figures of another implementation with four digits, and 0 where the bound
 * is tight; those of the whole visible normals at normal incidence are alpha^2/(1 + alpha^2).
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

enum { SAMPLES = 200000 };

/* The share of lost samples and the mean weight, over a lattice of numbers. */
static void sample_many(const char *spec, double cos_o, double phi_o, double *lost, double *albedo)
{
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    double wo[3], sum = 0;
    any_direction(cos_o, phi_o, wo);
    int none = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double u[3] = {(i + .5)/SAMPLES, fmod(i*0.61803398874989485, 1), .5};
        const facet_sample64 s = any_sample(&bsdf, wo, u);
        none += !(s.pdf > 0);
        sum += s.weight[0];
    }
    *lost = (double)none/SAMPLES;
    *albedo = sum/SAMPLES;
}

static void the_share_of_lost_samples_is_the_known_one(void **state)
{
    (void)state;
    static const double alphas[] = {.25, .5, .75, 1}, cosines[] = {1, .75, .5, .25, .1};
    static const double bounded[4][5] = {{0, .0282, .0393, .0376, .0140},
                                         {0, .0597, .0534, .0248, .0054},
                                         {0, .0525, .0364, .0126, .0023},
                                         {0, 0, 0, 0, 0}};
    static const double whole[4][5] = {{.0587, .0639, .0700, .0632, .0310},
                                       {.2000, .1883, .1607, .1024, .0465},
                                       {.3600, .3143, .2479, .1500, .0682},
                                       {.5, .75/1.75, .5/1.5, .25/1.25, .1/1.1}};
    for (int a = 0; a < 4; a++)
        for (int c = 0; c < 5; c++)
            for (int k = 0; k < 2; k++) {
                char spec[80];
                snprintf(spec, sizeof spec, "ggx alpha=%g sampling=%s", alphas[a], k ? "bounded" : "vndf");
                double lost, albedo;
                sample_many(spec, cosines[c], 1, &lost, &albedo);
                const double want = k ? bounded[a][c] : whole[a][c];
                /* half a unit of the fourth digit, three deviations of a million samples, the lattice's error */
                const double tolerance = 5e-5 + 3e-3*sqrt(want*(1 - want)) + 2e-4;
                if (!(fabs(lost - want) <= tolerance))
                    fail_msg("%s, cos %g: %g lost, not %g", spec, cosines[c], lost, want);
            }
}

/* Nothing above the horizon is out of reach: the mean weight is that of the whole visible normals. */
static void no_light_is_lost(void **state)
{
    (void)state;
    static const char *const shapes[] = {
        "alpha=.1", "alpha=.7", "alpha=1", "alpha=3", "alpha_x=.9 alpha_y=.2", "alpha_x=.1 alpha_y=2"};
    static const double cosines[] = {1, .6, .2, .01};
    for (int s = 0; s < 6; s++)
        for (int c = 0; c < 4; c++)
            for (int phi = 0; phi < 3; phi++) {
                char bounded[96], whole[96];
                snprintf(bounded, sizeof bounded, "ggx %s sampling=bounded", shapes[s]);
                snprintf(whole, sizeof whole, "ggx %s", shapes[s]);
                double lost[2], albedo[2];
                sample_many(bounded, cosines[c], .8*phi, &lost[0], &albedo[0]);
                sample_many(whole, cosines[c], .8*phi, &lost[1], &albedo[1]);
                /* the lattice's error: weights in [0, 1] that are 0 beyond the horizon's edge */
                if (!(fabs(albedo[0] - albedo[1]) <= 5e-4) || lost[0] > lost[1] + 2e-4)
                    fail_msg("%s, cos %g: albedo %g, %g; lost %g, %g", shapes[s], cosines[c], albedo[0], albedo[1],
                             lost[0], lost[1]);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_share_of_lost_samples_is_the_known_one),
        cmocka_unit_test(no_light_is_lost),
    };
    return cmocka_run_group_tests_name("bounded_sampling", tests, NULL, NULL);
}
