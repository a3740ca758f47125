/* beckmann.h: the Beckmann distribution, isotropic and anisotropic, with exact Smith masking (and the
 * published rational fit), and visible-normal sampling.
 *
 * [cs500]   CS500 Project 3: D_b, G_1 and the sampling of Beckmann.
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, 2007, section 5.2.
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014 (exact Lambda).
 * [heitz-deon14] Heitz and d'Eon, Importance sampling microfacet-based BSDFs using the distribution of
 *           visible normals, 2014 (stretching; slopes of visible normals).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "slopes.h"

#define LARGEST_EXPONENT 1000.0f /* exp(-1000) is 0 in double as well */
#define SLOPE_STEPS      (FACET_REAL_IS_DOUBLE ? 4 : 2)

/* The coefficients of the rational fit, as printed. */
#define FIT_3_535 ((real)3.535)
#define FIT_2_181 ((real)2.181)
#define FIT_2_276 ((real)2.276)
#define FIT_2_577 ((real)2.577)
#define FIT_1_6   ((real)1.6)

/* D at the direction of m, 1/sr; m need not be a unit vector.  [cs500, D_b], tan^2/alpha^2 written with the stretched
 * slopes. */
KERNEL real beckmann_D(real3 m, real alpha_x, real alpha_y)
{
    real cos2 = cos2_of(m);
    real e    = kexp(-kmin(stretched_tan2(m, alpha_x, alpha_y), LARGEST_EXPONENT));
    return m.z > 0 ? e*INV_PI/(alpha_x*alpha_y)/cos2/cos2 : (real)0;
}

/* Lambda(v) = exp(-a^2) (1/(a sqrt(pi)) - erfcx(a))/2, a the stretched cotangent.  [heitz14].
 * Departure: written with W(a) = 1 - sqrt(pi) a erfcx(a), which has no cancellation. */
KERNEL real beckmann_Lambda(real3 v, real alpha_x, real alpha_y)
{
    real a = kclamp(stretched_cot(v, alpha_x, alpha_y), COT_SMALLEST, COT_LARGEST);
    return 0.5f*INV_SQRT_PI*kexp_neg_square(a)*kmills_w(a)/a;
}

/* The rational fit printed in [cs500, G_1 of Beckmann] and [walter07, below eq. 27], as Lambda = 1/G1 - 1:
 * off by up to 3.1e-3, above 1 by 5.7e-5 just below a = 1.6, and 1 beyond. */
KERNEL real rational_fit_Lambda(real a)
{
    real bounded = kclamp(a, COT_SMALLEST, 2);
    real G1      = bounded*(FIT_3_535 + FIT_2_181*bounded)/(1 + bounded*(FIT_2_276 + FIT_2_577*bounded));
    return a < FIT_1_6 ? 1/G1 - 1 : (real)0;
}

/* The share of the facets, by projected area, whose tan^2 is above tan2, and the tan2 of a share; rest = 1 - share. */
KERNEL real beckmann_share_beyond(real tan2) { return kexp(-tan2); }
KERNEL real beckmann_tan2_beyond(real share, real rest) { return share > 0.5f ? -klog1p(-rest) : -klog(share); }

/* A normal with density D cos_m: tan^2 = -alpha^2 ln(1 - u.x).  [cs500, sampling of Beckmann]. */
KERNEL real3 beckmann_sample_ndf(real ux, real uy, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(-klog1p(-kmin(ux, 1 - REAL_EPSILON)));
    return make3(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y, 1);
}

/* The slope t towards the viewer of a visible normal, alpha = 1, for a viewer of cotangent a: its density is
 * proportional to (a + t)+ exp(-t^2) [heitz-deon14, section 4], so that
 *     F(t) = a erfc(t) + exp(-t^2)/sqrt(pi) = u F(-a).
 * The start lies between the solutions for a = 0, exp(-t^2) = u, and for large a, erfc(t) = u erfc(-a), and between the
 * bounds that exp(-a^2) <= exp(-t^2) <= 1 gives for t near -a.  Halley's method then has an error of u of at most
 * 4e-7 in float, 2e-15 in double. */
LARGE_KERNEL real beckmann_visible_slope(real a, real u)
{
    real e_a     = kexp_neg_square(a);
    real above   = kerfc(-a);
    real total   = a*above + INV_SQRT_PI*e_a;
    real up      = kclamp(u, 0.5f*REAL_EPSILON, 1 - 0.5f*REAL_EPSILON);
    real missing = ksqrt(SQRT_PI*(1 - up)*total);
    real low     = missing - a;
    real high    = missing/ksqrt(kmax(e_a, REAL_MIN)) - a;
    real grazing = ksqrt(-klog(up));
    real steep   = kerfcinv(up*above);
    real start   = steep + 0.5f/(a + 0.5f)*(grazing - steep);
    real t       = kmax(high < a ? kmin(start, high) : start, low);
    UNROLL
    for (int i = 0; i < SLOPE_STEPS; i++) {
        real e       = INV_SQRT_PI*kexp_neg_square(t);
        real seen    = kmax(a + t, REAL_MIN);
        real density = 2*seen*e;
        t            = kmax(t + halley_step(a*kerfc(t) + e - up*total, density, 1/seen - 2*t), low);
    }
    return t;
}

/* A normal with density D(wm) G1(wo) (wo.wm)+/cos_o.  [heitz-deon14]: stretch wo, sample the two slopes
 * for alpha = 1 (the one across the viewer's plane is an independent Gaussian), turn, and unstretch. */
KERNEL real3 beckmann_sample_vndf(real3 wo, real ux, real uy, real alpha_x, real alpha_y)
{
    stretched_view v = stretched_view_of(wo, alpha_x, alpha_y);
    real towards     = beckmann_visible_slope(v.cot, ux);
    real across      = kerfcinv(kclamp(2*uy, REAL_EPSILON, 2 - 2*REAL_EPSILON));
    return normal_of_slopes(v, towards, across, alpha_x, alpha_y);
}
