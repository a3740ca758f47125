/* slopes.h: what the distributions of normals share: stretched slopes and the limits of cosines and cotangents.
 *
 * A normal m has the slopes (m.x/m.z, m.y/m.z).  Dividing them by (alpha_x, alpha_y) turns an anisotropic
 * distribution into its isotropic one of roughness 1.  Sampled normals are vectors of any length with z > 0.
 *
 * [heitz14] Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, JCGT 2014.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"

/* Cotangents are kept inside [2^-60, 2^60], whose squares are normal numbers in float as well; a cosine
 * of 2^-30 is as good as 0 for every alpha in range. */
#define COT_LARGEST  1152921504606846976.0f
#define COT_SMALLEST (1/COT_LARGEST)
#define COS_SMALLEST (1/1073741824.0f)

/* The least roughness; below it a mirror is meant. */
#define ALPHA_SMALLEST ((real)1e-4)

/* sin(theta) of v after the stretch: the length of (alpha_x v.x, alpha_y v.y). */
KERNEL real stretched_sin(real3 v, real alpha_x, real alpha_y)
{
    real x = alpha_x*v.x;
    real y = alpha_y*v.y;
    return ksqrt(x*x + y*y);
}

/* cot(theta) of v after the slopes are divided by (alpha_x, alpha_y): the only thing about a direction that
 * the masking of a stretched isotropic distribution depends on.  [heitz14, section 5.3].  In [0, inf). */
KERNEL real stretched_cot(real3 v, real alpha_x, real alpha_y)
{
    return kabs(v.z)/kmax(stretched_sin(v, alpha_x, alpha_y), REAL_MIN);
}

/* tan^2(theta) of m after the slopes are divided by (alpha_x, alpha_y); m need not be a unit vector. */
KERNEL real stretched_tan2(real3 m, real alpha_x, real alpha_y)
{
    real z = kmax(m.z, COS_SMALLEST);
    real x = m.x/(alpha_x*z);
    real y = m.y/(alpha_y*z);
    return x*x + y*y;
}

/* cos^2(theta) of m, which need not be a unit vector; at least COS_SMALLEST^2 of its squared length. */
KERNEL real cos2_of(real3 m)
{
    real len2 = kmax(dot3(m, m), REAL_MIN);
    return kmax(m.z*m.z/len2, COS_SMALLEST*COS_SMALLEST);
}

/* A view after the slopes are divided by (alpha_x, alpha_y): its azimuth, and its cotangent in [COT_SMALLEST,
 * COT_LARGEST]. */
typedef struct stretched_view {
    real cot, cos_phi, sin_phi;
} stretched_view;

KERNEL stretched_view stretched_view_of(real3 wo, real alpha_x, real alpha_y)
{
    real sin     = stretched_sin(wo, alpha_x, alpha_y);
    int has_side = sin > REAL_MIN;
    real inv     = 1/(has_side ? sin : (real)1);
    stretched_view v;
    v.cot     = has_side ? kclamp(kabs(wo.z)*inv, COT_SMALLEST, COT_LARGEST) : COT_LARGEST;
    v.cos_phi = has_side ? alpha_x*wo.x*inv : (real)1;
    v.sin_phi = has_side ? alpha_y*wo.y*inv : (real)0;
    return v;
}

/* The normal with a slope towards the view and one across it, unstretched.  Slopes are -m.x/m.z: a normal that leans
 * towards the viewer has a positive one with m.x along wo. */
KERNEL real3 normal_of_slopes(stretched_view v, real towards, real across, real alpha_x, real alpha_y)
{
    real x = v.cos_phi*towards - v.sin_phi*across;
    real y = v.sin_phi*towards + v.cos_phi*across;
    return make3(alpha_x*x, alpha_y*y, 1);
}

/* One step of Halley's method for the decreasing f(q) = excess, with f' = -density < 0 and f''/f' = curvature. */
KERNEL real halley_step(real excess, real density, real curvature)
{
    real newton = excess/kmax(density, REAL_MIN);
    return newton/kmax(1 + 0.5f*newton*curvature, 0.5f);
}
