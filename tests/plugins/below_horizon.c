/* below_horizon.c: a diffuse surface that does not ask which side wi is on.
 *
 * Mistake: f = kd/pi and pdf = |cos(theta_i)|/pi below the horizon as well.
 * Source:  CS500 Project 3, EvalScattering and PdfBrdf (errata 6).
 * Right:   both are 0 where cos(theta_i) <= 0. As printed the density integrates to 2 over the sphere.
 *
 * expect: pdf-normalisation
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

/* |cos(theta_i)| kd/pi.  The mistake: at both sides. */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    (void)wo;
    for (int i = 0; i < 3; i++) f[i] = p[0]*fabs(wi[2])/PI;
}

/* The mistake, too. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    (void)p, (void)wo;
    return fabs(wi[2])/PI;
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
    {"kd", 0, 1, .5, "albedo of the upper side"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "below_horizon",
    .summary = "Lambert, at both sides",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
    .parameter_count = 1,
    .parameters = parameters,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
