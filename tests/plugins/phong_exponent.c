/* phong_exponent.c: Phong's distribution of normals drawn with the exponent of another lobe.
 *
 * Mistake: normals are drawn with cos(theta_m) = u^(1/(n + 1)), the law of the density (n + 1)/(2 pi) cos^n.
 * Source:  CS500 Project 3, SampleBrdf, Phong (errata 4).
 * Right:   cos(theta_m) = u^(1/(n + 2)), the law of D cos(theta_m), which pdf states here. The distribution
 * functions differ by up to .105 at n = 2.
 *
 * expect: chi-square
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* [walter07, eq. 30]: (n + 2)/(2 pi) cos^n. */
static double D(const double *p, const double m[3])
{
    return m[2] > 0 ? (p[0] + 2)/(2*PI)*pow(m[2], p[0]) : 0;
}

/* The mistake: 1/(n + 1). */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double cosine = pow(u[0], 1/(p[0] + 1)), sine = sqrt((1 - cosine)*(1 + cosine)), phi = 2*PI*u[1];
    m[0] = sine*cos(phi);
    m[1] = sine*sin(phi);
    m[2] = cosine;
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
    {"exponent", 1, 20, 2, "Phong exponent n"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "phong_exponent",
    .summary = "Phong, drawn with the exponent 1/(n + 1)",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
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
