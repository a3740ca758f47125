/* model_disney.h: the parameters of Disney's principled model, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/disney.h"
#include "read_material.h"

#ifdef FACET_PARAMETERS
static const facet_parameter disney_parameters[] = {
    {"base_color", FACET_COLOUR, 0, 1, {0.8, 0.8, 0.8}, "1", "", "diffuse colour, or reflectance of the metal"},
    {"subsurface", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "blends the diffuse shape to a flatter one"},
    {"metallic", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "0: dielectric, 1: metal"},
    {"specular", FACET_NUMBER, 0, 1, {0.5, 0, 0}, "1", "", "dielectric reflectance over .08"},
    {"specular_tint", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "tints that towards base_color"},
    {"roughness", FACET_NUMBER, 0, 1, {0.5, 0, 0}, "1", "", "perceptual roughness, alpha = roughness^2"},
    {"anisotropic", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "alpha_y/alpha_x = 1 - .9 anisotropic"},
    {"sheen", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "grazing reflectance of cloth"},
    {"sheen_tint", FACET_NUMBER, 0, 1, {0.5, 0, 0}, "1", "", "tints sheen towards base_color"},
    {"clearcoat", FACET_NUMBER, 0, 1, {0, 0, 0}, "1", "", "a second specular lobe, of weight 1/4"},
    {"clearcoat_gloss", FACET_NUMBER, 0, 1, {1, 0, 0}, "1", "", "its alpha: 0 is .1, 1 is .001"},
    {"coat_masking",
     FACET_CHOICE,
     0,
     1,
     {0, 0, 0},
     "1",
     "adhoc|exact",
     "clearcoat's masking: GGX of alpha .25, or GTR1's own"},
    {"g2", FACET_CHOICE, 0, 1, {1, 0, 0}, "1", "correlated|separable", "masking-shadowing: 1/(1+Li+Lo) or G1 G1"},
};
#endif

#ifdef FACET_PREPARE
static inline disney_params disney_prepare(const facet_material *m)
{
    const disney_point point = {
        .base_color = prepare_colour(m, "base_color"),
        .subsurface = prepare_number(m, "subsurface"),
        .metallic = prepare_number(m, "metallic"),
        .specular = prepare_number(m, "specular"),
        .specular_tint = prepare_number(m, "specular_tint"),
        .roughness = prepare_number(m, "roughness"),
        .anisotropic = prepare_number(m, "anisotropic"),
        .sheen = prepare_number(m, "sheen"),
        .sheen_tint = prepare_number(m, "sheen_tint"),
        .clearcoat = prepare_number(m, "clearcoat"),
        .clearcoat_gloss = prepare_number(m, "clearcoat_gloss"),
    };
    return disney_of(point, prepare_choice(m, "coat_masking"), prepare_choice(m, "g2"));
}
#endif
