/* not_reciprocal.c: a lobe scaled by its own albedo, called reciprocal.
 *
 * Mistake: f = f1(wi, wo)/E(wo): lossless, but E is that of wo alone; the plugin claims to be reciprocal,
 * too.
 * Source:  Turquin, Practical multiple scattering compensation for microfacet models, 2019, which scales so
 * and gives reciprocity up openly.
 * Right:   not to claim it, or to scale by a symmetric function of wi and wo.
 *
 * expect: reciprocity
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

/* Lommel and Seeliger's law, because its albedo has a closed form: f1 = 1/(4 pi (cos_i + cos_o)),
 * E = (1 - cos_o ln(1 + 1/cos_o))/2.  f cos(theta_i) = f1 cos(theta_i)/E(wo), the mistake. */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    const double E = (1 - wo[2]*log1p(1/wo[2]))/2;
    const int is_above = wi[2] > 0 && wo[2] > 0;
    for (int i = 0; i < 3; i++) f[i] = is_above ? p[0]*wi[2]/(4*PI*(wi[2] + wo[2])*E) : 0;
}

/* The density cos(theta_i)/pi. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    (void)p;
    return wi[2] > 0 && wo[2] > 0 ? wi[2]/PI : 0;
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
    {"reflectance", .1, 1, 1, "albedo for every wo"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "not_reciprocal",
    .summary = "Lommel-Seeliger over its albedo",
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
