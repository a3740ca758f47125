/* bsdf_checks.h: what holds for every material that is accepted.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

/* Values and densities are finite and not negative, in directions from grazing to normal on both sides; samples are
 * unit vectors with finite weights. */
void check_bsdf(const facet_bsdf *bsdf);
