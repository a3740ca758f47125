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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hemispheres_and_spheres_have_their_area),
        cmocka_unit_test(lobes_of_any_width_are_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
