/* ggx.h: the GGX (Trowbridge-Reitz) distribution, isotropic and anisotropic, with Smith masking and
 * visible-normal sampling.
 *
 * [cs500]   CS500 Project 3: D_g, G_1 and the sampling of GGX.
 * [bonn]    Zingsheim, BRDF Models, sections 4 and 5: anisotropic D and the dot-product forms.
 * [heitz14] Heitz, Understanding the masking-shadowing function, JCGT 2014, section 5.3 (anisotropy).
 * [dupuy23] Dupuy and Benyoub, Sampling visible GGX normals with spherical caps, CGF 2023.
 * [eto23]   Eto and Tokuyoshi, Bounded VNDF sampling for Smith-GGX reflections, SIGGRAPH Asia 2023.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "slopes.h"

/* D at the direction of m, 1/sr; m need not be a unit vector.  [bonn, D_AnGGX].
 * Departures: in terms of the vector's components, because near the normal sin^2 cannot be had from the rounded cosine;
 * and multiplied out with alpha_x alpha_y, so that only q is a quotient. */
KERNEL real ggx_D(real3 m, real alpha_x, real alpha_y)
{
    real area = alpha_x*alpha_y;
    real x    = m.x*alpha_y;
    real y    = m.y*alpha_x;
    real z    = m.z*area;
    real q    = dot3(m, m)*area/(x*x + y*y + z*z);
    return m.z > 0 ? INV_PI*area*(q*q) : (real)0;
}

/* |(alpha_x v.x, alpha_y v.y, v.z)|, the root in [bonn, V_AnSmithJointGGX]: cos (1 + 2 Lambda). */
KERNEL real ggx_root(real3 v, real alpha_x, real alpha_y) { return length3(make3(alpha_x*v.x, alpha_y*v.y, v.z)); }

/* The projected area of the microfacets that face v, cos (1 + Lambda); cos = v.z > 0. */
KERNEL real ggx_sigma(real3 v, real alpha_x, real alpha_y) { return 0.5f*(v.z + ggx_root(v, alpha_x, alpha_y)); }

/* Lambda(v) = (sqrt(1 + 1/mu^2) - 1)/2, mu the stretched cotangent.  [bonn, Lambda_L].
 * Departure: the difference is multiplied out, 1/(2 mu (mu + sqrt(1 + mu^2))), which does not cancel. */
KERNEL real ggx_Lambda(real3 v, real alpha_x, real alpha_y)
{
    real mu = kmin(stretched_cot(v, alpha_x, alpha_y), COT_LARGEST);
    return 0.5f/kmax(mu*(mu + ksqrt(1 + mu*mu)), REAL_MIN);
}

/* The share of the facets, by projected area, whose tan^2 is above tan2, and the tan2 of a share; rest = 1 - share. */
KERNEL real ggx_share_beyond(real tan2) { return 1/(1 + tan2); }
KERNEL real ggx_tan2_beyond(real share, real rest) { return rest/share; }

/* A normal with density D cos_m: tan = alpha sqrt(u.x/(1 - u.x)).  [cs500, sampling of GGX]. */
KERNEL real3 ggx_sample_ndf(real ux, real uy, real alpha_x, real alpha_y)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = ksqrt(ux/kmax(1 - ux, REAL_EPSILON));
    return make3(alpha_x*r*azimuth.x, alpha_y*r*azimuth.y, 1);
}

/* A normal that mirrors wo to a direction uniform on the cap above -lowest of the stretched sphere, lowest <= wo.z.
 * [dupuy23, listing 3].  Departure: the sphere has the radius of the stretched wo, which spares a normalisation. */
KERNEL real3 ggx_sample_cap(real3 wo, real lowest, real ux, real uy, real alpha_x, real alpha_y)
{
    real r        = ggx_root(wo, alpha_x, alpha_y);
    real2 azimuth = kcossin_turn(ux);
    real z        = (1 - uy)*(r + lowest) - lowest;
    real sin      = ksqrt(kmax((r - z)*(r + z), 0));
    real hx       = sin*azimuth.x + alpha_x*wo.x;
    real hy       = sin*azimuth.y + alpha_y*wo.y;
    return make3(alpha_x*hx, alpha_y*hy, kmax(z + wo.z, COS_SMALLEST));
}

/* A normal with density D(wm) G1(wo) (wo.wm)+/cos_o: in the stretched space, where the surface is a hemisphere, the
 * whole cap. */
KERNEL real3 ggx_sample_vndf(real3 wo, real ux, real uy, real alpha_x, real alpha_y)
{
    return ggx_sample_cap(wo, wo.z, ux, uy, alpha_x, alpha_y);
}

/* Where the cap may end without losing a direction above the horizon: k wo.z, k <= 1.  [eto23, listing 1]. */
KERNEL real ggx_lowest(real3 wo, real alpha_x, real alpha_y)
{
    real a  = kmin(kmin(alpha_x, alpha_y), 1);
    real s  = 1 + ksqrt(wo.x*wo.x + wo.y*wo.y);
    real s2 = s*s;
    return wo.z*((1 - a)*(1 + a)*s2/(s2 + ksquare(a*wo.z)));
}

/* The visible normals but for many that mirror wo below the horizon: density D(wm) (wo.wm)+/bounded sigma. */
KERNEL real3 ggx_sample_bounded(real3 wo, real ux, real uy, real alpha_x, real alpha_y)
{
    return ggx_sample_cap(wo, ggx_lowest(wo, alpha_x, alpha_y), ux, uy, alpha_x, alpha_y);
}

KERNEL real ggx_bounded_sigma(real3 wo, real alpha_x, real alpha_y)
{
    return 0.5f*(ggx_lowest(wo, alpha_x, alpha_y) + ggx_root(wo, alpha_x, alpha_y));
}
