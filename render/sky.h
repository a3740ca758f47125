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
    struct sky_row *rows;
    double mean;        /* mean luminance over the sphere */
    uint64_t n_dropped; /* texels that were NaN, infinite or negative and count as black */
} sky;

/* is_compensated: scattered rays that meet the sky are counted and weighted, too, so that directions of less than its
 * mean luminance need not be drawn. */
facet_status sky_create(const environment *e, bool is_compensated, sky *result, facet_error *why);
void sky_destroy(sky *s);

/* Where a unit direction lies in the map: fractions of its width and height. */
static inline real2 sky_place(real3 d)
{
    return make2(katan2(d.z, d.x)*INV_TWO_PI + 0.5f, kacos(kmin(kmax(d.y, -1), 1))*INV_PI);
}

/* Radiance from a direction. */
real3 sky_radiance_at(const sky *s, real2 place);
real3 sky_radiance(const sky *s, real3 direction);

/* A texel drawn from u (32-bit fraction), then a direction from v, w (in [0,1): place in it); pdf [1/sr]. */
uint32_t sky_draw_texel(const sky *s, uint32_t u);
real3 sky_sample(const sky *s, uint32_t drawn, float v, float w, float *pdf);
float sky_pdf(const sky *s, real2 place);

/* Maps are larger than caches: these ask memory for what sky_draw_texel, sky_sample and its sky_radiance, and
 * sky_pdf and sky_radiance_at will need. */
void sky_expect_draw(const sky *s, uint32_t u);
void sky_expect_sample(const sky *s, uint32_t drawn);
void sky_expect_place(const sky *s, real2 place);

#ifdef __cplusplus
}
#endif
