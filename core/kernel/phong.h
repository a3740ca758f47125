/* phong.h: the Phong distribution of normals, D = (n + 2)/(2 pi) cos^n, with its true Smith masking.
 *
 * [cs500]  CS500 Project 3: D_p, and the corrected sampling exponent 1/(n + 2) in place of 1/(n + 1).
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014, section 5.3.
 * [heitz-deon14] Heitz and d'Eon, Importance sampling microfacet-based BSDFs using the distribution of
 *           visible normals, 2014.
 * Departures: the masking is Phong's own (docs/models/phong.md), not the fit made for Beckmann, which is
 * `masking=published`; anisotropy stretches the slopes by (alpha_x, alpha_y), 1 when isotropic.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "slopes.h"
#include "student.h"

typedef struct phong_shape {
    real exponent;
    real beta_inverse; /* 1/B(1/2, exponent/2 + 1) */
} phong_shape;

KERNEL phong_shape phong_shape_of(real exponent)
{
    real half_n = 0.5f*exponent + 1;
    phong_shape s;
    s.exponent     = exponent;
    s.beta_inverse = half_n*kgamma_half_ratio(half_n)*INV_SQRT_PI;
    return s;
}

/* D at the direction of m, 1/sr; m need not be a unit vector.  [cs500, D_p], cos^n written as
 * exp(-n/2 log1p(tan^2)), exact near the normal; a stretch divides the density of slopes by its determinant:
 * D cos_m^4 = P22, [heitz14]. */
KERNEL real phong_D(real3 m, phong_shape shape, real alpha_x, real alpha_y)
{
    real tan2     = stretched_tan2(m, alpha_x, alpha_y);
    real stretch  = 1/((1 + tan2)*cos2_of(m)); /* cos^2 after the stretch over cos^2 before: 1 when isotropic */
    real cosine_n = kexp(-0.5f*shape.exponent*klog1p(tan2));
    real D        = (shape.exponent + 2)*0.5f*INV_PI*cosine_n*stretch*stretch/(alpha_x*alpha_y);
    return m.z > 0 ? D : (real)0;
}

/* The distribution of slopes along any axis, Student's with n + 2 degrees of freedom, and that of the slopes across a
 * slope q, over sqrt(1 + q^2), with n + 3; by B(1/2, p) B(1/2, p + 1/2) = pi/p. */
KERNEL student phong_slopes_along(phong_shape shape)
{
    student s;
    s.p            = 0.5f*shape.exponent + 1;
    s.beta_inverse = shape.beta_inverse;
    return s;
}

KERNEL student phong_slopes_across(phong_shape shape)
{
    student s;
    s.p            = 0.5f*shape.exponent + 1.5f;
    s.beta_inverse = INV_PI*(0.5f*shape.exponent + 1)/shape.beta_inverse;
    return s;
}

/* Smith's Lambda: that of the slopes along v.  [heitz14]. */
KERNEL real phong_Lambda(real3 v, phong_shape shape, real alpha_x, real alpha_y)
{
    real mu   = kclamp(stretched_cot(v, alpha_x, alpha_y), COT_SMALLEST, COT_LARGEST);
    student s = phong_slopes_along(shape);
    return student_Lambda(s, student_at(s, mu));
}

/* Beckmann's cotangent in place of the stretched one, for the fit that is made for Beckmann:
 * a = sqrt(n/2 + 1)/tan.  [cs500, G_1 of Phong]. */
KERNEL real phong_fit_scale(phong_shape shape) { return ksqrt(0.5f*shape.exponent + 1); }

/* The share of the facets, by projected area, whose tan^2 is above tan2, and the tan2 of a share; rest = 1 - share. */
KERNEL real phong_share_beyond(real tan2, phong_shape shape)
{
    return kexp(-(0.5f*shape.exponent + 1)*klog1p(tan2));
}

KERNEL real phong_tan2_beyond(real share, real rest, phong_shape shape)
{
    real ln = share > 0.5f ? klog1p(-rest) : klog(share);
    return kexpm1(-ln/(0.5f*shape.exponent + 1));
}

/* A normal with density D cos_m: cos = u.x^(1/(n+2)).  [cs500, sampling of Phong, exponent corrected];
 * written for the tangent, tan^2 = u.x^(-2/(n+2)) - 1, which stays accurate for large n. */
KERNEL real3 phong_sample_ndf(real ux, real uy, phong_shape shape, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(kexpm1(-2*klog(kmax(ux, REAL_MIN))/(shape.exponent + 2)));
    return make3(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y, 1);
}

/* A normal with density D (wo.m)+/sigma(wo).  [heitz-deon14]: stretch wo, sample the slope towards it and then the one
 * across, turn, and unstretch. */
KERNEL real3 phong_sample_vndf(real3 wo, real ux, real uy, phong_shape shape, real alpha_x, real alpha_y)
{
    stretched_view v = stretched_view_of(wo, alpha_x, alpha_y);
    real towards     = student_visible_slope(phong_slopes_along(shape), v.cot, ux);
    real across      = student_quantile(phong_slopes_across(shape), uy)*ksqrt(1 + towards*towards);
    return normal_of_slopes(v, towards, across, alpha_x, alpha_y);
}
