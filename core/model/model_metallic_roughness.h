/* model_metallic_roughness.h: the parameters of glTF's material, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/metallic_roughness.h"
#include "read_material.h"

#ifdef FACET_PARAMETERS
static const facet_parameter metallic_roughness_parameters[] = {
    {"base_color", FACET_COLOUR, 0, 1, {0.8, 0.8, 0.8}, "1", "", "diffuse colour, or reflectance of the metal"},
    {"metallic", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "0: dielectric, 1: metal"},
    {"roughness", FACET_NUMBER, 0, 1, {0.5, 0, 0}, "1", "", "perceptual roughness, alpha = roughness^2"},
    {"ior", FACET_NUMBER, 1, 10, {1.5, 0, 0}, "1", "", "index of refraction of the dielectric"},
    {"specular", FACET_NUMBER, 0, 1, {1, 0, 0}, "1", "", "strength of the dielectric's reflection"},
    {"specular_color",
     FACET_COLOUR,
     0,
     1,
     {1, 1, 1},
     "1",
     "",
     "tint of the dielectric's reflection at normal incidence"},
    {"diffuse",
     FACET_CHOICE,
     0,
     1,
     {0, 0, 0},
     "1",
     "lambert|burley",
     "base under the interface, or Disney's added to it"},
};
#endif

#ifdef FACET_PREPARE
static inline metallic_roughness_params metallic_roughness_prepare(const facet_material *m)
{
    metallic_roughness_params p = metallic_roughness_of(
        prepare_colour(m, "base_color"), prepare_number(m, "metallic"), prepare_number(m, "roughness"),
        fresnel_normal_incidence(prepare_number(m, "ior")), prepare_number(m, "specular"),
        prepare_colour(m, "specular_color"));
    p.diffuse = prepare_choice(m, "diffuse");
    return p;
}
#endif
