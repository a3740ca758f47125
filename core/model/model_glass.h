/* model_glass.h: the parameters of a smooth dielectric, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/glass.h"
#include "read_material.h"

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
};
#endif

#ifdef FACET_PREPARE
static inline glass_params glass_prepare(const facet_material *m)
{
    return (glass_params){
        .eta = prepare_number(m, "ior"), .tint = prepare_colour(m, "tint"), .wall = prepare_choice(m, "wall")};
}
#endif
