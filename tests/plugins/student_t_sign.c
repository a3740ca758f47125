/* student_t_sign.c: Student's t as the distribution of slopes, masked by a fit with one sign changed.
 *
 * Mistake: a constant of the rational fit of Lambda, F22, is -14.402.
 * Source:  a public implementation of the fit of Ribardiere et al., STD: Student's t-Distribution of Slopes,
 * 2017, eq. (23).
 * Right:   +14.402, with which G1 is within about 2 % of Smith's for gamma 1.6 to 10: so the fit with the
 * right sign is no exact masking either.
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

/* [ribardiere17, eq. 11]: a Student-t density of slopes,
 * (1 + tan^2/((gamma - 1) alpha^2))^-gamma/(pi alpha^2 cos^4). */
static double D(const double *p, const double m[3])
{
    const double a2 = p[0]*p[0], gamma = p[1], c2 = m[2]*m[2];
    const double tangent2 = (m[0]*m[0] + m[1]*m[1])/c2;
    return m[2] > 0 ? pow(1 + tangent2/((gamma - 1)*a2), -gamma)/(PI*a2*c2*c2) : 0;
}

/* [ribardiere17, eq. 14 and 23], z = 1/(alpha tan(theta)).  The mistake: -14.402 in F22. */
static double G1(const double *p, const double v[3])
{
    const double g = p[1], sine = hypot(v[0], v[1]), z = v[2]/(p[0]*sine);
    const double S1 = pow((g - 1)/(g - 1 + z*z), g)*pow(g - 1 + z*z, 1.5)/(z*(2*g - 3));
    const double F21 = z*(1.066 + z*(2.655 + z*4.892))/(1.038 + z*(2.969 + z*(4.305 + z*4.418)));
    const double F22 = (-14.402 + g*(-27.145 + g*(20.574 - g*2.745)))/
                       (-30.612 + g*(86.567 + g*(-84.341 + g*29.938)));
    const double F23 = (-129.404 + g*(324.987 + g*(-299.305 + g*93.268)))/
                       (-92.609 + g*(256.006 + g*(-245.663 + g*86.064)));
    const double F24 = (6.537 + z*(6.074 + z*(-.623 + z*5.223)))/
                       (6.538 + z*(6.103 + z*(-3.218 + z*6.347)));
    const double S2 = F21*(F22 + F23*F24);
    const double Lambda = tgamma(g - .5)/(tgamma(g)*sqrt(PI))*(S1 + sqrt(g - 1)*S2) - .5;
    return v[2] <= 0 ? 0 : sine == 0 ? 1 : 1/(1 + Lambda);
}

/* tan^2(theta_m) = (gamma - 1) alpha^2 ((1 - u)^(1/(1 - gamma)) - 1), the inverse of its distribution. */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double tangent = p[0]*sqrt((p[1] - 1)*(pow(1 - u[0], 1/(1 - p[1])) - 1)), phi = 2*PI*u[1];
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
    {"alpha", .1, 1, .3, "roughness"},
    {"gamma", 2, 6, 2, "2 is GGX, infinity Beckmann"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "student_t_sign",
    .summary = "Student-t slopes, the fit of Lambda with one sign changed",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_ISOTROPIC,
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
