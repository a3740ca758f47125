/* sampler_check.h: chi-square tests of a material's sampler against its density.
 *
 * Cells are a grid in the cosine and the azimuth of wi whose borders are quantiles of a pilot run, so that each lobe is
 * resolved whatever its width, on both sides of the surface if the material transmits; one more cell takes the draws
 * that give no sample.  The density is integrated over each cell in double precision.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "facet/facet.h"
#include "verify/chi_square.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Instrumented and unoptimised builds draw a tenth. */
#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(undefined_behavior_sanitizer)
#define SAMPLER_CHECK_IS_SLOW 1
#endif
#endif
#if defined(SAMPLER_CHECK_IS_SLOW) || defined(__SANITIZE_ADDRESS__) || !defined(__OPTIMIZE__)
enum { SAMPLER_CHECK_COUNT = 100000 };
#else
enum { SAMPLER_CHECK_COUNT = 1000000 };
#endif

/* Draws n directions for wo from `seed`; pdf = 0 where there is none. */
typedef void (*sampler)(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to);

/* The sampler `draw`, n samples, against the density of the material `density`. */
chi_square sampler_check(sampler draw, const void *context, const facet_bsdf64 *density, const float wo[3], int n,
                         uint64_t seed);

/* The sampler of libfacet; context: the facet_bsdf. */
void draw_from_bsdf(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to);

typedef struct sampler_case {
    const char *spec;
    double cos_o, phi_o;
} sampler_case;

/* More than there are checks in all files, in both of the builds that draw different numbers. */
enum { SAMPLER_CHECKS = 250 };

/* Checks the samplers of the cases against their densities, at a level of 0.01 for all checks of all files together;
 * prints every p. */
void check_samplers(const sampler_case *cases, int n_cases);

#ifdef __cplusplus
}
#endif
