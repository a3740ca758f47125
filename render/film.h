/* film.h: exact sums of samples per pixel.
 *
 * A sum is a whole number of 2^-52 in 128 bits, so that it does not depend on the order of the samples, nor on how
 * they were divided among threads, machines and runs.  The unit is chosen for as much room above 1 as below, beside
 * the 2^24 samples that a pixel may have: radiance from 2^-29 (2e-9) up is kept to its last bit, smaller one is rounded
 * to the unit, and what exceeds 2^51 (2e15; the sun seen in a mirror of alpha = 1e-4 in lux: 3e12) is clamped and
 * counted.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* In two's complement; -Wpedantic has no 128-bit integer. */
typedef struct exact_sum {
    uint64_t low, high;
} exact_sum;

typedef struct film_pixel {
    exact_sum rgb[3];            /* [2^-52] */
    exact_sum luminance_squares; /* for the noise estimate [2^-40], unsigned: luminance above 4e9 counts as that */
    uint32_t n;
} film_pixel;

typedef struct film {
    size_t width, height;
    film_pixel *pixels; /* [height][width] */
    uint64_t n_clamped; /* samples with a channel beyond FILM_MOST; atomic */
} film;

/* The largest magnitude of a sample's channel, 2^51 less one bit. */
#define FILM_MOST 0x1.fffffep50f

facet_status film_create(size_t width, size_t height, film *f);
void film_destroy(film *f);

/* Adds a sample of finite numbers.  Threads may add to different pixels at once. */
void film_add(film *f, size_t x, size_t y, const float rgb[3]);

/* Adds all samples of a film of the same size: the sums are those of one film that got every sample. */
void film_merge(film *f, const film *other);

/* Relative standard error of the picture: the root mean square over pixels of the standard error of the mean
 * luminance, over the picture's mean luminance.  Negative below two samples per pixel or if all is black. */
double film_noise(const film *f);

/* Means as an F32 RGB picture. */
facet_status film_develop(const film *f, image *picture);

#ifdef __cplusplus
}
#endif
