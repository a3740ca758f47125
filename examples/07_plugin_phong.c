/* 07_plugin_phong.c: a reflection model of one's own, Phong's distribution of normals between V-shaped grooves.
 * [walter07] Walter et al., Microfacet models for refraction, EGSR 2007.  [blinn77] Blinn, SIGGRAPH 1977.
 *     cc -shared -fPIC -I include -o plugin_phong.so examples/07_plugin_phong.c -lm
 *     facet verify --plugin ./plugin_phong.so
 * SPDX-License-Identifier: MIT */
#include <math.h>

#include "facet/plugin.h"

/* p[0]: the exponent n, p[1]: the reflectance along the normal.  D(m) = (n + 2)/(2 pi) cos^n, [walter07, eq. 30]. */
static double D(const double *p, const double m[3])
{
    return m[2] > 0 ? (p[0] + 2)/6.283185307179586*pow(m[2], p[0]) : 0;
}

/* f cos(theta_i) = D G F/(4 cos(theta_o)), G of the grooves [blinn77], F by Schlick with c = wo.m = wi.m; and the pdf,
 * D cos(theta_m)/(4 c), [walter07, eq. 14 and 24].  One function, because both need m, the normal between wi and wo. */
static double lobe(const double *p, const double wi[3], const double wo[3], double *density)
{
    const double h[3] = {wi[0] + wo[0], wi[1] + wo[1], wi[2] + wo[2]};
    const double c = sqrt(h[0]*h[0] + h[1]*h[1] + h[2]*h[2])/2,
                 m[3] = {h[0]/c/2, h[1]/c/2, h[2]/c/2};
    const double F = p[1] + (1 - p[1])*pow(fabs(1 - c), 5), G = fmin(1, 2*m[2]*fmin(wo[2], wi[2])/c);
    const int is_above = wi[2] > 0 && wo[2] > 0;
    *density = is_above ? D(p, m)*m[2]/(4*c) : 0;
    return is_above ? D(p, m)*G*F/(4*wo[2]) : 0;
}

static void eval(const double *p, const double wi[3], const double wo[3], double f[3])
{
    f[0] = f[1] = f[2] = lobe(p, wi, wo, &(double){0});
}

static double pdf(const double *p, const double wi[3], const double wo[3])
{
    double density;
    return (void)lobe(p, wi, wo, &density), density;
}

/* Draws m with cos(theta_m) = u^(1/(n + 2)), [walter07, eq. 31], and mirrors wo in it. */
static int sample(const double *p, const double wo[3], const double u[3], double wi[3], double weight[3])
{
    const double cosine = pow(u[0], 1/(p[0] + 2)), sine = sqrt(1 - cosine*cosine), phi = 6.283185307179586*u[1];
    const double m[3] = {sine*cos(phi), sine*sin(phi), cosine}, c = wo[0]*m[0] + wo[1]*m[1] + wo[2]*m[2];
    for (int i = 0; i < 3; i++) wi[i] = 2*c*m[i] - wo[i];
    double density;
    weight[0] = weight[1] = weight[2] = lobe(p, wi, wo, &density)/density;
    return density > 0; /* 0 where wi is below the horizon, as for all m that face away from wo */
}

static const facet_plugin_parameter table[] = {{"exponent", 1, 1000, 50, "n"}, {"reflectance", 0, 1, .9, "F at c = 1"}};
enum { CLAIMS = FACET_CLAIMS_RECIPROCAL | FACET_CLAIMS_PASSIVE | FACET_CLAIMS_ISOTROPIC };
static const facet_plugin plugin = {
    sizeof plugin, "phong", "Phong's normals, V-shaped grooves", CLAIMS, 2, table, eval, pdf, sample, D, NULL};

const facet_plugin *facet_plugin_describe(void)
{
    return &plugin;
}
