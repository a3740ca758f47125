/* model_microfacet.h: what the models on kernel/microfacet.h share: rows of their parameter tables, and how they are
 * prepared.
 *
 * [cs500] CS500 Project 3: SampleBrdf.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/microfacet.h"
#include "../metals.h"
#include "read_energy.h"
#include "read_material.h"

#ifdef FACET_PARAMETERS
/* The rows that every distribution of normals ends with. */
#define MICROFACET_PARAMETERS(SAMPLING_CHOICES, SAMPLING_LAST)                                                         \
    {"kd", FACET_COLOUR, 0, 1, {0, 0, 0}, "1", "", "Lambertian term that is added"},                                   \
        {"ks", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "reflectance at normal incidence (Schlick's Fresnel)"},         \
        {"f82", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "tint of that Fresnel term at 82 degrees, with ks"},           \
        {"ior",       FACET_NUMBER, 0.1, 10,                                                                           \
         {1.5, 0, 0}, "1",          "",  "index of refraction (exact dielectric Fresnel), not with ks"},               \
        {"metal",   FACET_CHOICE, 0,           METALS - 1,                                                             \
         {0, 0, 0}, "1",          METAL_NAMES, "a metal's measured indices (exact Fresnel), not with ks or ior"},      \
        {"eta", FACET_COLOUR, 0.01, 20, {1, 1, 1}, "1", "", "a conductor's index of refraction is eta + i k"},         \
        {"k", FACET_COLOUR, 0, 20, {0, 0, 0}, "1", "", "its imaginary part, with eta"},                                \
        {"g2", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "correlated|separable", "masking-shadowing: 1/(1+Li+Lo) or G1 G1"}, \
        {"masking",                                                                                                    \
         FACET_CHOICE,                                                                                                 \
         0,                                                                                                            \
         1,                                                                                                            \
         {0, 0, 0},                                                                                                    \
         "1",                                                                                                          \
         "exact|published",                                                                                            \
         "Smith's G1, or the fit that the paper prints"},                                                              \
        {"sampling",                                                                                                   \
         FACET_CHOICE,                                                                                                 \
         0,                                                                                                            \
         SAMPLING_LAST,                                                                                                \
         {0, 0, 0},                                                                                                    \
         "1",                                                                                                          \
         SAMPLING_CHOICES,                                                                                             \
         "normals that samples are drawn from"},                                                                       \
    {                                                                                                                  \
        "energy", FACET_CHOICE, 0, 2, {0, 0, 0}, "1", "single|multi|scaled",                                           \
            "one bounce, or all: a reciprocal lobe added, or the lobe scaled"                                          \
    }
#define ALPHA_PARAMETERS                                                                                               \
    {"alpha", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along both tangents"},                           \
        {"alpha_x", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along the tangent x, not with alpha"},     \
    {                                                                                                                  \
        "alpha_y", FACET_NUMBER, 1e-4, 4, {0.3, 0, 0}, "1", "", "roughness along the bitangent y, not with alpha"      \
    }
#endif

#ifdef FACET_PREPARE
static inline real3 prepare_index(const double rgb[3])
{
    return make3((real)rgb[0], (real)rgb[1], (real)rgb[2]);
}

/* Schlick's term of ks, unless what selects another is given. */
static inline fresnel prepare_fresnel(const facet_material *m)
{
    fresnel F = {.kind = FRESNEL_SCHLICK, .F0 = prepare_colour(m, "ks"), .eta = splat3(1)};
    if (facet_material_given(m, "metal")) {
        const metal *named = &metals[prepare_choice(m, "metal")];
        F.kind = FRESNEL_CONDUCTOR;
        F.eta = prepare_index(named->eta);
        F.k = prepare_index(named->k);
    } else if (facet_material_given(m, "eta")) {
        F.kind = FRESNEL_CONDUCTOR;
        F.eta = prepare_colour(m, "eta");
        F.k = prepare_colour(m, "k");
    } else if (facet_material_given(m, "ior")) {
        F.kind = FRESNEL_DIELECTRIC;
        F.eta = splat3(prepare_number(m, "ior"));
    } else if (facet_material_given(m, "f82")) {
        F.kind = FRESNEL_F82;
        F.dip = fresnel_f82_strength(F.F0, prepare_colour(m, "f82"));
    }
    return F;
}

/* Everything but the distribution's own shape. */
static inline microfacet_params microfacet_prepare(const facet_material *m, int kind)
{
    microfacet_params p = {.F = prepare_fresnel(m), .kd = prepare_colour(m, "kd"), .is_ggx = kind == NDF_GGX};
    p.d = (distribution){.kind = kind, .masking = prepare_choice(m, "masking"), .alpha_x = 1, .alpha_y = 1};
    p.g2 = prepare_choice(m, "g2");
    p.sampling = prepare_choice(m, "sampling");
    p.has_diffuse = length3(p.kd) > 0;
    p.is_one = p.sampling != SAMPLING_NDF && p.d.masking == MASKING_EXACT && !p.has_diffuse;
    p.p_diffuse = microfacet_p_diffuse(p.kd, fresnel_reflectance(p.F, 1));
    return p;
}

/* An average loss that is 0 to float's precision, so that F_ms over it stays finite. */
#define LOSS_SMALLEST ((real)1e-20)

/* F_ms of one channel.  [kulla17], see kernel/energy.h. */
static inline real multiple_bounces(real F, real loss)
{
    return F*F*(1 - loss)/(1 - F*loss);
}

/* The light of several bounces; the last step, when the distribution is complete. */
static inline void prepare_energy(const facet_material *m, microfacet_params *p)
{
    const int kind = prepare_choice(m, "energy");
    if (kind == ENERGY_SINGLE) return;
    const energy_surface surface = {.kind = p->d.kind,
                                    .masking = p->d.masking,
                                    .g2 = p->g2,
                                    .alpha_x = p->d.alpha_x,
                                    .alpha_y = p->d.alpha_y,
                                    .exponent = p->d.phong.exponent,
                                    .gamma = p->d.gtr.gamma,
                                    .anisotropy = p->d.gtr.anisotropy};
    energy_fit fit;
    facet_energy_fit_surface(&surface, &fit);
    p->ms = energy_of_fit(&fit);
    p->ms.kind = kind;
    p->is_one = 0;
    /* F_ms; 1 where F is, whatever the roughness. */
    const real3 average = fresnel_average(p->F);
    const real loss = kmax((real)fit.loss_average, LOSS_SMALLEST);
    const real3 multiple = make3(multiple_bounces(average.x, loss), multiple_bounces(average.y, loss),
                                 multiple_bounces(average.z, loss));
    if (kind == ENERGY_MULTI) {
        p->ms.added = scale3(INV_PI/loss, multiple);
        p->ms.share = mean3(multiple)/kmax(mean3(average), REAL_MIN);
    } else {
        p->ms.scale = fresnel_reflectance(p->F, 1);
    }
}

/* The roughness of a distribution that has one. */
static inline void prepare_alpha(const facet_material *m, distribution *d)
{
    const real alpha = prepare_number(m, "alpha");
    d->alpha_x = facet_material_given(m, "alpha_x") ? prepare_number(m, "alpha_x") : alpha;
    d->alpha_y = facet_material_given(m, "alpha_y") ? prepare_number(m, "alpha_y") : alpha;
}
#endif
