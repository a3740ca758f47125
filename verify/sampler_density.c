/* sampler_density.c: see sampler_density.h.
 * SPDX-License-Identifier: MIT */
#include "verify/sampler_density.h"

#include <math.h>
#include <stdlib.h>

#include "verify/quadrature.h"
#include "verify/views.h"

enum { BANDS = SAMPLER_BANDS, SECTORS = SAMPLER_SECTORS, PILOT = 20000, PIECES = 32 };

#define PI 3.14159265358979323846

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
static double azimuth_of(const sampler_cells *cells, const double v[3])
{
    return atan2(v[1]*cells->mean_x - v[0]*cells->mean_y, v[0]*cells->mean_x + v[1]*cells->mean_y);
}

int sampler_cell_of(const sampler_cells *cells, double cosine, double azimuth)
{
    const int band = interval_of(cells->cosines, cells->n_bands, cosine);
    return band*SECTORS + interval_of(cells->azimuths[band], SECTORS, azimuth);
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

static void place_borders(sampler_cells *cells, const sampler_subject *s, const double wo[3], pilot *p)
{
    p->n = 0;
    cells->mean_x = 0;
    cells->mean_y = 0;
    for (uint64_t k = 0; k < PILOT; k++)
        if (s->draw(s->context, wo, k, p->v[p->n])) {
            cells->mean_x += p->v[p->n][0];
            cells->mean_y += p->v[p->n][1];
            p->z[p->n] = p->v[p->n][2];
            p->n++;
        }
    if (cells->mean_x == 0 && cells->mean_y == 0) cells->mean_x = 1;
    for (int i = 0; i < p->n; i++) p->phi[i] = azimuth_of(cells, p->v[i]);
    if (cells->n_bands > BANDS) place_bands(p, false, cells->cosines);
    place_bands(p, true, cells->cosines + cells->n_bands - BANDS);
    for (int band = 0; band < cells->n_bands; band++) {
        int m = 0;
        for (int i = 0; i < p->n; i++)
            if (interval_of(cells->cosines, cells->n_bands, p->z[i]) == band) p->values[m++] = p->phi[i];
        quantiles(p->values, m, -PI, PI, cells->azimuths[band], SECTORS);
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
static double cell_mass(const sampler_cells *cells, int band, int sector, const density_of *of)
{
    double z[PIECES + 1], phi[PIECES + 1], mass = 0;
    const int rows = pieces_of(cells->cosines + band/BANDS*BANDS, BANDS, band%BANDS, z);
    const int columns = pieces_of(cells->azimuths[band], SECTORS, sector, phi);
    for (int r = 0; r < rows; r++)
        for (int c = 0; c < columns; c++) {
            const double low[2] = {z[r], phi[c]}, high[2] = {z[r + 1], phi[c + 1]};
            /* An error of 2e-8 is 0.02 samples of a million, where a cell's own spread is some 50. */
            mass += cubature(density_at, of, low, high, 2e-8/(rows*columns), 0);
        }
    return mass;
}

sampler_result sampler_test(const sampler_subject *s, const double wo[3], bool has_two_sides, int n,
                            sampler_cells *cells)
{
    cells->n_bands = has_two_sides ? 2*BANDS : BANDS;
    const int n_cells = cells->n_bands*SECTORS;
    pilot *p = malloc(sizeof *p);
    if (!p) abort();
    place_borders(cells, s, wo, p);
    free(p);
    const density_of of = {s, {wo[0], wo[1], wo[2]}, atan2(cells->mean_y, cells->mean_x)};
    double lost = 1;
    for (int i = 0; i < n_cells; i++) {
        const double mass = cell_mass(cells, i/SECTORS, i%SECTORS, &of);
        lost -= mass;
        cells->expected[i] = mass*n;
        cells->observed[i] = 0;
    }
    cells->expected[n_cells] = fmax(lost, 0)*n;
    cells->observed[n_cells] = 0;
    for (int k = 0; k < n; k++) {
        double wi[3];
        const bool is_sample = s->draw(s->context, wo, PILOT + (uint64_t)k, wi);
        cells->observed[is_sample ? sampler_cell_of(cells, wi[2], azimuth_of(cells, wi)) : n_cells]++;
    }
    const double unsampled = cells->observed[n_cells];
    /* What the cubature leaves undecided, its tolerance times the cells, is not zero probability. */
    if (unsampled > 0 && lost < 2e-8*n_cells) cells->expected[n_cells] = 2e-8*n_cells*n;
    return (sampler_result){chi_square_test(cells->expected, cells->observed, n_cells + 1), 1 - lost, unsampled/n};
}
