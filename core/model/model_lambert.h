/* model_lambert.h: the parameters of the ideal diffuse reflector, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../kernel/lambert.h"
#include "read_material.h"

#ifdef FACET_PARAMETERS
static const facet_parameter lambert_parameters[] = {
    {"kd", FACET_COLOUR, 0, 1, {0.8, 0.8, 0.8}, "1", "", "reflectance"},
};
#endif

#ifdef FACET_PREPARE
static inline lambert_params lambert_prepare(const facet_material *m)
{
    return (lambert_params){.kd = prepare_colour(m, "kd")};
}
#endif
