/* sky.c: latitude-longitude environment maps.
 * SPDX-License-Identifier: MIT */
#include "render/sky.h"

#include <math.h>
#include <stdlib.h>

#include "core/error.h"

static real3 texel_at(const environment *e, size_t x, size_t y)
{
    const float *c = (const float *)e->map.pixels + 3*(y*e->map.width + x);
    return make3(c[0], c[1], c[2]);
}

/* A texel as it is used: black where it is not a finite non-negative colour. */
static real3 clean_texel(const environment *e, size_t x, size_t y)
{
    const real3 t = texel_at(e, x, y);
    const bool is_clean = t.x >= 0 && t.y >= 0 && t.z >= 0 && t.x <= REAL_MAX && t.y <= REAL_MAX && t.z <= REAL_MAX;
    return is_clean ? t : splat3(0);
}

real3 sky_radiance(const sky *s, real3 d)
{
    const environment *e = s->environment;
    const real3 scale = vector_of(e->scale);
    if (!e->map.pixels) return scale;
    const size_t w = e->map.width, h = e->map.height;
    const float u = katan2(d.z, d.x)*INV_TWO_PI + 0.5f, v = kacos(kmin(kmax(d.y, -1), 1))*INV_PI;
    const float x = u*(float)w - 0.5f, y = kmin(kmax(v*(float)h - 0.5f, 0), (float)(h - 1));
    const float x0 = floorf(x), y0 = floorf(y);
    const float fx = x - x0, fy = y - y0;
    const size_t column[2] = {(size_t)((int64_t)x0 + (int64_t)w)%w, (size_t)((int64_t)x0 + 1 + (int64_t)w)%w};
    const size_t row[2] = {(size_t)y0, (size_t)y0 + 1 < h ? (size_t)y0 + 1 : h - 1};
    real3 sum = splat3(0);
    for (int corner = 0; corner < 4; corner++) {
        const int i = corner & 1, j = corner >> 1;
        sum = madd3(sum, (i ? fx : 1 - fx)*(j ? fy : 1 - fy), clean_texel(e, column[i], row[j]));
    }
    return mul3(sum, scale);
}

/* cos(theta) at the upper edge of a row; theta is measured from +y. */
static float row_edge(const sky *s, size_t row)
{
    return kcos(PI*(float)row/(float)s->environment->map.height);
}

/* cos at the upper edge of a row minus cos at the lower one, without cancellation. */
static float row_extent(const sky *s, size_t row)
{
    const float step = PI/(float)s->environment->map.height;
    return 2*ksin(((float)row + 0.5f)*step)*ksin(0.5f*step);
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
    return 0.5*(double)row_extent(s, row)/(double)s->environment->map.width; /* in units of 4 pi */
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
    if (!weights) return facet_error_set(why, FACET_NO_MEMORY, "environment", "no memory for its sampling table");
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
}

real3 sky_sample(const sky *s, uint32_t u, float v, float w, float *pdf)
{
    if (!s->texels.cells) {
        const float z = 1 - 2*v;
        const float sin = ksqrt(kmax((1 - z)*(1 + z), 0));
        const real2 azimuth = kcossin_turn(w);
        *pdf = INV_FOUR_PI;
        return make3(sin*azimuth.x, z, sin*azimuth.y);
    }
    uint32_t rest;
    const uint32_t cell = alias_table_draw(&s->texels, u, &rest);
    const size_t width = s->environment->map.width;
    const size_t x = cell%width, y = cell/width;
    const float extent = row_extent(s, y);
    const float cos = row_edge(s, y) - extent*v;
    const float sin = ksqrt(kmax((1 - cos)*(1 + cos), 0));
    const real2 azimuth = kcossin_turn(((float)x + w)/(float)width - 0.5f);
    *pdf = s->texels.cells[cell].probability*(float)width/(TWO_PI*extent);
    return make3(sin*azimuth.x, cos, sin*azimuth.y);
}

float sky_pdf(const sky *s, real3 d)
{
    if (!s->texels.cells) return INV_FOUR_PI;
    const size_t w = s->environment->map.width, h = s->environment->map.height;
    const float u = katan2(d.z, d.x)*INV_TWO_PI + 0.5f, v = kacos(kmin(kmax(d.y, -1), 1))*INV_PI;
    const size_t x = (size_t)kmin(kmax(u*(float)w, 0), (float)(w - 1));
    const size_t y = (size_t)kmin(kmax(v*(float)h, 0), (float)(h - 1));
    return s->texels.cells[y*w + x].probability*(float)w/(TWO_PI*row_extent(s, y));
}
