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

enum { SAMPLER_BANDS = 20, SAMPLER_SECTORS = 20, SAMPLER_MOST_CELLS = 2*SAMPLER_BANDS*SAMPLER_SECTORS };

/* Bands of cos_i, each cut into sectors of azimuth [rad], which is counted from that of the mean direction, so that no
 * lobe lies across the cut at half a turn.  Cell SAMPLER_SECTORS band + sector; the last one is of no sample. */
typedef struct sampler_cells {
    double mean_x, mean_y; /* not both 0 */
    int n_bands;           /* of the upper hemisphere, or of the lower one and then the upper one */
    double cosines[2*SAMPLER_BANDS + 1], azimuths[2*SAMPLER_BANDS][SAMPLER_SECTORS + 1];
    double expected[SAMPLER_MOST_CELLS + 1], observed[SAMPLER_MOST_CELLS + 1];
} sampler_cells;

/* The cell of a direction with this cosine and azimuth. */
int sampler_cell_of(const sampler_cells *cells, double cosine, double azimuth);

/* Tests n samples, and fills in what was counted. */
sampler_result sampler_test(const sampler_subject *s, const double wo[3], bool has_two_sides, int n,
                            sampler_cells *cells);

#ifdef __cplusplus
}
#endif
