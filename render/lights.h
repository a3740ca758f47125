/* lights.h: everything that emits: choosing one, a point on it, and the densities of both.
 *
 * A light is chosen with probability proportional to an estimate of what the point takes up of its light, by way of a
 * tree (light_tree.h) where there are many lights; the sky counts as one light.
 * Densities are per solid angle at the point that is lit, the choice of the light included, so that they
 * can be compared with the density of a scattering sampler.  [cs500-corrected]: SampleLight, PdfLight.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>

#include "render/geometry.h"
#include "render/light_receiver.h"
#include "render/rays.h"
#include "render/scene.h"
#include "render/sky.h"
#include "render/surface.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct light_set light_set;

/* The scene must stay until light_set_destroy.  has_scattered: scattered rays that meet lights are counted, too, with
 * weights by light_set_pdf_of_hit and light_set_pdf_of_sky; else every direction that light comes from is drawn. */
facet_status light_set_create(const scene *s, bool has_scattered, light_set **result, facet_error *why);
void light_set_destroy(light_set *set);

/* Whether there is anything to sample. */
bool light_set_is_empty(const light_set *set);

const sky *light_set_sky(const light_set *set);

/* Whether more than the receivers' positions is looked at. */
bool light_set_needs_receivers(const light_set *set);

/* What a light sends to a point.  pdf == 0: nothing.  is_delta: no scattered ray can meet this light, and pdf is
 * the probability of choosing it. */
typedef struct light_sample {
    real3 direction; /* unit, to the light */
    real3 target;    /* the point to be visible, already off its surface; unused when at infinity */
    bool is_infinite, is_delta;
    float pdf;      /* [1/sr] */
    real3 radiance; /* [W/(m^2 sr)]; for a delta light the irradiance on a plane across the light [W/m^2] */
} light_sample;

/* Draws a light and a point on it; u: 32-bit fractions. */
light_sample light_set_sample(const light_set *set, const light_receiver *to, const uint32_t u[3]);

/* The same for n points, in arrays with room for whole vectors (loops.h), in two steps.  The receivers get the sum of
 * what lights are chosen by. */
typedef struct light_choices {
    uint32_t *which;
    float *probability; /* 0: none */
    double *rest;       /* of the number that chose, again in [0,1) */
} light_choices;
void light_set_choose(const light_set *set, size_t n, light_receivers to, uint32_t *const u[3], light_choices c);

/* The probability with which light_set_choose, which has been called for these receivers, chooses the lights c.which,
 * in place of one that is not 0.  For matte surfaces under many lights it is about that, and the same whatever was
 * chosen, which takes a fraction of the time. */
void light_set_rate(const light_set *set, size_t n, light_receivers to, light_choices c);
bool light_set_rates_exactly(const light_set *set);

typedef struct light_samples {
    vectors direction, target, radiance;
    float *pdf;
    uint32_t *is_infinite, *is_delta;
} light_samples;

/* Draws the points on the lights that were chosen. */
void light_set_points(const light_set *set, size_t n, vectors from, light_choices chosen, uint32_t *const u[3],
                      light_samples s);

/* The density with which light_set_sample draws the direction to this hit of an emitting surface. */
float light_set_pdf_of_hit(const light_set *set, const light_receiver *to, const hit *h, const surface *at);

/* The same for a place of the sky (sky.h). */
float light_set_pdf_of_sky(const light_set *set, const light_receiver *to, real2 place);

#ifdef __cplusplus
}
#endif
