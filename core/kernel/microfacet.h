/* microfacet.h: the reflecting microfacet model of any distribution of normals, over a Lambertian term.
 *
 *     f(wi,wo) = kd/pi + D(wm) G2(wi,wo) F(wi.wm) / (4 cos_i cos_o)                        [cs500, BRDF]
 *
 * [cs500]   CS500 Project 3: EvalScattering, PdfBrdf, SampleBrdf.
 * [bonn]    Zingsheim, BRDF Models, section 5: V = G2/(4 cos_i cos_o) without trigonometry.
 * [heitz14] Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, JCGT 2014.
 *
 * Written with the projected area sigma(v) = cos (1 + Lambda) of the facets that face v, for which nothing is
 * divided by a cosine: G1 = cos/sigma, and 1/V = 4 (cos_i sigma_o + cos_o sigma_i - cos_i cos_o).
 * Departures from [cs500]: everything is 0 unless wi and wo are above the horizon; a half vector behind
 * wo gives no sample; G2 is height-correlated by default ([heitz14, eq. 99]) and `separable` as printed.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "bsdf.h"
#include "distribution.h"
#include "fresnel.h"

/* The order of the choices in the parameter tables. */
#define G2_CORRELATED 0
#define G2_SEPARABLE  1
#define SAMPLING_VNDF 0
#define SAMPLING_NDF  1

typedef struct microfacet_params {
    distribution d;
    fresnel F;
    real3 kd;       /* diffuse reflectance */
    real p_diffuse; /* probability of choosing the Lambertian lobe; 0 if and only if kd is 0 */
    int g2, sampling;
} microfacet_params;

/* The specular term at a pair of directions, but for Fresnel's. */
typedef struct specular_term {
    real3 h;      /* wi + wo, along wm */
    real cos_d;   /* wi.wm = wo.wm */
    real D;       /* of wm */
    real sigma_o; /* projected area towards wo */
    real rest;    /* 1/(4 V): the projected area that G2 leaves, divided by V's 4 */
    real inverse; /* 1/(4 rest sigma_o) */
} specular_term;

/* 1/(4 V) with masking and shadowing together.  correlated: G2 = 1/(1 + Li + Lo), [heitz14, eq. 99]; separable:
 * G1(wi) G1(wo), [cs500, "smith method"]. */
KERNEL real smith_rest(real cos_i, real cos_o, real sigma_i, real sigma_o, int g2)
{
    real separable  = sigma_i*sigma_o;
    real correlated = (cos_i*sigma_o + cos_o*sigma_i) - cos_i*cos_o;
    return g2 == G2_SEPARABLE ? separable : correlated;
}

KERNEL specular_term specular_at(distribution d, int g2, real3 wi, real3 wo)
{
    specular_term s;
    s.h       = add3(wi, wo);
    s.cos_d   = kmin(0.5f*length3(s.h), 1); /* |wi + wo| = 2 cos_d */
    s.D       = distribution_D(d, s.h);
    s.sigma_o = distribution_sigma(d, wo);
    s.rest    = smith_rest(wi.z, wo.z, distribution_sigma(d, wi), s.sigma_o, g2);
    s.inverse = 0.25f/(s.rest*s.sigma_o);
    return s;
}

/* D V cos_i */
KERNEL real specular_f(specular_term s, real3 wi) { return s.D*(s.inverse*s.sigma_o)*wi.z; }

/* The density of wi when the normal is drawn from the visible ones, D (wo.wm)/sigma_o over the Jacobian 4 (wo.wm):
 * s.D*(s.inverse*s.rest) with the sigma_o of the exact masking, whatever masks. */
KERNEL real specular_visible_pdf(distribution d, specular_term s, real3 wo)
{
    return d.masking == MASKING_PUBLISHED ? 0.25f*s.D/distribution_exact_sigma(d, wo) : s.D*(s.inverse*s.rest);
}

/* The same for all normals, D cos_m/(4 (wo.wm)).  [cs500, P_r]. */
KERNEL real specular_ndf_pdf(specular_term s)
{
    real cos_d = kmax(s.cos_d, COS_SMALLEST);
    return s.D*s.h.z/(8*cos_d*cos_d); /* cos_m = h.z/(2 cos_d) */
}

/* f cos_i of the mixture.  [cs500, EvalScattering]. */
KERNEL real3 microfacet_eval(microfacet_params p, real3 wi, real3 wo)
{
    specular_term s = specular_at(p.d, p.g2, wi, wo);
    real3 shine     = scale3(specular_f(s, wi), fresnel_reflectance(p.F, s.cos_d));
    real3 both      = madd3(shine, INV_PI*wi.z, p.kd);
    real3 f         = select3(p.p_diffuse > 0, both, shine);
    return select3(is_above(wi, wo), f, splat3(0));
}

/* Density of the mixture's sampler.  [cs500, PdfBrdf]: p_d P_d + p_r P_r. */
KERNEL real microfacet_pdf(microfacet_params p, real3 wi, real3 wo)
{
    specular_term s = specular_at(p.d, p.g2, wi, wo);
    real all        = specular_ndf_pdf(s);
    real visible    = specular_visible_pdf(p.d, s, wo);
    real P_r        = p.sampling == SAMPLING_NDF ? all : visible;
    real both       = p.p_diffuse*(INV_PI*wi.z) + (1 - p.p_diffuse)*P_r;
    real pdf        = p.p_diffuse > 0 ? both : P_r;
    return is_above(wi, wo) ? pdf : (real)0;
}

/* wi from the chosen lobe: the cosine direction, or wo mirrored about a normal.  [cs500, SampleBrdf].  The normal is
 * exactly that of wi + wo, so that eval and pdf belong to the sample to the last bit. */
KERNEL bsdf_sample microfacet_sample(microfacet_params p, real3 wo, real3 u)
{
    int is_diffuse = u.z < p.p_diffuse;
    real3 m        = select3(p.sampling == SAMPLING_NDF, distribution_sample_ndf(p.d, u.x, u.y),
                             distribution_sample_vndf(p.d, wo, u.x, u.y));
    real3 wi       = select3(is_diffuse, sample_cosine(u.x, u.y), reflect(wo, m));
    real3 f        = microfacet_eval(p, wi, wo);
    real pdf       = microfacet_pdf(p, wi, wo);
    int is_valid   = (pdf > REAL_MIN) & (is_diffuse | (dot3(wo, m) > 0));
    return complete_sample(wi, f, pdf, is_valid, LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY));
}

/* What the mixture's samples can be. */
KERNEL int microfacet_lobes(microfacet_params p)
{
    return LOBE_REFLECTION | LOBE_GLOSSY | (p.p_diffuse > 0 ? LOBE_DIFFUSE : 0);
}

/* D, Lambda, G1 at m. */
KERNEL real3 microfacet_terms(microfacet_params p, real3 m)
{
    real Lambda = distribution_Lambda(p.d, m);
    return make3(distribution_D(p.d, m), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

/* The loops are compiled four times for each distribution: for the usual settings, known to the compiler; for the
 * exact masking with either way of sampling; and for the published masking. */
#define MICROFACET_USUAL     0
#define MICROFACET_VNDF      1
#define MICROFACET_NDF       2
#define MICROFACET_PUBLISHED 3

KERNEL int microfacet_variant(microfacet_params p)
{
    int is_usual = (p.F.kind == FRESNEL_SCHLICK) & (p.g2 == G2_CORRELATED) & !(p.p_diffuse > 0);
    int exact    = p.sampling == SAMPLING_NDF ? MICROFACET_NDF : (is_usual ? MICROFACET_USUAL : MICROFACET_VNDF);
    return 4*p.d.kind + (p.d.masking == MASKING_PUBLISHED ? MICROFACET_PUBLISHED : exact);
}

/* p with the fields that are the same throughout a variant set to constants. */
KERNEL microfacet_params microfacet_fix(microfacet_params p, int variant)
{
    int settings        = variant%4;
    int is_usual        = settings == MICROFACET_USUAL;
    int is_published    = settings == MICROFACET_PUBLISHED;
    microfacet_params q = p;
    q.d.kind            = variant/4;
    q.d.masking         = is_published ? MASKING_PUBLISHED : MASKING_EXACT;
    q.sampling          = is_published ? p.sampling : (settings == MICROFACET_NDF ? SAMPLING_NDF : SAMPLING_VNDF);
    q.F.kind            = is_usual ? FRESNEL_SCHLICK : p.F.kind;
    q.g2                = is_usual ? G2_CORRELATED : p.g2;
    q.p_diffuse         = is_usual ? (real)0 : p.p_diffuse;
    return q;
}
