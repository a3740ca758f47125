/* film.h: exact sums of samples per pixel.
 *
 * A sum is a whole number of 2^-52 in 128 bits, so that it does not depend on the order of the samples, nor on how
 * they were divided among threads, machines and runs.  The unit is chosen for as much room above 1 as below, beside
 * the 2^24 samples that a pixel may have: radiance from 2^-29 (2e-9) up is kept to its last bit, smaller one is rounded
 * to the unit, and what exceeds 2^51 (2e15; the sun seen in a mirror of alpha = 1e-4 in lux: 3e12) is clamped and
 * counted.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
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

/* What the first surfaces look like, for denoisers and compositing: sums of numbers from -1 to 1 in units of 2^-32. */
typedef struct film_features {
    int64_t albedo[3], normal[3];
    exact_sum distance; /* [2^-52 m], of the n_hits samples that met a surface */
    uint32_t n_hits;
} film_features;

typedef struct film {
    size_t width, height;
    film_pixel *pixels;      /* [height][width] */
    film_features *features; /* [height][width], or NULL: not kept */
    uint64_t n_clamped;      /* samples with a channel beyond FILM_MOST; atomic */
} film;

/* The largest magnitude of a sample's channel, 2^51 less one bit. */
#define FILM_MOST 0x1.fffffep50f

facet_status film_create(size_t width, size_t height, film *f);
void film_destroy(film *f);

/* Adds a sample of finite numbers.  Threads may add to different pixels at once. */
void film_add(film *f, size_t x, size_t y, const float rgb[3]);

/* Makes room for features, all zero. */
facet_status film_keep_features(film *f);

/* What one sample saw first. */
typedef struct feature {
    float albedo[3]; /* 0 to 1: more counts as 1 */
    float normal[3]; /* unit, or 0 */
    float distance;  /* [m]; INFINITY: it met nothing */
} feature;

/* Adds a sample's feature, in the same way as film_add.  What is not a number counts as 0. */
void film_add_feature(film *f, size_t x, size_t y, const feature *seen);

/* Adds all samples of a film of the same size: the sums are those of one film that got every sample. */
void film_merge(film *f, const film *other);

/* The error of a part of the picture, x0 <= x < x1, y0 <= y < y1.  False below two samples in some pixel. */
typedef struct film_error {
    double luminance; /* mean */
    double deviation; /* standard error of a pixel's mean luminance: root of the mean square over pixels */
} film_error;
bool film_measure(const film *f, size_t x0, size_t y0, size_t x1, size_t y1, film_error *error);

/* Estimated relative error of the picture: the mean over blocks of FILM_BLOCK x FILM_BLOCK pixels of their deviation,
 * over the picture's mean luminance.  A pixel that a rare bright path has hit counts in its block alone.  Negative
 * below two samples per pixel or if all is black. */
double film_noise(const film *f);
#define FILM_BLOCK 32

/* Mean samples per pixel. */
double film_mean_samples(const film *f);

/* Means as an F32 RGB picture. */
facet_status film_develop(const film *f, image *picture);

/* Further pictures of a film; all but the samples need features.  albedo: F32 RGB, 0 to 1; normal: F32, three channels,
 * mean of unit vectors in world space; distance: F32, from the camera [m], mean of what met a surface, INFINITY where
 * nothing did; samples: F32, how many each pixel has. */
typedef enum film_layer { FILM_ALBEDO, FILM_NORMAL, FILM_DISTANCE, FILM_SAMPLES } film_layer;
facet_status film_develop_layer(const film *f, film_layer layer, image *picture);

#ifdef __cplusplus
}
#endif
