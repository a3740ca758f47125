/* phong.h: the Phong distribution of normals, D = (n + 2)/(2 pi) cos^n, with its true Smith masking.
 *
 * [cs500]  CS500 Project 3: D_p, and the corrected sampling exponent 1/(n + 2) in place of 1/(n + 1).
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014, section 5.3.
 * Departures: the masking is Phong's own (docs/models/phong.md), not the fit made for Beckmann, which is
 * `masking=published`; anisotropy stretches the slopes by (alpha_x, alpha_y), 1 when isotropic.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "beckmann.h"
#include "microfacet.h"

typedef microfacet_params phong_params;

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

/* tan^2(theta_m) after the slopes are divided by the stretch. */
KERNEL real phong_tan2(real3 wm, real alpha_x, real alpha_y)
{
    real z = kmax(wm.z, COS_SMALLEST);
    real x = wm.x/(alpha_x*z);
    real y = wm.y/(alpha_y*z);
    return x*x + y*y;
}

/* D(wm), 1/sr.  [cs500, D_p], cos^n written as exp(-n/2 log1p(tan^2)), exact near the normal; a stretch
 * divides the density of slopes by its determinant: D cos_m^4 = P22, [heitz14]. */
KERNEL real phong_D(real3 wm, real exponent, real alpha_x, real alpha_y)
{
    real tan2     = phong_tan2(wm, alpha_x, alpha_y);
    real z2       = kmax(wm.z*wm.z, COS_SMALLEST*COS_SMALLEST);
    real stretch  = 1/((1 + tan2)*z2); /* cos^2 after the stretch over cos^2 before: 1 when isotropic */
    real cosine_n = kexp(-0.5f*exponent*klog1p(tan2));
    real D        = (exponent + 2)*0.5f*INV_PI*cosine_n*stretch*stretch/(alpha_x*alpha_y);
    return wm.z > 0 ? D : (real)0;
}

/* Near grazing: sum over k of z^k (p + 1/2)_k/(3/2)_k, a hypergeometric series of positive terms. */
KERNEL real phong_series(real p, real z)
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
KERNEL real phong_fraction(real b, real x, real z)
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
KERNEL real phong_Lambda(real3 v, real exponent, real beta_inverse, real alpha_x, real alpha_y)
{
    real mu        = kclamp(stretched_cot(v, alpha_x, alpha_y), COT_SMALLEST, COT_LARGEST);
    real p         = 0.5f*exponent + 1;
    real b         = 0.5f*exponent + 0.5f;
    real mu2       = mu*mu;
    real x         = 1/(1 + mu2);
    real z         = mu2*x;
    real root_z    = mu*ksqrt(x);
    real x_p       = beta_inverse*kexp(-p*klog1p(mu2));
    int is_grazing = (z*p < PHONG_SERIES_LIMIT) & (z < PHONG_SERIES_COS2);
    real series    = phong_series(p, is_grazing ? z : (real)0);
    real fraction  = phong_fraction(b, is_grazing ? (real)0.5f : x, is_grazing ? (real)0.5f : z);
    real near      = x_p*(0.5f/(b*root_z) + root_z*series) - 0.5f;
    real far       = x_p*fraction/(4*b*p*root_z);
    return is_grazing ? near : far;
}

KERNEL real phong_masking(phong_params p, real3 v)
{
    real exact = phong_Lambda(v, p.exponent, p.beta_inverse, p.alpha_x, p.alpha_y);
    real fit   = rational_fit_Lambda(ksqrt(0.5f*p.exponent + 1)*stretched_cot(v, p.alpha_x, p.alpha_y));
    return p.masking == MASKING_PUBLISHED ? fit : exact;
}

/* A normal with density D cos_m: cos = u.x^(1/(n+2)).  [cs500, sampling of Phong, exponent corrected];
 * written for the tangent, tan^2 = u.x^(-2/(n+2)) - 1, which stays accurate for large n. */
KERNEL real3 phong_sample_ndf(real ux, real uy, real exponent, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(kexpm1(-2*klog(kmax(ux, REAL_MIN))/(exponent + 2)));
    return normal_of_slopes(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y);
}

KERNEL real3 phong_eval(phong_params p, real3 wi, real3 wo)
{
    real3 wm = half_vector(wi, wo);
    return microfacet_eval(p, wi, wo, wm, phong_D(wm, p.exponent, p.alpha_x, p.alpha_y), phong_masking(p, wi),
                           phong_masking(p, wo));
}

KERNEL real phong_pdf(phong_params p, real3 wi, real3 wo)
{
    real3 wm = half_vector(wi, wo);
    return microfacet_pdf(p, wi, wo, wm, phong_D(wm, p.exponent, p.alpha_x, p.alpha_y), 0);
}

KERNEL bsdf_sample phong_sample(phong_params p, real3 wo, real3 u)
{
    real3 wm = phong_sample_ndf(u.x, u.y, p.exponent, p.alpha_x, p.alpha_y);
    real3 wi = microfacet_choose(p, wo, wm, u);
    return microfacet_complete(p, wi, wo, wm, u, phong_eval(p, wi, wo), phong_pdf(p, wi, wo));
}

KERNEL int phong_lobes(phong_params p) { return microfacet_lobes(p); }

/* D, Lambda, G1 at m. */
KERNEL real3 phong_terms(phong_params p, real3 m)
{
    real Lambda = phong_masking(p, m);
    return make3(phong_D(m, p.exponent, p.alpha_x, p.alpha_y), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

#ifdef FACET_PARAMETERS
static const facet_parameter phong_parameters[] = {
    {"exponent", FACET_NUMBER, 0, 1e6, {50, 0, 0}, "1", "", "n in D = (n + 2)/(2 pi) cos^n"},
    {"alpha_x", FACET_NUMBER, 1e-3, 1, {0.2, 0, 0}, "1", "", "roughness sqrt(2/(n + 2)) along x, not with exponent"},
    {"alpha_y", FACET_NUMBER, 1e-3, 1, {0.2, 0, 0}, "1", "", "roughness sqrt(2/(n + 2)) along y, not with exponent"},
    MICROFACET_PARAMETERS("ndf", 0),
};
#endif

#ifdef FACET_PREPARE
/* Different roughness along x and y: the exponent is that of their geometric mean, and the slopes are
 * stretched by the ratio to it. */
static phong_params phong_prepare(const facet_material *m)
{
    phong_params p = microfacet_prepare(m);
    p.exponent     = prepare_number(m, "exponent");
    if (facet_material_given(m, "alpha_x") || facet_material_given(m, "alpha_y")) {
        const real alpha_x = prepare_number(m, "alpha_x");
        const real alpha_y = prepare_number(m, "alpha_y");
        const real mean    = ksqrt(alpha_x*alpha_y);
        p.exponent         = kmax(2/(mean*mean) - 2, 0);
        p.alpha_x          = alpha_x/mean;
        p.alpha_y          = alpha_y/mean;
    }
    const real half_n = 0.5f*p.exponent + 1;
    p.beta_inverse    = half_n*kgamma_half_ratio(half_n)*INV_SQRT_PI;
    p.sampling        = SAMPLING_NDF;
    return p;
}
#endif
