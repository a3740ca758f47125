/* weight_check.c: see weight_check.h.
 * SPDX-License-Identifier: MIT */
#include "tests/weight_check.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* pdf, and f/pdf of the channels, at a direction. */
static void density_and_weights(const any_bsdf *bsdf, const double wi[3], const double wo[3], double values[4])
{
    any_eval(bsdf, wi, wo, values + 1);
    values[0] = any_pdf(bsdf, wi, wo);
    for (int k = 1; k < 4; k++) values[k] /= values[0];
}

facet_sample64 weight_check(const any_bsdf *bsdf, const double wo[3], const double u[3], double steps)
{
    const facet_sample64 s = any_sample(bsdf, wo, u);
    if (s.pdf == 0) {
        for (int k = 0; k < 3; k++) assert_true(s.weight[k] == 0);
        return s;
    }
    const double eps = any_epsilon(bsdf), drawn[4] = {s.pdf, s.weight[0], s.weight[1], s.weight[2]};
    double at[4], tolerance[4];
    density_and_weights(bsdf, s.wi, wo, at);
    for (int k = 0; k < 4; k++) tolerance[k] = 5*eps*fabs(at[k]);
    for (int axis = 0; axis < 6; axis++) {
        double most[4] = {0};
        for (int side = -1; side <= 1; side += 2) {
            double near[4], pair[6] = {s.wi[0], s.wi[1], s.wi[2], wo[0], wo[1], wo[2]};
            pair[axis] += side*steps*eps;
            if (pair[2]*s.wi[2] <= 0 || pair[5]*wo[2] <= 0) continue;
            density_and_weights(bsdf, pair, pair + 3, near);
            for (int k = 0; k < 4; k++) most[k] = fmax(most[k], fabs(near[k] - at[k]));
        }
        for (int k = 0; k < 4; k++) tolerance[k] += most[k];
    }
    for (int k = 0; k < 4; k++)
        if (!(fabs(drawn[k] - at[k]) <= tolerance[k]))
            fail_msg("%s, wo (%a, %a, %a), wi (%a, %a, %a): %s %a, of the sample %a, tolerance %g", bsdf->spec, wo[0],
                     wo[1], wo[2], s.wi[0], s.wi[1], s.wi[2], k ? "eval/pdf" : "pdf", at[k], drawn[k], tolerance[k]);
    return s;
}
