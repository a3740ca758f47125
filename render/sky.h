/* sky.h: radiance from infinity: looking it up, and sampling it in proportion to its brightness.
 *
 * The map is interpolated bilinearly; a direction is drawn by choosing a texel with probability proportional to
 * the integral of the interpolated luminance over it, then a uniform direction in the texel.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "render/alias.h"
#include "render/geometry.h"
#include "render/scene.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct sky {
    const environment *environment;
    alias_table texels; /* empty without a map */
    double mean;        /* mean luminance over the sphere */
    uint64_t n_dropped; /* texels that were NaN, infinite or negative and count as black */
} sky;

facet_status sky_create(const environment *e, sky *result, facet_error *why);
void sky_destroy(sky *s);

/* Radiance from the unit direction. */
real3 sky_radiance(const sky *s, real3 direction);

/* A direction drawn from u (32-bit fraction: texel) and v, w (in [0,1): place in it); pdf [1/sr]. */
real3 sky_sample(const sky *s, uint32_t u, float v, float w, float *pdf);
float sky_pdf(const sky *s, real3 direction);

#ifdef __cplusplus
}
#endif
