/* bsdf.h: what every model shares: a sample, its lobes, mirror directions, and cosine-distributed ones.
 *
 * [cs500] CS500 Project 3: SampleBrdf.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"
#include "slopes.h"

/* What a sample is; the same numbers as FACET_REFLECTION, ... of facet.h. */
#define LOBE_REFLECTION   1
#define LOBE_TRANSMISSION 2
#define LOBE_DIFFUSE      4
#define LOBE_GLOSSY       8
#define LOBE_DELTA        16

/* A direction drawn for wo; pdf == 0: none. */
typedef struct bsdf_sample {
    real3 wi;
    real pdf;
    real3 weight;
    int lobe;
    real eta; /* index of refraction on wi's side over that on wo's; 1 unless the sample refracts */
} bsdf_sample;

/* f cos_i and the density of wi. */
typedef struct bsdf_value {
    real3 f;
    real pdf;
} bsdf_value;

/* (wi + wo)/|wi + wo|; the normal where the two cancel. */
KERNEL real3 half_vector(real3 wi, real3 wo)
{
    real3 sum = add3(wi, wo);
    real len2 = dot3(sum, sum);
    real inv  = 1/ksqrt(kmax(len2, REAL_MIN));
    real3 n   = make3(0, 0, 1);
    return select3(len2 > REAL_MIN, scale3(inv, sum), n);
}

/* wo mirrored about the direction of m, which need not be a unit vector.  [cs500, SampleBrdf], without the absolute
 * value. */
KERNEL real3 reflect(real3 wo, real3 m) { return sub3(scale3(2*dot3(wo, m)/dot3(m, m), m), wo); }

/* Whether both directions are above the horizon.  A cosine of COS_SMALLEST counts as 0, so that quotients by it stay
 * finite. */
KERNEL int is_above(real3 wi, real3 wo) { return (wi.z > COS_SMALLEST) & (wo.z > COS_SMALLEST); }

/* Cosine-distributed direction.  [cs500, SampleBrdf, diffuse]: cos = sqrt(u.x), azimuth 2 pi u.y. */
KERNEL real3 sample_cosine(real ux, real uy)
{
    real2 azimuth = kcossin_turn(uy);
    real sin      = ksqrt(kmax(1 - ux, 0));
    return make3(sin*azimuth.x, sin*azimuth.y, ksqrt(ux));
}

/* A reflected sample from its parts; none unless it is valid. */
KERNEL bsdf_sample complete_sample(real3 wi, real3 weight, real pdf, int is_valid, int lobe)
{
    bsdf_sample s;
    s.wi     = select3(is_valid, wi, make3(0, 0, 1));
    s.pdf    = is_valid ? pdf : (real)0;
    s.weight = select3(is_valid, weight, splat3(0));
    s.lobe   = lobe;
    s.eta    = 1;
    return s;
}

/* NAME_eval_pdf of a kernel whose eval and pdf share nothing that the compiler cannot see. */
#define EVAL_AND_PDF(name)                                                                                             \
    KERNEL bsdf_value name##_eval_pdf(name##_params p, real3 wi, real3 wo)                                             \
    {                                                                                                                  \
        bsdf_value both;                                                                                               \
        both.f   = name##_eval(p, wi, wo);                                                                             \
        both.pdf = name##_pdf(p, wi, wo);                                                                              \
        return both;                                                                                                   \
    }

/* What model_table.h asks for, of a kernel whose settings choose nothing. */
#define ONE_VARIANT(name)                                                                                              \
    KERNEL int name##_variant(name##_params p)                                                                         \
    {                                                                                                                  \
        (void)p;                                                                                                       \
        return 0;                                                                                                      \
    }                                                                                                                  \
    KERNEL name##_params name##_fix(name##_params p, int variant)                                                      \
    {                                                                                                                  \
        (void)variant;                                                                                                 \
        return p;                                                                                                      \
    }
