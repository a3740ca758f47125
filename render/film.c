/* film.c: exact sums of samples per pixel.
 * SPDX-License-Identifier: MIT */
#include "render/film.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const double UNITS = 0x1p52, SQUARE_UNITS = 0x1p40;
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

void film_merge(film *f, const film *other)
{
    for (size_t i = 0; i < f->width*f->height; i++) {
        film_pixel *p = &f->pixels[i];
        const film_pixel *q = &other->pixels[i];
        for (int k = 0; k < 3; k++) add_sum(&p->rgb[k], q->rgb[k]);
        add_sum(&p->luminance_squares, q->luminance_squares);
        p->n += q->n;
    }
    f->n_clamped += other->n_clamped;
}

/* The mean of a pixel with samples. */
static void mean_of(const film_pixel *p, double mean[3])
{
    for (int k = 0; k < 3; k++) mean[k] = value_of_signed(p->rgb[k])/UNITS/p->n;
}

double film_noise(const film *f)
{
    double variance = 0, total = 0;
    const size_t n_pixels = f->width*f->height;
    for (size_t i = 0; i < n_pixels; i++) {
        const film_pixel *p = &f->pixels[i];
        if (p->n < 2) return -1;
        double mean[3];
        mean_of(p, mean);
        const double n = p->n, m = luminance_of(mean);
        variance += fmax(value_of_unsigned(p->luminance_squares)/SQUARE_UNITS/n - m*m, 0)/(n - 1);
        total += m;
    }
    return total > 0 ? sqrt(variance/(double)n_pixels)/(total/(double)n_pixels) : -1;
}

facet_status film_develop(const film *f, image *picture)
{
    const size_t n_pixels = f->width*f->height;
    float *pixels = calloc(n_pixels, 3*sizeof *pixels);
    if (!pixels) return FACET_NO_MEMORY;
    for (size_t i = 0; i < n_pixels; i++) {
        double mean[3];
        if (f->pixels[i].n == 0) continue;
        mean_of(&f->pixels[i], mean);
        for (size_t k = 0; k < 3; k++) pixels[3*i + k] = (float)mean[k];
    }
    *picture = (image){.width = f->width, .height = f->height, .n_channels = 3, .type = PIXEL_F32, .pixels = pixels};
    return FACET_OK;
}
