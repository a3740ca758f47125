/* model_beckmann.h: the parameters of `beckmann`, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_microfacet.h"

#ifdef FACET_PARAMETERS
static const facet_parameter beckmann_parameters[] = {
    ALPHA_PARAMETERS,
    MICROFACET_PARAMETERS("vndf|ndf", 1),
};
#endif

#ifdef FACET_PREPARE
static inline microfacet_params beckmann_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, NDF_BECKMANN);
    prepare_alpha(m, &p.d);
    prepare_energy(m, &p);
    return p;
}
#endif
