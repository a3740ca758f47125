/* test_gtr_masking.c: Smith's masking of GTR against 25-digit values, and three other ways to compute it; and what
 * the sampler draws of the tail.
 *
 * The table gtr_g1.csv (mpmath, 50 digits, from the distribution of slopes along one axis) is used where it lies
 * beside the source tree.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/kernel_access.h"
#include "tests/table_file.h"

#define PI 3.14159265358979323846

static const kernel_access *const precisions[] = {&kernel_access_f32, &kernel_access_f64};
static const double G1_bounds[] = {1e-6, 1e-12}, direct_bounds[] = {5e-7, 1e-12}, Lambda_bounds[] = {1e-5, 1e-13};
#define LEAST_LAMBDA 1e-30
/* Errors of the probability of the sampler's line: two and eight steps of Newton's method. */
static const double line_bounds[] = {1e-5, 1e-13};

static const double alphas[] = {1e-4, 3e-4, 1e-3, .01, .03, .1, .3, .6, .9, .99, .9999, 1};
static const double gammas[] = {1e-3, .05, .3,  .7, .9,  .999,  1, 1.001, 1.1, 1.2, 1.3,  1.5, 1.8,
                                2,    2.2, 2.7, 3,  3.6, 3.999, 4, 4.001, 6.3, 10,  14.5, 20};
/* cotangents in units of alpha, and by themselves */
static const double scaled_mus[] = {1e-6, .1, .3, 1, 3}, mus[] = {.03, .3, 1, 3, 30, 1e3, 1e9};
enum {
    N_ALPHAS = sizeof alphas/sizeof alphas[0],
    N_GAMMAS = sizeof gammas/sizeof gammas[0],
    N_SCALED = sizeof scaled_mus/sizeof scaled_mus[0],
    N_MUS = N_SCALED + sizeof mus/sizeof mus[0],
};

static double rounded(double x, int is_double)
{
    return is_double ? x : (double)(float)x;
}

static void G1_and_Lambda_agree_with_25_digits(void **state)
{
    (void)state;
    char path[512];
    snprintf(path, sizeof path, "%s/../shared/reference/gtr_g1.csv", FACET_SOURCE_DIR);
    table_file row;
    if (!table_file_open(&row, path)) {
        print_message("  gtr_g1.csv: the table is not beside the source tree\n");
        skip();
    }
    double worst[2][4] = {{0}};
    while (table_file_next(&row)) {
        const double alpha = table_file_number(&row, "alpha"), gamma = table_file_number(&row, "gamma");
        const double mu = table_file_number(&row, "mu");
        const double G1 = table_file_number(&row, "G1"), Lambda = table_file_number(&row, "Lambda");
        for (int k = 0; k < 2; k++) {
            for (int which = KERNEL_PREPARED; which <= KERNEL_DIRECT; which++) {
                const double got = precisions[k]->gtr_G1((kernel_masking)which, alpha, gamma, mu);
                worst[k][which] = fmax(worst[k][which], fabs(got - G1));
                if (!(fabs(got - G1) <= (which == KERNEL_DIRECT ? direct_bounds : G1_bounds)[k]))
                    fail_msg("line %d, alpha %g gamma %g mu %g, %s, form %d: %a for %a", row.line, alpha, gamma, mu,
                             precisions[k]->name, which, got, G1);
            }
            if (!(Lambda > LEAST_LAMBDA)) continue;
            const double error = precisions[k]->gtr_Lambda(alpha, gamma, mu)/Lambda - 1;
            worst[k][3] = fmax(worst[k][3], fabs(error));
            if (!(fabs(error) <= Lambda_bounds[k]))
                fail_msg("line %d, alpha %g gamma %g mu %g, %s: Lambda off by %.3g", row.line, alpha, gamma, mu,
                         precisions[k]->name, error);
        }
    }
    for (int k = 0; k < 2; k++)
        print_message("  %s: G1 %.2g, drawn %.2g, direct %.2g; Lambda %.2g, relative\n", precisions[k]->name,
                      worst[k][KERNEL_PREPARED], worst[k][KERNEL_DRAWN], worst[k][KERNEL_DIRECT], worst[k][3]);
}

/* P(tan^2(theta_m) > t), the integral of D, with libm. */
static double survival(double t, double alpha, double gamma)
{
    const double k0 = (1 - alpha)*(1 + alpha), rest = k0/(1 + t);
    if (k0 == 0) return 1/(1 + t);
    const double log_s = rest < .5 ? log1p(-rest) : log((t + alpha*alpha)/(1 + t));
    const double L = -2*log(alpha);
    return gamma == 1 ? -log_s/L : expm1((1 - gamma)*log_s)/expm1((gamma - 1)*L);
}

/* Lambda by the trapezoidal rule in y = ln(e/mu), e^2 = r^2 - mu^2: Lambda = 1/(pi mu) Int S(r) e^2/r^2 de.  Steps
 * of 1/8 are exact to 1e-14 for gamma up to 20. */
static double reference_G1(double alpha, double gamma, double mu)
{
    const double h = .125, top = fmax(0, -log(mu)) + 37;
    double sum = 0;
    for (double y = -13; y < top; y += h) {
        const double w2 = exp(2*y);
        sum += survival(mu*mu*(1 + w2), alpha, gamma)*exp(3*y)/(1 + w2);
    }
    return 1/(1 + sum*h/PI);
}

static void G1_agrees_with_quadrature_over_the_whole_domain(void **state)
{
    (void)state;
    double worst[2][3] = {{0}};
    for (int a = 0; a < N_ALPHAS; a++)
        for (int g = 0; g < N_GAMMAS; g++)
            for (int m = 0; m < N_MUS; m++)
                for (int k = 0; k < 2; k++) {
                    const double alpha = rounded(alphas[a], k), gamma = rounded(gammas[g], k);
                    const double mu = rounded(m < N_SCALED ? alpha*scaled_mus[m] : mus[m - N_SCALED], k);
                    const double want = reference_G1(alpha, gamma, mu);
                    for (int which = KERNEL_PREPARED; which <= (k ? KERNEL_DRAWN : KERNEL_DIRECT); which++) {
                        const double G1 = precisions[k]->gtr_G1((kernel_masking)which, alpha, gamma, mu);
                        const double error = fabs(G1 - want);
                        worst[k][which] = fmax(worst[k][which], error);
                        if (!(error <= (which == KERNEL_DIRECT ? direct_bounds : G1_bounds)[k]))
                            fail_msg("alpha %g gamma %g mu %g, %s, form %d: %.3g", alpha, gamma, mu,
                                     precisions[k]->name, which, error);
                    }
                }
    print_message("  G1: float %.2g, drawn %.2g, direct %.2g; double %.2g, drawn %.2g\n", worst[0][KERNEL_PREPARED],
                  worst[0][KERNEL_DRAWN], worst[0][KERNEL_DIRECT], worst[1][KERNEL_PREPARED], worst[1][KERNEL_DRAWN]);
}

/* A GTR of gamma < 2 is a mixture of GGX of roughness^2 a, and Lambda mixes linearly.  With (a - alpha^2)/(1 - a) =
 * e^tau the density of tau is e^((2 - gamma) tau)/((1 + e^tau)(alpha^2 + e^tau)), which the trapezoidal rule
 * integrates to e^(-4 pi^2). */
static double mixed_G1(double alpha, double gamma, double mu)
{
    const double h = .5, a0 = alpha*alpha;
    double mass = 0, sum = 0;
    for (double tau = -420; tau < 420; tau += h) {
        const double e = exp(-fabs(tau));
        const double upper = tau > 0 ? 1 : e, lower = tau > 0 ? e : 1; /* e^tau = upper/lower */
        const double a = (a0*lower + upper)/(lower + upper);
        const double w = exp((tau > 0 ? -gamma : 2 - gamma)*tau)/((lower + upper)*(a0*lower + upper));
        mass += w;
        sum += w*a/(2*mu*(mu + sqrt(mu*mu + a)));
    }
    return 1/(1 + sum/mass);
}

static void masking_below_gamma_2_is_a_mixture_of_ggx(void **state)
{
    (void)state;
    static const double below[] = {.2, .5, .9, 1, 1.25, 1.5, 1.8};
    for (int a = 0; a < N_ALPHAS - 1; a++)
        for (size_t g = 0; g < sizeof below/sizeof below[0]; g++)
            for (int m = 0; m < N_MUS; m++) {
                const double mu = m < N_SCALED ? alphas[a]*scaled_mus[m] : mus[m - N_SCALED];
                const double got = kernel_access_f64.gtr_G1(KERNEL_PREPARED, alphas[a], below[g], mu);
                const double error = fabs(got - mixed_G1(alphas[a], below[g], mu));
                if (!(error <= 1e-12)) fail_msg("alpha %g gamma %g mu %g: %.3g", alphas[a], below[g], mu, error);
            }
}

/* [vray]'s five closed forms, and ggx. */
static void integer_gammas_have_their_closed_forms(void **state)
{
    (void)state;
    for (int a = 0; a < N_ALPHAS; a++)
        for (int gamma = 1; gamma <= 4; gamma++)
            for (int m = 0; m < N_MUS; m++)
                for (int k = 0; k < 2; k++) {
                    const double mu = m < N_SCALED ? alphas[a]*scaled_mus[m] : mus[m - N_SCALED];
                    const double exact = precisions[k]->gtr_G1(KERNEL_PREPARED, alphas[a], gamma, mu);
                    const double closed = precisions[k]->gtr_G1(KERNEL_PUBLISHED, alphas[a], gamma, mu);
                    const double A = hypot(mu, rounded(alphas[a], k));
                    if (!(fabs(exact - closed) <= G1_bounds[k]) ||
                        (gamma == 2 && !(fabs(exact - 2*mu/(A + mu)) <= G1_bounds[k])))
                        fail_msg("alpha %g gamma %d mu %g, %s: %a, closed %a", alphas[a], gamma, mu,
                                 precisions[k]->name, exact, closed);
                }
}

/* ... of which that of gamma 0, where gtr itself has no value, is ggx of alpha 1. */
static void the_spline_begins_at_ggx_of_alpha_1(void **state)
{
    (void)state;
    for (int a = 0; a < N_ALPHAS; a++)
        for (int m = 0; m < N_MUS; m++)
            for (int k = 0; k < 2; k++) {
                const double mu = m < N_SCALED ? alphas[a]*scaled_mus[m] : mus[m - N_SCALED];
                const double got = precisions[k]->gtr_G1(KERNEL_PUBLISHED, alphas[a], 0, mu);
                if (!(fabs(got - 2*mu/(mu + hypot(mu, 1))) <= G1_bounds[k]))
                    fail_msg("alpha %g mu %g, %s: %a", alphas[a], mu, precisions[k]->name, got);
            }
}

/* Between the knots a natural cubic spline: second derivatives 0 at 0 and 4 and continuous at the knots, by
 * differences; beyond 4 as at 4.  The two largest known errors of the published scheme. */
static void published_masking_is_the_papers_spline(void **state)
{
    (void)state;
    const double alpha = .2, mu = .3, h = 1e-3;
    double (*const G1)(kernel_masking, double, double, double) = kernel_access_f64.gtr_G1;
    for (int knot = 1; knot < 4; knot++) {
        double y[9];
        for (int i = 0; i < 9; i++) y[i] = G1(KERNEL_PUBLISHED, alpha, knot + (i - 4)*h, mu);
        const double left = (2*y[4] - 5*y[3] + 4*y[2] - y[1])/(h*h);
        const double right = (2*y[4] - 5*y[5] + 4*y[6] - y[7])/(h*h);
        assert_true(fabs(left - right) < 1e-6 && fabs(right) > 1e-3);
        assert_true(fabs((y[5] - y[3]) - (y[6] - y[2])/2) < 1e-6);
    }
    const double end = (2*G1(KERNEL_PUBLISHED, alpha, 4, mu) - 5*G1(KERNEL_PUBLISHED, alpha, 4 - h, mu) +
                        4*G1(KERNEL_PUBLISHED, alpha, 4 - 2*h, mu) - G1(KERNEL_PUBLISHED, alpha, 4 - 3*h, mu))/
                       (h*h);
    assert_true(fabs(end) < 1e-6);
    assert_true(G1(KERNEL_PUBLISHED, alpha, 4, mu) == G1(KERNEL_PUBLISHED, alpha, 17, mu));
    const double clamped = G1(KERNEL_PREPARED, .6061, 10, .1199) - G1(KERNEL_PUBLISHED, .6061, 10, .1199);
    const double splined = fabs(G1(KERNEL_PREPARED, .018, 1.45, .094) - G1(KERNEL_PUBLISHED, .018, 1.45, .094));
    print_message("  the clamp at 4 costs up to %.6f, the spline %.4f\n", clamped, splined);
    assert_true(fabs(clamped - .294908) < 1e-6);
    assert_true(fabs(splined - .1247) < 3e-3);
}

/* The tail's line has T(q) = (1 - u) T(mu), T = mu Lambda.  Tails with a probability below 1e-4 are left out: T, which
 * is G1's, has few digits there in float. */
static void tails_lines_have_their_shares(void **state)
{
    (void)state;
    static const double numbers[] = {0, .05, .3, .8, .99};
    double worst[2] = {0};
    for (int a = 0; a < N_ALPHAS; a += 2)
        for (int g = 1; g < N_GAMMAS; g += 3)
            for (int m = 0; m < N_SCALED; m++)
                for (int i = 0; i < 10; i++) {
                    const int k = i%2;
                    const double alpha = rounded(alphas[a], k), gamma = rounded(gammas[g], k);
                    const double mu = rounded(alpha*scaled_mus[m], k), u = rounded(numbers[i/2], k);
                    const double Lambda = kernel_access_f64.gtr_Lambda(alpha, gamma, mu);
                    if (Lambda < 1e-4) continue;
                    const double q = precisions[k]->gtr_tail_line(alpha, gamma, mu, u);
                    const double beyond = q*kernel_access_f64.gtr_Lambda(alpha, gamma, q)/(mu*Lambda);
                    const double error = fabs(beyond - (1 - u))*Lambda/(1 + Lambda);
                    worst[k] = fmax(worst[k], error);
                    if (!(error <= line_bounds[k]))
                        fail_msg("alpha %g gamma %g mu %g, u %g, %s: line %g off by %.3g", alpha, gamma, mu, u,
                                 precisions[k]->name, q, error);
                }
    print_message("  line: float %.2g, double %.2g\n", worst[0], worst[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(G1_and_Lambda_agree_with_25_digits),
        cmocka_unit_test(G1_agrees_with_quadrature_over_the_whole_domain),
        cmocka_unit_test(masking_below_gamma_2_is_a_mixture_of_ggx),
        cmocka_unit_test(integer_gammas_have_their_closed_forms),
        cmocka_unit_test(the_spline_begins_at_ggx_of_alpha_1),
        cmocka_unit_test(published_masking_is_the_papers_spline),
        cmocka_unit_test(tails_lines_have_their_shares),
    };
    return cmocka_run_group_tests_name("gtr_masking", tests, NULL, NULL);
}
