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

/* The specular term at a pair of directions, but for Fresnel's. */
typedef struct specular_term {
    real3 m;      /* along wm, of any length */
    real cos_d;   /* wi.wm = wo.wm */
    real D;       /* of wm */
    real drawn_D; /* ... of the normals that samples are made with */
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

/* The term about a given normal m, of any length; cos_d = wo.wm. */
KERNEL specular_term specular_about(distribution d, int g2, real3 wi, real3 wo, real3 m, real cos_d)
{
    specular_term s;
    s.m       = m;
    s.cos_d   = kmin(cos_d, 1);
    s.D       = distribution_D(d, m);
    s.drawn_D = distribution_drawn_D(d, m);
    s.sigma_o = distribution_sigma(d, wo);
    s.rest    = smith_rest(wi.z, wo.z, distribution_sigma(d, wi), s.sigma_o, g2);
    s.inverse = 0.25f/(s.rest*s.sigma_o);
    return s;
}

/* The same about wi + wo, whose length is 2 cos_d. */
KERNEL specular_term specular_at(distribution d, int g2, real3 wi, real3 wo)
{
    real3 h = add3(wi, wo);
    return specular_about(d, g2, wi, wo, h, 0.5f*length3(h));
}

/* D V cos_i */
KERNEL real specular_f(specular_term s, real3 wi) { return s.D*(s.inverse*s.sigma_o)*wi.z; }

/* The density of wi when the normal is drawn from the visible ones, D (wo.wm)/sigma_o over the Jacobian 4 (wo.wm):
 * s.drawn_D*(s.inverse*s.rest) with the sigma_o of the exact masking, whatever masks. */
KERNEL real specular_visible_pdf(distribution d, specular_term s, real3 wo)
{
    return d.masking == MASKING_PUBLISHED ? 0.25f*s.drawn_D/distribution_exact_sigma(d, wo)
                                          : s.drawn_D*(s.inverse*s.rest);
}

/* The same for ggx's bounded ones. */
KERNEL real specular_bounded_pdf(distribution d, specular_term s, real3 wo)
{
    return 0.25f*s.drawn_D/ggx_bounded_sigma(wo, d.alpha_x, d.alpha_y);
}

/* The same for all normals, D cos_m/(4 (wo.wm)).  [cs500, P_r]. */
KERNEL real specular_ndf_pdf(specular_term s)
{
    real cos_d = kmax(s.cos_d, COS_SMALLEST);
    return s.drawn_D*s.m.z/(4*length3(s.m)*cos_d);
}

/* f cos_i of the mixture.  [cs500, EvalScattering]. */
KERNEL real3 microfacet_eval(microfacet_params p, real3 wi, real3 wo)
{
    specular_term s = specular_at(p.d, p.g2, wi, wo);
    real3 single    = scale3(specular_f(s, wi), fresnel_reflectance(p.F, s.cos_d));
    real3 shine     = p.ms.kind == ENERGY_SINGLE ? single : energy_complete(p.ms, single, wi, wo);
    real3 both      = madd3(shine, INV_PI*wi.z, p.kd);
    real3 f         = select3(p.has_diffuse, both, shine);
    return select3(is_above(wi, wo), f, splat3(0));
}

/* Whether samples are ggx's bounded ones. */
KERNEL int microfacet_is_bounded(microfacet_params p)
{
    return (p.d.kind == NDF_GGX) & (p.sampling == SAMPLING_BOUNDED);
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
KERNEL real microfacet_pdf(microfacet_params p, real3 wi, real3 wo)
{
    specular_term s = specular_at(p.d, p.g2, wi, wo);
    real all        = specular_ndf_pdf(s);
    real visible    = specular_visible_pdf(p.d, s, wo);
    real bounded    = specular_bounded_pdf(p.d, s, wo);
    real seen       = microfacet_is_bounded(p) ? bounded : visible;
    real single     = p.sampling == SAMPLING_NDF ? all : seen;
    real p_multi    = microfacet_p_multi(p, wo);
    real P_r        = p.ms.kind == ENERGY_SINGLE ? single : mix(single, energy_pdf(p.ms, wi), p_multi);
    real both       = p.p_diffuse*(INV_PI*wi.z) + (1 - p.p_diffuse)*P_r;
    real pdf        = p.has_diffuse ? both : P_r;
    return keep_if(is_above(wi, wo), pdf);
}

/* A mirror direction about a visible normal, exact masking and no Lambertian term: the weight is F G2/G1(wo), with the
 * bounded sigma for G1's, without D, which cancels.  The density is that of the normal drawn, exact where wi's
 * rounding would blur it. */
KERNEL bsdf_sample microfacet_sample_visible(microfacet_params p, real3 wo, real3 m)
{
    real towards    = dot3(wo, m);
    real ratio      = towards/dot3(m, m);
    real3 wi        = sub3(scale3(2*ratio, m), wo);
    specular_term s = specular_about(p.d, p.g2, wi, wo, m, ksqrt(kmax(ratio*towards, 0)));
    real sigma      = microfacet_is_bounded(p) ? ggx_bounded_sigma(wo, p.d.alpha_x, p.d.alpha_y) : s.sigma_o;
    real3 weight    = scale3(sigma*wi.z/s.rest, fresnel_reflectance(p.F, s.cos_d));
    real pdf        = 0.25f*s.D/sigma;
    int is_valid    = is_above(wi, wo) & (towards > 0) & (pdf > REAL_MIN);
    return complete_sample(wi, weight, pdf, is_valid, LOBE_REFLECTION | LOBE_GLOSSY);
}

/* A direction of the mixture: the cosine direction, one of several bounces, or wo mirrored about a normal.
 * [cs500, SampleBrdf]. */
KERNEL bsdf_sample microfacet_sample_mixture(microfacet_params p, real3 wo, real3 u, real3 m)
{
    int is_diffuse = u.z < p.p_diffuse;
    int is_multi   = (p.ms.kind != ENERGY_SINGLE) & !is_diffuse & (microfacet_mirror_number(p, wo, u.z) < 0);
    real3 mirrored = select3(is_multi, energy_sample(p.ms, u.x, u.y), reflect(wo, m));
    real3 wi       = select3(is_diffuse, sample_cosine(u.x, u.y), mirrored);
    real pdf       = microfacet_pdf(p, wi, wo);
    int is_valid   = (pdf > REAL_MIN) & (is_diffuse | is_multi | (dot3(wo, m) > 0));
    real inv       = 1/(is_valid ? pdf : (real)1);
    return complete_sample(wi, scale3(inv, microfacet_eval(p, wi, wo)), pdf, is_valid,
                           LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY));
}

/* The sample about a normal that is already drawn. */
KERNEL bsdf_sample microfacet_sample_about(microfacet_params p, real3 wo, real3 u, real3 m)
{
    return p.is_one ? microfacet_sample_visible(p, wo, m) : microfacet_sample_mixture(p, wo, u, m);
}

KERNEL bsdf_sample microfacet_sample(microfacet_params p, real3 wo, real3 u)
{
    real3 visible = distribution_sample_vndf(p.d, wo, u.x, u.y, microfacet_mirror_number(p, wo, u.z));
    real3 bounded = ggx_sample_bounded(wo, u.x, u.y, p.d.alpha_x, p.d.alpha_y);
    real3 seen    = select3(microfacet_is_bounded(p), bounded, visible);
    real3 m       = select3(p.sampling == SAMPLING_NDF, distribution_sample_ndf(p.d, u.x, u.y), seen);
    return microfacet_sample_about(p, wo, u, m);
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

/* The loops are compiled once for each distribution and each of these groups of settings, so that what is the same for
 * a whole material is not chosen per element.  Compiling takes long: only GGX, where Fresnel's term weighs, has them
 * all; the others take PURE for METAL, and RARE for MIXED; Beckmann and Phong also PURE for USUAL. */
#define MICROFACET_USUAL     0 /* as PURE, with Schlick's Fresnel and correlated masking */
#define MICROFACET_METAL     1 /* as PURE, of a conductor, whose Fresnel term costs more than all the rest */
#define MICROFACET_MIXED     2 /* as PURE, over a Lambertian term; no conductor */
#define MICROFACET_PURE      3 /* one lobe: visible normals, exact masking (GGX: no conductor, not bounded) */
#define MICROFACET_NDF       4 /* all normals, exact masking; no conductor */
#define MICROFACET_PUBLISHED 5 /* all normals, the masking that the paper prints; no conductor */
#define MICROFACET_RARE      6 /* everything else, Disney's anisotropic gtr too; chooses as it runs */
#define MICROFACET_MULTI     7 /* GGX and GTR as USUAL, isotropic, with the lobe of several bounces */
#define MICROFACET_ENERGY    8 /* all else with that lobe, or scaled; chooses as it runs */
#define MICROFACET_BOUNDED   9 /* GGX as PURE, with bounded normals */
#define MICROFACET_GROUPS    10

KERNEL int microfacet_variant(microfacet_params p)
{
    int is_ggx       = p.d.kind == NDF_GGX;
    int is_metal     = p.F.kind == FRESNEL_CONDUCTOR;
    int is_published = p.d.masking == MASKING_PUBLISHED;
    int is_usual     = (is_ggx | (p.d.kind == NDF_GTR)) & (p.F.kind == FRESNEL_SCHLICK) & (p.g2 == G2_CORRELATED);
    int one          = (is_metal & is_ggx) ? MICROFACET_METAL : (is_usual ? MICROFACET_USUAL : MICROFACET_PURE);
    int all      = (is_published & !is_ggx) ? MICROFACET_PUBLISHED : (is_published ? MICROFACET_RARE : MICROFACET_NDF);
    int visible  = (is_ggx & !is_published) ? MICROFACET_MIXED : MICROFACET_RARE;
    int several  = (is_metal | distribution_is_disney(p.d)) ? MICROFACET_RARE
                                                            : (p.sampling == SAMPLING_NDF ? all : visible);
    int single   = p.is_one ? one : several;
    int is_multi = is_usual & (p.ms.kind == ENERGY_MULTI) & p.ms.is_isotropic & !p.has_diffuse & !is_published &
                   (p.sampling == SAMPLING_VNDF) & !distribution_is_disney(p.d);
    int bounces = is_multi ? MICROFACET_MULTI : MICROFACET_ENERGY;
    int seen    = (p.is_one & microfacet_is_bounded(p)) ? MICROFACET_BOUNDED : single;
    return MICROFACET_GROUPS*p.d.kind + (p.ms.kind == ENERGY_SINGLE ? seen : bounces);
}

/* p with the fields that are the same throughout a variant set to constants. */
KERNEL microfacet_params microfacet_fix(microfacet_params p, int variant)
{
    int group      = variant%MICROFACET_GROUPS;
    int kind       = variant/MICROFACET_GROUPS;
    int is_multi   = group == MICROFACET_MULTI;
    int is_usual   = (group == MICROFACET_USUAL) | is_multi;
    int is_metal   = group == MICROFACET_METAL;
    int is_bounded = group == MICROFACET_BOUNDED;
    int is_one     = (is_usual & !is_multi) | is_metal | is_bounded | (group == MICROFACET_PURE);
    int is_energy  = group == MICROFACET_ENERGY;
    int is_any = (group == MICROFACET_RARE) | is_energy | is_bounded | ((group == MICROFACET_PURE) & (kind != NDF_GGX));
    int is_rare         = (group == MICROFACET_RARE) | is_energy;
    int is_published    = group == MICROFACET_PUBLISHED;
    int is_all          = is_published | (group == MICROFACET_NDF);
    int clear           = p.F.kind == FRESNEL_CONDUCTOR ? FRESNEL_SCHLICK : p.F.kind; /* says that it is none */
    int other           = is_usual ? FRESNEL_SCHLICK : (is_any ? p.F.kind : clear);
    microfacet_params q = p;
    q.d.kind            = kind;
    q.d.gtr.anisotropy  = is_rare ? p.d.gtr.anisotropy : GTR_STRETCHED;
    q.d.masking         = is_rare ? p.d.masking : (is_published ? MASKING_PUBLISHED : MASKING_EXACT);
    int drawn           = is_all ? SAMPLING_NDF : (is_bounded ? SAMPLING_BOUNDED : SAMPLING_VNDF);
    q.sampling          = is_rare ? p.sampling : drawn;
    q.F.kind            = is_metal ? FRESNEL_CONDUCTOR : other;
    q.g2                = is_usual ? G2_CORRELATED : p.g2;
    q.is_one            = is_one;
    q.has_diffuse       = is_one | is_multi ? 0 : (group == MICROFACET_MIXED ? 1 : p.has_diffuse);
    q.p_diffuse         = is_multi ? (real)0 : p.p_diffuse;
    q.ms.kind           = is_energy ? ENERGY_SCALED : (is_multi ? ENERGY_MULTI : ENERGY_SINGLE); /* SCALED: either */
    q.ms.is_isotropic   = is_multi ? 1 : p.ms.is_isotropic;
    return q;
}

/* Of the variants, those that microfacet_variant gives: of ggx, beckmann, phong and gtr. */
#define EACH_VARIANT_microfacet(CASE, name)                                                                            \
    CASE(name, 0)                                                                                                      \
    CASE(name, 1)                                                                                                      \
    CASE(name, 2)                                                                                                      \
    CASE(name, 3)                                                                                                      \
    CASE(name, 4)                                                                                                      \
    CASE(name, 6)                                                                                                      \
    CASE(name, 7)                                                                                                      \
    CASE(name, 8)                                                                                                      \
    CASE(name, 9)                                                                                                      \
    CASE(name, 13)                                                                                                     \
    CASE(name, 14)                                                                                                     \
    CASE(name, 15)                                                                                                     \
    CASE(name, 16)                                                                                                     \
    CASE(name, 18)                                                                                                     \
    CASE(name, 23)                                                                                                     \
    CASE(name, 24)                                                                                                     \
    CASE(name, 25)                                                                                                     \
    CASE(name, 26)                                                                                                     \
    CASE(name, 28)                                                                                                     \
    CASE(name, 30)                                                                                                     \
    CASE(name, 33)                                                                                                     \
    CASE(name, 34)                                                                                                     \
    CASE(name, 35)                                                                                                     \
    CASE(name, 36)                                                                                                     \
    CASE(name, 37)                                                                                                     \
    CASE(name, 38)
