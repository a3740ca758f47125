/* clearcoat_jacobian.c: a clearcoat whose pdf is the density of the normal, not that of the direction.
 *
 * Mistake: pdf lacks the Jacobian 1/(4 wo.wm) of the reflection.
 * Source:  mmp/pbrt-v3#172, which adds it to the clearcoat of the Disney material.
 * Right:   D cos(theta_m)/(4 wo.wm), [walter07, eq. 14]. Without it the density integrates to as much as 4,
 * and the samples are not drawn by it.
 *
 * expect: pdf-normalisation
 *
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

static const double PI = 3.14159265358979323846;

static double dot(const double a[3], const double b[3])
{
    return a[0]*b[0] + a[1]*b[1] + a[2]*b[2];
}

/* GTR with gamma = 1, [disney, eq. 4]: (alpha^2 - 1)/(pi ln(alpha^2) (sin^2 + alpha^2 cos^2)). */
static double D(const double *p, const double m[3])
{
    const double a2 = p[0]*p[0], t = m[0]*m[0] + m[1]*m[1] + a2*m[2]*m[2];
    return m[2] > 0 ? (a2 - 1)/(PI*log(a2)*t) : 0;
}

/* Smith's G1 of GTR with gamma = 1, [vray, section 3.2], arranged so that nothing cancels.  mu = cot(theta). */
static double G1(const double *p, const double v[3])
{
    const double sine = hypot(v[0], v[1]), mu = v[2]/sine, A = hypot(mu, p[0]), B = hypot(mu, 1);
    const double t = (1 - p[0])*(1 + p[0])/(A + B);
    const double Lambda = (mu*log1p(t/(mu + A)) - t)/(mu*2*log(p[0]));
    return v[2] <= 0 ? 0 : sine == 0 ? 1 : 1/(1 + Lambda);
}

/* [disney, eq. 5]: cos^2(theta_m) = (1 - alpha^(2 (1 - u)))/(1 - alpha^2). */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double a2 = p[0]*p[0], cosine2 = fmin(1, (1 - pow(a2, 1 - u[0]))/(1 - a2));
    const double sine = sqrt(1 - cosine2), phi = 2*PI*u[1];
    m[0] = sine*cos(phi);
    m[1] = sine*sin(phi);
    m[2] = sqrt(cosine2);
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

/* The mistake: no 1/(4 wo.wm). */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    double m[3];
    return half_vector(wi, wo, m) ? D(p, m)*m[2] : 0;
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
    {"alpha", .01, .3, .1, "roughness of GTR with gamma 1"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "clearcoat_jacobian",
    .summary = "GTR with gamma 1, pdf without 1/(4 wo.wm)",
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
