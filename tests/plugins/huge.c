/* huge.c: Lambert with f, and a density that claims as much, of 10^scale.
 * A verifier must say that light appears, in seconds: its tolerances are no smaller than what rounding leaves.
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

/* f cos(theta_i) = 10^scale cos(theta_i). */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    for (int i = 0; i < 3; i++) f[i] = wi[2] > 0 && wo[2] > 0 ? pow(10, p[0])*wi[2] : 0;
}

/* 10^scale times the density of the samples, cos(theta_i)/pi. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    return wi[2] > 0 && wo[2] > 0 ? pow(10, p[0])*wi[2]/PI : 0;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    const double sine = sqrt(u[0]), phi = 2*PI*u[1];
    wi[0] = sine*cos(phi);
    wi[1] = sine*sin(phi);
    wi[2] = sqrt(1 - u[0]);
    const double density = pdf(p, wi, wo);
    if (!(density > 0)) return 0;
    eval(p, wi, wo, weight);
    for (int i = 0; i < 3; i++) weight[i] /= density;
    return 1;
}

static const facet_plugin_parameter parameters[] = {
    {"scale", 20, 308, 20, "power of ten of f"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "huge",
    .summary = "f of 10^scale",
    .parameter_count = 1,
    .parameters = parameters,
    .claims = FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC | FACET_CLAIMS_RECIPROCAL,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
