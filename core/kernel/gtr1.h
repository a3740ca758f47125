/* gtr1.h: GTR with gamma = 1, isotropic, the distribution of Disney's clearcoat: its density, its exact Smith
 * masking and its visible normals, all in closed form.
 *
 * [burley12] Burley, Physically-based shading at Disney, 2012 (2014), appendix B.2, (4).
 * [dimov15]  Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015, Lambda^1.
 * [corless02] Corless and Jeffrey, The Wright omega function, 2002.
 * [fritsch73] Fritsch, Shafer and Crowley, Algorithm 443: solution of the transcendental equation w e^w = x, 1973.
 *
 * 1/((a^2 + r^2)(1 + r^2)) is (1 - a^2)^-1 times the integral of ds^2/(s^2 + r^2)^2 from a to 1, so that GTR1 is a
 * mixture of GGX whose alpha s is log-uniform in [a, 1].  Masking and visible normals follow from GGX's.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "slopes.h"

typedef struct gtr1 {
    real alpha; /* in (0, 1] */
    real L;     /* ln(1/alpha^2) */
    real scale; /* (1 - alpha^2)/L, which tends to 1 at alpha = 1 */
} gtr1;

KERNEL gtr1 gtr1_of(real alpha)
{
    real L = -2*klog(alpha);
    gtr1 g;
    g.alpha = alpha;
    g.L     = L;
    g.scale = L > 0 ? (1 - alpha)*(1 + alpha)/kmax(L, REAL_MIN) : (real)1;
    return g;
}

/* D at the direction of m, 1/sr; m need not be a unit vector.  [burley12, (4)].  Departures: 1 + (alpha^2 - 1) cos^2 is
 * written sin^2 + alpha^2 cos^2, with sin^2 from the vector, because near the normal it cannot be had from the rounded
 * cosine; alpha = 1 gives 1/pi. */
KERNEL real gtr1_D(gtr1 g, real3 m)
{
    real t = m.x*m.x + m.y*m.y + ksquare(g.alpha*m.z);
    return m.z > 0 ? INV_PI*g.scale*dot3(m, m)/t : (real)0;
}

/* Lambda(v).  [dimov15, Lambda^1] as
 *     scale/(mu (A + B)) (1 - mu/(mu + A) ln(1 + x)/x),  x = (1 - alpha^2)/((A + B)(mu + A)),
 * A = hypot(mu, alpha), B = hypot(mu, 1).  Departure: as printed it is a difference of large numbers; here the bracket
 * is at least 1/2, and alpha = 1 is no exception. */
KERNEL real gtr1_Lambda(gtr1 g, real3 v)
{
    real mu    = kclamp(stretched_cot(v, 1, 1), COT_SMALLEST, COT_LARGEST);
    real A     = ksqrt(mu*mu + g.alpha*g.alpha);
    real B     = ksqrt(mu*mu + 1);
    real x     = (1 - g.alpha)*(1 + g.alpha)/((A + B)*(mu + A));
    real ratio = x > REAL_MIN ? klog1p(x)/kmax(x, REAL_MIN) : (real)1;
    return g.scale*(1 - mu/(mu + A)*ratio)/(mu*(A + B));
}

/* The projected area of the microfacets that face v, cos (1 + Lambda); cos = v.z > 0. */
KERNEL real gtr1_sigma(gtr1 g, real3 v) { return v.z*(1 + gtr1_Lambda(g, v)); }

/* One step of [fritsch73] for v + ln v = y, of fourth order. */
KERNEL real wright_omega_step(real v, real y)
{
    real r = y - v - klog(v);
    real a = 2*(1 + v)*(1 + v + (real)0.666666666666666666666666666667*r);
    return v*(1 + r/(1 + v)*((a - r)/(a - 2*r)));
}

/* The v > 0 with v + ln v = y, the Wright omega function [corless02]; y in [-80, 2^60].  Relative error at most
 * 1.5 eps (1 + |y|)/(1 + v): the start is within 27 %, the first step within 2e-4, the second within rounding. */
KERNEL real wright_omega(real y)
{
    real e     = kexp(kmin(y, 1));
    real start = y < 1 ? e/(1 + e) : y - klog(kmax(y, 1));
    return wright_omega_step(wright_omega_step(start, y), y);
}

/* Which GGX of the mixture a normal visible from wo belongs to: its alpha s in [g.alpha, 1], with density
 * (1 + Lambda_s(wo))/s, u in [0, 1].  With v = 2 Lambda_s = sqrt(1 + (s/mu)^2) - 1 that density is 1 + 1/v in v, and
 * its integral v + ln v is inverted by the Wright omega function.  Cotangents above 2^20 count as 2^20: Lambda is
 * at most 3e-13 for all of them. */
KERNEL real gtr1_visible_alpha(gtr1 g, real3 wo, real u)
{
    real mu    = kclamp(stretched_cot(wo, 1, 1), COT_SMALLEST, 1048576.0f);
    real a2    = g.alpha*g.alpha;
    real v_min = a2/(mu*(mu + ksqrt(mu*mu + a2)));
    real v_max = 1/(mu*(mu + ksqrt(mu*mu + 1)));
    real v     = wright_omega(mix(v_min + klog(v_min), v_max + klog(v_max), u));
    return kclamp(mu*ksqrt(v)*ksqrt(v + 2), g.alpha, 1);
}
