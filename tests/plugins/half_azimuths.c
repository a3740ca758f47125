/* half_azimuths.c: a distribution of normals that leans to one side.
 *
 * Mistake: D is the density that the sampler of aniso_atan.c draws: twice GGX's for x > 0, nothing for x < 0.
 * Source:  what follows from Burley 2012, eq. (11), solved with atan (errata 25).
 * Right:   the facets of a level surface project to its area in every direction, the integral of D (v.m) is
 * cos(theta_v); here the mean slope is not 0, although D cos(theta_m) integrates to 1 and the samples follow
 * it.
 *
 * expect: projected-area
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* Twice [walter07, eq. 33] on one side.  The mistake: the other side. */
static double D(const double *p, const double m[3])
{
    const double a2 = p[0]*p[0], t = m[0]*m[0] + m[1]*m[1] + a2*m[2]*m[2];
    return m[2] > 0 && m[0] > 0 ? 2*a2/(PI*t*t) : 0;
}

/* tan(theta_m) = alpha sqrt(u/(1 - u)), [walter07, eq. 35], phi in (-pi/2, pi/2). */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double tangent = p[0]*sqrt(u[0]/(1 - u[0])), phi = PI*(u[1] - .5);
    m[2] = 1/sqrt(1 + tangent*tangent);
    m[0] = m[2]*tangent*cos(phi);
    m[1] = m[2]*tangent*sin(phi);
}

/* The normal between wi and wo; whether both are above the horizon. */
static int half_vector(const double wi[3], const double wo[3], double m[3])
{
    const double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    const double length = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2]);
    for (int i = 0; i < 3; i++) m[i] = h[i]/length;
    return wi[2] > 0 && wo[2] > 0;
}

/* f cos(theta_i) = D(wm) G F/(4 cos(theta_o)), with F = 1 and the G of V-shaped grooves [torrance67; blinn77]:
 * min(1, 2 cos_m cos_i/(wo.wm), 2 cos_m cos_o/(wo.wm)). */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    double m[3];
    const int is_above = half_vector(wi, wo, m);
    const double G = fmin(1, 2*m[2]*fmin(wi[2], wo[2])/dot(wo, m));
    for (int i = 0; i < 3; i++) f[i] = is_above ? D(p, m)*G/(4*wo[2]) : 0;
}

/* D cos(theta_m)/(4 wo.wm): normals drawn by D cos(theta_m), [walter07, eq. 14 and 24]. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    double m[3];
    return half_vector(wi, wo, m) ? D(p, m)*m[2]/(4*dot(wo, m)) : 0;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    double m[3];
    draw_normal(p, u, m);
    const double wo_m = dot(wo, m);
    for (int i = 0; i < 3; i++) wi[i] = 2*wo_m*m[i] - wo[i];
    const double density = wo_m > 0 ? pdf(p, wi, wo) : 0;
    if (!(density > 0)) return 0;
    eval(p, wi, wo, weight);
    for (int i = 0; i < 3; i++) weight[i] /= density;
    return 1;
}

static const facet_plugin_parameter parameters[] = {
    {"alpha", .1, .6, .3, "roughness of GGX"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "half_azimuths",
    .summary = "GGX with normals on one side only",
    .claims = FACET_CLAIMS_RECIPROCAL,
    .parameter_count = 1,
    .parameters = parameters,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .D = D,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
