/* film.c: sums of samples per pixel.
 * SPDX-License-Identifier: MIT */
#include "render/film.h"

#include <math.h>
#include <stdlib.h>

static double luminance_of(const double rgb[3])
{
    return 0.2126*rgb[0] + 0.7152*rgb[1] + 0.0722*rgb[2];
}

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
    const double c[3] = {rgb[0], rgb[1], rgb[2]};
    const double light = luminance_of(c);
    for (int k = 0; k < 3; k++) p->sum[k] += c[k];
    p->luminance_squares += light*light;
    p->n++;
}

double film_noise(const film *f)
{
    double variance = 0, mean = 0;
    const size_t n_pixels = f->width*f->height;
    for (size_t i = 0; i < n_pixels; i++) {
        const film_pixel *p = &f->pixels[i];
        if (p->n < 2) return -1;
        const double n = p->n, m = luminance_of(p->sum)/n;
        variance += fmax(p->luminance_squares/n - m*m, 0)/(n - 1);
        mean += m;
    }
    return mean > 0 ? sqrt(variance/(double)n_pixels)/(mean/(double)n_pixels) : -1;
}

facet_status film_develop(const film *f, image *picture)
{
    const size_t n_pixels = f->width*f->height;
    float *pixels = malloc(3*n_pixels*sizeof *pixels);
    if (!pixels) return FACET_NO_MEMORY;
    for (size_t i = 0; i < n_pixels; i++) {
        const film_pixel *p = &f->pixels[i];
        for (int k = 0; k < 3; k++) pixels[3*i + (size_t)k] = p->n ? (float)(p->sum[k]/p->n) : 0;
    }
    *picture = (image){.width = f->width, .height = f->height, .n_channels = 3, .type = PIXEL_F32, .pixels = pixels};
    return FACET_OK;
}
