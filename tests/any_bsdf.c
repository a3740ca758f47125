/* any_bsdf.c: see any_bsdf.h.
 * SPDX-License-Identifier: MIT */
#include "tests/any_bsdf.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

static void round3(const double from[3], float to[3])
{
    for (int k = 0; k < 3; k++) to[k] = (float)from[k];
}

any_bsdf any_bsdf_of(const char *spec, int is_double)
{
    any_bsdf bsdf = {.is_double = is_double};
    snprintf(bsdf.spec, sizeof bsdf.spec, "%s", spec);
    facet_material material;
    facet_error why;
    if (facet_material_parse(spec, &material, &why) || facet_bsdf_prepare(&material, &bsdf.single, &why) ||
        facet_bsdf64_prepare(&material, &bsdf.twice, &why))
        fail_msg("%s: %s: %s", spec, why.place, why.text);
    return bsdf;
}

facet_bsdf single_bsdf_of(const char *spec)
{
    return any_bsdf_of(spec, 0).single;
}

double any_epsilon(const any_bsdf *bsdf)
{
    return bsdf->is_double ? DBL_EPSILON : FLT_EPSILON;
}

void any_eval(const any_bsdf *bsdf, const double wi[3], const double wo[3], double f[3])
{
    if (bsdf->is_double) {
        facet_bsdf64_eval(&bsdf->twice, wi, wo, f);
        return;
    }
    float in[3], out[3], value[3];
    round3(wi, in);
    round3(wo, out);
    facet_bsdf_eval(&bsdf->single, in, out, value);
    for (int k = 0; k < 3; k++) f[k] = (double)value[k];
}

double any_pdf(const any_bsdf *bsdf, const double wi[3], const double wo[3])
{
    if (bsdf->is_double) return facet_bsdf64_pdf(&bsdf->twice, wi, wo);
    float in[3], out[3];
    round3(wi, in);
    round3(wo, out);
    return (double)facet_bsdf_pdf(&bsdf->single, in, out);
}

facet_sample64 any_sample(const any_bsdf *bsdf, const double wo[3], const double u[3])
{
    if (bsdf->is_double) return facet_bsdf64_sample(&bsdf->twice, wo, u);
    float out[3], numbers[3];
    round3(wo, out);
    round3(u, numbers);
    const facet_sample s = facet_bsdf_sample(&bsdf->single, out, numbers);
    facet_sample64 wide = {.pdf = (double)s.pdf, .lobe = s.lobe, .eta = (double)s.eta};
    for (int k = 0; k < 3; k++) {
        wide.wi[k] = (double)s.wi[k];
        wide.weight[k] = (double)s.weight[k];
    }
    return wide;
}

facet_terms64 any_terms(const any_bsdf *bsdf, const double m[3])
{
    if (bsdf->is_double) return facet_bsdf64_terms(&bsdf->twice, m);
    float normal[3];
    round3(m, normal);
    const facet_terms t = facet_bsdf_terms(&bsdf->single, normal);
    return (facet_terms64){.D = (double)t.D, .Lambda = (double)t.Lambda, .G1 = (double)t.G1};
}

void any_direction(double cos_theta, double phi, double v[3])
{
    const double sin_theta = sqrt((1 - cos_theta)*(1 + cos_theta));
    v[0] = sin_theta*cos(phi);
    v[1] = sin_theta*sin(phi);
    v[2] = cos_theta;
}
