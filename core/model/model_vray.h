/* model_vray.h: V-Ray's parameters of gtr: sharpness and tail falloff, with its spline over the closed forms of G1.
 *
 * [dimov15] Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015: section 7 (the sharpness), and
 *           its implementation, which clamps gamma at 4 in G1 alone and masks separably.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_gtr.h"

#ifdef FACET_PARAMETERS
static const facet_parameter vray_parameters[] = {
    {"sharpness", FACET_NUMBER, 0, 1, {0.8, 0, 0}, "1", "", "alpha = (1 - sharpness)^2, at least 1e-4"},
    {"gamma", FACET_NUMBER, 1e-3, 20, {2, 0, 0}, "1", "", "tail falloff: the exponent of gtr"},
    {"kd", FACET_COLOUR, 0, 1, {0, 0, 0}, "1", "", "Lambertian term that is added"},
    {"ks", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "reflectance at normal incidence (Schlick's Fresnel)"},
    {"ior", FACET_NUMBER, 0.1, 10, {1.5, 0, 0}, "1", "", "index of refraction (exact Fresnel), not with ks"},
    {"g2", FACET_CHOICE, 0, 1, {G2_SEPARABLE, 0, 0}, "1", "correlated|separable", "1/(1+Li+Lo), or G1 G1 as printed"},
    {"masking",
     FACET_CHOICE,
     0,
     1,
     {MASKING_PUBLISHED, 0, 0},
     "1",
     "exact|published",
     "Smith's G1, or the spline over gamma as printed"},
    {"sampling", FACET_CHOICE, 0, 1, {SAMPLING_NDF, 0, 0}, "1", "vndf|ndf", "visible normals, or all as printed"},
};
#endif

#ifdef FACET_PREPARE
static inline microfacet_params vray_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, NDF_GTR);
    const real blur = 1 - prepare_number(m, "sharpness");
    const real alpha = kmax(blur*blur, ALPHA_SMALLEST);
    const real gamma = prepare_number(m, "gamma");
    p.d.alpha_x = alpha;
    p.d.alpha_y = alpha;
    p.d.gtr = gtr_shape_of(alpha, alpha, gamma, GTR_STRETCHED);
    p.d.spline = gtr_spline_at(gamma);
    return p;
}
#endif
