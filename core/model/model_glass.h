/* model_glass.h: the parameters of a dielectric interface, smooth or rough, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/glass.h"
#include "../kernel/rough_dielectric.h"
#include "model_gtr.h"
#include "model_phong.h"

#ifdef FACET_PARAMETERS
static const facet_parameter glass_parameters[] = {
    {"ior", FACET_NUMBER, 0.1, 10, {1.5, 0, 0}, "1", "", "index of refraction of the inside to the outside"},
    {"tint", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "multiplies what is transmitted, at each crossing"},
    {"wall",
     FACET_CHOICE,
     0,
     1,
     {0, 0, 0},
     "1",
     "solid|thin",
     "a body that refracts, or a thin sheet that does not bend light"},
    {"alpha", FACET_NUMBER, 0, 4, {0, 0, 0}, "1", "", "roughness along both tangents; smooth below 1e-4"},
    {"alpha_x", FACET_NUMBER, 0, 4, {0, 0, 0}, "1", "", "roughness along the tangent x, not with alpha"},
    {"alpha_y", FACET_NUMBER, 0, 4, {0, 0, 0}, "1", "", "roughness along the bitangent y, not with alpha"},
    {"exponent", FACET_NUMBER, 0, 1e6, {50, 0, 0}, "1", "", "roughness sqrt(2/(n + 2)) where given, not with alpha"},
    {"ndf", FACET_CHOICE, 0, NDF_COUNT - 1, {0, 0, 0}, "1", "ggx|beckmann|phong|gtr", "distribution of normals"},
    {"gamma", FACET_NUMBER, 1e-3, 20, {2, 0, 0}, "1", "", "exponent of gtr"},
    {"g2", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "correlated|separable", "masking-shadowing: of both, or G1 G1"},
    {"masking", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "exact|published", "Smith's G1, or the fit that the paper prints"},
    {"sampling", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "vndf|ndf", "normals that samples are drawn from; gtr: ndf"},
};
#endif

#ifdef FACET_PREPARE
static inline glass_params glass_prepare(const facet_material *m)
{
    return (glass_params){
        .eta = prepare_number(m, "ior"), .tint = prepare_colour(m, "tint"), .wall = prepare_choice(m, "wall")};
}

/* The roughness along x and y, in whichever way it is given. */
static inline real2 glass_roughness(const facet_material *m)
{
    if (facet_material_given(m, "exponent")) {
        const real alpha = ksqrt(2/(prepare_number(m, "exponent") + 2));
        return make2(alpha, alpha);
    }
    if (facet_material_given(m, "alpha_x") || facet_material_given(m, "alpha_y"))
        return make2(prepare_number(m, "alpha_x"), prepare_number(m, "alpha_y"));
    return make2(prepare_number(m, "alpha"), prepare_number(m, "alpha"));
}

static inline int glass_needs_rough_dielectric(const facet_material *m)
{
    const real2 alpha = glass_roughness(m);
    return is_rough_interface(prepare_number(m, "ior"), kmax(alpha.x, alpha.y));
}

static inline rough_dielectric_params glass_prepare_rough_dielectric(const facet_material *m)
{
    const real2 alpha = glass_roughness(m);
    rough_dielectric_params p = {.d = {.kind = prepare_choice(m, "ndf"),
                                       .masking = prepare_choice(m, "masking"),
                                       .alpha_x = kmax(alpha.x, ALPHA_SMALLEST),
                                       .alpha_y = kmax(alpha.y, ALPHA_SMALLEST)},
                                 .eta = prepare_number(m, "ior"),
                                 .tint = prepare_colour(m, "tint"),
                                 .wall = prepare_choice(m, "wall"),
                                 .g2 = prepare_choice(m, "g2"),
                                 .sampling = prepare_choice(m, "sampling")};
    if (p.d.kind == NDF_PHONG) prepare_stretched_phong(p.d.alpha_x, p.d.alpha_y, &p.d);
    if (p.d.kind == NDF_GTR) {
        const real gamma = prepare_number(m, "gamma");
        p.d.gtr = gtr_shape_of(p.d.alpha_x, p.d.alpha_y, gamma, GTR_STRETCHED);
        p.d.spline = gtr_spline_at(gamma);
        p.sampling = SAMPLING_NDF; /* a visible normal takes all three numbers, and none is left to choose F with */
    }
    return p;
}
#endif
