/* gtr_published.h: Smith's G1 of GTR as the V-Ray paper computes it, to be compared: its closed forms for gamma = 0,
 * 1, 2, 3, 4, and for other gammas a natural cubic spline through these five, gamma beyond 4 counting as 4.
 *
 * [vray] Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015, sections 4 to 6.
 * The closed forms are exact.  The spline is off by up to 0.17, the clamp by up to 0.44; some values exceed 1 by 0.04,
 * and some are negative.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr.h"

/* Beyond this cotangent G1 is 1 to the last bit, and its fourth power is finite. */
#if FACET_REAL_IS_DOUBLE
#define GTR_STEEPEST 134217728.0f
#else
#define GTR_STEEPEST 16384.0f
#endif

#define GTR_LEAST_G1 ((real)1e-12) /* of the spline, where it is used: finite in the products of two */

/* The weights of the five closed forms in the spline's value at gamma. */
typedef struct gtr_spline {
    real w0, w1, w2, w3, w4;
} gtr_spline;

/* G1 for gamma = 1 at the cotangent mu; A, B: hypot(mu, alpha), hypot(mu, 1).  Departure from [vray]: written with one
 * log1p, which is finite at alpha = 1 and has no cancellation. */
KERNEL real gtr1_G1(real mu, real A, real B, real k0, real log_range)
{
    real d = k0/(A + B); /* B - A */
    real T = (d - mu*klog1p(d/(mu + A)))/log_range;
    return mu/(mu + T);
}

/* [vray, section 5 and 6]. */
KERNEL real gtr_published_G1(real3 v, gtr_shape g, gtr_spline spline)
{
    real3 w = gtr_unstretch_direction(g, v);
    real mu = kclamp(w.z/kmax(ksqrt(w.x*w.x + w.y*w.y), REAL_MIN), COT_SMALLEST, GTR_STEEPEST);
    real a  = g.alpha*g.alpha;
    real m2 = mu*mu;
    real A2 = m2 + a;
    real A  = ksqrt(A2);
    real B  = ksqrt(m2 + 1);
    real A3 = A*A2;
    real e  = 8*(a*a + a + 1);
    real G0 = 2*mu/(B + mu);
    real G1 = gtr1_G1(mu, A, B, g.k0, g.log_range);
    real G2 = 2*mu/(A + mu);
    real G3 = 4*(a + 1)*mu*A/(a*(3*a + 1) + 2*mu*(a + 1)*(mu + A));
    real G4 = 2*e*mu*A3/
              (e*mu*(A3 + m2*mu) + 3*a*(a*(5*a*a + 2*a + 1) + 4*m2*(2*a*a + a + 1)));
    return spline.w0*G0 + spline.w1*G1 + spline.w2*G2 + spline.w3*G3 + spline.w4*G4;
}
