/* visible_normals_pdf.c: visible normals drawn, and a density without G1.
 *
 * Mistake: pdf = D/(4 cos(theta_o)).
 * Source:  NVIDIA-RTX/Donut#23, reports a density of visible normals without G1.
 * Right:   G1(wo) D/(4 cos(theta_o)), [heitz18, eq. 3 and 17]. Without it the density integrates to up to
 * 1/G1(wo).
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

/* [walter07, eq. 33], with the sine: alpha^2/(pi (sin^2 + alpha^2 cos^2)^2). */
static double D(const double *p, const double m[3])
{
    const double a2 = p[0]*p[0], t = m[0]*m[0] + m[1]*m[1] + a2*m[2]*m[2];
    return m[2] > 0 ? a2/(PI*t*t) : 0;
}

/* [walter07, eq. 34]: 2/(1 + sqrt(1 + alpha^2 tan^2)). */
static double G1(const double *p, const double v[3])
{
    const double a2 = p[0]*p[0];
    return v[2] > 0 ? 2*v[2]/(v[2] + sqrt(v[2]*v[2] + a2*(v[0]*v[0] + v[1]*v[1]))) : 0;
}

/* Draws a normal visible from wo, [heitz18, appendix A]. */
static void draw_normal(const double *p, const double wo[3], const double u[3], double m[3])
{
    const double sx = p[0]*wo[0], sy = p[0]*wo[1], length = sqrt(sx*sx + sy*sy + wo[2]*wo[2]);
    const double v[3] = {sx/length, sy/length, wo[2]/length}, s = hypot(v[0], v[1]);
    const double t1[3] = {s > 0 ? -v[1]/s : 1, s > 0 ? v[0]/s : 0, 0};
    const double t2[3] = {v[1]*t1[2] - v[2]*t1[1], v[2]*t1[0] - v[0]*t1[2], v[0]*t1[1] - v[1]*t1[0]};
    const double a = sqrt(u[0])*cos(2*PI*u[1]), b0 = sqrt(u[0])*sin(2*PI*u[1]), k = (1 + v[2])/2;
    const double b = (1 - k)*sqrt(1 - a*a) + k*b0, c = sqrt(fmax(0, 1 - a*a - b*b));
    for (int i = 0; i < 3; i++) m[i] = (a*t1[i] + b*t2[i] + c*v[i])*(i < 2 ? p[0] : 1);
    m[2] = fmax(0, m[2]);
    const double m_length = sqrt(dot(m, m));
    for (int i = 0; i < 3; i++) m[i] /= m_length;
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

/* The mistake: no G1(wo). */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    double m[3];
    return half_vector(wi, wo, m) ? D(p, m)/(4*wo[2]) : 0;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    double m[3];
    draw_normal(p, wo, u, m);
    const double wo_m = dot(wo, m);
    for (int i = 0; i < 3; i++) wi[i] = 2*wo_m*m[i] - wo[i];
    const double density = wo_m > 0 ? pdf(p, wi, wo) : 0;
    if (!(density > 0)) return 0;
    eval(p, wi, wo, weight);
    for (int i = 0; i < 3; i++) weight[i] /= density;
    return 1;
}

static const facet_plugin_parameter parameters[] = {
    {"alpha", .1, 1, .5, "roughness of GGX"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "visible_normals_pdf",
    .summary = "GGX, the density of visible normals without G1",
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
