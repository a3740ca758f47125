/* test_distribution_identities.c: integrals that hold exactly for every distribution of normals, in both precisions.
 *
 * In slope space, s = (m.x, m.y)/m.z, D cos_m d omega = P22 ds with P22 = D cos_m^4.  Slopes are measured in units
 * of the roughness, along (p) and across (q) the viewer's plane, where (v.m)/m.z = S (p + a), S the length of the
 * stretched horizontal part of v, a = v.z/S.  The half plane p < -a is behind the viewer.  The rules are exact to
 * 1e-12 for these integrands, so that the tolerances are the kernels'.  Where D matters, its exponent is at most 10
 * and so is its condition number: 10 eps in all in float, 1.2e-6; in double 1e-12, the rules' own error.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/kernel_access.h"
#include "verify/quadrature.h"

typedef struct shape {
    kernel_distribution which;
    double x, y;
} shape;

static const shape shapes[] = {
    {KERNEL_PHONG, 0, 0},       {KERNEL_PHONG, 1, 1},     {KERNEL_PHONG, 2.5, 2.5},      {KERNEL_PHONG, 50, 50},
    {KERNEL_PHONG, 2000, 2000}, {KERNEL_PHONG, 1e6, 1e6}, {KERNEL_BECKMANN, 1e-4, 1e-4}, {KERNEL_BECKMANN, .01, .01},
    {KERNEL_BECKMANN, .3, .3},  {KERNEL_BECKMANN, 1, 1},  {KERNEL_BECKMANN, 4, 4},       {KERNEL_BECKMANN, .05, .6},
    {KERNEL_BECKMANN, 1e-4, 4}, {KERNEL_GGX, 1e-4, 1e-4}, {KERNEL_GGX, .01, .01},        {KERNEL_GGX, .3, .3},
    {KERNEL_GGX, 1, 1},         {KERNEL_GGX, 4, 4},       {KERNEL_GGX, .05, .6},         {KERNEL_GGX, 4, 1e-4},
};
enum { N_SHAPES = sizeof shapes/sizeof shapes[0] };

static const double cosines[] = {1, 0.999, 0.7, 0.3, 0.1, 0.01, 1e-4};
enum { N_COSINES = sizeof cosines/sizeof cosines[0] };

static double tolerance(int is_double)
{
    return is_double ? 1e-12 : 1.2e-6;
}

static any_bsdf bsdf_of(const shape *s, int is_double, const char *extra)
{
    char spec[160];
    if (s->which == KERNEL_PHONG) snprintf(spec, sizeof spec, "phong exponent=%.17g %s", s->x, extra);
    else
        snprintf(spec, sizeof spec, "%s alpha_x=%.17g alpha_y=%.17g %s", s->which == KERNEL_GGX ? "ggx" : "beckmann",
                 s->x, s->y, extra);
    return any_bsdf_of(spec, is_double);
}

/* The units of slope: the roughness. */
static double unit_x(const shape *s)
{
    return s->which == KERNEL_PHONG ? sqrt(2/(s->x + 2)) : s->x;
}

static double unit_y(const shape *s)
{
    return s->which == KERNEL_PHONG ? sqrt(2/(s->x + 2)) : s->y;
}

/* P22 in those units at (p, q), p along the azimuth (c, s). */
static double slope_density(const shape *of, const kernel_access *access, double c, double s, double p, double q)
{
    const double x = unit_x(of)*(c*p - s*q), y = unit_y(of)*(s*p + c*q);
    const double z = 1/sqrt(1 + x*x + y*y);
    return access->D(of->which, of->x, of->y, (double[3]){x*z, y*z, z})*z*z*z*z*unit_x(of)*unit_y(of);
}

/* Int D cos_m = Int P22 ds. */
static double normalisation(const shape *of, const kernel_access *access, const quadrature *line)
{
    double sum = 0;
    for (int i = 0; i < line->n; i++) {
        const double p = line->x[i], width = sqrt(1 + p*p);
        for (int j = 0; j < line->n; j++)
            sum += line->w[i]*line->w[j]*width*slope_density(of, access, 1, 0, p, width*line->x[j]);
    }
    return sum;
}

/* Int D (v.m)+ / v.z = (Int over all slopes) - (Int over those behind v), each smooth. */
static double projected_area(const shape *of, const kernel_access *access, const double v[3], const quadrature *line,
                             const quadrature *half)
{
    const double x = unit_x(of)*v[0], y = unit_y(of)*v[1], S = hypot(x, y);
    if (S == 0) return normalisation(of, access, line);
    const double a = v[2]/S, c = x/S, s = y/S, scale = fmax(a, 1);
    double sum = 0;
    for (int i = 0; i < line->n; i++) {
        const double p = line->x[i], width = sqrt(1 + p*p);
        for (int j = 0; j < line->n; j++)
            sum += line->w[i]*line->w[j]*width*(p + a)*slope_density(of, access, c, s, p, width*line->x[j]);
    }
    for (int i = 0; i < half->n; i++) {
        const double p = -a - scale*half->x[i], width = sqrt(1 + p*p);
        for (int j = 0; j < line->n; j++)
            sum -= scale*half->w[i]*line->w[j]*width*(p + a)*
                   slope_density(of, access, c, s, p, width*line->x[j]);
    }
    return sum/a;
}

static void distributions_are_normalised(void **state)
{
    (void)state;
    const quadrature line = whole_line(1.0/20);
    for (int is_double = 0; is_double < 2; is_double++) {
        double worst = 0;
        for (int i = 0; i < N_SHAPES; i++) {
            const shape *s = &shapes[i];
            const double value = normalisation(s, is_double ? &kernel_access_f64 : &kernel_access_f32, &line);
            worst = fmax(worst, fabs(value - 1));
            if (!(fabs(value - 1) <= tolerance(is_double)))
                fail_msg("distribution %d (%a, %a): Int D cos = %.15g", s->which, s->x, s->y, value);
        }
        print_message("  Int D cos - 1, %s: %.2g\n", is_double ? "double" : "float", worst);
    }
}

static void weak_white_furnace_is_closed(void **state)
{
    (void)state;
    const quadrature line = whole_line(1.0/20), half = half_line(1.0/14);
    for (int is_double = 0; is_double < 2; is_double++) {
        const kernel_access *access = is_double ? &kernel_access_f64 : &kernel_access_f32;
        double worst = 0;
        for (int i = 0; i < N_SHAPES; i++) {
            const any_bsdf bsdf = bsdf_of(&shapes[i], is_double, "");
            for (int k = 0; k < N_COSINES; k++) {
                double v[3];
                any_direction(cosines[k], 0.7, v);
                const double G1 = any_terms(&bsdf, v).G1;
                const double value = G1*projected_area(&shapes[i], access, v, &line, &half);
                worst = fmax(worst, fabs(value - 1));
                if (!(fabs(value - 1) <= tolerance(is_double)))
                    fail_msg("%s, cos %a: Int G1 D (v.m)+ / cos = %.15g", bsdf.spec, cosines[k], value);
            }
        }
        print_message("  Int G1 D (v.m)+ / cos - 1, %s: %.2g\n", is_double ? "double" : "float", worst);
    }
}

/* The fit made for Beckmann, used for Phong as printed: G1_fit/G1_true with both computed by mpmath at 50 digits. */
static void published_phong_masking_breaks_the_furnace(void **state)
{
    (void)state;
    const quadrature line = whole_line(1.0/20), half = half_line(1.0/14);
    const double expected[][2] = {{1, 1.312754622}, {2, 1.201820994}, {10, 1.046291598}};
    for (int i = 0; i < 3; i++) {
        const shape s = {KERNEL_PHONG, expected[i][0], expected[i][0]};
        const any_bsdf bsdf = bsdf_of(&s, 1, "masking=published");
        double v[3];
        any_direction(0.1, 0, v);
        const double value = any_terms(&bsdf, v).G1*projected_area(&s, &kernel_access_f64, v, &line, &half);
        if (!(fabs(value - expected[i][1]) <= 1e-9)) fail_msg("exponent %g: %.6f", s.x, value);
    }
}

/* The models that borrow a distribution report its terms, to the bit: 0.5^2 and the exponent's alpha are exact.  And
 * G1 = 1/(1 + Lambda) above the horizon: one rounding of Lambda, of the sum and of the quotient. */
static void borrowed_distributions_have_their_terms(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"ggx alpha=.25", "metallic_roughness roughness=.5 metallic=1"},
        {"ggx alpha=.25", "disney roughness=.5 clearcoat=1"},
        {"ggx alpha_x=.25 alpha_y=1", "glass alpha_x=.25 alpha_y=1"},
        {"beckmann alpha=.25", "glass ndf=beckmann alpha=.25 wall=thin"},
        {"phong exponent=30", "glass ndf=phong exponent=30"},
    };
    static const double heights[] = {1, .9, .5, .1, .001, -.001, -1};
    for (size_t i = 0; i < sizeof pairs/sizeof pairs[0]; i++)
        for (int k = 0; k < 14; k++) {
            const any_bsdf own = any_bsdf_of(pairs[i][0], k%2), borrowed = any_bsdf_of(pairs[i][1], k%2);
            double m[3];
            any_direction(heights[k/2], .7, m);
            const facet_terms64 want = any_terms(&own, m), got = any_terms(&borrowed, m);
            const double G1 = heights[k/2] > 0 ? 1/(1 + got.Lambda) : 0;
            if (!(got.D == want.D && got.Lambda == want.Lambda && got.G1 == want.G1))
                fail_msg("%s, cos %g: D %a Lambda %a G1 %a; %s: %a %a %a", pairs[i][1], heights[k/2], got.D,
                         got.Lambda, got.G1, pairs[i][0], want.D, want.Lambda, want.G1);
            if (!(fabs(got.G1 - G1) <= 2*any_epsilon(&borrowed)*G1) || (want.D > 0 && heights[k/2] < 0))
                fail_msg("%s, cos %g: D %a, G1 %a, not %a", pairs[i][1], heights[k/2], want.D, got.G1, G1);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(distributions_are_normalised),
        cmocka_unit_test(weak_white_furnace_is_closed),
        cmocka_unit_test(published_phong_masking_breaks_the_furnace),
        cmocka_unit_test(borrowed_distributions_have_their_terms),
    };
    return cmocka_run_group_tests_name("distribution_identities", tests, NULL, NULL);
}
