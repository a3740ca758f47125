/* glass.h: a smooth dielectric interface: mirror reflection and refraction, both deltas.
 *
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, 2007, section 4
 *            (Snell's law; radiance scales with the square of the index).
 * [cs500]    CS500 Project 3, exact Fresnel.
 *
 * wo.z < 0 means that the viewer is inside.  A thin wall is two such interfaces with nothing between: light
 * passes straight, and the reflections inside add up to F' = 2F/(1 + F).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "bsdf.h"
#include "fresnel.h"

#define WALL_SOLID 0
#define WALL_THIN  1

typedef struct glass_params {
    real eta;   /* n inside / n outside, > 0 */
    real3 tint; /* multiplies what is transmitted */
    int wall;
} glass_params;

/* Deltas only: no pair of directions has a finite value. */
KERNEL real3 glass_eval(glass_params p, real3 wi, real3 wo)
{
    (void)p;
    (void)wi;
    (void)wo;
    return splat3(0);
}

KERNEL real glass_pdf(glass_params p, real3 wi, real3 wo)
{
    (void)p;
    (void)wi;
    (void)wo;
    return 0;
}

/* Reflects with probability F, else refracts.  Transmitted radiance scales by (n_o/n_i)^2, n_o on the
 * viewer's side: [walter07, section 4]; the factors of entering and leaving cancel.  pdf is a probability. */
KERNEL bsdf_sample glass_sample(glass_params p, real3 wo, real3 u)
{
    int is_inside  = wo.z < 0;
    int is_thin    = p.wall == WALL_THIN;
    real eta       = (is_inside & !is_thin) ? 1/p.eta : p.eta; /* n on the far side / n on the viewer's side */
    real cos_o     = kabs(wo.z);
    real F1        = fresnel_dielectric(kmin(cos_o, 1), eta);
    real F         = is_thin ? 2*F1/(1 + F1) : F1;
    real sin2_t    = kmax(1 - wo.z*wo.z, 0)/(eta*eta);
    real cos_t     = ksqrt(kmax(1 - sin2_t, 0));
    real side      = is_inside ? (real)-1 : (real)1;
    real3 mirrored = make3(-wo.x, -wo.y, wo.z);
    real3 bent     = normalize3(make3(-wo.x/eta, -wo.y/eta, -side*cos_t));
    real3 straight = neg3(wo);
    int reflects   = u.z < F;
    int is_valid   = cos_o > 0;
    real3 through  = scale3(is_thin ? (real)1 : 1/(eta*eta), p.tint);
    bsdf_sample s;
    s.wi     = select3(reflects, mirrored, select3(is_thin, straight, bent));
    s.pdf    = is_valid ? (reflects ? F : 1 - F) : (real)0;
    s.weight = select3(is_valid, select3(reflects, splat3(1), through), splat3(0));
    s.lobe   = LOBE_DELTA | (reflects ? LOBE_REFLECTION : LOBE_TRANSMISSION);
    s.eta    = reflects | is_thin ? (real)1 : eta;
    return s;
}

KERNEL int glass_lobes(glass_params p)
{
    (void)p;
    return LOBE_REFLECTION | LOBE_TRANSMISSION | LOBE_DELTA;
}

/* No distribution of normals. */
KERNEL real3 glass_terms(glass_params p, real3 m)
{
    (void)p;
    (void)m;
    return splat3(0);
}

EVAL_AND_PDF(glass)
ONE_VARIANT(glass)
#define EACH_VARIANT_glass(CASE, name) CASE(name, 0)
