/* microfacet_lane.h: the parameters of microfacet.h at one element of a batch where they vary, as textures make them.
 *
 * Exact masking and a single bounce.  Phong's exponent is 2/alpha^2 - 2 of the geometric mean; gtr integrates Lambda
 * for each element (gtr_lambda.h) and draws all normals, because its polynomials are fitted once per material.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "microfacet.h"

/* What varies. */
typedef struct microfacet_lane {
    real alpha_x, alpha_y, gamma;
    real3 kd;
    real3 ks; /* reflectance at normal incidence, whatever Fresnel's term */
} microfacet_lane;

/* The elementary part of a GTR's shape: what D, the sampling of all normals and Lambda without polynomials take. */
KERNEL gtr_shape gtr_elementary_shape(real alpha_x, real alpha_y, real gamma)
{
    gtr_shape g;
    real alpha     = kmin(ksqrt(alpha_x*alpha_y), GTR_ROUGHEST);
    g.anisotropy   = GTR_STRETCHED;
    g.is_isotropic = 0;
    g.alpha        = alpha;
    g.gamma        = gamma;
    g.stretch_x    = alpha_x/alpha;
    g.stretch_y    = alpha_y/alpha;
    g.excess       = gtr_excess(gamma);
    g.log_range    = -2*klog(alpha);
    g.k0           = (1 - alpha)*(1 + alpha);
    g.survival     = 1/kexpm1(-g.excess*g.log_range);
    g.peak         = -INV_PI*g.excess*g.survival*(g.k0/(alpha*alpha));
    return g; /* cppcheck-suppress uninitvar */
}

/* The same distribution with another roughness. */
KERNEL distribution distribution_at_lane(distribution d, microfacet_lane lane)
{
    int is_phong   = d.kind == NDF_PHONG;
    real mean      = is_phong ? ksqrt(lane.alpha_x*lane.alpha_y) : (real)1;
    distribution q = d;
    q.masking      = MASKING_EXACT;
    q.alpha_x      = lane.alpha_x/mean;
    q.alpha_y      = lane.alpha_y/mean;
    q.phong        = phong_shape_of(kmax(2/(mean*mean) - 2, 0));
    q.gtr          = gtr_elementary_shape(lane.alpha_x, lane.alpha_y, lane.gamma);
    return q;
}

KERNEL microfacet_params microfacet_at_lane(microfacet_params p, microfacet_lane lane)
{
    microfacet_params q = p;
    q.d                 = distribution_at_lane(p.d, lane);
    q.F.F0              = lane.ks;
    q.kd                = lane.kd;
    q.p_diffuse         = microfacet_p_diffuse(lane.kd, lane.ks);
    q.has_diffuse       = 1;
    q.is_one            = 0;
    q.sampling          = p.d.kind == NDF_GTR_DIRECT ? SAMPLING_NDF : SAMPLING_VNDF;
    q.ms.kind           = ENERGY_SINGLE;
    return q;
}
