/* sampler_density.h: Pearson's test of a sampler against its density.
 *
 * Cells are a grid in the cosine and the azimuth of wi whose borders are quantiles of a pilot run, so that each lobe is
 * resolved whatever its width, on both sides of the surface; one more cell takes the draws that give no sample.  The
 * density is integrated over each cell by adaptive cubature.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stdint.h>

#include "verify/chi_square.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is tested: draw(context, wo, number, wi) fills wi from the sample of that number and returns false if it gives
 * none; density(context, wi, wo). */
typedef struct sampler_subject {
    const void *context;
    bool (*draw)(const void *context, const double wo[3], uint64_t number, double wi[3]);
    double (*density)(const void *context, const double wi[3], const double wo[3]);
} sampler_subject;

/* The integral of the density over all cells, and the share of n draws that gave no sample, are filled in too. */
typedef struct sampler_result {
    chi_square test;
    double mass, lost;
} sampler_result;

sampler_result sampler_test(const sampler_subject *s, const double wo[3], bool has_two_sides, int n);

#ifdef __cplusplus
}
#endif
