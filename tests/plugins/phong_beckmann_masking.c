/* phong_beckmann_masking.c: Phong's distribution of normals with a masking made for Beckmann's.
 *
 * Mistake: G1 is the rational fit of Beckmann's, taken at a = sqrt(n/2 + 1)/tan(theta).
 * Source:  CS500 Project 3, Phong, "same G1 as Beckmann" (errata 8); Walter et al. 2007, section 5.2, as a
 * stand-in for rough exponents.
 * Right:   Smith's G1 of Phong's own D. The weak white furnace gives up to 1.31 (n = 1), 1.05 (n = 10) at
 * cos(theta) = .1, and the albedo with F = 1 exceeds 1.
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

/* [walter07, eq. 30]: (n + 2)/(2 pi) cos^n. */
static double D(const double *p, const double m[3])
{
    return m[2] > 0 ? (p[0] + 2)/(2*PI)*pow(m[2], p[0]) : 0;
}

/* The mistake: the fit of [walter07, eq. 27] for Beckmann's D. */
static double G1(const double *p, const double v[3])
{
    const double a = sqrt(p[0]/2 + 1)*v[2]/hypot(v[0], v[1]);
    return v[2] <= 0 ? 0 : a < 1.6 ? a*(3.535 + 2.181*a)/(1 + a*(2.276 + 2.577*a)) : 1;
}

/* [walter07, eq. 31]: cos(theta_m) = u^(1/(n + 2)). */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double cosine = pow(u[0], 1/(p[0] + 2)), sine = sqrt((1 - cosine)*(1 + cosine)), phi = 2*PI*u[1];
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
    {"exponent", 1, 20, 2, "Phong exponent n"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "phong_beckmann_masking",
    .summary = "Phong, masked by Beckmann's rational fit",
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
