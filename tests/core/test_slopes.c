/* test_slopes.c: the slopes of visible normals solve the equations that define them, for all exponents and views.
 *
 * The second method is quadrature of the densities (mu + q)+ P2(q) and (1 + q^2)^(-p-1/2), in double, over angles:
 * q = tan a makes P2 dq = cos(a)^(2p-1) da/B, and the visible share (mu + tan a) cos(a)^(2p-1).
 * SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/kernel_access.h"
#include "verify/quadrature.h"

#define HALF_PI 1.5707963267948966

static const double exponents[] = {0, .001, 1, 2, 5, 50, 1000, 1e5, 1e6};
/* Cotangents in units of the exponent's roughness: from 89.999 degrees to nearly normal incidence. */
static const double views[] = {1e-5, .01, .1, .5, 1, 2, 5, 20, 1e4};
static const double numbers[] = {0x1p-24, 1e-5, 1e-3, .01,         .1,          .25,         .5,
                                 .75,     .9,   .99,  1 - 0x1p-10, 1 - 0x1p-14, 1 - 0x1p-20, 1 - 0x1p-24};
enum { EXPONENTS = 9, VIEWS = 9, NUMBERS = 14 };

/* cos(a)^n; near 0 from the sine, because the rounding of the cosine would count n times. */
static double cosine_power(double s, double c, double n)
{
    return fabs(s) < 0.5 ? exp(0.5*n*log1p(-s*s)) : pow(c, n);
}

/* Int of (mu + tan a) cos(a)^(n + 1) B over a, from low to high, mu = infinity without its factor: exact to 1e-15 by
 * double-exponential quadrature, on pieces of the length on which the power falls. */
static double share(double n, double mu, double low, double high)
{
    static quadrature rule;
    if (rule.n == 0) rule = unit_interval(1.0/16);
    const double width = 1.5/sqrt(n + 2);
    double sum = 0;
    /* Beyond 9 widths of the Gaussian the power is 0; broad ones have no more than the half turn. */
    const double from = fmax(low, -9*width), to = fmin(high, 9*width);
    for (double a = from; a < to; a += width) {
        const double length = fmin(width, to - a);
        for (int i = 0; i < rule.n; i++) {
            const double t = a + length*rule.x[i], c = cos(t), s = sin(t);
            const double visible = isinf(mu) ? c : mu*c + s;
            sum += length*rule.w[i]*visible*cosine_power(s, c, n);
        }
    }
    return sum;
}

static double residual_along(double n, double mu, double q, double u)
{
    const double horizon = -atan(mu);
    const double above = share(n, mu, atan(q), HALF_PI);
    return above/share(n, mu, horizon, HALF_PI) - u;
}

/* u as the kernel sees it. */
static double rounded(const kernel_access *access, double u)
{
    return access->epsilon > 1e-10 ? (double)(float)u : u;
}

static const kernel_access *const builds[] = {&kernel_access_f64, &kernel_access_f32};
static const double bounds[] = {2e-14, 2e-6};

static void visible_slopes_have_the_share_u_above_them(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++) {
        double worst = 0;
        for (int e = 0; e < EXPONENTS; e++)
            for (int v = 0; v < VIEWS; v++)
                for (int k = 0; k < NUMBERS; k++) {
                    const double n = rounded(builds[b], exponents[e]);
                    const double mu = rounded(builds[b], views[v]/sqrt(n/2 + 1));
                    const double q = builds[b]->phong_slope_along(n, mu, numbers[k]);
                    const double error = fabs(residual_along(n, mu, q, numbers[k]));
                    worst = fmax(worst, error);
                    if (!(q >= -mu && error <= bounds[b]))
                        fail_msg("%s, exponent %g, mu %a, u %a: slope %a, error of u %g", builds[b]->name, n, mu,
                                 numbers[k], q, error);
                }
        print_message("  %s: largest error of u %.2g\n", builds[b]->name, worst);
    }
}

static void slopes_across_are_quantiles(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++) {
        double worst = 0;
        for (int e = 0; e < EXPONENTS; e++)
            for (int k = 0; k < NUMBERS; k++) {
                const double n = rounded(builds[b], exponents[e]);
                const double q = builds[b]->phong_slope_across(n, numbers[k]);
                const double error = fabs(
                    share(n + 1, INFINITY, atan(q), HALF_PI)/share(n + 1, INFINITY, -HALF_PI, HALF_PI) - numbers[k]);
                worst = fmax(worst, error);
                if (!(error <= bounds[b]))
                    fail_msg("%s, exponent %g, u %a: slope %a, error of u %g", builds[b]->name, n, numbers[k], q,
                             error);
            }
        print_message("  %s: largest error of u %.2g\n", builds[b]->name, worst);
    }
}

/* P(|slope| > q), and Lambda + 1 = Int (mu + q)+ P2 dq/mu. */
static void tail_and_Lambda_are_the_integrals(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++)
        for (int e = 0; e < EXPONENTS; e++)
            for (int v = 0; v < VIEWS; v++) {
                const double n = rounded(builds[b], exponents[e]);
                const double mu = rounded(builds[b], views[v]/sqrt(n/2 + 1));
                const double all = share(n, INFINITY, -HALF_PI, HALF_PI);
                const double tail = 2*share(n, INFINITY, atan(mu), HALF_PI)/all;
                const double G1 = mu*all/share(n, mu, -atan(mu), HALF_PI);
                const double got = builds[b]->slope_tail(n, mu), got_G1 = 1/(1 + builds[b]->slope_Lambda(n, mu));
                if (!(fabs(got - tail) <= bounds[b] && fabs(got_G1 - G1) <= bounds[b]))
                    fail_msg("%s, exponent %g, cot %a: tail %.17g, not %.17g; G1 %.17g, not %.17g", builds[b]->name, n,
                             mu, got, tail, got_G1, G1);
            }
}

/* a erfc(t) + exp(-t^2)/sqrt(pi) = u (a erfc(-a) + exp(-a^2)/sqrt(pi)), by libm. */
static double beckmann_visible(double a, double t)
{
    return a*erfc(t) + exp(-t*t)*0.56418958354775628695;
}

static void beckmanns_visible_slopes_have_the_share_u_above_them(void **state)
{
    (void)state;
    for (int b = 0; b < 2; b++) {
        double worst = 0;
        for (int v = 0; v < VIEWS; v++)
            for (int k = 0; k < NUMBERS; k++) {
                const double a = rounded(builds[b], views[v]);
                const double t = builds[b]->beckmann_slope_along(a, numbers[k]);
                const double error = fabs(beckmann_visible(a, t)/beckmann_visible(a, -a) - numbers[k]);
                worst = fmax(worst, error);
                if (!(t >= -a && error <= bounds[b]/4))
                    fail_msg("%s, a %a, u %a: slope %a, error of u %g", builds[b]->name, a, numbers[k], t, error);
            }
        print_message("  %s: largest error of u %.2g\n", builds[b]->name, worst);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(visible_slopes_have_the_share_u_above_them),
        cmocka_unit_test(slopes_across_are_quantiles),
        cmocka_unit_test(tail_and_Lambda_are_the_integrals),
        cmocka_unit_test(beckmanns_visible_slopes_have_the_share_u_above_them),
    };
    return cmocka_run_group_tests_name("slopes", tests, NULL, NULL);
}
