/* isotropy_claim.c: an anisotropic lobe that claims to be isotropic.
 *
 * Mistake: the claim: the lobe has alpha_x and alpha_y, and they differ.
 * Source:  of no document: made for these tests.
 * Right:   to claim no isotropy.
 *
 * expect: isotropy
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* [disney, eq. 13]: 1/(pi alpha_x alpha_y (x^2/alpha_x^2 + y^2/alpha_y^2 + z^2)^2). */
static double D(const double *p, const double m[3])
{
    const double x = m[0]/p[0], y = m[1]/p[1], t = x*x + y*y + m[2]*m[2];
    return m[2] > 0 ? 1/(PI*p[0]*p[1]*t*t) : 0;
}

/* Smith's, with alpha along v, [heitz14, section 5.3]: 2/(1 + sqrt(1 + (alpha_x^2 x^2 + alpha_y^2 y^2)/z^2)). */
static double G1(const double *p, const double v[3])
{
    const double x = p[0]*v[0], y = p[1]*v[1];
    return v[2] > 0 ? 2*v[2]/(v[2] + sqrt(v[2]*v[2] + x*x + y*y)) : 0;
}

/* [disney, eq. 14 and 15]. */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double r = sqrt(u[1]/(1 - u[1])), x = r*p[0]*cos(2*PI*u[0]), y = r*p[1]*sin(2*PI*u[0]);
    m[2] = 1/sqrt(1 + x*x + y*y);
    m[0] = m[2]*x;
    m[1] = m[2]*y;
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
    {"alpha_x", .1, .3, .2, "roughness along x"},
    {"alpha_y", .5, 1, .6, "roughness along y"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "isotropy_claim",
    .summary = "anisotropic GGX, called isotropic",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
    .parameter_count = 2,
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
