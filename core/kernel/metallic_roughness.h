/* metallic_roughness.h: glTF's material: a dielectric with a diffuse base, blended towards a metal.
 *
 * [gltf] Khronos Group, glTF 2.0 Specification, appendix B (BRDF implementation);
 *        KHR_materials_ior, KHR_materials_specular.
 * [burley12] Burley, Physically-based shading at Disney, 2012, section 5.3.
 *
 *     f = (1 - metallic) (1 - max F) base/pi + D G2 F/(4 cos_i cos_o)
 * (diffuse=lambert), or, as Blender 3.4's Principled node reads the same files, with Disney's retro-reflective
 * base added in full (diffuse=burley),
 *     f = (1 - metallic) base/pi (1 + (FD90 - 1)(1 - cos_i)^5)(1 + (FD90 - 1)(1 - cos_o)^5) + the same,
 * with GGX, alpha = roughness^2, and Schlick's F from F0 to F90, both blended by metallic.  Departures:
 * height-correlated G2 (the specification leaves it open), and the lobe is chosen by Fresnel's share at wo.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "ggx.h"

#define DIFFUSE_LAMBERT 0
#define DIFFUSE_BURLEY  1

typedef struct metallic_roughness_params {
    real3 kd;      /* (1 - metallic) base */
    real3 F0, F90; /* reflectance at normal and grazing incidence */
    real alpha;    /* roughness^2 */
    int diffuse;   /* DIFFUSE_LAMBERT or DIFFUSE_BURLEY */
} metallic_roughness_params;

/* From the factors of a material at one point.  dielectric_F0: ((ior - 1)/(ior + 1))^2; specular and
 * specular_color: KHR_materials_specular.  roughness in [0,1]; alpha is kept at 1e-4 or more. */
KERNEL metallic_roughness_params metallic_roughness_of(real3 base, real metallic, real roughness, real dielectric_F0,
                                                       real specular, real3 specular_color)
{
    real3 tinted = scale3(dielectric_F0, specular_color);
    real3 F0     = scale3(specular, make3(kmin(tinted.x, 1), kmin(tinted.y, 1), kmin(tinted.z, 1)));
    metallic_roughness_params p;
    p.kd      = scale3(1 - metallic, base);
    p.F0      = mix3(F0, base, metallic);
    p.F90     = splat3(mix(specular, 1, metallic));
    p.alpha   = kmax(roughness*roughness, ALPHA_SMALLEST);
    p.diffuse = DIFFUSE_LAMBERT;
    return p;
}

/* The probability of the diffuse lobe for this wo. */
KERNEL real metallic_roughness_p_diffuse(metallic_roughness_params p, real3 wo)
{
    real F       = mean3(fresnel_schlick(p.F0, p.F90, kclamp(wo.z, 0, 1)));
    real diffuse = mean3(p.kd)*(1 - F);
    real sum     = diffuse + F;
    real share   = diffuse/kmax(sum, REAL_MIN);
    /* Never starve a lobe that is there: at least an eighth for each. */
    real kept = kclamp(share, 0.125f, 0.875f);
    return diffuse > 0 ? (F > 0 ? kept : (real)1) : (real)0;
}

/* The same as shared microfacet parameters, for sampling and density. */
KERNEL microfacet_params metallic_roughness_mixture(metallic_roughness_params p, real3 wo)
{
    microfacet_params m;
    m.kd           = p.kd;
    m.F0           = p.F0;
    m.eta          = 1;
    m.alpha_x      = p.alpha;
    m.alpha_y      = p.alpha;
    m.exponent     = 0;
    m.beta_inverse = 0;
    m.p_diffuse    = metallic_roughness_p_diffuse(p, wo);
    m.fresnel      = FRESNEL_SCHLICK;
    m.g2           = G2_CORRELATED;
    m.masking      = MASKING_EXACT;
    m.sampling     = SAMPLING_VNDF;
    return m;
}

/* The diffuse base over kd/pi: what the interface above lets through, or [burley12, section 5.3], where
 * FD90 = 1/2 + 2 roughness cos_d^2 and cos_d = wi.wm. */
KERNEL real metallic_roughness_base(metallic_roughness_params p, real cos_i, real cos_o, real cos_d, real3 F)
{
    real FD90_1 = 2*ksqrt(p.alpha)*cos_d*cos_d - 0.5f;
    real burley = (1 + FD90_1*kpow5(kmax(1 - cos_i, 0)))*(1 + FD90_1*kpow5(kmax(1 - cos_o, 0)));
    return p.diffuse == DIFFUSE_BURLEY ? burley : 1 - max_of3(F);
}

KERNEL real3 metallic_roughness_eval(metallic_roughness_params p, real3 wi, real3 wo)
{
    real3 wm      = half_vector(wi, wo);
    real D        = ggx_D(wm, p.alpha, p.alpha);
    real G2       = smith_G2(ggx_Lambda(wi, p.alpha, p.alpha), ggx_Lambda(wo, p.alpha, p.alpha), G2_CORRELATED);
    real cos_d    = kmin(kabs(dot3(wi, wm)), 1);
    real3 F       = fresnel_schlick(p.F0, p.F90, cos_d);
    real specular = D*G2/(4*kmax(wo.z, COS_SMALLEST));
    real diffuse  = INV_PI*wi.z*metallic_roughness_base(p, wi.z, wo.z, cos_d, F);
    return select3(is_above(wi, wo), add3(scale3(diffuse, p.kd), scale3(specular, F)), splat3(0));
}

KERNEL real metallic_roughness_pdf(metallic_roughness_params p, real3 wi, real3 wo)
{
    real3 wm = half_vector(wi, wo);
    return microfacet_pdf(metallic_roughness_mixture(p, wo), wi, wo, wm, ggx_D(wm, p.alpha, p.alpha),
                          ggx_Lambda(wo, p.alpha, p.alpha));
}

KERNEL bsdf_sample metallic_roughness_sample(metallic_roughness_params p, real3 wo, real3 u)
{
    microfacet_params lobes = metallic_roughness_mixture(p, wo);
    real3 wm                = ggx_sample_vndf(wo, u.x, u.y, p.alpha, p.alpha);
    real3 wi                = microfacet_choose(lobes, wo, wm, u);
    return microfacet_complete(lobes, wi, wo, wm, u, metallic_roughness_eval(p, wi, wo),
                               metallic_roughness_pdf(p, wi, wo));
}

KERNEL int metallic_roughness_lobes(metallic_roughness_params p)
{
    return LOBE_REFLECTION | LOBE_GLOSSY | (max_of3(p.kd) > 0 ? LOBE_DIFFUSE : 0);
}

/* D, Lambda, G1 at m. */
KERNEL real3 metallic_roughness_terms(metallic_roughness_params p, real3 m)
{
    real Lambda = ggx_Lambda(m, p.alpha, p.alpha);
    return make3(ggx_D(m, p.alpha, p.alpha), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

#ifdef FACET_PARAMETERS
static const facet_parameter metallic_roughness_parameters[] = {
    {"base_color", FACET_COLOUR, 0, 1, {0.8, 0.8, 0.8}, "1", "", "diffuse colour, or reflectance of the metal"},
    {"metallic", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "0: dielectric, 1: metal"},
    {"roughness", FACET_NUMBER, 0, 1, {0.5, 0, 0}, "1", "", "perceptual roughness, alpha = roughness^2"},
    {"ior", FACET_NUMBER, 1, 10, {1.5, 0, 0}, "1", "", "index of refraction of the dielectric"},
    {"specular", FACET_NUMBER, 0, 1, {1, 0, 0}, "1", "", "strength of the dielectric's reflection"},
    {"specular_color",
     FACET_COLOUR,
     0,
     1,
     {1, 1, 1},
     "1",
     "",
     "tint of the dielectric's reflection at normal incidence"},
    {"diffuse",
     FACET_CHOICE,
     0,
     1,
     {0, 0, 0},
     "1",
     "lambert|burley",
     "base under the interface, or Disney's added to it"},
};
#endif

#ifdef FACET_PREPARE
static metallic_roughness_params metallic_roughness_prepare(const facet_material *m)
{
    metallic_roughness_params p = metallic_roughness_of(
        prepare_colour(m, "base_color"), prepare_number(m, "metallic"), prepare_number(m, "roughness"),
        fresnel_normal_incidence(prepare_number(m, "ior")), prepare_number(m, "specular"),
        prepare_colour(m, "specular_color"));
    p.diffuse = prepare_choice(m, "diffuse");
    return p;
}
#endif
