/* sky.c: latitude-longitude environment maps.
 * SPDX-License-Identifier: MIT */
#include "render/sky.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"
#include "render/expect.h"

static real3 texel_at(const environment *e, size_t x, size_t y)
{
    const float *c = (const float *)e->map.pixels + 3*(y*e->map.width + x);
    return make3(c[0], c[1], c[2]);
}

/* What the texels of a row have in common; cosines of theta, measured from +y. */
typedef struct sky_row {
    float edge;   /* cos at the upper edge */
    float extent; /* less cos at the lower one, without cancellation */
} sky_row;

/* A texel as it is used: black where it is not a finite non-negative colour. */
static real3 clean_texel(const environment *e, size_t x, size_t y)
{
    const real3 t = texel_at(e, x, y);
    const bool is_clean = t.x >= 0 && t.y >= 0 && t.z >= 0 && t.x <= REAL_MAX && t.y <= REAL_MAX && t.z <= REAL_MAX;
    return is_clean ? t : splat3(0);
}

real3 sky_radiance_at(const sky *s, real2 place)
{
    const environment *e = s->environment;
    const real3 scale = vector_of(e->scale);
    if (!e->map.pixels) return scale;
    const size_t w = e->map.width, h = e->map.height;
    const float x = place.x*(float)w - 0.5f, y = kmin(kmax(place.y*(float)h - 0.5f, 0), (float)(h - 1));
    const float x0 = floorf(x), y0 = floorf(y);
    const float fx = x - x0, fy = y - y0;
    const size_t left = x0 < 0 ? w - 1 : (size_t)x0 < w ? (size_t)x0 : 0;
    const size_t column[2] = {left, left + 1 < w ? left + 1 : 0};
    const size_t row[2] = {(size_t)y0, (size_t)y0 + 1 < h ? (size_t)y0 + 1 : h - 1};
    real3 sum = splat3(0);
    for (int corner = 0; corner < 4; corner++) {
        const int i = corner & 1, j = corner >> 1;
        const real3 t = s->n_dropped ? clean_texel(e, column[i], row[j]) : texel_at(e, column[i], row[j]);
        sum = madd3(sum, (i ? fx : 1 - fx)*(j ? fy : 1 - fy), t);
    }
    return mul3(sum, scale);
}

real3 sky_radiance(const sky *s, real3 direction)
{
    return sky_radiance_at(s, sky_place(direction));
}

static facet_status create_rows(sky *s)
{
    const size_t h = s->environment->map.height;
    const float step = PI/(float)h;
    s->rows = calloc(h + 1, sizeof *s->rows);
    if (!s->rows) return FACET_NO_MEMORY;
    for (size_t y = 0; y < h; y++)
        s->rows[y] = (sky_row){kcos(PI*(float)y/(float)h), 2*ksin(((float)y + 0.5f)*step)*ksin(0.5f*step)};
    return FACET_OK;
}

/* The integral of the bilinear interpolant over a texel weighs it and its neighbours by (1, 6, 1)/8 along both
 * axes, which is positive wherever the interpolant is positive somewhere in the texel. */
static double texel_weight(const environment *e, size_t x, size_t y)
{
    static const double taps[3] = {0.125, 0.75, 0.125};
    const size_t w = e->map.width, h = e->map.height;
    double sum = 0;
    for (size_t j = 0; j < 3; j++)
        for (size_t i = 0; i < 3; i++) {
            const size_t row = y + j < 1 ? 0 : y + j > h ? h - 1 : y + j - 1;
            const real3 t = mul3(clean_texel(e, (x + i + w - 1)%w, row), vector_of(e->scale));
            sum += taps[i]*taps[j]*(0.2126*(double)t.x + 0.7152*(double)t.y + 0.0722*(double)t.z);
        }
    return sum;
}

static double solid_angle(const sky *s, size_t row)
{
    return 0.5*(double)s->rows[row].extent/(double)s->environment->map.width; /* in units of 4 pi */
}

/* Takes the mean luminance from every weight.  [karlik19] Karlik, Sik, Vevoda, Skrivan and Krivanek, MIS compensation,
 * 2019: what is dimmer is left to scattered rays, which find it well enough.  A sky that is even keeps its weights. */
static void compensate(const sky *s, double *weights, double mean)
{
    const size_t w = s->environment->map.width, n = w*s->environment->map.height;
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += fmax(weights[i] - mean*solid_angle(s, i/w), 0);
    if (!(sum > 1e-3*mean)) return;
    for (size_t i = 0; i < n; i++) weights[i] = fmax(weights[i] - mean*solid_angle(s, i/w), 0);
}

facet_status sky_create(const environment *e, bool is_compensated, sky *result, facet_error *why)
{
    *result = (sky){.environment = e, .mean = (double)luminance(vector_of(e->scale))};
    if (!e->map.pixels) return FACET_OK;
    const size_t w = e->map.width, h = e->map.height;
    if (w*h > UINT32_MAX/2) return facet_error_set(why, FACET_UNSUPPORTED, "environment", "more than 2^31 texels");
    double *weights = calloc(w*h, sizeof *weights);
    if (!weights || create_rows(result)) {
        free(weights);
        return facet_error_set(why, FACET_NO_MEMORY, "environment", "no memory for its sampling table");
    }
    double sum = 0, solid_sum = 0;
    for (size_t y = 0; y < h; y++) {
        const double solid = solid_angle(result, y);
        for (size_t x = 0; x < w; x++) {
            const real3 t = texel_at(e, x, y), c = clean_texel(e, x, y);
            if (!(t.x == c.x && t.y == c.y && t.z == c.z)) result->n_dropped++;
            weights[y*w + x] = solid*texel_weight(e, x, y);
            sum += weights[y*w + x];
            solid_sum += solid;
        }
    }
    if (is_compensated) compensate(result, weights, sum/solid_sum);
    result->mean = sum;
    const facet_status status = alias_table_create(weights, (uint32_t)(w*h), &result->texels);
    free(weights);
    if (status) facet_error_set(why, status, "environment", "no memory for its sampling table");
    return status;
}

void sky_destroy(sky *s)
{
    alias_table_destroy(&s->texels);
    free(s->rows);
    s->rows = NULL;
}

uint32_t sky_draw_texel(const sky *s, uint32_t u)
{
    uint32_t rest;
    return s->texels.cells ? alias_table_draw(&s->texels, u, &rest) : 0;
}

real3 sky_sample(const sky *s, uint32_t drawn, float v, float w, float *pdf)
{
    if (!s->texels.cells) {
        const float z = 1 - 2*v;
        const float sin = ksqrt(kmax((1 - z)*(1 + z), 0));
        const real2 azimuth = kcossin_turn(w);
        *pdf = INV_FOUR_PI;
        return make3(sin*azimuth.x, z, sin*azimuth.y);
    }
    const uint32_t width = (uint32_t)s->environment->map.width;
    const uint32_t x = drawn%width, y = drawn/width;
    const sky_row row = s->rows[y];
    const float cos = row.edge - row.extent*v;
    const float sin = ksqrt(kmax((1 - cos)*(1 + cos), 0));
    *pdf = s->texels.cells[drawn].probability*(float)width/(TWO_PI*row.extent);
    const real2 azimuth = kcossin_turn(((float)x + w)/(float)width - 0.5f);
    return make3(sin*azimuth.x, cos, sin*azimuth.y);
}

static size_t texel_of_place(const sky *s, real2 place)
{
    const size_t w = s->environment->map.width, h = s->environment->map.height;
    const size_t x = (size_t)kmin(kmax(place.x*(float)w, 0), (float)(w - 1));
    const size_t y = (size_t)kmin(kmax(place.y*(float)h, 0), (float)(h - 1));
    return y*w + x;
}

float sky_pdf(const sky *s, real2 place)
{
    if (!s->texels.cells) return INV_FOUR_PI;
    const size_t w = s->environment->map.width, texel = texel_of_place(s, place);
    return s->texels.cells[texel].probability*(float)w/(TWO_PI*s->rows[texel/w].extent);
}

void sky_expect_draw(const sky *s, uint32_t u)
{
    if (s->texels.cells) alias_table_expect(&s->texels, u);
}

/* A texel of interpolation lies in the row above or in that below. */
EXPECTING void expect_texel(const sky *s, size_t texel)
{
    const size_t w = s->environment->map.width, n = w*s->environment->map.height;
    const float *const pixels = s->environment->map.pixels;
    __builtin_prefetch(&s->texels.cells[texel]);
    __builtin_prefetch(pixels + 3*(texel > 0 ? texel - 1 : 0));
    __builtin_prefetch(pixels + 3*(texel >= w ? texel - w : texel));
    __builtin_prefetch(pixels + 3*(texel + w < n ? texel + w : texel));
}

void sky_expect_sample(const sky *s, uint32_t drawn)
{
    if (s->texels.cells) expect_texel(s, drawn);
}

void sky_expect_place(const sky *s, real2 place)
{
    if (s->texels.cells) expect_texel(s, texel_of_place(s, place));
}
