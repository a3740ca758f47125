/* sky.h: radiance from infinity: looking it up, and sampling it in proportion to its brightness.
 *
 * The map is interpolated bilinearly; a direction is drawn by choosing a texel with probability proportional to
 * the integral of the interpolated luminance over it, or of what exceeds the mean, then a uniform direction in the
 * texel.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

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

/* is_compensated: scattered rays that meet the sky are counted and weighted, too, so that directions of less than its
 * mean luminance need not be drawn. */
facet_status sky_create(const environment *e, bool is_compensated, sky *result, facet_error *why);
void sky_destroy(sky *s);

/* Radiance from the unit direction. */
real3 sky_radiance(const sky *s, real3 direction);

/* A direction drawn from u (32-bit fraction: texel) and v, w (in [0,1): place in it); pdf [1/sr]. */
real3 sky_sample(const sky *s, uint32_t u, float v, float w, float *pdf);
float sky_pdf(const sky *s, real3 direction);

#ifdef __cplusplus
}
#endif
