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

#include "microfacet.h"

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

/* The diffuse base over kd/pi: what the interface above lets through, or [burley12, section 5.3], where
 * FD90 = 1/2 + 2 roughness cos_d^2 and cos_d = wi.wm. */
KERNEL real metallic_roughness_base(metallic_roughness_params p, real cos_i, real cos_o, real cos_d, real3 F)
{
    real FD90_1 = 2*ksqrt(p.alpha)*cos_d*cos_d - 0.5f;
    real burley = (1 + FD90_1*kpow5(kmax(1 - cos_i, 0)))*(1 + FD90_1*kpow5(kmax(1 - cos_o, 0)));
    return p.diffuse == DIFFUSE_BURLEY ? burley : 1 - max_of3(F);
}

/* The specular term of isotropic GGX. */
KERNEL specular_term metallic_roughness_specular(metallic_roughness_params p, real3 wi, real3 wo)
{
    smith_terms t;
    t.D           = ggx_D(add3(wi, wo), p.alpha, p.alpha);
    t.drawn_D     = t.D;
    t.sigma_i     = ggx_sigma(wi, p.alpha, p.alpha);
    t.sigma_o     = ggx_sigma(wo, p.alpha, p.alpha);
    t.drawn_sigma = t.sigma_o;
    return specular_at(t, G2_CORRELATED, wi, wo);
}

KERNEL real3 metallic_roughness_eval(metallic_roughness_params p, real3 wi, real3 wo)
{
    specular_term s = metallic_roughness_specular(p, wi, wo);
    real3 F         = fresnel_schlick(p.F0, p.F90, s.cos_d);
    real diffuse    = INV_PI*wi.z*metallic_roughness_base(p, wi.z, wo.z, s.cos_d, F);
    return select3(is_above(wi, wo), add3(scale3(diffuse, p.kd), scale3(specular_f(s, wi), F)), splat3(0));
}

KERNEL real metallic_roughness_pdf(metallic_roughness_params p, real3 wi, real3 wo)
{
    specular_term s = metallic_roughness_specular(p, wi, wo);
    real p_diffuse  = metallic_roughness_p_diffuse(p, wo);
    real pdf        = p_diffuse*(INV_PI*wi.z) + (1 - p_diffuse)*specular_visible_pdf(s, 1);
    return keep_if(is_above(wi, wo), pdf);
}

KERNEL bsdf_sample metallic_roughness_sample(metallic_roughness_params p, real3 wo, real3 u)
{
    int is_diffuse = u.z < metallic_roughness_p_diffuse(p, wo);
    real3 m        = ggx_sample_vndf(wo, u.x, u.y, p.alpha, p.alpha);
    real3 wi       = select3(is_diffuse, sample_cosine(u.x, u.y), reflect(wo, m));
    real pdf       = metallic_roughness_pdf(p, wi, wo);
    int is_valid   = (pdf > REAL_MIN) & (is_diffuse | (dot3(wo, m) > 0));
    real inv       = 1/(is_valid ? pdf : (real)1);
    return complete_sample(wi, scale3(inv, metallic_roughness_eval(p, wi, wo)), pdf, is_valid,
                           LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY));
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

EVAL_AND_PDF(metallic_roughness)
ONE_VARIANT(metallic_roughness)
#define EACH_VARIANT_metallic_roughness(CASE, name) CASE(name, 0)
