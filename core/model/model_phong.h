/* model_phong.h: the parameters of `phong`, and how they are prepared.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "model_microfacet.h"

#ifdef FACET_PARAMETERS
static const facet_parameter phong_parameters[] = {
    {"exponent", FACET_NUMBER, 0, 1e6, {50, 0, 0}, "1", "", "n in D = (n + 2)/(2 pi) cos^n"},
    {"alpha_x", FACET_NUMBER, 1e-3, 1, {0.2, 0, 0}, "1", "", "roughness sqrt(2/(n + 2)) along x, not with exponent"},
    {"alpha_y", FACET_NUMBER, 1e-3, 1, {0.2, 0, 0}, "1", "", "roughness sqrt(2/(n + 2)) along y, not with exponent"},
    MICROFACET_PARAMETERS("vndf|ndf", 1),
};
#endif

#ifdef FACET_PREPARE
/* Different roughness along x and y: the exponent is that of their geometric mean, and the slopes are
 * stretched by the ratio to it. */
static inline void prepare_stretched_phong(real alpha_x, real alpha_y, distribution *d)
{
    const real mean = ksqrt(alpha_x*alpha_y);
    d->phong = phong_shape_of(kmax(2/(mean*mean) - 2, 0));
    d->alpha_x = alpha_x/mean;
    d->alpha_y = alpha_y/mean;
}

static inline microfacet_params phong_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, NDF_PHONG);
    if (facet_material_given(m, "alpha_x") || facet_material_given(m, "alpha_y"))
        prepare_stretched_phong(prepare_number(m, "alpha_x"), prepare_number(m, "alpha_y"), &p.d);
    else p.d.phong = phong_shape_of(prepare_number(m, "exponent"));
    prepare_energy(m, &p);
    return p;
}
#endif
