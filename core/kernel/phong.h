/* phong.h: the Phong distribution of normals, D = (n + 2)/(2 pi) cos^n, with its true Smith masking.
 *
 * [cs500]  CS500 Project 3: D_p, and the corrected sampling exponent 1/(n + 2) in place of 1/(n + 1).
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014, section 5.3.
 * Departures: the masking is Phong's own (docs/models/phong.md), not the fit made for Beckmann, which is
 * `masking=published`; anisotropy stretches the slopes by (alpha_x, alpha_y), 1 when isotropic.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "slopes.h"

typedef struct phong_shape {
    real exponent;
    real beta_inverse; /* 1/B(1/2, exponent/2 + 1) */
} phong_shape;

/* Below z p = LIMIT and z = COS2 the series loses at most two digits by cancellation and has converged after TERMS
 * terms; above it the fraction has converged after LEVELS levels (checked for exponents 0 to 1e6). */
#if FACET_REAL_IS_DOUBLE
#define PHONG_SERIES_LIMIT    2.0f
#define PHONG_SERIES_TERMS    34
#define PHONG_FRACTION_LEVELS 92
#else
#define PHONG_SERIES_LIMIT    1.5f
#define PHONG_SERIES_TERMS    16
#define PHONG_FRACTION_LEVELS 28
#endif
#define PHONG_SERIES_COS2 0.125f

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

/* Near grazing: sum over k of z^k (p + 1/2)_k/(3/2)_k, a hypergeometric series of positive terms. */
LARGE_KERNEL real phong_series(real p, real z)
{
    real sum  = 0;
    real term = 1;
    UNROLL
    for (int k = 0; k < PHONG_SERIES_TERMS; k++) {
        sum += term;
        term *= z*(p + 0.5f + k)/(1.5f + k);
    }
    return sum;
}

/* Away from grazing: Gauss's continued fraction of 2F1(b, 1; b + 3/2; x) from its end, z = 1 - x.  A level is
 * f = 1 - odd x/(1 - even x/f).  For large b, odd and x are near 1 and the difference would lose as many digits as z
 * has zeros: it is written with `rest` = 1 - odd, multiplied out. */
LARGE_KERNEL real phong_fraction(real b, real x, real z)
{
    real c = b + 1.5f;
    real f = 1;
    UNROLL
    for (int m = PHONG_FRACTION_LEVELS/2; m > 0; m--) {
        real even = m*(m + 0.5f)/((c + (2*m - 2))*(c + (2*m - 1)));
        real inv  = 1/((c + (2*m - 3))*(c + (2*m - 2)));
        real odd  = (b + (m - 1))*(c + (m - 2))*inv;
        real rest = (b*(2*m - 0.5f) + (m*(3*m - 2.5f) + 0.25f))*inv;
        real tail = even*x/f;
        f         = (rest + odd*z - tail)/(1 - tail);
    }
    return 1/f;
}

/* Lambda(v) for n + 2 = 2 p, b = p - 1/2, mu the stretched cotangent, x = 1/(1 + mu^2), z = mu^2 x, and
 * B = B(1/2, p):
 *     Lambda = x^p/(2 b sqrt(z) B) - I_x(p, 1/2)/2.
 * Where z is small, I_x = 1 - 2 sqrt(z) x^p S/B with the series S; elsewhere, with all terms positive,
 *     Lambda = x^b/(2 pi mu) Int_0^1 sqrt(v) (1 - v)^(b-1)/(z + x v) dv = x^p F/(4 b p sqrt(z) B),
 * with F the continued fraction.  Derivation: docs/models/phong.md. */
LARGE_KERNEL real phong_Lambda(real3 v, phong_shape shape, real alpha_x, real alpha_y)
{
    real mu     = kclamp(stretched_cot(v, alpha_x, alpha_y), COT_SMALLEST, COT_LARGEST);
    real p      = 0.5f*shape.exponent + 1;
    real b      = 0.5f*shape.exponent + 0.5f;
    real mu2    = mu*mu;
    real x      = 1/(1 + mu2);
    real z      = mu2*x;
    real root_z = mu*ksqrt(x);
    real x_p    = shape.beta_inverse*kexp(-p*klog1p(mu2));
    /* One comparison, and arguments limited by kmin: a test of two keeps gcc from vectorising the loop around. */
    int is_grazing = kmax(z*p*(1/PHONG_SERIES_LIMIT), z*(1/PHONG_SERIES_COS2)) < 1;
    real series    = phong_series(p, kmin(z, kmin(PHONG_SERIES_COS2, PHONG_SERIES_LIMIT/p)));
    real fraction  = phong_fraction(b, x, z);
    real near      = x_p*(0.5f/(b*root_z) + root_z*series) - 0.5f;
    real far       = x_p*fraction/(4*b*p*root_z);
    return is_grazing ? near : far;
}

/* Beckmann's cotangent in place of the stretched one, for the fit that is made for Beckmann:
 * a = sqrt(n/2 + 1)/tan.  [cs500, G_1 of Phong]. */
KERNEL real phong_fit_scale(phong_shape shape) { return ksqrt(0.5f*shape.exponent + 1); }

/* A normal with density D cos_m: cos = u.x^(1/(n+2)).  [cs500, sampling of Phong, exponent corrected];
 * written for the tangent, tan^2 = u.x^(-2/(n+2)) - 1, which stays accurate for large n. */
KERNEL real3 phong_sample_ndf(real ux, real uy, phong_shape shape, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(kexpm1(-2*klog(kmax(ux, REAL_MIN))/(shape.exponent + 2)));
    return make3(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y, 1);
}
