/* kd_plus_specular.c: a diffuse term beside a specular one, each at will.
 *
 * Mistake: f = kd/pi + specular with kd and ks free, and the claim that no more leaves than came.
 * Source:  CS500 Project 3, "Changes to the BRDF" (errata 12).
 * Right:   kd at most 1 less the albedo of the specular term. kd = 1, ks = .04, alpha = .3 has the albedo
 * 1.105 at cos_o = .2.
 *
 * expect: furnace
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

/* tan(theta_m) = alpha sqrt(u/(1 - u)), [walter07, eq. 35]. */
static void draw_normal(const double *p, const double u[3], double m[3])
{
    const double tangent = p[0]*sqrt(u[0]/(1 - u[0])), phi = 2*PI*u[1];
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

/* kd/pi + D G1 G1 F/(4 cos_i cos_o), times cos(theta_i), with Schlick's F.  The mistake: kd is what the user asks for,
 * whatever the specular term reflects. */
static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    double m[3];
    const int is_above = half_vector(wi, wo, m);
    const double F = p[2] + (1 - p[2])*pow(fmax(0, 1 - dot(wo, m)), 5);
    const double specular = D(p, m)*G1(p, wi)*G1(p, wo)*F/(4*wo[2]);
    for (int i = 0; i < 3; i++) f[i] = is_above ? p[1]*wi[2]/PI + specular : 0;
}

/* Either term half of the time. */
static double pdf(const double *p, const double wi[3], const double wo[3])
{
    double m[3];
    return half_vector(wi, wo, m) ? wi[2]/(2*PI) + D(p, m)*m[2]/(8*dot(wo, m)) : 0;
}

static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    double m[3];
    const double r = sqrt(u[0]), phi = 2*PI*u[1];
    draw_normal(p, u, m);
    const double wo_m = dot(wo, m), diffuse[3] = {r*cos(phi), r*sin(phi), sqrt(1 - u[0])};
    for (int i = 0; i < 3; i++) wi[i] = u[2] < .5 ? diffuse[i] : 2*wo_m*m[i] - wo[i];
    const double density = u[2] < .5 || wo_m > 0 ? pdf(p, wi, wo) : 0;
    if (!(density > 0)) return 0;
    eval(p, wi, wo, weight);
    for (int i = 0; i < 3; i++) weight[i] /= density;
    return 1;
}

static const facet_plugin_parameter parameters[] = {
    {"alpha", .1, 1, .3, "roughness of GGX"},
    {"kd", 0, 1, 1, "diffuse albedo"},
    {"ks", 0, 1, .04, "reflectance along the normal, Schlick"},
};

static const facet_plugin plugin = {
    .struct_size = sizeof(facet_plugin),
    .name = "kd_plus_specular",
    .summary = "Lambert plus GGX, not limited",
    .claims = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC,
    .parameter_count = 3,
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
