/* test_gtr_identities.c: integrals and special cases of GTR, in both precisions.
 *
 * The integrals run over y = ln(tan(theta)/mu), in which D is analytic for |Im y| < pi/2 and falls exponentially, so
 * that the trapezoidal rule of step 1/8 is exact to 1e-14.
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/kernel_access.h"

#define PI 3.14159265358979323846
#define STEP 0.125

/* The demands: relative errors of integrals in float and double. */
static const double tolerances[] = {1e-5, 1e-10};

static const double alphas[] = {1e-4, .003, .1, .6, .999, 1};
static const double gammas[] = {.05, .5, .999, 1, 1.001, 1.5, 2, 4.5, 20};
enum { N_ALPHAS = sizeof alphas/sizeof alphas[0], N_GAMMAS = sizeof gammas/sizeof gammas[0] };

static any_bsdf gtr(double alpha_x, double alpha_y, double gamma, const char *extra, int is_double)
{
    char spec[160];
    snprintf(spec, sizeof spec, "gtr alpha_x=%.17g alpha_y=%.17g gamma=%.17g %s", alpha_x, alpha_y, gamma, extra);
    return any_bsdf_of(spec, is_double);
}

static const kernel_access *const precisions[] = {&kernel_access_f32, &kernel_access_f64};

typedef struct shape {
    double alpha_x, alpha_y, gamma;
    int is_disney;
} shape;

static double D_at(int is_double, shape s, double slope, double phi)
{
    const double cosine = 1/hypot(1, slope);
    const double m[3] = {slope*cosine*cos(phi), slope*cosine*sin(phi), cosine};
    return precisions[is_double]->gtr_D(s.alpha_x, s.alpha_y, s.gamma, s.is_disney, m);
}

/* Int D cos d omega = Int P22 r dr d phi, P22 = D cos^4, with r = e^y. */
static double normalisation(int is_double, shape s, int n_azimuths)
{
    double sum = 0;
    for (int k = 0; k < n_azimuths; k++)
        for (double y = -28; y < 40; y += STEP) {
            const double r = exp(y), cos2 = 1/(1 + r*r);
            sum += D_at(is_double, s, r, 2*PI*(k + .5)/n_azimuths)*r*r*cos2*cos2;
        }
    return sum*STEP*2*PI/n_azimuths;
}

static void D_integrates_to_one(void **state)
{
    (void)state;
    double worst[2] = {0};
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < N_ALPHAS; a++)
            for (int g = 0; g < N_GAMMAS; g++) {
                const double error = fabs(normalisation(k, (shape){alphas[a], alphas[a], gammas[g], 0}, 1) - 1);
                worst[k] = fmax(worst[k], error);
                if (!(error <= tolerances[k]))
                    fail_msg("alpha %g gamma %g, %s: %.3g", alphas[a], gammas[g], precisions[k]->name, error);
            }
    print_message("  float %.2g, double %.2g\n", worst[0], worst[1]);
}

/* 8 to 1, where n azimuths are exact to e^(-n atanh(1/8)), 1e-14 for 256. */
static void anisotropic_D_integrates_to_one(void **state)
{
    (void)state;
    static const double some[] = {.3, 1, 1.5, 2, 5};
    for (int k = 0; k < 2; k++)
        for (size_t g = 0; g < sizeof some/sizeof some[0]; g++)
            for (int is_disney = 0; is_disney < 2; is_disney++) {
                const double error = fabs(normalisation(k, (shape){.8, .1, some[g], is_disney}, 256) - 1);
                if (!(error <= tolerances[k]))
                    fail_msg("gamma %g, Disney %d, %s: %.3g", some[g], is_disney, precisions[k]->name, error);
            }
}

/* The weak white furnace: the microfacets that a viewer sees have his own projected area,
 *     Int G1 D (v.m)+ d omega = cos_v,
 * which is G1 (1 + T/mu) = 1 with T = Int P22 (t - mu)+ over slopes t towards him.  Over azimuths,
 *     T = 2 Int P22 r (sqrt(r^2 - mu^2) - mu arccos(mu/r)) dr, and with e^2 = r^2 - mu^2, e = mu e^y, r dr = e de. */
static double furnace(int is_double, double alpha, double gamma, double mu)
{
    const shape s = {alpha, alpha, gamma, 0};
    double T = 0;
    for (double y = -14; y < 32 + fmax(0, -log(mu)); y += STEP) { /* it falls as e^-y */
        const double w = exp(y), e = mu*w, r = hypot(mu, e), cos2 = 1/(1 + r*r);
        const double kernel = w < .02 ? w*w*w*(1./3 - w*w*(1./5 - w*w/7)) : w - atan(w);
        T += D_at(is_double, s, r, .3)*cos2*cos2*mu*kernel*e*e;
    }
    return precisions[is_double]->gtr_G1(KERNEL_PREPARED, alpha, gamma, mu)*(1 + 2*T*STEP/mu);
}

static void visible_normals_fill_the_view(void **state)
{
    (void)state;
    static const double cosines[] = {.999, .7, .1, 1e-4};
    double worst[2] = {0};
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < N_ALPHAS; a++)
            for (int g = 0; g < N_GAMMAS; g++)
                for (size_t c = 0; c < sizeof cosines/sizeof cosines[0]; c++) {
                    const double mu = cosines[c]/sqrt(1 - cosines[c]*cosines[c]);
                    const double error = fabs(furnace(k, alphas[a], gammas[g], mu) - 1);
                    worst[k] = fmax(worst[k], error);
                    if (!(error <= tolerances[k]))
                        fail_msg("alpha %g gamma %g cos %g, %s: %.3g", alphas[a], gammas[g], cosines[c],
                                 precisions[k]->name, error);
                }
    print_message("  float %.2g, double %.2g\n", worst[0], worst[1]);
}

/* Directions over the sphere above the horizon. */
static void direction(int i, int n, double v[3])
{
    any_direction((i + .5)/n, 2.4*i, v);
}

/* f cos and pdf of two materials, relative to the first. */
static double difference(const any_bsdf *a, const any_bsdf *b)
{
    enum { N = 40 };
    double worst = 0;
    for (int i = 0; i < N; i++)
        for (int o = 0; o < N; o++) {
            double wi[3], wo[3], f[3], h[3];
            direction(i, N, wi);
            direction(o, N, wo);
            any_eval(a, wi, wo, f);
            any_eval(b, wi, wo, h);
            worst = fmax(worst, fabs(f[0] - h[0])/f[0]);
            worst = fmax(worst, fabs(any_pdf(a, wi, wo)/any_pdf(b, wi, wo) - 1));
        }
    return worst;
}

/* Also [disney, 10 to 15]: the stretch and Disney's D are the anisotropic GGX. */
static void gamma_2_is_ggx(void **state)
{
    (void)state;
    static const double shapes[][2] = {{.001, .001}, {.2, .2}, {1, 1}, {.5, .1}, {.1, 1}};
    for (int k = 0; k < 2; k++)
        for (size_t s = 0; s < sizeof shapes/sizeof shapes[0]; s++)
            for (int is_disney = 0; is_disney < 2; is_disney++) {
                char spec[80];
                snprintf(spec, sizeof spec, "ggx alpha_x=%.17g alpha_y=%.17g", shapes[s][0], shapes[s][1]);
                const any_bsdf ggx = any_bsdf_of(spec, k);
                const any_bsdf bsdf = gtr(shapes[s][0], shapes[s][1], 2, is_disney ? "anisotropy=disney" : "", k);
                const double error = difference(&ggx, &bsdf);
                /* D by a power and G1 by a polynomial: 20 eps and the bound on G1 */
                if (!(error <= (k ? 1e-12 : 4e-6))) fail_msg("%s, %d: %.3g", bsdf.spec, k, error);
            }
}

/* [disney, 4], alpha < 1: D = (alpha^2 - 1)/(pi ln alpha^2 (1 + (alpha^2 - 1) cos^2)), with the sine. */
static void gamma_1_has_its_closed_form(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < N_ALPHAS - 1; a++)
            for (double theta = .01; theta < 1.55; theta += .1) {
                const double alpha = k ? alphas[a] : (double)(float)alphas[a], alpha2 = alpha*alpha, k0 = 1 - alpha2;
                const double s = sin(theta), want = k0/(-2*PI*log(alpha)*(s*s + alpha2*(1 - s*s)));
                const double got = D_at(k, (shape){alpha, alpha, 1, 0}, tan(theta), 1);
                if (!(fabs(got/want - 1) <= (k ? 1e-13 : 2e-6)))
                    fail_msg("alpha %g theta %g, %s: %a for %a", alpha, theta, precisions[k]->name, got, want);
            }
}

/* Every number is finite over the whole range of parameters and directions. */
static void nothing_is_ever_nan(void **state)
{
    (void)state;
    static const double cosines[] = {1, .99999, .5, 1e-3, 1e-8, 1e-30};
    static const double numbers[] = {0, 1e-8, .3, .5, .999, 1 - 0x1p-24};
    enum { C = sizeof cosines/sizeof cosines[0], U = sizeof numbers/sizeof numbers[0] };
    static const char *const extras[] = {"", "sampling=ndf", "masking=published", "anisotropy=disney"};
    for (int k = 0; k < 2; k++)
        for (int a = 0; a < N_ALPHAS; a++)
            for (int g = 0; g < N_GAMMAS; g++)
                for (int e = 0; e < 4; e++) {
                    const any_bsdf bsdf = gtr(alphas[a], alphas[N_ALPHAS - 1 - a], gammas[g], extras[e], k);
                    for (int c = 0; c < C; c++) {
                        double wo[3];
                        any_direction(cosines[c], c, wo);
                        for (int u = 0; u < U*U*U; u++) {
                            const double three[3] = {numbers[u%U], numbers[u/U%U], numbers[u/U/U]};
                            const facet_sample64 s = any_sample(&bsdf, wo, three);
                            if (!isfinite(s.pdf) || !isfinite(s.weight[0]) || !isfinite(s.wi[0] + s.wi[1] + s.wi[2]))
                                fail_msg("%s, %d, cos %g, u %g %g %g: pdf %g weight %g", bsdf.spec, k, cosines[c],
                                         three[0], three[1], three[2], s.pdf, s.weight[0]);
                        }
                    }
                }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(D_integrates_to_one),           cmocka_unit_test(anisotropic_D_integrates_to_one),
        cmocka_unit_test(visible_normals_fill_the_view), cmocka_unit_test(gamma_2_is_ggx),
        cmocka_unit_test(gamma_1_has_its_closed_form),   cmocka_unit_test(nothing_is_ever_nan),
    };
    return cmocka_run_group_tests_name("gtr_identities", tests, NULL, NULL);
}
