/* rough_dielectric.h: reflection and refraction by the facets of a rough dielectric interface, for any distribution of
 * normals.
 *
 * [walter07] Walter et al., Microfacet models for refraction through rough surfaces, EGSR 2007.
 * [heitz16]  Heitz, Hanika, d'Eon and Dachsbacher, Multiple-scattering microfacet BSDFs with the Smith model, 2016
 *            (masking and shadowing together, on two sides).
 *
 *     f cos_i = D G2/cos_o F/4                                   wi on wo's side,               [walter07, eq. 20]
 *             = D G2/cos_o (1 - F) (wo.wm)|wi.wm|/|wo + eta wi|^2    on the other,              [walter07, eq. 21]
 *
 * with all cosines positive and eta = n_i/n_o, of wi's side over wo's.  It is the value for radiance, which scales by
 * 1/eta^2 where it is transmitted, as in glass.h: f/n_o^2 is reciprocal, n_i^2 f(wi,wo) = n_o^2 f(wo,wi), and a tracer
 * of importance uses f(wo,wi).  wo.z < 0 means that the viewer is inside; the surface is then turned over.
 *
 * A thin wall is two such interfaces with nothing between: the mirrored lobe carries F' = 2F/(1 + F), and 1 - F' goes
 * through as the same lobe mirrored at the plane of the surface.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "bsdf.h"
#include "distribution.h"
#include "fresnel.h"
#include "glass.h"
#include "microfacet.h"

typedef struct rough_dielectric_params {
    distribution d;
    real eta;   /* n inside / n outside, > 0 */
    real3 tint; /* multiplies what is transmitted */
    int wall, g2, sampling;
} rough_dielectric_params;

/* Below this |eta - 1| alpha the directions of a refracted lobe are not told apart in single precision: the interface
 * is as good as smooth. */
#define LEAST_BEND ((real)1e-6)

/* Whether an interface is rough, and its lobes wide enough to be told from those of glass.h. */
KERNEL int is_rough_interface(real eta, real alpha)
{
    return (alpha >= ALPHA_SMALLEST) & (kabs(eta - 1)*alpha >= LEAST_BEND);
}

/* What lies between two directions: the facets that send light from one to the other. */
typedef struct facet_pair {
    real3 o, i;     /* wo and wi, turned over if need be: wo is above */
    real eta;       /* index on the far side over that on the viewer's */
    int is_through; /* from one side to the other */
    int is_bent;    /* and refracted */
    int is_seen;    /* both directions are off the horizon, and see the outer sides of the facets */
    real3 m;        /* along wm, above, of any length */
    real share;     /* of the light that meets such a facet and goes this way: F or 1 - F */
    real turning;   /* dwm/dwi */
    real cos_o;     /* wo.wm */
    real cos_m;     /* wm.z */
} facet_pair;

/* 1 - F where both cosines are known: (ts^2 + tp^2)/2 times the ratio of the projected areas and of the indices.  The
 * same both ways, and without a root that cancels near total reflection. */
KERNEL real fresnel_transmittance(real cos_o, real cos_i, real eta)
{
    real s = cos_o + eta*cos_i;
    real p = eta*cos_o + cos_i;
    return kmin(2*eta*cos_o*cos_i*(1/(s*s) + 1/(p*p)), 1);
}

/* A wall reflects F, two of them 2F/(1 + F). */
KERNEL real wall_reflectance(int wall, real F) { return wall == WALL_THIN ? 2*F/(1 + F) : F; }

/* n on the far side over n on the viewer's; a thin wall has the outside on both. */
KERNEL real index_ratio(rough_dielectric_params p, real3 wo)
{
    int is_inside = (wo.z < 0) & (p.wall == WALL_SOLID);
    return is_inside ? 1/p.eta : p.eta;
}

/* The half vector is along wo + eta wi [walter07, eqs. 13, 16], with eta = 1 for a mirror; on the upper side, where
 * normals are.  dwm/dwi is 1/(4 wo.wm) [eq. 14] or eta^2 |wi.wm|/|wo + eta wi|^2 [eq. 17]. */
KERNEL facet_pair facets_between(rough_dielectric_params p, real3 wi, real3 wo)
{
    int is_thin    = p.wall == WALL_THIN;
    real turn      = kcopysign(1, wo.z);
    real3 o        = scale3(turn, wo);
    real3 i        = scale3(turn, wi);
    real eta       = index_ratio(p, wo);
    int is_through = i.z < 0;
    int is_bent    = i.z*(is_thin ? (real)0 : (real)1) < 0; /* one comparison, for gcc's vectoriser */
    real3 sum      = madd3(o, is_bent ? eta : (real)1, make3(i.x, i.y, is_thin ? kabs(i.z) : i.z));
    real3 h        = scale3(kcopysign(1, sum.z), sum);
    real inv       = 1/ksqrt(kmax(dot3(h, h), REAL_MIN));
    real half      = kmin(0.5f*dot3(h, h)*inv, 1); /* |wi + wo| = 2 cos_d of a mirror */
    real cos_o     = kmin(dot3(o, h)*inv, 1);
    real cos_i     = kmin(-dot3(i, h)*inv, 1);
    real F         = wall_reflectance(p.wall, fresnel_dielectric(half, eta));
    facet_pair f;
    f.o          = o;
    f.i          = i;
    f.eta        = eta;
    f.is_through = is_through;
    f.is_bent    = is_bent;
    f.is_seen    = kmin(kmin(o.z, kabs(i.z)) - COS_SMALLEST, is_bent ? kmin(cos_o, cos_i) : (real)1) > 0;
    f.m          = h;
    f.share      = is_bent ? fresnel_transmittance(cos_o, cos_i, eta) : (is_through ? 1 - F : F);
    f.turning    = is_bent ? eta*eta*cos_i*inv*inv : 0.5f*inv;
    f.cos_o      = is_bent ? cos_o : half;
    f.cos_m      = h.z*inv;
    return f;
}

/* G2/cos_o.  A facet at the height that a share u of the surface lies below sees out to wo with probability u^Lambda_o;
 * to wi with u^Lambda_i above the surface, (1 - u)^Lambda_i under it.  Over u in [0, 1] that is 1/(1 + Lo + Li) and
 * B(1 + Lo, 1 + Li), [heitz16]; `separable` is G1(wo) G1(wi) for both. */
KERNEL real interface_masking(rough_dielectric_params p, facet_pair f)
{
    real cos_i   = kmax(kabs(f.i.z), COS_SMALLEST);
    real cos_o   = kmax(f.o.z, COS_SMALLEST);
    real sigma_o = distribution_sigma(p.d, f.o);
    real sigma_i = distribution_sigma(p.d, make3(f.i.x, f.i.y, cos_i));
    real across  = kbeta(sigma_o/cos_o, sigma_i/cos_i)/cos_o;
    real usual   = cos_i/smith_rest(cos_i, cos_o, sigma_i, sigma_o, p.g2);
    real most    = p.g2 == G2_SEPARABLE ? usual : across;
    return f.is_bent ? most : usual;
}

/* By what transmitted radiance is multiplied. */
KERNEL real3 interface_tint(rough_dielectric_params p, facet_pair f)
{
    real scale = f.is_bent ? 1/(f.eta*f.eta) : (real)1;
    return select3(f.is_through, scale3(scale, p.tint), splat3(1));
}

/* f |cos_i|. */
KERNEL real3 rough_dielectric_eval(rough_dielectric_params p, real3 wi, real3 wo)
{
    facet_pair f = facets_between(p, wi, wo);
    real value   = distribution_D(p.d, f.m)*(f.cos_o*f.turning)*f.share*interface_masking(p, f);
    return scale3(keep_if(f.is_seen, value), interface_tint(p, f));
}

/* Density of wi: of the normal, times F or 1 - F, times dwm/dwi. */
KERNEL real interface_pdf(rough_dielectric_params p, facet_pair f)
{
    real normals = p.sampling == SAMPLING_NDF ? f.cos_m : f.cos_o/distribution_exact_sigma(p.d, f.o);
    return keep_if(f.is_seen, distribution_D(p.d, f.m)*f.share*f.turning*normals);
}

KERNEL real rough_dielectric_pdf(rough_dielectric_params p, real3 wi, real3 wo)
{
    return interface_pdf(p, facets_between(p, wi, wo));
}

/* Reflects at a sampled normal with probability F, else refracts: wi = -(wo + k wm)/eta, k = (eta^2 - 1)/(c + g),
 * c = wo.wm, g = sqrt(eta^2 - 1 + c^2), which is [walter07, eq. 40] without its difference; |wo + eta wi| = |k| and
 * |wi.wm| = g/eta.  What leaves on the wrong side is lost.  The weight is G2/G1(wo) or G2 (wo.wm)/(cos_o cos_m): D
 * and F cancel.  The density is that of the normal drawn, exact where wi's rounding would blur it. */
KERNEL bsdf_sample rough_dielectric_sample(rough_dielectric_params p, real3 wo, real3 u)
{
    int is_thin    = p.wall == WALL_THIN;
    real turn      = kcopysign(1, wo.z);
    real3 o        = scale3(turn, wo);
    real eta       = index_ratio(p, wo);
    real3 m        = normalize3(select3(p.sampling == SAMPLING_NDF, distribution_sample_ndf(p.d, u.x, u.y),
                                        distribution_sample_vndf(p.d, o, u.x, u.y, u.z)));
    real towards   = dot3(o, m);
    real c         = kclamp(towards, REAL_EPSILON, 1);
    real F         = wall_reflectance(p.wall, fresnel_dielectric(c, eta));
    int reflects   = u.z < F;
    int is_bent    = !reflects & !is_thin;
    real e         = (eta - 1)*(eta + 1);
    real g         = ksqrt(kmax(e + c*c, 0));
    real k         = e/(c + g);
    real3 mirrored = sub3(scale3(2*c, m), o);
    real3 straight = make3(mirrored.x, mirrored.y, -mirrored.z);
    real3 bent     = normalize3(neg3(madd3(o, k, m)));
    facet_pair f;
    f.o           = o;
    f.i           = select3(reflects, mirrored, select3(is_thin, straight, bent));
    f.eta         = eta;
    f.is_through  = !reflects;
    f.is_bent     = is_bent;
    f.m           = m;
    f.share       = is_bent ? fresnel_transmittance(c, g/eta, eta) : (reflects ? F : 1 - F);
    f.turning     = is_bent ? eta*g/(k*k) : 0.25f/c;
    f.cos_o       = c;
    f.cos_m       = m.z;
    f.is_seen     = kmin(kmin(o.z, reflects ? f.i.z : -f.i.z) - COS_SMALLEST, towards) > 0;
    real pdf      = interface_pdf(p, f);
    real drawn    = p.sampling == SAMPLING_NDF ? c/m.z : distribution_exact_sigma(p.d, o);
    real3 weight  = scale3(interface_masking(p, f)*drawn, interface_tint(p, f));
    int lobe      = LOBE_GLOSSY | (reflects ? LOBE_REFLECTION : LOBE_TRANSMISSION);
    bsdf_sample s = complete_sample(scale3(turn, f.i), weight, pdf, pdf > REAL_MIN, lobe);
    s.eta         = is_bent ? eta : (real)1;
    return s;
}

KERNEL int rough_dielectric_lobes(rough_dielectric_params p)
{
    (void)p;
    return LOBE_REFLECTION | LOBE_TRANSMISSION | LOBE_GLOSSY;
}

/* D, Lambda, G1 at m. */
KERNEL real3 rough_dielectric_terms(rough_dielectric_params p, real3 m)
{
    real Lambda = distribution_Lambda(p.d, m);
    return make3(distribution_D(p.d, m), Lambda, m.z > 0 ? 1/(1 + Lambda) : (real)0);
}

/* The loops are compiled three times for each distribution. */
#define INTERFACE_SOLID  0 /* a body; visible normals (gtr: all), exact and correlated masking */
#define INTERFACE_THIN   1 /* the same for a thin wall */
#define INTERFACE_RARE   2 /* everything else; chooses as it runs */
#define INTERFACE_GROUPS 3

KERNEL int rough_dielectric_variant(rough_dielectric_params p)
{
    int is_drawn = (p.sampling == SAMPLING_VNDF) | (p.d.kind == NDF_GTR);
    int is_usual = is_drawn & (p.g2 == G2_CORRELATED) & (p.d.masking == MASKING_EXACT);
    int wall     = p.wall == WALL_THIN ? INTERFACE_THIN : INTERFACE_SOLID;
    return INTERFACE_GROUPS*p.d.kind + (is_usual ? wall : INTERFACE_RARE);
}

/* p with the fields that are the same throughout a variant set to constants. */
KERNEL rough_dielectric_params rough_dielectric_fix(rough_dielectric_params p, int variant)
{
    int group                 = variant%INTERFACE_GROUPS;
    int kind                  = variant/INTERFACE_GROUPS;
    int is_rare               = group == INTERFACE_RARE;
    int drawn                 = is_rare ? p.sampling : SAMPLING_VNDF;
    rough_dielectric_params q = p;
    q.d.kind                  = kind;
    q.d.masking               = is_rare ? p.d.masking : MASKING_EXACT;
    q.d.gtr.anisotropy        = GTR_STRETCHED;
    q.wall                    = is_rare ? p.wall : (group == INTERFACE_THIN ? WALL_THIN : WALL_SOLID);
    q.g2                      = is_rare ? p.g2 : G2_CORRELATED;
    q.sampling                = kind == NDF_GTR ? SAMPLING_NDF : drawn;
    return q;
}

EVAL_AND_PDF(rough_dielectric)

/* Of ggx, beckmann, phong and gtr. */
#define EACH_VARIANT_rough_dielectric(CASE, name)                                                                      \
    CASE(name, 0)                                                                                                      \
    CASE(name, 1)                                                                                                      \
    CASE(name, 2)                                                                                                      \
    CASE(name, 3)                                                                                                      \
    CASE(name, 4) CASE(name, 5) CASE(name, 6) CASE(name, 7) CASE(name, 8) CASE(name, 9) CASE(name, 10) CASE(name, 11)
