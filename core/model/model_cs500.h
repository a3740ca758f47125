/* model_cs500.h: the BRDF of the CS500 course, with the choices that its text prints: any of three distributions, the
 * rational fit for G1, separable G, all normals sampled.
 *
 * [cs500] CS500 Project 3: EvalScattering, PdfBrdf, SampleBrdf.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_microfacet.h"
#include "model_phong.h"

#ifdef FACET_PARAMETERS
static const facet_parameter cs500_parameters[] = {
    {"ndf", FACET_CHOICE, 0, 2, {NDF_GGX, 0, 0}, "1", "ggx|beckmann|phong", "distribution of normals, D"},
    {"alpha", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness, alpha_g or alpha_b"},
    {"exponent", FACET_NUMBER, 0, 1e6, {50, 0, 0}, "1", "", "alpha_p of phong; 2/alpha^2 - 2, not with alpha"},
    {"kd", FACET_COLOUR, 0, 1, {0, 0, 0}, "1", "", "diffuse reflectance, Kd"},
    {"ks", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "reflectance at normal incidence, Ks (Schlick's Fresnel)"},
    {"ior", FACET_NUMBER, 0.1, 10, {1.5, 0, 0}, "1", "", "index of refraction (exact Fresnel), not with ks"},
    {"g2", FACET_CHOICE, 0, 1, {G2_SEPARABLE, 0, 0}, "1", "correlated|separable", "1/(1+Li+Lo), or G1 G1 as printed"},
    {"masking",
     FACET_CHOICE,
     0,
     1,
     {MASKING_PUBLISHED, 0, 0},
     "1",
     "exact|published",
     "Smith's G1, or the fit as printed"},
    {"sampling", FACET_CHOICE, 0, 1, {SAMPLING_NDF, 0, 0}, "1", "vndf|ndf", "visible normals, or all as printed"},
};
#endif

#ifdef FACET_PREPARE
/* Roughness and exponent are converted by the printed alpha_p = 2/alpha_b^2 - 2, up to 1e6.  The lobe is chosen by
 * |Kd|/(|Kd| + |Ks|) as printed; departure: where Ks is 0 the specular lobe, which Fresnel's term leaves at grazing
 * angles, keeps a probability of 1/8. */
static inline microfacet_params cs500_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, prepare_choice(m, "ndf"));
    const real alpha = prepare_number(m, "alpha");
    const real exponent = prepare_number(m, "exponent");
    if (p.d.kind == NDF_PHONG) {
        const real converted = kclamp(2/(alpha*alpha) - 2, 0, 1e6f);
        p.d.phong = phong_shape_of(facet_material_given(m, "alpha") ? converted : exponent);
    } else {
        p.d.alpha_x = facet_material_given(m, "exponent") ? ksqrt(2/(exponent + 2)) : alpha;
        p.d.alpha_y = p.d.alpha_x;
    }
    const real kd = length3(p.kd);
    const real ks = length3(fresnel_reflectance(p.F, 1));
    p.p_diffuse = ks > 0 ? kd/(kd + ks) : p.p_diffuse;
    return p;
}
#endif
