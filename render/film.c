/* film.c: exact sums of samples per pixel.
 * SPDX-License-Identifier: MIT */
#include "render/film.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double UNITS = 0x1p52, SQUARE_UNITS = 0x1p40, FEATURE_UNITS = 0x1p32;
static const double SQUARE_MOST = 0x1.fffffffffffffp63; /* 2^24 of them fit into 2^128 units of 2^-40 */

static double luminance_of(const double rgb[3])
{
    return 0.2126*rgb[0] + 0.7152*rgb[1] + 0.0722*rgb[2];
}

/* ---- Sums ---------------------------------------------------------------------------------------------------- */

static void add_sum(exact_sum *s, exact_sum other)
{
    s->low += other.low;
    s->high += other.high + (s->low < other.low);
}

/* Adds a number below 2^127, rounded to a whole one. */
static void add_number(exact_sum *s, double number)
{
    if (fabs(number) < 0x1p63) {
        const int64_t whole = llrint(number);
        add_sum(s, (exact_sum){(uint64_t)whole, whole < 0 ? UINT64_MAX : 0});
    } else { /* whole, having 53 bits */
        const double high = floor(number*0x1p-64);
        add_sum(s, (exact_sum){(uint64_t)(number - high*0x1p64), (uint64_t)(int64_t)high});
    }
}

static double value_of_unsigned(exact_sum s)
{
    return (double)s.high*0x1p64 + (double)s.low;
}

static double value_of_signed(exact_sum s)
{
    const exact_sum negated = {0 - s.low, ~s.high + (s.low == 0)};
    return s.high >> 63 ? -value_of_unsigned(negated) : value_of_unsigned(s);
}

/* ---- Films --------------------------------------------------------------------------------------------------- */

facet_status film_create(size_t width, size_t height, film *f)
{
    *f = (film){.width = width, .height = height, .pixels = calloc(width*height, sizeof *f->pixels)};
    return f->pixels ? FACET_OK : FACET_NO_MEMORY;
}

void film_destroy(film *f)
{
    free(f->features);
    free(f->pixels);
    *f = (film){0};
}

void film_add(film *f, size_t x, size_t y, const float rgb[3])
{
    film_pixel *p = &f->pixels[y*f->width + x];
    double c[3];
    bool is_clamped = false;
    for (int k = 0; k < 3; k++) {
        const bool is_beyond = fabsf(rgb[k]) > FILM_MOST;
        c[k] = (double)(is_beyond ? copysignf(FILM_MOST, rgb[k]) : rgb[k]);
        is_clamped |= is_beyond;
        add_number(&p->rgb[k], UNITS*c[k]);
    }
    const double light = luminance_of(c), square = light*light;
    add_number(&p->luminance_squares, SQUARE_UNITS*(square < SQUARE_MOST ? square : SQUARE_MOST));
    p->n++;
    if (is_clamped) __atomic_fetch_add(&f->n_clamped, 1, __ATOMIC_RELAXED);
}

facet_status film_keep_features(film *f)
{
    f->features = calloc(f->width*f->height, sizeof *f->features);
    return f->features ? FACET_OK : FACET_NO_MEMORY;
}

/* A number from `least` to 1 in units of 2^-32; NaN counts as 0. */
static int64_t feature_units(float number, double least)
{
    const double x = (double)number;
    return x >= least ? llrint(FEATURE_UNITS*(x < 1 ? x : 1)) : x < least ? llrint(FEATURE_UNITS*least) : 0;
}

/* Sums of samples are far from overflow; those of a damaged checkpoint may wrap around. */
static int64_t wrapped_sum(int64_t a, int64_t b)
{
    return (int64_t)((uint64_t)a + (uint64_t)b);
}

void film_add_feature(film *f, size_t x, size_t y, const feature *seen)
{
    film_features *p = &f->features[y*f->width + x];
    for (int k = 0; k < 3; k++) {
        p->albedo[k] = wrapped_sum(p->albedo[k], feature_units(seen->albedo[k], 0));
        p->normal[k] = wrapped_sum(p->normal[k], feature_units(seen->normal[k], -1));
    }
    if (seen->distance <= FILM_MOST) {
        add_number(&p->distance, UNITS*(double)seen->distance);
        p->n_hits++;
    }
}

static void merge_features(film_features *p, const film_features *q)
{
    for (int k = 0; k < 3; k++) {
        p->albedo[k] = wrapped_sum(p->albedo[k], q->albedo[k]);
        p->normal[k] = wrapped_sum(p->normal[k], q->normal[k]);
    }
    add_sum(&p->distance, q->distance);
    p->n_hits += q->n_hits;
}

void film_merge(film *f, const film *other)
{
    for (size_t i = 0; i < f->width*f->height; i++) {
        film_pixel *p = &f->pixels[i];
        const film_pixel *q = &other->pixels[i];
        for (int k = 0; k < 3; k++) add_sum(&p->rgb[k], q->rgb[k]);
        add_sum(&p->luminance_squares, q->luminance_squares);
        p->n += q->n;
        if (f->features) merge_features(&f->features[i], &other->features[i]);
    }
    f->n_clamped += other->n_clamped;
}

/* The mean of a pixel with samples. */
static void mean_of(const film_pixel *p, double mean[3])
{
    for (int k = 0; k < 3; k++) mean[k] = value_of_signed(p->rgb[k])/UNITS/p->n;
}

bool film_measure(const film *f, size_t x0, size_t y0, size_t x1, size_t y1, film_error *error)
{
    double variance = 0, total = 0;
    for (size_t y = y0; y < y1; y++)
        for (size_t x = x0; x < x1; x++) {
            const film_pixel *p = &f->pixels[y*f->width + x];
            if (p->n < 2) return false;
            double mean[3];
            mean_of(p, mean);
            const double n = p->n, m = luminance_of(mean);
            variance += fmax(value_of_unsigned(p->luminance_squares)/SQUARE_UNITS/n - m*m, 0)/(n - 1);
            total += m;
        }
    const double n_pixels = (double)((x1 - x0)*(y1 - y0));
    *error = (film_error){total/n_pixels, sqrt(variance/n_pixels)};
    return true;
}

double film_noise(const film *f)
{
    double deviation = 0, luminance = 0; /* over all pixels */
    for (size_t y = 0; y < f->height; y += FILM_BLOCK)
        for (size_t x = 0; x < f->width; x += FILM_BLOCK) {
            const size_t x1 = x + FILM_BLOCK < f->width ? x + FILM_BLOCK : f->width,
                         y1 = y + FILM_BLOCK < f->height ? y + FILM_BLOCK : f->height;
            film_error e;
            if (!film_measure(f, x, y, x1, y1, &e)) return -1;
            deviation += e.deviation*(double)((x1 - x)*(y1 - y));
            luminance += e.luminance*(double)((x1 - x)*(y1 - y));
        }
    return luminance > 0 ? deviation/luminance : -1;
}

double film_mean_samples(const film *f)
{
    double n = 0;
    for (size_t i = 0; i < f->width*f->height; i++) n += f->pixels[i].n;
    return n/(double)(f->width*f->height);
}

/* A picture of floats, all zero. */
static facet_status make_picture(const film *f, size_t n_channels, image *picture)
{
    float *pixels = calloc(f->width*f->height, n_channels*sizeof *pixels);
    if (!pixels) return FACET_NO_MEMORY;
    *picture = (image){
        .width = f->width, .height = f->height, .n_channels = n_channels, .type = PIXEL_F32, .pixels = pixels};
    return FACET_OK;
}

facet_status film_develop(const film *f, image *picture)
{
    if (make_picture(f, 3, picture)) return FACET_NO_MEMORY;
    float *pixels = picture->pixels;
    for (size_t i = 0; i < f->width*f->height; i++) {
        double mean[3];
        if (f->pixels[i].n == 0) continue;
        mean_of(&f->pixels[i], mean);
        for (size_t k = 0; k < 3; k++) pixels[3*i + k] = (float)mean[k];
    }
    return FACET_OK;
}

static float mean_distance(const film_features *p)
{
    return p->n_hits ? (float)(value_of_signed(p->distance)/UNITS/p->n_hits) : INFINITY;
}

facet_status film_develop_layer(const film *f, film_layer layer, image *picture)
{
    const size_t n_channels = layer == FILM_ALBEDO || layer == FILM_NORMAL ? 3 : 1;
    if (make_picture(f, n_channels, picture)) return FACET_NO_MEMORY;
    float *to = picture->pixels;
    for (size_t i = 0; i < f->width*f->height; i++, to += n_channels) {
        const uint32_t n = f->pixels[i].n;
        if (layer == FILM_SAMPLES) *to = (float)n;
        else if (layer == FILM_DISTANCE) *to = mean_distance(&f->features[i]);
        else
            for (int k = 0; k < 3; k++) {
                const int64_t sum = layer == FILM_ALBEDO ? f->features[i].albedo[k] : f->features[i].normal[k];
                to[k] = n ? (float)((double)sum/FEATURE_UNITS/n) : 0;
            }
    }
    return FACET_OK;
}
