/* film.h: sums of samples per pixel.
 *
 * A pixel's samples are added in the order of their index by whichever thread has its tile, so the sums do not
 * depend on threads or tiles.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct film_pixel {
    double sum[3];
    double luminance_squares; /* sum of squared luminances, for the noise estimate */
    uint32_t n;
} film_pixel;

typedef struct film {
    size_t width, height;
    film_pixel *pixels; /* [height][width] */
} film;

facet_status film_create(size_t width, size_t height, film *f);
void film_destroy(film *f);

void film_add(film *f, size_t x, size_t y, const float rgb[3]);

/* Relative standard error of the picture: the root mean square over pixels of the standard error of the mean
 * luminance, over the picture's mean luminance.  Negative below two samples per pixel or if all is black. */
double film_noise(const film *f);

/* Means as an F32 RGB picture. */
facet_status film_develop(const film *f, image *picture);

#ifdef __cplusplus
}
#endif
