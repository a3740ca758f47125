/* disney.h: Disney's principled BRDF of 2012 with the addenda of 2014.
 *
 * [burley12] Burley, Physically-based shading at Disney, SIGGRAPH 2012 course notes, version 3 (2014): section 5 (the
 *            lobes), appendix B (GTR) and the addenda (anisotropy, sheen, Smith's G without the remap).
 * [dupuy23]  Dupuy and Benyoub, Sampling visible GGX normals with spherical caps, CGF 2023.
 *
 *     f = (1 - metallic)(base/pi mix(Fd, ss, subsurface) + Fsheen) + Ds Gs Fs/(4 cos_i cos_o)
 *         + clearcoat/4 Dr Gr Fr/(4 cos_i cos_o)
 *
 * Letters are those of the notes: d, l, v and h are half vector, wi, wo and wm; theta_d is the angle of wi to wm.
 * Departures: base_color is linear; alpha is 1e-4 at least; the clearcoat's G is the notes' (GGX of alpha 1/4) or
 * GTR1's own (coat_masking=exact); the sampler draws visible normals.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "bsdf.h"
#include "ggx.h"
#include "gtr1.h"
#include "microfacet.h"

/* The clearcoat's masking, in the order of the choices in the parameter table; or no clearcoat. */
#define COAT_ADHOC 0
#define COAT_EXACT 1
#define COAT_NONE  2

#define COAT_ALPHA_DULL   ((real)0.1)   /* clearcoat_gloss = 0 */
#define COAT_ALPHA_GLOSSY ((real)0.001) /* clearcoat_gloss = 1 */
#define COAT_F0           ((real)0.04)  /* index 1.5 */
#define COAT_G_ALPHA      0.25f

/* The user's parameters at one point, all in [0,1]. */
typedef struct disney_point {
    real3 base_color;
    real subsurface, metallic, specular, specular_tint, roughness, anisotropic, sheen, sheen_tint, clearcoat,
        clearcoat_gloss;
} disney_point;

typedef struct disney_params {
    real3 kd;              /* (1 - metallic) base_color */
    real3 Csheen;          /* (1 - metallic) sheen times its tint */
    real3 Cspec0;          /* specular reflectance at normal incidence */
    real roughness;        /* of the diffuse terms */
    real subsurface;       /* blend from Fd to ss */
    real alpha_x, alpha_y; /* of Ds and Gs */
    real coat;             /* clearcoat/4 */
    gtr1 Dr;               /* the clearcoat's distribution */
    int coat_kind, g2;     /* COAT_NONE if and only if clearcoat is 0 */
} disney_params;

/* The colour's hue and saturation: divided by its luminance, as the notes approximate that; white for black. */
KERNEL real3 disney_Ctint(real3 base)
{
    real luminance = (real)0.3*base.x + (real)0.6*base.y + (real)0.1*base.z;
    return select3(luminance > REAL_MIN, scale3(1/kmax(luminance, REAL_MIN), base), splat3(1));
}

/* [burley12, section 5, and addenda: aspect, alpha_x, alpha_y].  alpha_x/alpha_y is 10 at most, alpha_x 3.162. */
KERNEL disney_params disney_of(disney_point m, int coat_masking, int g2)
{
    real3 Ctint    = disney_Ctint(m.base_color);
    real3 white    = splat3(1);
    real3 Cdiel    = scale3((real)0.08*m.specular, mix3(white, Ctint, m.specular_tint));
    real aspect    = ksqrt(1 - (real)0.9*m.anisotropic);
    real roughness = m.roughness*m.roughness;
    disney_params p;
    p.kd         = scale3(1 - m.metallic, m.base_color);
    p.Csheen     = scale3((1 - m.metallic)*m.sheen, mix3(white, Ctint, m.sheen_tint));
    p.Cspec0     = mix3(Cdiel, m.base_color, m.metallic);
    p.roughness  = m.roughness;
    p.subsurface = m.subsurface;
    p.alpha_x    = kmax(roughness/aspect, ALPHA_SMALLEST);
    p.alpha_y    = kmax(roughness*aspect, ALPHA_SMALLEST);
    p.coat       = 0.25f*m.clearcoat;
    p.Dr         = gtr1_of(mix(COAT_ALPHA_DULL, COAT_ALPHA_GLOSSY, m.clearcoat_gloss));
    p.coat_kind  = p.coat > 0 ? coat_masking : COAT_NONE;
    p.g2         = g2;
    return p;
}

/* cos(theta_d) = |wi + wo|/2, the same for both directions. */
KERNEL real disney_cos_d(real3 wi, real3 wo) { return kmin(0.5f*length3(add3(wi, wo)), 1); }

/* FH = (1 - cos(theta_d))^5.  Departure: 1 - cos_d is written |wi - wo|^2/(4 (1 + cos_d)), which does not cancel where
 * light returns. */
KERNEL real disney_FH(real3 wi, real3 wo)
{
    real3 d = sub3(wi, wo);
    return kpow5(kmin(0.25f*dot3(d, d)/(1 + disney_cos_d(wi, wo)), 1));
}

/* (1 + (F90 - 1)(1 - cos_i)^5)(1 + (F90 - 1)(1 - cos_o)^5) */
KERNEL real disney_schlick_both(real F90, real cos_i, real cos_o)
{
    return (1 + (F90 - 1)*kpow5(kmax(1 - cos_i, 0)))*(1 + (F90 - 1)*kpow5(kmax(1 - cos_o, 0)));
}

/* Diffuse with retro-reflection at grazing angles, over base/pi.  [burley12, section 5.3]: FD90 = 1/2 + 2 roughness
 * cos_d^2. */
KERNEL real disney_Fd(real roughness, real cos_i, real cos_o, real cos_d)
{
    return disney_schlick_both(0.5f + 2*roughness*cos_d*cos_d, cos_i, cos_o);
}

/* The flat look of subsurface scattering, after Hanrahan and Krueger, over base/pi.  [burley12, section 5.3 and its
 * published code]: 5/4 (Fss (1/(cos_i + cos_o) - 1/2) + 1/2), Fss90 = roughness cos_d^2. */
KERNEL real disney_ss(real roughness, real cos_i, real cos_o, real cos_d)
{
    real Fss = disney_schlick_both(roughness*cos_d*cos_d, cos_i, cos_o);
    return 1.25f*(Fss*(1/kmax(cos_i + cos_o, COS_SMALLEST) - 0.5f) + 0.5f);
}

/* f of the diffuse and sheen lobes, 1/sr. */
KERNEL real3 disney_base(disney_params p, real3 wi, real3 wo)
{
    real cos_d   = disney_cos_d(wi, wo);
    real Fd      = disney_Fd(p.roughness, wi.z, wo.z, cos_d);
    real ss      = disney_ss(p.roughness, wi.z, wo.z, cos_d);
    real3 Fsheen = scale3(disney_FH(wi, wo), p.Csheen);
    return madd3(Fsheen, INV_PI*mix(Fd, ss, p.subsurface), p.kd);
}

/* The projected area that masks the clearcoat, cos (1 + Lambda). */
KERNEL real disney_coat_sigma(disney_params p, real3 v)
{
    return p.coat_kind == COAT_EXACT ? gtr1_sigma(p.Dr, v) : ggx_sigma(v, COAT_G_ALPHA, COAT_G_ALPHA);
}

/* f of the primary specular lobe, Ds Gs Fs/(4 cos_i cos_o). */
KERNEL real3 disney_specular(disney_params p, real3 wi, real3 wo)
{
    real Ds      = ggx_D(add3(wi, wo), p.alpha_x, p.alpha_y);
    real sigma_i = ggx_sigma(wi, p.alpha_x, p.alpha_y);
    real sigma_o = ggx_sigma(wo, p.alpha_x, p.alpha_y);
    real3 Fs     = mix3(p.Cspec0, splat3(1), disney_FH(wi, wo));
    return scale3(0.25f*Ds/smith_rest(wi.z, wo.z, sigma_i, sigma_o, p.g2), Fs);
}

/* f of the clearcoat, clearcoat/4 Dr Gr Fr/(4 cos_i cos_o).  The notes' G is separable whatever g2 says. */
KERNEL real disney_coat(disney_params p, real3 wi, real3 wo)
{
    real Dr   = gtr1_D(p.Dr, add3(wi, wo));
    int g2    = p.coat_kind == COAT_EXACT ? p.g2 : G2_SEPARABLE;
    real rest = smith_rest(wi.z, wo.z, disney_coat_sigma(p, wi), disney_coat_sigma(p, wo), g2);
    real Fr   = mix(COAT_F0, 1, disney_FH(wi, wo));
    return p.coat_kind == COAT_NONE ? (real)0 : 0.25f*p.coat*Dr*Fr/rest;
}

/* f cos_i, 1/sr. */
KERNEL real3 disney_eval(disney_params p, real3 wi, real3 wo)
{
    real3 gloss = add3(disney_specular(p, wi, wo), splat3(disney_coat(p, wi, wo)));
    real3 f     = add3(gloss, disney_base(p, wi, wo));
    return select3(is_above(wi, wo), scale3(wi.z, f), splat3(0));
}

/* ---- The sampler: u.z chooses the lobe ---------------------------------------------------------- */

/* The probability of the diffuse lobe and of the clearcoat; the rest is the specular lobe's. */
typedef struct disney_shares {
    real diffuse, coat;
} disney_shares;

#define DISNEY_SHARE_LEAST 0.0625f /* of a lobe that is there, so that none is starved */

/* In proportion to estimates of the three albedos: Fresnel's terms at wo, and kd.  Sheen reflects .09 of its colour at
 * most: an estimate of it changes no noise by 5 %. */
KERNEL disney_shares disney_shares_of(disney_params p, real3 wo)
{
    real FV       = kpow5(ksaturate(1 - wo.z));
    real diffuse  = mean3(p.kd);
    real specular = mix(mean3(p.Cspec0), 1, FV);
    real coat     = p.coat*mix(COAT_F0, 1, FV);
    int is_base   = max_of3(p.kd) + max_of3(p.Csheen) > 0;
    int is_coat   = p.coat_kind != COAT_NONE;
    real free     = 1 - DISNEY_SHARE_LEAST*(real)(1 + is_base + is_coat);
    real unit     = free/kmax(diffuse + specular + coat, REAL_MIN);
    disney_shares s;
    s.diffuse = is_base ? DISNEY_SHARE_LEAST + unit*diffuse : (real)0;
    s.coat    = is_coat ? DISNEY_SHARE_LEAST + unit*coat : (real)0;
    return s;
}

/* The diffuse lobe is drawn with density (b + 2 (1 - b) cos_i)/(2 pi), between the cosine (b = 0) and uniform (b = 1):
 * the base is flatter than a cosine at grazing angles, and the more so the more subsurface. */
KERNEL real disney_flatness(disney_params p) { return mix(0.0625f, 0.25f, p.subsurface); }

/* That density's direction: b cos + (1 - b) cos^2 = u.x. */
KERNEL real3 disney_sample_base(disney_params p, real ux, real uy)
{
    real b        = disney_flatness(p);
    real2 azimuth = kcossin_turn(uy);
    real z        = kmin(2*ux/(b + ksqrt(b*b + 4*(1 - b)*ux)), 1);
    real sin      = ksqrt((1 - z)*(1 + z));
    return make3(sin*azimuth.x, sin*azimuth.y, z);
}

/* Density of the sampler, 1/sr: of the base, and of wo mirrored about visible normals, D/(4 sigma(wo)), which holds
 * the Jacobian 1/(4 wo.wm). */
KERNEL real disney_pdf(disney_params p, real3 wi, real3 wo)
{
    real3 h         = add3(wi, wo);
    disney_shares s = disney_shares_of(p, wo);
    real b          = disney_flatness(p);
    real base       = INV_TWO_PI*(b + 2*(1 - b)*wi.z);
    real specular   = ggx_D(h, p.alpha_x, p.alpha_y)/ggx_sigma(wo, p.alpha_x, p.alpha_y);
    real coat       = p.coat_kind == COAT_NONE ? (real)0 : gtr1_D(p.Dr, h)/gtr1_sigma(p.Dr, wo);
    real gloss      = (1 - s.coat - s.diffuse)*specular + s.coat*coat;
    return keep_if(is_above(wi, wo), s.diffuse*base + 0.25f*gloss);
}

/* The normal of the specular lobe or the clearcoat, by spherical caps [dupuy23]: the clearcoat's from one GGX of the
 * mixture that it is, chosen by what u.z has left over. */
KERNEL real3 disney_sample_normal(disney_params p, disney_shares s, real3 wo, real3 u)
{
    int is_coat = (p.coat_kind != COAT_NONE) & (u.z >= 1 - s.coat);
    real rest   = ksaturate((u.z - (1 - s.coat))/kmax(s.coat, REAL_MIN));
    real alpha  = gtr1_visible_alpha(p.Dr, wo, rest);
    return ggx_sample_vndf(wo, u.x, u.y, is_coat ? alpha : p.alpha_x, is_coat ? alpha : p.alpha_y);
}

KERNEL bsdf_sample disney_sample(disney_params p, real3 wo, real3 u)
{
    disney_shares shares = disney_shares_of(p, wo);
    real3 m              = disney_sample_normal(p, shares, wo, u);
    int is_diffuse       = u.z < shares.diffuse;
    real3 wi             = select3(is_diffuse, disney_sample_base(p, u.x, u.y), reflect(wo, m));
    real pdf             = disney_pdf(p, wi, wo);
    int is_valid         = (pdf > REAL_MIN) & (is_diffuse | (dot3(wo, m) > 0));
    real inv             = 1/(is_valid ? pdf : (real)1);
    return complete_sample(wi, scale3(inv, disney_eval(p, wi, wo)), pdf, is_valid,
                           LOBE_REFLECTION | (is_diffuse ? LOBE_DIFFUSE : LOBE_GLOSSY));
}

KERNEL int disney_lobes(disney_params p)
{
    int is_base = max_of3(p.kd) + max_of3(p.Csheen) > 0;
    return LOBE_REFLECTION | LOBE_GLOSSY | (is_base ? LOBE_DIFFUSE : 0);
}

/* D, Lambda, G1 of the primary specular lobe at m. */
KERNEL real3 disney_terms(disney_params p, real3 m)
{
    real Lambda = ggx_Lambda(m, p.alpha_x, p.alpha_y);
    return make3(ggx_D(m, p.alpha_x, p.alpha_y), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

/* The loops are compiled without a clearcoat, for either G2, and with a clearcoat, for either masking. */
#define DISNEY_SEPARABLE  0
#define DISNEY_CORRELATED 1
#define DISNEY_COAT       2 /* + coat_kind */

KERNEL int disney_variant(disney_params p)
{
    int bare = p.g2 == G2_SEPARABLE ? DISNEY_SEPARABLE : DISNEY_CORRELATED;
    return p.coat_kind == COAT_NONE ? bare : DISNEY_COAT + p.coat_kind;
}

/* p with the fields that are the same throughout a variant set to constants. */
KERNEL disney_params disney_fix(disney_params p, int variant)
{
    int bare_g2     = variant == DISNEY_SEPARABLE ? G2_SEPARABLE : G2_CORRELATED;
    disney_params q = p;
    q.coat_kind     = variant < DISNEY_COAT ? COAT_NONE : variant - DISNEY_COAT;
    q.g2            = variant < DISNEY_COAT ? bare_g2 : p.g2;
    return q;
}

EVAL_AND_PDF(disney)

#define EACH_VARIANT_disney(CASE, name) CASE(name, 0) CASE(name, 1) CASE(name, 2) CASE(name, 3)
