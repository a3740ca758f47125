/* gtr_lambda.h: Smith's Lambda of GTR without prepared constants: where alpha and gamma differ from point to point, and
 * where Lambda is wanted to its last digits however small it is.
 *
 * Both integrate the probability S(r) that a normal's slope exceeds r,
 *     Lambda = 1/(pi mu) Int S(sqrt(mu^2 + e^2)) e^2/(mu^2 + e^2) de,  e from 0 to infinity,
 *     S(r) = (e^((gamma - 1) Y) - 1)/(e^((gamma - 1) L) - 1),  Y = -ln s(r^2),  L = -ln(alpha^2).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr.h"

#if FACET_REAL_IS_DOUBLE
#define LAMBDA_POINTS  500
#define LAMBDA_LOWEST  13.0f /* the integrand falls as e^(3y) below y = ln(e/mu) = 0, */
#define LAMBDA_HIGHEST 37.0f /* and as e^-y above the larger of 0 and -ln mu */
#define LAMBDA_CLOSEST ((real)1e-8)
#else
#define LAMBDA_POINTS  128
#define LAMBDA_LOWEST  7.0f
#define LAMBDA_HIGHEST 19.0f
#define LAMBDA_CLOSEST ((real)1e-4)
#endif

#define GTR_DIRECT_LARGEST 1048576.0f /* beyond this cotangent Lambda is below 1e-12; before its inverse T is linear */
#define GTR_DIRECT_STRETCH ((real)0.2)

/* gamma - 1, or a number that acts as 0 in (e^((gamma - 1) x) - 1)/(gamma - 1). */
KERNEL real gtr_excess(real gamma)
{
    real excess = gamma - 1;
    return kabs(excess) > GTR_LEAST_EXCESS ? excess : GTR_LEAST_EXCESS;
}

/* S(r) at t = r^2; S is 0 nowhere, and accurate relative to its size. */
KERNEL real gtr_survival(real t, real alpha2, real k0, real excess, real log_range)
{
    real inverse = 1/(1 + t);
    real rest    = k0*inverse; /* 1 - s */
    real lift    = klog1p(t*rest/alpha2);
    real Y       = rest < 0.5f ? -klog1p(-rest) : log_range - lift;
    return kexp(-excess*lift)*(kexpm1(-excess*Y)/kexpm1(-excess*log_range));
}

/* Lambda, to the relative accuracy of the elementary functions: the trapezoidal rule in y = ln(e/mu), where the
 * integrand is analytic for |Im y| < pi/2 and falls exponentially.  Near mu = 0, T = mu Lambda is linear. */
KERNEL real gtr_Lambda_exact(real alpha, real gamma, real mu)
{
    real a      = kmin(alpha, GTR_ROUGHEST);
    real alpha2 = a*a;
    real k0     = (1 - a)*(1 + a);
    real L      = -2*klog(a);
    real excess = gtr_excess(gamma);
    real least  = LAMBDA_CLOSEST*a;
    real m      = kclamp(mu, least, COT_LARGEST);
    real width  = LAMBDA_LOWEST + LAMBDA_HIGHEST + kmax(-klog(m), 0);
    real step   = width/LAMBDA_POINTS;
    real sum    = 0;
    for (int i = 0; i < LAMBDA_POINTS; i++) {
        real w  = kexp((i + 0.5f)*step - LAMBDA_LOWEST); /* e/mu */
        real w2 = w*w;
        sum += gtr_survival(m*m*(1 + w2), alpha2, k0, excess, L)*(w*(w2/(1 + w2)));
    }
    real T = INV_PI*step*m*sum + 0.5f*kmax(least - mu, 0);
    return T/kmax(mu, COT_SMALLEST);
}

/* Smith's Lambda at v, to its last digits. */
KERNEL real gtr_Lambda(real3 v, gtr_shape g)
{
    real3 w = gtr_unstretch_direction(g, v);
    return gtr_Lambda_exact(g.alpha, g.gamma, kabs(w.z)/kmax(ksqrt(w.x*w.x + w.y*w.y), REAL_MIN));
}

#if FACET_REAL_IS_DOUBLE
/* Lambda for an alpha and a gamma of their own. */
KERNEL real gtr_Lambda_direct(real alpha, real gamma, real mu) { return gtr_Lambda_exact(alpha, gamma, mu); }
#else
/* x - atan x, x >= 0, relative error 1e-7; pi/2 - 1/x + ... beyond 1. */
KERNEL real gtr_x_minus_atan(real x)
{
    int is_far = x > 1;
    real v     = is_far ? 1/kmax(x, 1) : x;
    real v2    = v*v;
    real c0 = 0.3333333173f, c1 = -0.1999973933f, c2 = 0.1427856875f, c3 = -0.1103376412f, c4 = 0.0865688043f;
    real c5 = -0.06250169445f, c6 = 0.03587153898f, c7 = -0.01350777143f, c8 = 0.002386997317f;
    real v4   = v2*v2;
    real near = v*v2*
                ((c0 + v2*c1) + v4*((c2 + v2*c3) + v4*((c4 + v2*c5) + v4*((c6 + v2*c7) + v4*c8))));
    return is_far ? (x - HALF_PI) + (v - near) : near;
}

/* Gauss's rule of 16 nodes for the weight (1 + x)^2 and the angle omega in [0, pi/2]: sin^2, cos^2, and the weight by
 * sin(2 omega).  Roots of Jacobi's polynomial P_16^(0,2), computed with 40 digits. */
typedef struct gtr_direct_node {
    real sin2, cos2, weight;
} gtr_direct_node;

static const gtr_direct_node gtr_direct_nodes[16] = {
    {(real)0.001128866243987658, (real)0.998871133756012341, (real)0.002945346980782112},
    {(real)0.007932558020859106, (real)0.992067441979140894, (real)0.011894637371881239},
    {(real)0.027629936398890673, (real)0.972370063601109326, (real)0.028905382904077184},
    {(real)0.068390047998589552, (real)0.931609952001410447, (real)0.053758988721521775},
    {(real)0.136781347025826978, (real)0.863218652974173022, (real)0.083420956646482715},
    {(real)0.234970915663205231, (real)0.765029084336794769, (real)0.112256550683369854},
    {(real)0.358736940899304052, (real)0.641263059100695948, (real)0.133459075630640714},
    {(real)0.497427744156008425, (real)0.502572255843991575, (real)0.141397147875116884},
    {(real)0.6363203664442962, (real)0.3636796335557038, (real)0.133855732964676754},
    {(real)0.760651406055541987, (real)0.239348593944458013, (real)0.112971325963471783},
    {(real)0.85966118457930525, (real)0.14033881542069475, (real)0.084322220457339840},
    {(real)0.928985584059688454, (real)0.071014415940311546, (real)0.054700271779981738},
    {(real)0.970652525240125272, (real)0.029347474759874728, (real)0.029759388045060033},
    {(real)0.991121112688051009, (real)0.008878887311948990, (real)0.012571452488622379},
    {(real)0.998490181863538005, (real)0.001509818136461994, (real)0.003393513474367660},
    {(real)0.999944852068803826, (real)0.000055147931196174, (real)0.000282604061124041},
};

/* Lambda for an alpha and a gamma of their own.  G1 is exact to 5e-7: integrated by parts,
 *     T = c/k0 Int s^(1 - gamma) (e - mu atan(e/mu)) dy,  y = ln s from ln s(mu^2) to 0,
 * with e^2 = r^2 - mu^2 = (mu^2 + alpha^2) (e^dy - 1)/(1 - s), dy from the lower end.  dy = Y sin^2/(1 + rho cos^2)
 * in the angle omega takes away the roots at both ends, and rho keeps the nodes where a large gamma puts the mass. */
typedef struct gtr_direct {
    real m;     /* mu, but not 0 and not infinite */
    real ratio; /* (mu^2 + alpha^2)/mu^2 */
    real Y, rho, excess;
    real scale; /* of the sum over the nodes */
} gtr_direct;

KERNEL gtr_direct gtr_direct_at(real alpha, real gamma, real mu)
{
    real a       = kmin(alpha, GTR_ROUGHEST);
    real k0      = (1 - a)*(1 + a);
    real L       = -2*klog(a);
    real excess  = gtr_excess(gamma);
    real m       = kclamp(mu, 1/GTR_DIRECT_LARGEST, GTR_DIRECT_LARGEST);
    real m2      = m*m;
    real inverse = 1/(1 + m2);
    real rest    = k0*inverse;
    real s       = (m2 + a*a)*inverse;
    real lift    = klog1p(m2*rest/(a*a));
    gtr_direct d;
    d.m      = m;
    d.ratio  = (m2 + a*a)/m2;
    d.Y      = rest < 0.5f ? -klog1p(-rest) : -klog(s);
    d.rho    = kmax(gamma - 1.5f, 0)*d.Y*GTR_DIRECT_STRETCH;
    d.excess = excess;
    d.scale  = excess/-kexpm1(-excess*L)*kexp(-excess*lift)*INV_PI*(1 + d.rho)/d.Y;
    return d;
}

/* z = dy/sin^2 and e/mu at a node, and the node's term of the sum. */
KERNEL real2 gtr_direct_node_at(gtr_direct d, gtr_direct_node n)
{
    real z    = d.Y/(1 + d.rho*n.cos2);
    real left = -kexpm1_within(-z*(1 + d.rho)*n.cos2);
    return make2(z, ksqrt(d.ratio*(kexpm1_within(z*n.sin2)/left)));
}

KERNEL real gtr_direct_term(gtr_direct d, gtr_direct_node n, real2 at)
{
    return n.weight*(at.x*at.x)*kexp(-d.excess*(at.x*n.sin2))*gtr_x_minus_atan(at.y);
}

KERNEL real gtr_direct_Lambda(gtr_direct d, real sum, real mu)
{
    real T = d.m*(d.scale*sum) + 0.5f*kmax(d.m - mu, 0);
    return T/kmax(mu, COT_SMALLEST);
}

KERNEL real gtr_Lambda_direct(real alpha, real gamma, real mu)
{
    gtr_direct d = gtr_direct_at(alpha, gamma, mu);
    real sum     = 0;
    UNROLL
    for (int i = 0; i < 16; i++) {
        gtr_direct_node n = gtr_direct_nodes[i];
        sum += gtr_direct_term(d, n, gtr_direct_node_at(d, n));
    }
    return gtr_direct_Lambda(d, sum, mu);
}
#endif

/* The cotangent of a direction, after the unstretch, and Lambda_direct there, of the shape's alpha and gamma. */
KERNEL real gtr_cot(real3 v, gtr_shape g)
{
    real3 w = gtr_unstretch_direction(g, v);
    return kabs(w.z)/kmax(ksqrt(w.x*w.x + w.y*w.y), REAL_MIN);
}

KERNEL real gtr_Lambda_at(real3 v, gtr_shape g) { return gtr_Lambda_direct(g.alpha, g.gamma, gtr_cot(v, g)); }
