/* two_alphas.c: GGX whose D and G1 have different alphas.
 *
 * Mistake: D has alpha = roughness^2, G1 has alpha = roughness.
 * Source:  drsnuggles8/OloEngineBase#904.
 * Right:   one alpha for both. At roughness .5 D is that of alpha .25 and G1 that of alpha .5.
 *
 * expect: weak-furnace
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* [walter07, eq. 33], with the sine; alpha = roughness^2. */
static double D(const double *p, const double m[3])
{
    const double alpha = p[0]*p[0], a2 = alpha*alpha, t = m[0]*m[0] + m[1]*m[1] + a2*m[2]*m[2];
    return m[2] > 0 ? a2/(PI*t*t) : 0;
}

/* [walter07, eq. 34].  The mistake: alpha = roughness. */
static double G1(const double *p, const double v[3])
{
    const double a2 = p[0]*p[0];
    return v[2] > 0 ? 2*v[2]/(v[2] + sqrt(v[2]*v[2] + a2*(v[0]*v[0] + v[1]*v[1]))) : 0;
}

/* tan(theta_m) = alpha sqrt(u/(1 - u)), [walter07, eq. 35]. */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double tangent = p[0]*p[0]*sqrt(u[0]/(1 - u[0])), phi = 2*PI*u[1];
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

/* f cos(theta_i) = D(wm) G1(wi) G1(wo) F/(4 cos(theta_o)), [walter07, eq. 20 and 23], with F = 1. */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    double m[3];
    const int is_above = half_vector(wi, wo, m);
    for (int i = 0; i < 3; i++) f[i] = is_above ? D(p, m)*G1(p, wi)*G1(p, wo)/(4*wo[2]) : 0;
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
    {"roughness", .3, .9, .5, "alpha of D is its square"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "two_alphas",
    .summary = "GGX, D with roughness^2 and G1 with roughness",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
    .parameter_count = 1,
    .parameters = parameters,
    .eval = eval,
    .pdf = pdf,
    .sample = sample,
    .D = D,
    .G1 = G1,
};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
