/* model_ggx.h: the parameters of `ggx`, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_microfacet.h"

#ifdef FACET_PARAMETERS
static const facet_parameter ggx_parameters[] = {
    ALPHA_PARAMETERS,
    MICROFACET_PARAMETERS("vndf|ndf|bounded", SAMPLING_BOUNDED),
};
#endif

#ifdef FACET_PREPARE
static inline microfacet_params ggx_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, NDF_GGX);
    prepare_alpha(m, &p.d);
    prepare_energy(m, &p);
    return p;
}
#endif
