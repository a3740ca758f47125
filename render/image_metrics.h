/* image_metrics.h: how much two pictures differ.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "facet/facet.h"
#include "render/image.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Per channel, over all pixels, summed in double. */
typedef struct image_difference {
    double mean_a[3], mean_b[3];
    double mse[3];      /* mean of (a - b)^2 */
    double rel_mse[3];  /* mean of (a - b)^2/(b^2 + 0.01): b is the reference */
    double largest[3];  /* |a - b| */
    size_t n_different; /* pixels */
    size_t n_bad;       /* pixels with a NaN or infinity in either picture; they make the means NaN or infinite */
} image_difference;

/* a, b: F32 RGB of the same size. */
image_difference image_compare(const image *a, const image *b);

/* The perceived difference of two pictures, 0 to 1, as an observer sees it who flips between them on a
 * screen with 67 pixels per degree of view.  a (under test), b (reference): F32 RGB of the same size,
 * display values in [0,1], sRGB encoded.  errors: one value per pixel; *mean is their average.
 *
 * [flip] P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. D. Fairchild, "FLIP: A
 * Difference Evaluator for Alternating Images", Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. */
facet_status image_flip(const image *a, const image *b, float *errors, double *mean, facet_error *why);

#ifdef __cplusplus
}
#endif
