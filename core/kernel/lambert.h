/* lambert.h: the ideal diffuse reflector, f = kd/pi.
 *
 * [cs500] CS500 Project 3: E_d, P_d and the diffuse branch of SampleBrdf.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "bsdf.h"

typedef struct lambert_params {
    real3 kd; /* reflectance, [0,1] */
} lambert_params;

/* f cos_i = kd cos_i/pi.  [cs500, E_d].  Departure: 0 unless both directions are above the horizon. */
KERNEL real3 lambert_eval(lambert_params p, real3 wi, real3 wo)
{
    return select3((wi.z > 0) & (wo.z > 0), scale3(INV_PI*wi.z, p.kd), splat3(0));
}

/* cos_i/pi.  [cs500, P_d], without the absolute value. */
KERNEL real lambert_pdf(lambert_params p, real3 wi, real3 wo)
{
    (void)p;
    return ((wi.z > 0) & (wo.z > 0)) ? INV_PI*wi.z : (real)0;
}

KERNEL bsdf_sample lambert_sample(lambert_params p, real3 wo, real3 u)
{
    real3 wi     = sample_cosine(u.x, u.y);
    int is_valid = (wi.z > 0) & (wo.z > 0);
    bsdf_sample s;
    s.wi     = select3(is_valid, wi, make3(0, 0, 1));
    s.pdf    = is_valid ? INV_PI*wi.z : (real)0;
    s.weight = select3(is_valid, p.kd, splat3(0));
    s.lobe   = LOBE_REFLECTION | LOBE_DIFFUSE;
    s.eta    = 1;
    return s;
}

KERNEL int lambert_lobes(lambert_params p)
{
    (void)p;
    return LOBE_REFLECTION | LOBE_DIFFUSE;
}

/* No distribution of normals. */
KERNEL real3 lambert_terms(lambert_params p, real3 m)
{
    (void)p;
    (void)m;
    return splat3(0);
}

EVAL_AND_PDF(lambert)
ONE_VARIANT(lambert)
#define EACH_VARIANT_lambert(CASE, name) CASE(name, 0)
