/* test_ward.c: the three lobes of Ward's family against Beckmann's distribution, their albedos, and the weights of
 * their samples.
 *
 * The albedos were computed by a separate program: Gauss-Legendre quadrature over wi on pieces graded towards the
 * horizon and the plane of incidence, 9 digits; they agree with the known three digits of alpha = .3.
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

#define TWO_PI 6.283185307179586

/* Int f cos_i d omega_i for ks = 1, the cosine by a rule that reaches grazing directions, the azimuth by one that
 * gathers at that of the mirrored direction; each half turn by itself. */
static double albedo(const any_bsdf *bsdf, const double wo[3], double phi_o)
{
    const quadrature rule = unit_interval(1.0/24);
    double sum = 0;
    for (int i = 0; i < rule.n; i++)
        for (int j = 0; j < rule.n; j++)
            for (int side = -1; side <= 1; side += 2) {
                double wi[3], f[3];
                any_direction(rule.x[i], phi_o + TWO_PI/2*(1 + side*rule.x[j]), wi);
                any_eval(bsdf, wi, wo, f);
                sum += rule.w[i]*rule.w[j]*TWO_PI/2*f[0];
            }
    return sum;
}

/* Three digits of each are errata of the text that printed another formula under this name. */
static void albedos_are_the_known_ones(void **state)
{
    (void)state;
    static const struct {
        const char *spec;
        double cos_o, phi_o, value;
    } known[] = {
        {"ward alpha=.3 variant=ward92", 1, 0, .793893003},
        {"ward alpha=.3 variant=ward92", .1, 0, .232096179},
        {"ward alpha=.3 variant=ward92", .01, 0, .454998829},
        {"ward alpha=.3 variant=ward92", .001, 0, 1.363675114},
        {"ward alpha=.3 variant=duer", 1, 0, .856312289},
        {"ward alpha=.3 variant=duer", .1, 0, 1.160863207},
        {"ward alpha=.3 variant=duer", .01, 0, 7.164211663},
        {"ward alpha=.3 variant=duer", .001, 0, 67.729265295},
        {"ward alpha=.3", 1, 0, .910001345},
        {"ward alpha=.3", .1, 0, .805663746},
        {"ward alpha=.3", .01, 0, .942181084},
        {"ward alpha=.3", .001, 0, .989785903},
        {"ward alpha_x=.1 alpha_y=.4 variant=ward92", .5, 1, .440239448},
        {"ward alpha_x=.1 alpha_y=.4 variant=duer", .02, 1, 4.161861488},
        {"ward alpha_x=.1 alpha_y=.4 variant=gmd", .02, 1, .919621091},
    };
    for (size_t i = 0; i < sizeof known/sizeof known[0]; i++)
        for (int is_double = 0; is_double < 2; is_double++) {
            const any_bsdf bsdf = any_bsdf_of(known[i].spec, is_double);
            double wo[3];
            any_direction(known[i].cos_o, known[i].phi_o, wo);
            const double got = albedo(&bsdf, wo, known[i].phi_o);
            /* Float: the rounding of wo's cosine, half an eps, and of sums of terms of one sign. */
            const double bound = is_double ? 2e-9 : 2e-6;
            if (!(fabs(got/known[i].value - 1) <= bound))
                fail_msg("%s, cos_o %g: albedo %.9f, not %.9f", bsdf.spec, known[i].cos_o, got, known[i].value);
        }
}

/* With Beckmann's D of the half vector: duer = D cos_m^4/(4 cos_i cos_o), ward92 = duer sqrt(cos_i cos_o), gmd =
 * D/(4 (wi.wm)^2).  The printed formula D/(4 cos_i cos_o) is none of them. */
static void lobes_are_beckmanns(void **state)
{
    (void)state;
    const any_bsdf beckmann = any_bsdf_of("beckmann alpha_x=.3 alpha_y=.8", 1);
    const any_bsdf lobes[3] = {any_bsdf_of("ward variant=ward92 alpha_x=.3 alpha_y=.8", 1),
                               any_bsdf_of("ward variant=duer alpha_x=.3 alpha_y=.8", 1),
                               any_bsdf_of("ward variant=gmd alpha_x=.3 alpha_y=.8", 1)};
    draws random = {1};
    for (int n = 0; n < 2000; n++) {
        double wi[3], wo[3], m[3];
        draw_direction(&random, wi);
        draw_direction(&random, wo);
        wi[2] = fabs(wi[2]);
        wo[2] = fabs(wo[2]);
        for (int k = 0; k < 3; k++) m[k] = wi[k] + wo[k];
        const double length = sqrt(m[0]*m[0] + m[1]*m[1] + m[2]*m[2]);
        for (int k = 0; k < 3; k++) m[k] /= length;
        const double wi_m = wi[0]*m[0] + wi[1]*m[1] + wi[2]*m[2];
        const double D = any_terms(&beckmann, m).D;
        const double duer = D*pow(m[2], 4)/(4*wi[2]*wo[2]);
        const double want[3] = {duer*sqrt(wi[2]*wo[2]), duer, D/(4*wi_m*wi_m)};
        for (int v = 0; v < 3; v++) {
            double f[3];
            any_eval(&lobes[v], wi, wo, f);
            /* The exponent, at most 69 where the value is not negligible, has 8 roundings. */
            if (want[v] > 1e-30 && !(fabs(f[0]/(wi[2]*want[v]) - 1) <= 1e-12))
                fail_msg("%s, wi (%a, %a, %a), wo (%a, %a, %a): %a, not %a", lobes[v].spec, wi[0], wi[1], wi[2], wo[0],
                         wo[1], wo[2], f[0], wi[2]*want[v]);
            assert_true(any_terms(&lobes[v], m).D == D);
        }
    }
}

static const double alphas[][2] = {{1e-4, 1e-4}, {1e-4, 1}, {.01, .01}, {.1, .3}, {.3, .3}, {1, .2}, {1, 1}};
static const double cosines[] = {1, .7, .2, .02, 1e-3, 1e-6, 1e-8};
enum { N_ALPHAS = sizeof alphas/sizeof alphas[0], N_COSINES = sizeof cosines/sizeof cosines[0] };

/* The weight of a flipped sample of gmd is the larger of cos_i/(cos_i + cos_o) and cos_i cos_o/(wi.wm)^2, and neither
 * exceeds 1: the energy is conserved at every roughness and angle.  Ward's own weigh 2 at most.  8 roundings, and the
 * cosine of the reflected direction, which is off by eps absolutely. */
static void weights_of_gmd_are_bounded(void **state)
{
    (void)state;
    for (int is_double = 0; is_double < 2; is_double++)
        for (int a = 0; a < N_ALPHAS; a++)
            for (int is_ndf = 0; is_ndf < 2; is_ndf++) {
                char spec[160];
                snprintf(spec, sizeof spec, "ward alpha_x=%g alpha_y=%g sampling=%s", alphas[a][0], alphas[a][1],
                         is_ndf ? "ndf" : "flip");
                const any_bsdf bsdf = any_bsdf_of(spec, is_double);
                draws random = {(uint64_t)a};
                for (int c = 0; c < N_COSINES; c++)
                    for (int n = 0; n < 1000; n++) {
                        const double u[3] = {draw(&random), draw(&random), draw(&random)};
                        double wo[3];
                        any_direction(cosines[c], TWO_PI*draw(&random), wo);
                        const facet_sample64 s = any_sample(&bsdf, wo, u);
                        if (!(s.weight[0] <= (is_ndf ? 2 : 1)*(1 + 8*any_epsilon(&bsdf))))
                            fail_msg("%s, wo (%a, %a, %a), u (%a, %a, %a): weight %a", bsdf.spec, wo[0], wo[1], wo[2],
                                     u[0], u[1], u[2], s.weight[0]);
                    }
            }
}

typedef struct moments {
    double mean, variance;
} moments;

static moments weights(const char *variant, const char *sampling, double cos_o, int n)
{
    char spec[160];
    snprintf(spec, sizeof spec, "ward alpha=.3 variant=%s sampling=%s", variant, sampling);
    const any_bsdf bsdf = any_bsdf_of(spec, 1);
    draws random = {7};
    double wo[3], sum = 0, squares = 0;
    any_direction(cos_o, .5, wo);
    for (int i = 0; i < n; i++) {
        const double u[3] = {draw(&random), draw(&random), draw(&random)};
        const double w = any_sample(&bsdf, wo, u).weight[0];
        sum += w;
        squares += w*w;
    }
    return (moments){.mean = sum/n, .variance = squares/n - (sum/n)*(sum/n)};
}

/* Both samplers estimate the same albedo, the flipped one with less noise. */
static void flipped_normals_are_less_noisy(void **state)
{
    (void)state;
    static const char *const variants[] = {"ward92", "duer", "gmd"};
    static const double views[] = {.9, .5, .1, .02};
    enum { N = 40000 };
    for (int v = 0; v < 3; v++)
        for (int c = 0; c < 4; c++) {
            const moments a = weights(variants[v], "flip", views[c], N), b = weights(variants[v], "ndf", views[c], N);
            const double error = sqrt((a.variance + b.variance)/N);
            print_message("  %-6s cos_o %.2f: albedo %.4f %.4f, variance %.4f, ndf %.4f (%.1f times)\n", variants[v],
                          views[c], a.mean, b.mean, a.variance, b.variance, b.variance/a.variance);
            if (!(fabs(a.mean - b.mean) <= 5*error)) fail_msg("means differ by more than 5 sigma, %g", 5*error);
            assert_true(a.variance < b.variance);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(albedos_are_the_known_ones),
        cmocka_unit_test(lobes_are_beckmanns),
        cmocka_unit_test(weights_of_gmd_are_bounded),
        cmocka_unit_test(flipped_normals_are_less_noisy),
    };
    return cmocka_run_group_tests_name("ward", tests, NULL, NULL);
}
