/* integrals.c: see integrals.h.
 *
 * All are double integrals over an azimuth and the logarithm of a distance from an axis, in which a lobe of any
 * width is as smooth as another: nested adaptive Gauss-Kronrod rules.  The inner one splits where the lobes of usual
 * roughness end, and both split until the two rules agree.
 * SPDX-License-Identifier: MIT */
#include "verify/integrals.h"

#include <math.h>

#include "verify/quadrature.h"
#include "verify/views.h"

#define PI 3.14159265358979323846

enum { DEEPEST = 12, SECTORS = 4 };

/* The slopes or tangents at which an integral along a line is cut. */
static const double cuts[] = {1e-10, 1e-5, 1e-3, .03, .3, 2, 30, 1e3, 1e7};
enum { N_CUTS = sizeof cuts/sizeof *cuts };

typedef struct plane_integral {
    sphere_function g;
    const void *context;
    double tolerance;                         /* of a part of a line */
    int depth;                                /* of halving */
    double start;                             /* azimuth of the first line */
    double end;                               /* of the line, in its distance */
    double cos_phi, sin_phi;                  /* of the line */
    const double *wo;                         /* over_mirrored */
    double axis[3], tangent[3], bitangent[3]; /* over_sphere */
    double (*along)(double x, const void *line);
    double (*end_of)(const struct plane_integral *p);
} plane_integral;

static double along_line(double phi, const void *context)
{
    plane_integral line = *(const plane_integral *)context;
    line.cos_phi = cos(phi);
    line.sin_phi = sin(phi);
    line.end = line.end_of(&line);
    double sum = 0;
    for (int i = 0; i + 1 < N_CUTS && cuts[i] < line.end; i++)
        sum += gauss_kronrod(line.along, &line, log(cuts[i]), log(fmin(cuts[i + 1], line.end)), line.tolerance,
                             line.depth);
    return sum;
}

static double over_sectors(const plane_integral *p)
{
    double sum = 0;
    for (int k = 0; k < SECTORS; k++)
        sum += gauss_kronrod(along_line, p, p->start + 2*PI*k/SECTORS, p->start + 2*PI*(k + 1)/SECTORS,
                             8*p->tolerance, p->depth);
    return sum;
}

/* A first look without any halving says how large the integral is.  Where it saw far more than there is, as between the
 * nodes of a narrow lobe, the second look is asked again with the tolerance that its own result deserves. */
static double over_plane(const plane_integral *p)
{
    plane_integral q = *p;
    const double estimate = over_sectors(&q);
    q.depth = DEEPEST;
    q.tolerance = quadrature_tolerance(p->tolerance, estimate);
    const double sum = over_sectors(&q);
    if (!(fabs(sum) < 0.1*fabs(estimate)) || q.tolerance == p->tolerance) return sum;
    q.tolerance = quadrature_tolerance(p->tolerance, sum);
    return over_sectors(&q);
}

/* ---- Normals, by their slopes ------------------------------------------------------------------ */

/* The normal of slope r along the line, and dm/(dphi dln r) = r^2 cos^3. */
static double normal_at(const plane_integral *p, double x, double m[3])
{
    const double r = exp(x), inverse = 1/sqrt(1 + r*r);
    m[0] = r*p->cos_phi*inverse;
    m[1] = r*p->sin_phi*inverse;
    m[2] = inverse;
    return r*r*inverse*inverse*inverse;
}

static double at_normal(double x, const void *context)
{
    const plane_integral *p = context;
    double m[3];
    const double jacobian = normal_at(p, x, m);
    return jacobian*p->g(p->context, m);
}

static double all_slopes(const plane_integral *p)
{
    (void)p;
    return cuts[N_CUTS - 1];
}

double over_normals(sphere_function g, const void *context, double tolerance)
{
    const plane_integral p = {
        .g = g, .context = context, .tolerance = tolerance, .along = at_normal, .end_of = all_slopes};
    return over_plane(&p);
}

/* wi = 2 (wo.m) m - wo, d omega_i = 4 (wo.m) dm [walter07, eq. 14]. */
static double at_mirrored(double x, const void *context)
{
    const plane_integral *p = context;
    double m[3];
    const double jacobian = normal_at(p, x, m);
    const double c = p->wo[0]*m[0] + p->wo[1]*m[1] + p->wo[2]*m[2];
    const double wi[3] = {2*c*m[0] - p->wo[0], 2*c*m[1] - p->wo[1], 2*c*m[2] - p->wo[2]};
    return c > 0 && wi[2] > 0 ? 4*c*jacobian*p->g(p->context, wi) : 0;
}

/* The slope at which wi reaches the horizon: (1 - r^2) cos_o + 2 r b = 0, b = wo along the line. */
static double horizon(const plane_integral *p)
{
    const double b = (p->wo[0]*p->cos_phi + p->wo[1]*p->sin_phi)/p->wo[2];
    return b > 0 ? b + sqrt(b*b + 1) : 1/(sqrt(b*b + 1) - b);
}

double over_mirrored(sphere_function g, const void *context, const double wo[3], double tolerance)
{
    const plane_integral p = {.g = g,
                              .context = context,
                              .tolerance = tolerance,
                              .start = atan2(wo[1], wo[0]), /* at grazing views, all light is near it */
                              .wo = wo,
                              .along = at_mirrored,
                              .end_of = horizon};
    return over_plane(&p);
}

/* ---- Directions, by the tangent of half their angle with an axis ------------------------------- */

/* With t = tan(theta/2): cos = (1 - t^2)/(1 + t^2), sin = 2 t/(1 + t^2), d omega = sin dtheta dphi = 4 t^2/(1 + t^2)^2
 * dln t dphi. */
static double at_direction(double x, const void *context)
{
    const plane_integral *p = context;
    const double t = exp(x), inverse = 1/(1 + t*t), cosine = (1 - t*t)*inverse, sine = 2*t*inverse;
    double v[3];
    for (int k = 0; k < 3; k++)
        v[k] = cosine*p->axis[k] + sine*(p->cos_phi*p->tangent[k] + p->sin_phi*p->bitangent[k]);
    return 4*t*t*inverse*inverse*p->g(p->context, v);
}

double over_sphere(sphere_function g, const void *context, const double axis[3], double tolerance)
{
    plane_integral p = {.g = g,
                        .context = context,
                        .tolerance = tolerance,
                        .axis = {axis[0], axis[1], axis[2]},
                        .along = at_direction,
                        .end_of = all_slopes};
    /* a frame [duff17] */
    const double sign = copysign(1, axis[2]), a = -1/(sign + axis[2]), b = axis[0]*axis[1]*a;
    p.tangent[0] = 1 + sign*axis[0]*axis[0]*a;
    p.tangent[1] = sign*b;
    p.tangent[2] = -sign*axis[0];
    p.bitangent[0] = b;
    p.bitangent[1] = sign + axis[1]*axis[1]*a;
    p.bitangent[2] = -axis[1];
    return over_plane(&p);
}
