/* ggx.h: the GGX (Trowbridge-Reitz) distribution, isotropic and anisotropic, with Smith masking and
 * visible-normal sampling.
 *
 * [cs500]  CS500 Project 3: D_g, G_1 and the sampling of GGX.
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014, section 5.3 (anisotropy).
 * [dupuy23] Dupuy and Benyoub, Sampling visible GGX normals with spherical caps, CGF 2023.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "microfacet.h"

typedef microfacet_params ggx_params;

/* D(wm), 1/sr.  [cs500, D_g], with tan^2/alpha^2 as the squared length of the stretched slopes.
 * Departure: written without tan(theta_m), which overflows at grazing angles; all in terms of the vector's
 * components, because near the normal sin^2 cannot be had from the rounded cosine. */
KERNEL real ggx_D(real3 wm, real alpha_x, real alpha_y)
{
    real x = wm.x/alpha_x;
    real y = wm.y/alpha_y;
    real t = x*x + y*y + wm.z*wm.z;
    return wm.z > 0 ? INV_PI/(alpha_x*alpha_y*t*t) : (real)0;
}

/* Lambda(v) = (sqrt(1 + 1/mu^2) - 1)/2, mu the stretched cotangent.  [cs500, G_1 of GGX, as 1/(1 + Lambda)].
 * Departure: the difference is multiplied out, 1/(2 mu (mu + sqrt(1 + mu^2))), which does not cancel. */
KERNEL real ggx_Lambda(real3 v, real alpha_x, real alpha_y)
{
    real mu = kmin(stretched_cot(v, alpha_x, alpha_y), COT_LARGEST);
    return 0.5f/kmax(mu*(mu + ksqrt(1 + mu*mu)), REAL_MIN);
}

/* A normal with density D cos_m: tan = alpha sqrt(u.x/(1 - u.x)).  [cs500, sampling of GGX]. */
KERNEL real3 ggx_sample_ndf(real ux, real uy, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(ux/kmax(1 - ux, REAL_EPSILON));
    return normal_of_slopes(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y);
}

/* A normal with density D(wm) G1(wo) (wo.wm)+/cos_o: in the stretched space, where the surface is a
 * hemisphere, the reflected direction is uniform on a spherical cap.  [dupuy23, listing 3]. */
KERNEL real3 ggx_sample_vndf(real3 wo, real ux, real uy, real alpha_x, real alpha_y)
{
    real3 v       = normalize3(make3(alpha_x*wo.x, alpha_y*wo.y, wo.z));
    real2 azimuth = kcossin_turn(ux);
    real z        = (1 - uy)*(1 + v.z) - v.z;
    real sin      = ksqrt(kmax((1 - z)*(1 + z), 0));
    real3 h       = make3(sin*azimuth.x + v.x, sin*azimuth.y + v.y, z + v.z);
    real3 m       = make3(alpha_x*h.x, alpha_y*h.y, kmax(h.z, 0));
    real len2     = dot3(m, m);
    return select3(len2 > REAL_MIN, scale3(1/ksqrt(kmax(len2, REAL_MIN)), m), make3(0, 0, 1));
}

KERNEL real3 ggx_eval(ggx_params p, real3 wi, real3 wo)
{
    real3 wm = half_vector(wi, wo);
    return microfacet_eval(p, wi, wo, wm, ggx_D(wm, p.alpha_x, p.alpha_y), ggx_Lambda(wi, p.alpha_x, p.alpha_y),
                           ggx_Lambda(wo, p.alpha_x, p.alpha_y));
}

KERNEL real ggx_pdf(ggx_params p, real3 wi, real3 wo)
{
    real3 wm = half_vector(wi, wo);
    return microfacet_pdf(p, wi, wo, wm, ggx_D(wm, p.alpha_x, p.alpha_y), ggx_Lambda(wo, p.alpha_x, p.alpha_y));
}

KERNEL bsdf_sample ggx_sample(ggx_params p, real3 wo, real3 u)
{
    real3 wm = select3(p.sampling == SAMPLING_NDF, ggx_sample_ndf(u.x, u.y, p.alpha_x, p.alpha_y),
                       ggx_sample_vndf(wo, u.x, u.y, p.alpha_x, p.alpha_y));
    real3 wi = microfacet_choose(p, wo, wm, u);
    return microfacet_complete(p, wi, wo, wm, u, ggx_eval(p, wi, wo), ggx_pdf(p, wi, wo));
}

KERNEL int ggx_lobes(ggx_params p) { return microfacet_lobes(p); }

/* D, Lambda, G1 at m. */
KERNEL real3 ggx_terms(ggx_params p, real3 m)
{
    real Lambda = ggx_Lambda(m, p.alpha_x, p.alpha_y);
    return make3(ggx_D(m, p.alpha_x, p.alpha_y), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

#ifdef FACET_PARAMETERS
static const facet_parameter ggx_parameters[] = {
    ALPHA_PARAMETERS,
    MICROFACET_PARAMETERS("vndf|ndf", 1),
};
#endif

#ifdef FACET_PREPARE
static ggx_params ggx_prepare(const facet_material *m)
{
    ggx_params p = microfacet_prepare(m);
    alpha_prepare(m, &p);
    return p;
}
#endif
