/* model_ward.h: the parameters of `ward`, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/ward.h"
#include "read_material.h"

#ifdef FACET_PARAMETERS
static const facet_parameter ward_parameters[] = {
    {"variant", FACET_CHOICE, 0, 2, {WARD_GMD, 0, 0}, "1", "ward92|duer|gmd", "normalisation; gmd conserves energy"},
    {"alpha", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along both tangents"},
    {"alpha_x", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along the tangent x, not with alpha"},
    {"alpha_y", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along the bitangent y, not with alpha"},
    {"kd", FACET_COLOUR, 0, 1, {0, 0, 0}, "1", "", "Lambertian term that is added"},
    {"ks", FACET_COLOUR, 0, 1, {1, 1, 1}, "1", "", "specular reflectance rho_s"},
    {"sampling", FACET_CHOICE, 0, 1, {0, 0, 0}, "1", "flip|ndf", "normals turned to the viewer, or Ward's own"},
};
#endif

#ifdef FACET_PREPARE
/* Each lobe that is there is chosen by its share of kd + ks, but with a probability of 1/8 at least. */
static inline ward_params ward_prepare(const facet_material *m)
{
    const real alpha = prepare_number(m, "alpha");
    ward_params p = {.kd = prepare_colour(m, "kd"),
                     .ks = prepare_colour(m, "ks"),
                     .variant = prepare_choice(m, "variant"),
                     .sampling = prepare_choice(m, "sampling")};
    p.alpha_x = facet_material_given(m, "alpha_x") ? prepare_number(m, "alpha_x") : alpha;
    p.alpha_y = facet_material_given(m, "alpha_y") ? prepare_number(m, "alpha_y") : alpha;
    const real kd = length3(p.kd);
    const real ks = length3(p.ks);
    const real share = kd > 0 ? kclamp(kd/(kd + ks), 0.125f, 0.875f) : (real)0;
    p.p_diffuse = kd > 0 && !(ks > 0) ? (real)1 : share;
    return p;
}
#endif
