/* microfacet.h: what every reflecting microfacet model shares: the record of parameters, the half vector,
 * masking-shadowing from Lambda, Fresnel, and the mixture of a Lambertian and a specular lobe.
 *
 * f(wi,wo) = kd/pi + D(wm) G2(wi,wo) F(wi.wm) / (4 cos_i cos_o)                        [cs500, BRDF]
 *
 * [cs500]   CS500 Project 3: EvalScattering, PdfBrdf, SampleBrdf.
 * [heitz14] Heitz, Understanding the masking-shadowing function in microfacet-based BRDFs, JCGT 2014.
 *
 * Departures from [cs500]: everything is 0 unless wi and wo are above the horizon; a half vector behind
 * wo gives no sample; G2 is height-correlated by default ([heitz14, eq. 99]) and `separable` as printed.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "fresnel.h"
#include "kmath.h"
#include "real.h"

/* The order of the choices in the parameter tables. */
#define G2_CORRELATED      0
#define G2_SEPARABLE       1
#define MASKING_EXACT      0
#define MASKING_PUBLISHED  1
#define SAMPLING_VNDF      0
#define SAMPLING_NDF       1
#define FRESNEL_SCHLICK    0
#define FRESNEL_DIELECTRIC 1

/* What a sample is; the same numbers as FACET_REFLECTION, ... of facet.h. */
#define LOBE_REFLECTION   1
#define LOBE_TRANSMISSION 2
#define LOBE_DIFFUSE      4
#define LOBE_GLOSSY       8
#define LOBE_DELTA        16

/* Cotangents are kept inside [2^-60, 2^60], whose squares are normal numbers in float as well; a cosine
 * of 2^-30 is as good as 0 for every alpha in range. */
#define COT_LARGEST  1152921504606846976.0f
#define COT_SMALLEST (1/COT_LARGEST)
#define COS_SMALLEST (1/1073741824.0f)

/* The least roughness; below it a mirror is meant. */
#define ALPHA_SMALLEST ((real)1e-4)

/* The parameters of a distribution with a Lambertian term, prepared. */
typedef struct microfacet_params {
    real3 kd;     /* diffuse reflectance */
    real3 F0;     /* Schlick: reflectance at normal incidence */
    real eta;     /* dielectric: n inside / n outside */
    real alpha_x; /* roughness along x and y; for phong the stretch of slopes, 1 when isotropic */
    real alpha_y;
    real exponent;     /* phong */
    real beta_inverse; /* phong: 1/B(1/2, exponent/2 + 1) */
    real p_diffuse;    /* probability of choosing the Lambertian lobe */
    int fresnel, g2, masking, sampling;
} microfacet_params;

/* A direction drawn for wo; pdf == 0: none. */
typedef struct bsdf_sample {
    real3 wi;
    real pdf;
    real3 weight;
    int lobe;
    real eta; /* index of refraction on wi's side over that on wo's; 1 unless the sample refracts */
} bsdf_sample;

/* (wi + wo)/|wi + wo|; the normal where the two cancel. */
KERNEL real3 half_vector(real3 wi, real3 wo)
{
    real3 sum = add3(wi, wo);
    real len2 = dot3(sum, sum);
    real inv  = 1/ksqrt(kmax(len2, REAL_MIN));
    real3 n   = make3(0, 0, 1);
    return select3(len2 > REAL_MIN, scale3(inv, sum), n);
}

/* wo mirrored about wm.  [cs500, SampleBrdf], without the absolute value. */
KERNEL real3 reflect(real3 wo, real3 wm) { return sub3(scale3(2*dot3(wo, wm), wm), wo); }

/* cot(theta) of v after the slopes are divided by (alpha_x, alpha_y): the only thing about a direction that
 * the masking of a stretched isotropic distribution depends on.  [heitz14, section 5.3].  In [0, inf). */
KERNEL real stretched_cot(real3 v, real alpha_x, real alpha_y)
{
    real x   = alpha_x*v.x;
    real y   = alpha_y*v.y;
    real sin = ksqrt(x*x + y*y);
    return kabs(v.z)/kmax(sin, REAL_MIN);
}

/* The normal with slopes (sx, sy): (sx, sy, 1) normalised. */
KERNEL real3 normal_of_slopes(real sx, real sy)
{
    real inv = 1/ksqrt(sx*sx + sy*sy + 1);
    return make3(sx*inv, sy*inv, inv);
}

/* Whether both directions are above the horizon.  A cosine of COS_SMALLEST counts as 0, so that quotients by it stay
 * finite. */
KERNEL int is_above(real3 wi, real3 wo) { return (wi.z > COS_SMALLEST) & (wo.z > COS_SMALLEST); }

/* Masking and shadowing together.  correlated: 1/(1 + Li + Lo), [heitz14, eq. 99]; separable: G1(wi) G1(wo),
 * [cs500, "smith method"]. */
KERNEL real smith_G2(real Lambda_i, real Lambda_o, int g2)
{
    return g2 == G2_SEPARABLE ? 1/((1 + Lambda_i)*(1 + Lambda_o)) : 1/(1 + Lambda_i + Lambda_o);
}

KERNEL real3 microfacet_fresnel(microfacet_params p, real c)
{
    real F = fresnel_dielectric(c, p.eta);
    return select3(p.fresnel == FRESNEL_DIELECTRIC, make3(F, F, F), fresnel_schlick(p.F0, make3(1, 1, 1), c));
}

/* f cos_i of the mixture.  [cs500, EvalScattering]; cos_i of the numerator cancels that of the specular
 * term's denominator. */
KERNEL real3 microfacet_eval(microfacet_params p, real3 wi, real3 wo, real3 wm, real D, real Lambda_i, real Lambda_o)
{
    real specular = D*smith_G2(Lambda_i, Lambda_o, p.g2)/(4*kmax(wo.z, COS_SMALLEST));
    real3 F       = microfacet_fresnel(p, kmin(kabs(dot3(wi, wm)), 1));
    real3 f       = add3(scale3(INV_PI*wi.z, p.kd), scale3(specular, F));
    return select3(is_above(wi, wo), f, splat3(0));
}

/* Density of the mixture's sampler.  [cs500, PdfBrdf]: p_d P_d + p_r P_r, where P_r is the density of
 * visible normals D G1(wo) (wo.wm)/cos_o, or of all normals D cos_m, over the Jacobian 4 (wo.wm). */
KERNEL real microfacet_pdf(microfacet_params p, real3 wi, real3 wo, real3 wm, real D, real Lambda_o)
{
    real visible  = D/(4*kmax(wo.z, COS_SMALLEST)*(1 + Lambda_o));
    real cos_om   = kmax(dot3(wo, wm), kmax(0.5f*(wi.z + wo.z), COS_SMALLEST));
    real all      = D*wm.z/(4*cos_om);
    real specular = p.sampling == SAMPLING_NDF ? all : visible;
    real pdf      = p.p_diffuse*INV_PI*wi.z + (1 - p.p_diffuse)*specular;
    return is_above(wi, wo) ? pdf : (real)0;
}

/* Cosine-distributed direction.  [cs500, SampleBrdf, diffuse]: cos = sqrt(u.x), azimuth 2 pi u.y. */
KERNEL real3 sample_cosine(real ux, real uy)
{
    real2 azimuth = kcossin_turn(uy);
    real sin      = ksqrt(kmax(1 - ux, 0));
    return make3(sin*azimuth.x, sin*azimuth.y, ksqrt(ux));
}

/* wi from the chosen lobe: the cosine direction, or wo mirrored about wm. */
KERNEL real3 microfacet_choose(microfacet_params p, real3 wo, real3 wm, real3 u)
{
    return select3(u.z < p.p_diffuse, sample_cosine(u.x, u.y), reflect(wo, wm));
}

/* Completes a sample from its direction, f cos and pdf; none below the horizon or behind wm. */
KERNEL bsdf_sample microfacet_complete(microfacet_params p, real3 wi, real3 wo, real3 wm, real3 u, real3 f, real pdf)
{
    int is_diffuse = u.z < p.p_diffuse;
    int is_valid   = (pdf > REAL_MIN) & is_above(wi, wo) & (is_diffuse | (dot3(wo, wm) > 0));
    real inv       = 1/(is_valid ? pdf : (real)1);
    bsdf_sample s;
    s.wi     = select3(is_valid, wi, make3(0, 0, 1));
    s.pdf    = is_valid ? pdf : (real)0;
    s.weight = select3(is_valid, scale3(inv, f), splat3(0));
    s.lobe   = LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY);
    s.eta    = 1;
    return s;
}

/* What the mixture's samples can be. */
KERNEL int microfacet_lobes(microfacet_params p)
{
    return LOBE_REFLECTION | LOBE_GLOSSY | (p.p_diffuse > 0 ? LOBE_DIFFUSE : 0);
}

#ifdef FACET_PARAMETERS
/* The rows that every distribution of normals ends with. */
#define MICROFACET_PARAMETERS(SAMPLING_CHOICES, SAMPLING_LAST)                                                         \
    {"kd", FACET_COLOUR, 0, 1, {0, 0, 0}, "1", "", "Lambertian term that is added"},                                   \
        {"ks", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "reflectance at normal incidence (Schlick's Fresnel)"},         \
        {"ior",       FACET_NUMBER, 0.1, 10,                                                                           \
         {1.5, 0, 0}, "1",          "",  "index of refraction (exact dielectric Fresnel), not with ks"},               \
        {"g2", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "correlated|separable", "masking-shadowing: 1/(1+Li+Lo) or G1 G1"}, \
        {"masking",                                                                                                    \
         FACET_CHOICE,                                                                                                 \
         0,                                                                                                            \
         1,                                                                                                            \
         {0, 0, 0},                                                                                                    \
         "1",                                                                                                          \
         "exact|published",                                                                                            \
         "Smith's G1, or the fit that the paper prints"},                                                              \
    {                                                                                                                  \
        "sampling", FACET_CHOICE, 0, SAMPLING_LAST, {0, 0, 0}, "1", SAMPLING_CHOICES,                                  \
            "normals that samples are drawn from"                                                                      \
    }
#define ALPHA_PARAMETERS                                                                                               \
    {"alpha", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along both tangents"},                           \
        {"alpha_x", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along the tangent x, not with alpha"},     \
    {                                                                                                                  \
        "alpha_y", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along the bitangent y, not with alpha"      \
    }
#endif

#ifdef FACET_PREPARE
static real3 prepare_colour(const facet_material *m, const char *name)
{
    return make3((real)facet_material_value(m, name, 0), (real)facet_material_value(m, name, 1),
                 (real)facet_material_value(m, name, 2));
}

static real prepare_number(const facet_material *m, const char *name) { return (real)facet_material_value(m, name, 0); }

static int prepare_choice(const facet_material *m, const char *name) { return (int)facet_material_value(m, name, 0); }

/* Everything but the distribution's own shape.  The lobe is chosen as [cs500, SampleBrdf] says, by
 * |Kd|/(|Kd| + |Ks|); departure: a specular lobe keeps a probability of 1/8, because Fresnel's term is
 * not 0 at grazing angles when Ks is. */
static microfacet_params microfacet_prepare(const facet_material *m)
{
    microfacet_params p = {
        .kd = prepare_colour(m, "kd"), .F0 = prepare_colour(m, "ks"), .eta = prepare_number(m, "ior")};
    p.fresnel     = facet_material_given(m, "ior") ? FRESNEL_DIELECTRIC : FRESNEL_SCHLICK;
    p.g2          = prepare_choice(m, "g2");
    p.masking     = prepare_choice(m, "masking");
    p.sampling    = prepare_choice(m, "sampling");
    p.alpha_x     = 1;
    p.alpha_y     = 1;
    const real kd = length3(p.kd);
    const real ks = p.fresnel == FRESNEL_DIELECTRIC ? length3(splat3(fresnel_normal_incidence(p.eta))) : length3(p.F0);
    p.p_diffuse   = kd > 0 ? kmin(kd/(kd + ks), 0.875f) : (real)0;
    return p;
}

static void alpha_prepare(const facet_material *m, microfacet_params *p)
{
    const real alpha = prepare_number(m, "alpha");
    p->alpha_x       = facet_material_given(m, "alpha_x") ? prepare_number(m, "alpha_x") : alpha;
    p->alpha_y       = facet_material_given(m, "alpha_y") ? prepare_number(m, "alpha_y") : alpha;
}
#endif
