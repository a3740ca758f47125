/* sampler_density.c: see sampler_density.h.
 * SPDX-License-Identifier: MIT */
#include "verify/sampler_density.h"

#include <math.h>
#include <stdlib.h>

#include "verify/quadrature.h"
#include "verify/views.h"

enum {
    BANDS = 20, /* of one hemisphere */
    SECTORS = 20,
    MOST_CELLS = 2*BANDS*SECTORS,
    PILOT = 20000,
    PIECES = 32
};

#define PI 3.14159265358979323846

/* Azimuths are counted from that of the mean direction, so that no lobe lies across the cut at half a turn. */
typedef struct cell_grid {
    double mean_x, mean_y; /* not both 0 */
    int n_bands;           /* of the upper hemisphere, or of the lower one and then the upper one */
    double cosines[2*BANDS + 1], azimuths[2*BANDS][SECTORS + 1];
} cell_grid;

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

/* The azimuth of a direction, in [-pi, pi]. */
static double azimuth_of(const cell_grid *grid, const double v[3])
{
    return atan2(v[1]*grid->mean_x - v[0]*grid->mean_y, v[0]*grid->mean_x + v[1]*grid->mean_y);
}

static int cell_of(const cell_grid *grid, const double v[3])
{
    const int band = interval_of(grid->cosines, grid->n_bands, v[2]);
    return band*SECTORS + interval_of(grid->azimuths[band], SECTORS, azimuth_of(grid, v));
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

/* A pilot's samples, and room to sort some of them. */
typedef struct pilot {
    int n;
    double v[PILOT][3], z[PILOT], phi[PILOT], values[PILOT];
} pilot;

/* The borders of a hemisphere's bands. */
static void place_bands(pilot *p, bool is_upper, double *borders)
{
    int m = 0;
    for (int i = 0; i < p->n; i++)
        if ((p->z[i] >= 0) == is_upper) p->values[m++] = p->z[i];
    quantiles(p->values, m, is_upper ? 0 : -1, is_upper ? 1 : 0, borders, BANDS);
}

static void place_borders(cell_grid *grid, const sampler_subject *s, const double wo[3], pilot *p)
{
    p->n = 0;
    grid->mean_x = 0;
    grid->mean_y = 0;
    for (uint64_t k = 0; k < PILOT; k++)
        if (s->draw(s->context, wo, k, p->v[p->n])) {
            grid->mean_x += p->v[p->n][0];
            grid->mean_y += p->v[p->n][1];
            p->z[p->n] = p->v[p->n][2];
            p->n++;
        }
    if (grid->mean_x == 0 && grid->mean_y == 0) grid->mean_x = 1;
    for (int i = 0; i < p->n; i++) p->phi[i] = azimuth_of(grid, p->v[i]);
    if (grid->n_bands > BANDS) place_bands(p, false, grid->cosines);
    place_bands(p, true, grid->cosines + grid->n_bands - BANDS);
    for (int band = 0; band < grid->n_bands; band++) {
        int m = 0;
        for (int i = 0; i < p->n; i++)
            if (interval_of(grid->cosines, grid->n_bands, p->z[i]) == band) p->values[m++] = p->phi[i];
        quantiles(p->values, m, -PI, PI, grid->azimuths[band], SECTORS);
    }
}

typedef struct density_of {
    const sampler_subject *s;
    double wo[3], mean_phi;
} density_of;

static double density_at(double cos_theta, double phi, const void *context)
{
    const density_of *of = context;
    double wi[3];
    verify_direction(cos_theta, phi + of->mean_phi, wi);
    return of->s->density(of->s->context, wi, of->wo);
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

sampler_result sampler_test(const sampler_subject *s, const double wo[3], bool has_two_sides, int n)
{
    cell_grid grid;
    double expected[MOST_CELLS + 1], observed[MOST_CELLS + 1];
    grid.n_bands = has_two_sides ? 2*BANDS : BANDS;
    const int n_cells = grid.n_bands*SECTORS;
    pilot *p = malloc(sizeof *p);
    if (!p) abort();
    place_borders(&grid, s, wo, p);
    free(p);
    const density_of of = {s, {wo[0], wo[1], wo[2]}, atan2(grid.mean_y, grid.mean_x)};
    double lost = 1;
    for (int i = 0; i < n_cells; i++) {
        const double mass = cell_mass(&grid, i/SECTORS, i%SECTORS, &of);
        lost -= mass;
        expected[i] = mass*n;
        observed[i] = 0;
    }
    expected[n_cells] = fmax(lost, 0)*n;
    observed[n_cells] = 0;
    for (int k = 0; k < n; k++) {
        double wi[3];
        observed[s->draw(s->context, wo, PILOT + (uint64_t)k, wi) ? cell_of(&grid, wi) : n_cells]++;
    }
    /* What the cubature leaves undecided, its tolerance times the cells, is not zero probability. */
    if (observed[n_cells] > 0 && lost < 2e-8*n_cells) expected[n_cells] = 2e-8*n_cells*n;
    return (sampler_result){chi_square_test(expected, observed, n_cells + 1), 1 - lost, observed[n_cells]/n};
}
