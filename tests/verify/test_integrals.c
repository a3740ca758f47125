/* test_integrals.c: the integrals that `facet verify` rests on, against numbers that are known.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka needs the headers above */
#include <cmocka.h>

#include "verify/integrals.h"
#include "verify/quadrature.h"
#include "verify/views.h"

#define PI 3.14159265358979323846

static double one(const void *context, const double v[3])
{
    (void)context;
    (void)v;
    return 1;
}

static double cosine(const void *context, const double v[3])
{
    (void)context;
    return fmax(v[2], 0);
}

/* GGX's D cos of the roughness *context, whose integral is 1. */
static double ggx(const void *context, const double m[3])
{
    const double alpha = *(const double *)context, x2 = m[0]*m[0] + m[1]*m[1];
    const double t = x2/(alpha*alpha) + m[2]*m[2];
    return m[2] > 0 ? m[2]/(PI*alpha*alpha*t*t) : 0;
}

/* A cap of half angle acos(1 - *context) about an oblique axis, as a steep but smooth bump: exp(-(1 - c)/w), whose
 * integral is 2 pi w (1 - e^(-2/w)). */
static const double bump_axis[3] = {0.48, 0.64, -0.6};
static double bump(const void *context, const double v[3])
{
    const double c = v[0]*bump_axis[0] + v[1]*bump_axis[1] + v[2]*bump_axis[2];
    return exp((c - 1) / *(const double *)context);
}

static void near(double found, double truth, double tolerance)
{
    if (!(fabs(found - truth) <= tolerance*fabs(truth))) fail_msg("%.12g, not %.12g", found, truth);
}

static void hemispheres_and_spheres_have_their_area(void **state)
{
    (void)state;
    near(over_normals(one, NULL, 1e-6), 2*PI, 1e-5);
    near(over_normals(cosine, NULL, 1e-6), PI, 1e-5);
    for (double c = 1; c > 0.01; c *= 0.6) {
        double wo[3];
        verify_direction(c, 0.7, wo);
        near(over_mirrored(cosine, NULL, wo, 1e-6), PI, 1e-5);
        near(over_sphere(one, NULL, wo, 1e-6), 4*PI, 1e-5);
        near(over_sphere(cosine, NULL, wo, 1e-6), PI, 1e-4); /* with an edge that no line follows */
    }
}

static void lobes_of_any_width_are_found(void **state)
{
    (void)state;
    for (double width = 1; width > 1e-4; width *= 0.2) {
        near(over_normals(ggx, &width, 1e-6), 1, 1e-5);
        near(over_sphere(bump, &width, bump_axis, 1e-6*width), 2*PI*width*-expm1(-2/width), 1e-5);
    }
}

typedef struct scaled {
    double factor;
    long *n_calls;
} scaled;

static double scaled_bump(const void *context, const double v[3])
{
    static const double width = 0.01;
    const scaled *s = context;
    ++*s->n_calls;
    return s->factor*bump(&width, v)*(1 + 1e-5*sin(1e5*v[0]));
}

static double scaled_wave(double x, double y, const void *context)
{
    const scaled *s = context;
    ++*s->n_calls;
    return s->factor*exp(sin(7*x)*y);
}

/* Rounding at 1e20 is above every absolute tolerance: the work must not grow with the function, nor with its noise.
 * What overflows is infinite, at once. */
static void huge_functions_take_no_more_work(void **state)
{
    (void)state;
    static const double low[2] = {0, 0}, high[2] = {2, 2};
    double sphere = 0, plane = 0;
    long sphere_calls = 0, plane_calls = 0;
    for (double factor = 1e6; factor < 1e307; factor *= 1e9) {
        long n = 0;
        const scaled s = {factor, &n};
        const double over = over_sphere(scaled_bump, &s, bump_axis, 1e-6);
        if (!sphere_calls) sphere_calls = n, sphere = over/factor;
        assert_true(n <= sphere_calls);
        near(over/factor, sphere, 1e-3);
        n = 0;
        const double whole = cubature(scaled_wave, &s, low, high, 1e-9, 0);
        if (!plane_calls) plane_calls = n, plane = whole/factor;
        assert_true(n <= plane_calls);
        near(whole/factor, plane, 1e-3);
    }
    long n = 0;
    const scaled overflowing = {1e308, &n};
    assert_true(isinf(cubature(scaled_wave, &overflowing, low, high, 1e-9, 0)) && n <= plane_calls);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hemispheres_and_spheres_have_their_area),
        cmocka_unit_test(lobes_of_any_width_are_found),
        cmocka_unit_test(huge_functions_take_no_more_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
