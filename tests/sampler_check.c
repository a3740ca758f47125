/* sampler_check.c: see sampler_check.h.
 * SPDX-License-Identifier: MIT */
#include "tests/sampler_check.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "tests/any_bsdf.h"
#include "tests/draws.h"
#include "tests/quadrature.h"

enum {
    BANDS = 20, /* of one hemisphere */
    SECTORS = 20,
    MOST_CELLS = 2*BANDS*SECTORS,
    PILOT = 20000,
    CHUNK = 4096,
    PIECES = 32
};

#define PI 3.14159265358979323846

/* Azimuths are counted from that of the mean direction, so that no lobe lies across the cut at half a turn. */
typedef struct cell_grid {
    double mean_x, mean_y; /* not both 0 */
    int n_bands;           /* of the upper hemisphere, or of the lower one and then the upper one */
    double cosines[2*BANDS + 1], azimuths[2*BANDS][SECTORS + 1];
} cell_grid;

typedef struct chunk {
    float data[7][CHUNK];
} chunk;

static facet_samples outputs(chunk *c)
{
    return (facet_samples){c->data[0], c->data[1], c->data[2], c->data[3], c->data[4], c->data[5], c->data[6]};
}

void draw_from_bsdf(const void *context, const float wo[3], uint64_t seed, int n, facet_samples to)
{
    static _Thread_local float view[3][CHUNK], u[3][CHUNK];
    draws random = {seed};
    for (int i = 0; i < n; i++)
        for (int k = 0; k < 3; k++) {
            view[k][i] = wo[k];
            u[k][i] = (float)draw(&random);
        }
    facet_bsdf_sample_batch(context, (size_t)n, (facet_dirs){view[0], view[1], view[2]}, (facet_dirs){u[0], u[1], u[2]},
                            to);
}

/* The number of inner borders at or below x. */
static int interval_of(const double *borders, int n, double x)
{
    int low = 0, high = n - 1;
    while (low < high) {
        const int middle = (low + high + 1)/2;
        if (x >= borders[middle]) low = middle;
        else high = middle - 1;
    }
    return low;
}

/* The azimuth of sample i, in [-pi, pi]. */
static double azimuth_of(const cell_grid *grid, const chunk *c, int i)
{
    const double x = (double)c->data[0][i], y = (double)c->data[1][i];
    return atan2(y*grid->mean_x - x*grid->mean_y, x*grid->mean_x + y*grid->mean_y);
}

static int cell_of(const cell_grid *grid, const chunk *c, int i)
{
    const int band = interval_of(grid->cosines, grid->n_bands, (double)c->data[2][i]);
    return band*SECTORS + interval_of(grid->azimuths[band], SECTORS, azimuth_of(grid, c, i));
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Borders at the quantiles of `values`, between `low` and `high`. */
static void quantiles(double *values, int n, double low, double high, double *borders, int n_parts)
{
    qsort(values, (size_t)n, sizeof *values, compare_doubles);
    borders[0] = low;
    borders[n_parts] = high;
    for (int k = 1; k < n_parts; k++)
        borders[k] = n > 0 ? values[(long)n*k/n_parts] : low + (high - low)*k/n_parts;
}

/* The borders of a hemisphere's bands, from those of the cosines z[n] that lie in it. */
static void place_bands(const double *z, int n, bool is_upper, double *borders)
{
    static _Thread_local double values[PILOT];
    int m = 0;
    for (int i = 0; i < n; i++)
        if ((z[i] >= 0) == is_upper) values[m++] = z[i];
    quantiles(values, m, is_upper ? 0 : -1, is_upper ? 1 : 0, borders, BANDS);
}

static void place_borders(cell_grid *grid, sampler draw_some, const void *context, const float wo[3], uint64_t seed)
{
    static _Thread_local double z[PILOT], phi[PILOT], values[PILOT];
    static _Thread_local chunk c;
    int n = 0;
    grid->mean_x = 0;
    grid->mean_y = 0;
    for (int start = 0; start < PILOT; start += CHUNK) {
        const int count = PILOT - start < CHUNK ? PILOT - start : CHUNK;
        draw_some(context, wo, seed + (uint64_t)start, count, outputs(&c));
        for (int i = 0; i < count && start == 0; i++)
            if (c.data[3][i] > 0) {
                grid->mean_x += (double)c.data[0][i];
                grid->mean_y += (double)c.data[1][i];
            }
        for (int i = 0; i < count; i++)
            if (c.data[3][i] > 0) {
                z[n] = (double)c.data[2][i];
                phi[n++] = azimuth_of(grid, &c, i);
            }
    }
    if (grid->n_bands > BANDS) place_bands(z, n, false, grid->cosines);
    place_bands(z, n, true, grid->cosines + grid->n_bands - BANDS);
    for (int band = 0; band < grid->n_bands; band++) {
        int m = 0;
        for (int i = 0; i < n; i++)
            if (interval_of(grid->cosines, grid->n_bands, z[i]) == band) values[m++] = phi[i];
        quantiles(values, m, -PI, PI, grid->azimuths[band], SECTORS);
    }
}

typedef struct density_of {
    const facet_bsdf64 *bsdf;
    double wo[3], mean_phi;
} density_of;

static double density_at(double cos_theta, double phi, const void *context)
{
    const density_of *of = context;
    double wi[3];
    any_direction(cos_theta, phi + of->mean_phi, wi);
    return facet_bsdf64_pdf(of->bsdf, wi, of->wo);
}

/* The borders of the pieces that interval k of n is integrated in: the outermost are wide and the lobe is at their
 * inner end, where a first look would miss it, so that they are cut at distances that grow from their neighbour's
 * width. */
static int pieces_of(const double *borders, int n, int k, double *pieces)
{
    int count = 0;
    pieces[count++] = borders[k];
    if (k == 0 && n > 1)
        for (double d = (borders[0] - borders[1])/2; count < PIECES && d < borders[1] - borders[2]; d /= 2)
            pieces[count++] = borders[1] + d;
    if (k == n - 1 && n > 1) {
        double d = borders[n - 1] - borders[n - 2];
        for (; count < PIECES && d < borders[n] - borders[n - 1]; d *= 2) pieces[count++] = borders[n - 1] + d;
    }
    pieces[count] = borders[k + 1];
    return count;
}

/* The density's integral over a cell. */
static double cell_mass(const cell_grid *grid, int band, int sector, const density_of *of)
{
    double z[PIECES + 1], phi[PIECES + 1], mass = 0;
    const int rows = pieces_of(grid->cosines + band/BANDS*BANDS, BANDS, band%BANDS, z);
    const int columns = pieces_of(grid->azimuths[band], SECTORS, sector, phi);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            const double low[2] = {z[r], phi[c]}, high[2] = {z[r + 1], phi[c + 1]};
            /* An error of 2e-8 is 0.02 samples of a million, where a cell's own spread is some 50. */
            mass += cubature(density_at, of, low, high, 2e-8/(rows*columns), 0);
        }
    return mass;
}

chi_square sampler_check(sampler draw_some, const void *context, const facet_bsdf64 *density, const float wo[3], int n,
                         uint64_t seed)
{
    static _Thread_local cell_grid grid;
    static _Thread_local double expected[MOST_CELLS + 1], observed[MOST_CELLS + 1];
    static _Thread_local chunk c;
    grid.n_bands = facet_bsdf64_lobes(density) & FACET_TRANSMISSION ? 2*BANDS : BANDS;
    const int n_cells = grid.n_bands*SECTORS;
    place_borders(&grid, draw_some, context, wo, seed*1000003 + 1);
    const density_of of = {density, {(double)wo[0], (double)wo[1], (double)wo[2]}, atan2(grid.mean_y, grid.mean_x)};
    double lost = 1;
    for (int i = 0; i < n_cells; i++) {
        const int band = i/SECTORS, sector = i%SECTORS;
        const double mass = cell_mass(&grid, band, sector, &of);
        lost -= mass;
        expected[i] = mass*n;
        observed[i] = 0;
    }
    expected[n_cells] = fmax(lost, 0)*n;
    observed[n_cells] = 0;
    for (int start = 0; start < n; start += CHUNK) {
        const int count = n - start < CHUNK ? n - start : CHUNK;
        draw_some(context, wo, (seed*1000003 + 2)*1000003 + (uint64_t)start, count, outputs(&c));
        for (int i = 0; i < count; i++) observed[c.data[3][i] > 0 ? cell_of(&grid, &c, i) : n_cells]++;
    }
    /* What the cubature leaves undecided, its tolerance times the cells, is not zero probability. */
    if (observed[n_cells] > 0 && lost < 2e-8*n_cells) expected[n_cells] = 2e-8*n_cells*n;
    return chi_square_test(expected, observed, n_cells + 1);
}

void check_samplers(const sampler_case *cases, int n_cases)
{
    const double level = sidak_level(0.01, SAMPLER_CHECKS);
    for (int i = 0; i < n_cases; i++) {
        const any_bsdf bsdf = any_bsdf_of(cases[i].spec, 0);
        double wo[3];
        any_direction(cases[i].cos_o, cases[i].phi_o, wo);
        const float view[3] = {(float)wo[0], (float)wo[1], (float)wo[2]};
        const chi_square result = sampler_check(draw_from_bsdf, &bsdf.single, &bsdf.twice, view, SAMPLER_CHECK_COUNT,
                                                (uint64_t)(i + 1));
        print_message("  %-44s cos_o %-5g chi^2 %8.1f of %d, p %.3g\n", cases[i].spec, cases[i].cos_o, result.statistic,
                      result.degrees, result.p);
        if (!(result.p >= level) || result.forbidden > 0)
            fail_msg("%s, wo (%a, %a, %a): p = %g is below %g, or %g samples are where none should be", cases[i].spec,
                     (double)view[0], (double)view[1], (double)view[2], result.p, level, result.forbidden);
    }
}
