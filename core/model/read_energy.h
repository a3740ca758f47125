/* read_energy.h: a fit of core/energy_fit.c as the kernels' parameters.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../energy_fit.h"
#include "../kernel/energy.h"

/* What depends on the surface alone; neither kind nor Fresnel's term. */
static inline energy energy_of_fit(const energy_fit *fit)
{
    energy e;
    e.kind = ENERGY_SINGLE;
    e.is_isotropic = fit->is_isotropic;
    e.is_root = fit->is_root;
    e.power = fit->power;
    e.reach2_x = (real)fit->reach2_x;
    e.reach2_y = (real)fit->reach2_y;
    e.reach2_z = (real)fit->reach2_z;
    e.a_n = (real)fit->a_n;
    e.skew = (real)fit->skew;
    e.added = splat3(0);
    e.scale = splat3(0);
    e.share = 0;
    e.inv_log = INV_TWO_PI/klog1p((real)(1/fit->a_n));
    for (int k = 0; k < ENERGY_COEFFICIENTS; k++) e.coefficients[k] = (real)fit->coefficients[k];
    return e;
}
