/* gamma_clamp.c: GTR masked as if gamma were at most 4.
 *
 * Mistake: G1 is that of gamma = 4 for every gamma above.
 * Source:  the V-Ray paper on Smith's G1 for GTR, section 6, which states the clamp (errata 36).
 * Right:   the G1 of the gamma of D. It differs by .046 at gamma 4.5, .29 at 10.
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

/* GTR, [disney, eq. 1]: D0 (1 + (1/alpha^2 - 1) sin^2)^-gamma, with D0 by expm1 so that nothing overflows. */
static double D(const double *p, const double m[3])
{
    const double a2 = p[0]*p[0], e = 1 - a2, x = (p[1] - 1)*log(a2);
    const double D0 = e/(PI*a2)*(p[1] - 1)/-expm1(x);
    return m[2] > 0 ? D0*pow(1 + e/a2*(m[0]*m[0] + m[1]*m[1]), -p[1]) : 0;
}

/* [vray, section 3.5], mu = cot(theta).  The mistake: gamma is 4. */
static double G1(const double *p, const double v[3])
{
    const double a2 = p[0]*p[0], a4 = a2*a2, sine = hypot(v[0], v[1]), mu = v[2]/sine, mu2 = mu*mu;
    const double A = 8*(a4 + a2 + 1), B = hypot(mu, p[0]), B3 = B*B*B;
    const double below = A*mu*(B3 + mu*mu2) + 3*a2*(a2*(5*a4 + 2*a2 + 1) + 4*mu2*(2*a4 + a2 + 1));
    return v[2] <= 0 ? 0 : mu > 1e6 || sine == 0 ? 1 : 2*A*mu*B3/below;
}

/* [disney, eq. 3], solved for the sine: (1 + (1/alpha^2 - 1) sin^2)^(1 - gamma) = 1 + u (alpha^(2 (gamma - 1)) - 1). */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double a2 = p[0]*p[0], x = (p[1] - 1)*log(a2), phi = 2*PI*u[1];
    const double sine2 = fmin(1, a2*expm1(log1p(u[0]*expm1(x))/(1 - p[1]))/(1 - a2)), sine = sqrt(sine2);
    m[0] = sine*cos(phi);
    m[1] = sine*sin(phi);
    m[2] = sqrt(1 - sine2);
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
    {"alpha", .1, .9, .6, "roughness of GTR"},
    {"gamma", 5, 10, 8, "exponent of GTR"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "gamma_clamp",
    .summary = "GTR, masked with gamma 4",
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
