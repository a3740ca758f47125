/* microfacet.h: the reflecting microfacet model of any distribution of normals, over a Lambertian term.
 *
 *     f(wi,wo) = kd/pi + D(wm) G2(wi,wo) F(wi.wm) / (4 cos_i cos_o)                        [cs500, BRDF]
 *
 * with the light of several bounces between facets added or not (energy.h).
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
#include "energy.h"
#include "fresnel.h"

/* The order of the choices in the parameter tables. */
#define G2_CORRELATED    0
#define G2_SEPARABLE     1
#define SAMPLING_VNDF    0
#define SAMPLING_NDF     1
#define SAMPLING_BOUNDED 2

typedef struct microfacet_params {
    distribution d;
    fresnel F;
    real3 kd;        /* diffuse reflectance */
    real p_diffuse;  /* probability of choosing the Lambertian lobe */
    int has_diffuse; /* whether kd is not 0 */
    int is_one;      /* whether samples have one lobe: visible normals, exact masking, one bounce, no kd */
    int is_ggx;      /* whether the distribution is ggx, whose D and sigma cost less than all the rest */
    int g2, sampling;
    energy ms;
} microfacet_params;

/* The probability of the Lambertian lobe: |Kd|/(|Kd| + |Ks|), [cs500, SampleBrdf]; departure: a specular lobe keeps a
 * probability of 1/8, because Fresnel's term is not 0 at grazing angles when Ks is. */
KERNEL real microfacet_p_diffuse(real3 kd, real3 ks)
{
    real d = length3(kd);
    return kmin(d/kmax(d + length3(ks), REAL_MIN), 0.875f);
}

/* What the distribution says about a pair of directions and a normal. */
typedef struct smith_terms {
    real D;                /* of the normal */
    real drawn_D;          /* ... of the normals that samples are made with */
    real sigma_i, sigma_o; /* projected areas towards wi and wo */
    real drawn_sigma;      /* ... towards wo, of the normals that samples are made with */
} smith_terms;

/* The specular term at a pair of directions, but for Fresnel's. */
typedef struct specular_term {
    smith_terms t;
    real3 m;      /* along wm, of any length */
    real cos_d;   /* wi.wm = wo.wm */
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

/* m: the normal, of any length; sampling says which normals are drawn. */
KERNEL smith_terms smith_terms_at(distribution d, int sampling, real3 wi, real3 wo, real3 m)
{
    smith_terms t;
    t.D           = distribution_D(d, m);
    t.drawn_D     = distribution_drawn_D(d, m);
    t.sigma_i     = distribution_sigma(d, wi);
    t.sigma_o     = distribution_sigma(d, wo);
    real exact    = d.masking == MASKING_PUBLISHED ? distribution_exact_sigma(d, wo) : t.sigma_o;
    t.drawn_sigma = sampling == SAMPLING_BOUNDED ? ggx_bounded_sigma(wo, d.alpha_x, d.alpha_y) : exact;
    return t;
}

/* The term about a given normal m, of any length; cos_d = wo.wm. */
KERNEL specular_term specular_about(smith_terms t, int g2, real3 wi, real3 wo, real3 m, real cos_d)
{
    specular_term s;
    s.t       = t;
    s.m       = m;
    s.cos_d   = kmin(cos_d, 1);
    s.rest    = smith_rest(wi.z, wo.z, t.sigma_i, t.sigma_o, g2);
    s.inverse = 0.25f/(s.rest*t.sigma_o);
    return s;
}

/* The same about wi + wo, whose length is 2 cos_d. */
KERNEL specular_term specular_at(smith_terms t, int g2, real3 wi, real3 wo)
{
    real3 h = add3(wi, wo);
    return specular_about(t, g2, wi, wo, h, 0.5f*length3(h));
}

/* D V cos_i */
KERNEL real specular_f(specular_term s, real3 wi) { return s.t.D*(s.inverse*s.t.sigma_o)*wi.z; }

/* The density of wi when the normal is drawn from the visible ones, D (wo.wm)/sigma over the Jacobian 4 (wo.wm); is_own
 * says that sigma is the one that masks. */
KERNEL real specular_visible_pdf(specular_term s, int is_own)
{
    return is_own ? s.t.drawn_D*(s.inverse*s.rest) : 0.25f*s.t.drawn_D/s.t.drawn_sigma;
}

/* The same for all normals, D cos_m/(4 (wo.wm)).  [cs500, P_r]. */
KERNEL real specular_ndf_pdf(specular_term s)
{
    real cos_d = kmax(s.cos_d, COS_SMALLEST);
    return s.t.drawn_D*s.m.z/(4*length3(s.m)*cos_d);
}

/* The terms at a pair of directions. */
KERNEL smith_terms microfacet_terms_at(microfacet_params p, real3 wi, real3 wo)
{
    return smith_terms_at(p.d, p.sampling, wi, wo, add3(wi, wo));
}

/* f cos_i of the mixture.  [cs500, EvalScattering]. */
KERNEL real3 microfacet_eval_with(microfacet_params p, smith_terms t, real3 wi, real3 wo)
{
    specular_term s = specular_at(t, p.g2, wi, wo);
    real3 single    = scale3(specular_f(s, wi), fresnel_reflectance(p.F, s.cos_d));
    real3 shine     = p.ms.kind == ENERGY_SINGLE ? single : energy_complete(p.ms, single, wi, wo);
    real3 both      = madd3(shine, INV_PI*wi.z, p.kd);
    real3 f         = select3(p.has_diffuse, both, shine);
    return select3(is_above(wi, wo), f, splat3(0));
}

KERNEL real3 microfacet_eval(microfacet_params p, real3 wi, real3 wo)
{
    return microfacet_eval_with(p, microfacet_terms_at(p, wi, wo), wi, wo);
}

/* The part of specular samples that the lobe of several bounces gets. */
KERNEL real microfacet_p_multi(microfacet_params p, real3 wo)
{
    return p.ms.kind == ENERGY_SINGLE ? (real)0 : energy_probability(p.ms, wo);
}

/* What is uniform again of the number that chooses the lobe, where it chooses the mirror directions; below 0 where it
 * chooses another. */
KERNEL real microfacet_mirror_number(microfacet_params p, real3 wo, real u)
{
    real specular = p.has_diffuse ? (u - p.p_diffuse)/(1 - p.p_diffuse) : u;
    real p_multi  = microfacet_p_multi(p, wo);
    real mirrored = (specular - p_multi)/kmax(1 - p_multi, REAL_EPSILON);
    return p.ms.kind == ENERGY_SINGLE ? specular : mirrored;
}

/* Density of the mixture's sampler.  [cs500, PdfBrdf]: p_d P_d + p_r P_r, where P_r has a part for the lobe of
 * several bounces. */
KERNEL real microfacet_pdf_with(microfacet_params p, smith_terms t, real3 wi, real3 wo)
{
    specular_term s = specular_at(t, p.g2, wi, wo);
    int is_own      = p.is_ggx & (p.d.masking == MASKING_EXACT) & (p.sampling != SAMPLING_BOUNDED);
    real single     = p.sampling == SAMPLING_NDF ? specular_ndf_pdf(s) : specular_visible_pdf(s, is_own);
    real p_multi    = microfacet_p_multi(p, wo);
    real P_r        = p.ms.kind == ENERGY_SINGLE ? single : mix(single, energy_pdf(p.ms, wi), p_multi);
    real both       = p.p_diffuse*(INV_PI*wi.z) + (1 - p.p_diffuse)*P_r;
    real pdf        = p.has_diffuse ? both : P_r;
    return keep_if(is_above(wi, wo), pdf);
}

KERNEL real microfacet_pdf(microfacet_params p, real3 wi, real3 wo)
{
    return microfacet_pdf_with(p, microfacet_terms_at(p, wi, wo), wi, wo);
}

KERNEL bsdf_value microfacet_eval_pdf_with(microfacet_params p, smith_terms t, real3 wi, real3 wo)
{
    bsdf_value both;
    both.f   = microfacet_eval_with(p, t, wi, wo);
    both.pdf = microfacet_pdf_with(p, t, wi, wo);
    return both;
}

KERNEL bsdf_value microfacet_eval_pdf(microfacet_params p, real3 wi, real3 wo)
{
    return microfacet_eval_pdf_with(p, microfacet_terms_at(p, wi, wo), wi, wo);
}

/* A sample is made in three steps, which batches take one after the other: a normal, a direction, and its weight and
 * density with the terms of both. */
KERNEL real3 microfacet_sample_normal(microfacet_params p, real3 wo, real3 u)
{
    real3 visible = distribution_sample_vndf(p.d, wo, u.x, u.y, microfacet_mirror_number(p, wo, u.z));
    real3 bounded = ggx_sample_bounded(wo, u.x, u.y, p.d.alpha_x, p.d.alpha_y);
    real3 seen    = select3(p.sampling == SAMPLING_BOUNDED, bounded, visible);
    return select3(p.sampling == SAMPLING_NDF, distribution_sample_ndf(p.d, u.x, u.y), seen);
}

/* Whether u chooses the lobe of several bounces. */
KERNEL int microfacet_chooses_multi(microfacet_params p, real3 wo, real3 u)
{
    return (p.ms.kind != ENERGY_SINGLE) & (u.z >= p.p_diffuse) & (microfacet_mirror_number(p, wo, u.z) < 0);
}

/* wo mirrored about the normal, the cosine direction, or one of several bounces.  [cs500, SampleBrdf]. */
KERNEL real3 microfacet_sample_direction(microfacet_params p, real3 wo, real3 u, real3 m)
{
    real3 mirrored = reflect(wo, m);
    int is_multi   = p.is_one ? 0 : microfacet_chooses_multi(p, wo, u);
    real3 specular = select3(is_multi, energy_sample(p.ms, u.x, u.y), mirrored);
    return p.is_one ? mirrored : select3(u.z < p.p_diffuse, sample_cosine(u.x, u.y), specular);
}

/* The normal that a sample's terms are about: the one drawn, exact where wi's rounding would blur it, or wi + wo where
 * the direction may come from another lobe. */
KERNEL real3 microfacet_normal_of(microfacet_params p, real3 wi, real3 wo, real3 m)
{
    return p.is_one ? m : add3(wi, wo);
}

/* One lobe: the weight is F G2/G1(wo), with the sigma of the normals drawn for G1's, without D, which cancels. */
KERNEL bsdf_sample microfacet_complete_mirrored(microfacet_params p, smith_terms t, real3 wi, real3 wo, real3 m)
{
    real towards    = dot3(wo, m);
    real ratio      = towards/dot3(m, m);
    specular_term s = specular_about(t, p.g2, wi, wo, m, ksqrt(kmax(ratio*towards, 0)));
    real3 weight    = scale3(t.drawn_sigma*wi.z/s.rest, fresnel_reflectance(p.F, s.cos_d));
    real pdf        = 0.25f*t.D/t.drawn_sigma;
    int is_valid    = is_above(wi, wo) & (towards > 0) & (pdf > REAL_MIN);
    return complete_sample(wi, weight, pdf, is_valid, LOBE_REFLECTION | LOBE_GLOSSY);
}

/* Several: the weight is eval/pdf of the mixture. */
KERNEL bsdf_sample microfacet_complete_mixture(microfacet_params p, smith_terms t, real3 wi, real3 wo, real3 u, real3 m)
{
    int is_diffuse  = u.z < p.p_diffuse;
    bsdf_value both = microfacet_eval_pdf_with(p, t, wi, wo);
    int is_valid    = (both.pdf > REAL_MIN) & (is_diffuse | microfacet_chooses_multi(p, wo, u) | (dot3(wo, m) > 0));
    real inv        = 1/(is_valid ? both.pdf : (real)1);
    return complete_sample(wi, scale3(inv, both.f), both.pdf, is_valid,
                           LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY));
}

KERNEL bsdf_sample microfacet_complete(microfacet_params p, smith_terms t, real3 wi, real3 wo, real3 u, real3 m)
{
    return p.is_one ? microfacet_complete_mirrored(p, t, wi, wo, m) : microfacet_complete_mixture(p, t, wi, wo, u, m);
}

KERNEL bsdf_sample microfacet_sample(microfacet_params p, real3 wo, real3 u)
{
    real3 m       = microfacet_sample_normal(p, wo, u);
    real3 wi      = microfacet_sample_direction(p, wo, u, m);
    smith_terms t = smith_terms_at(p.d, p.sampling, wi, wo, microfacet_normal_of(p, wi, wo, m));
    return microfacet_complete(p, t, wi, wo, u, m);
}

/* What the mixture's samples can be. */
KERNEL int microfacet_lobes(microfacet_params p)
{
    return LOBE_REFLECTION | LOBE_GLOSSY | (p.has_diffuse ? LOBE_DIFFUSE : 0);
}

/* D, Lambda, G1 at m. */
KERNEL real3 microfacet_terms(microfacet_params p, real3 m)
{
    real Lambda = distribution_Lambda(p.d, m);
    return make3(distribution_D(p.d, m), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

/* The loops are compiled once for each of these groups of settings, so that what is the same for a whole material is
 * not
 * chosen per element: for ggx, and for the other distributions together, whose terms loops of their own find before
 * (batch_microfacet_text.h). */
#define MICROFACET_USUAL   0 /* as PURE, with Schlick's Fresnel and correlated masking */
#define MICROFACET_METAL   1 /* as PURE, of a conductor, whose Fresnel term costs more than all the rest */
#define MICROFACET_PURE    2 /* one lobe: visible normals, exact masking; no conductor */
#define MICROFACET_MIXED   3 /* visible normals, over a Lambertian term or not; ggx: exact masking; no conductor */
#define MICROFACET_NDF     4 /* all normals, over a Lambertian term or not; ggx: exact masking; no conductor */
#define MICROFACET_MULTI   5 /* as USUAL, isotropic, with the lobe of several bounces */
#define MICROFACET_ENERGY  6 /* all else with that lobe, or scaled; chooses as it runs */
#define MICROFACET_RARE    7 /* everything else; chooses as it runs */
#define MICROFACET_BOUNDED 8 /* ggx as PURE, with bounded normals */
#define MICROFACET_GROUPS  9

#define MICROFACET_VARIANTS (2*MICROFACET_GROUPS - 1) /* more than any other kernel has */

KERNEL int microfacet_variant(microfacet_params p)
{
    int is_metal     = p.F.kind == FRESNEL_CONDUCTOR;
    int is_published = p.d.masking == MASKING_PUBLISHED;
    int is_ndf       = p.sampling == SAMPLING_NDF;
    int is_visible   = (p.sampling == SAMPLING_VNDF) & !is_published;
    int is_usual     = (p.F.kind == FRESNEL_SCHLICK) & (p.g2 == G2_CORRELATED);
    int pure         = is_metal ? MICROFACET_METAL : (is_usual ? MICROFACET_USUAL : MICROFACET_PURE);
    int one          = p.sampling == SAMPLING_BOUNDED ? MICROFACET_BOUNDED : pure;
    int is_all       = is_ndf & !(p.is_ggx & is_published);
    int is_mixed     = p.is_ggx ? is_visible : !is_ndf;
    int several      = is_metal ? MICROFACET_RARE
                                : (is_all ? MICROFACET_NDF : (is_mixed ? MICROFACET_MIXED : MICROFACET_RARE));
    int is_multi     = is_usual & is_visible & (p.ms.kind == ENERGY_MULTI) & p.ms.is_isotropic & !p.has_diffuse;
    int bounces      = is_multi ? MICROFACET_MULTI : MICROFACET_ENERGY;
    int single       = p.is_one ? one : several;
    return (p.is_ggx ? 0 : MICROFACET_GROUPS) + (p.ms.kind == ENERGY_SINGLE ? single : bounces);
}

/* p with the fields that are the same throughout a variant set to constants. */
KERNEL microfacet_params microfacet_fix(microfacet_params p, int variant)
{
    int group           = variant%MICROFACET_GROUPS;
    int is_ggx          = variant < MICROFACET_GROUPS;
    int is_multi        = group == MICROFACET_MULTI;
    int is_metal        = group == MICROFACET_METAL;
    int is_bounded      = group == MICROFACET_BOUNDED;
    int is_ndf          = group == MICROFACET_NDF;
    int is_energy       = group == MICROFACET_ENERGY;
    int is_usual        = (group == MICROFACET_USUAL) | is_multi;
    int is_rare         = (group == MICROFACET_RARE) | is_energy;
    int is_one          = (group == MICROFACET_USUAL) | is_metal | (group == MICROFACET_PURE) | is_bounded;
    int is_mixed        = group == MICROFACET_MIXED;
    int clear           = p.F.kind == FRESNEL_CONDUCTOR ? FRESNEL_SCHLICK : p.F.kind; /* says that it is none */
    int other           = is_usual ? FRESNEL_SCHLICK : (is_rare | is_bounded ? p.F.kind : clear);
    microfacet_params q = p;
    q.is_ggx            = is_ggx;
    q.d.kind            = is_ggx ? NDF_GGX : p.d.kind;
    q.d.masking         = is_rare | ((is_ndf | is_mixed) & !is_ggx) ? p.d.masking : MASKING_EXACT;
    int drawn           = is_ndf ? SAMPLING_NDF : (is_bounded ? SAMPLING_BOUNDED : SAMPLING_VNDF);
    q.sampling          = is_rare ? p.sampling : drawn;
    q.F.kind            = is_metal ? FRESNEL_CONDUCTOR : other;
    q.g2                = is_usual ? G2_CORRELATED : p.g2;
    q.is_one            = is_one;
    q.has_diffuse       = is_one | is_multi ? 0 : (is_mixed ? 1 : p.has_diffuse);
    q.p_diffuse         = is_one | is_multi ? (real)0 : p.p_diffuse;
    q.ms.kind           = is_energy ? ENERGY_SCALED : (is_multi ? ENERGY_MULTI : ENERGY_SINGLE); /* SCALED: either */
    q.ms.is_isotropic   = is_multi ? 1 : p.ms.is_isotropic;
    return q;
}

#define EACH_VARIANT_microfacet(CASE, name)                                                                            \
    CASE(name, 0)                                                                                                      \
    CASE(name, 1)                                                                                                      \
    CASE(name, 2)                                                                                                      \
    CASE(name, 3)                                                                                                      \
    CASE(name, 4)                                                                                                      \
    CASE(name, 5)                                                                                                      \
    CASE(name, 6)                                                                                                      \
    CASE(name, 7)                                                                                                      \
    CASE(name, 8)                                                                                                      \
    CASE(name, 9)                                                                                                      \
    CASE(name, 10)                                                                                                     \
    CASE(name, 11)                                                                                                     \
    CASE(name, 12) CASE(name, 13) CASE(name, 14) CASE(name, 15) CASE(name, 16)
