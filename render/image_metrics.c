/* image_metrics.c: plain differences of two pictures, channel by channel.
 * SPDX-License-Identifier: MIT */
#include "render/image_metrics.h"

#include <math.h>
#include <stdbool.h>

image_difference image_compare(const image *a, const image *b)
{
    image_difference d = {0};
    const float(*pa)[3] = (const float(*)[3])a->pixels, (*pb)[3] = (const float(*)[3])b->pixels;
    const size_t n = a->width*a->height;
    for (size_t i = 0; i < n; i++) {
        bool is_different = false, is_finite = true;
        for (int k = 0; k < 3; k++) {
            const double x = pa[i][k], y = pb[i][k], e = x - y;
            d.mean_a[k] += x;
            d.mean_b[k] += y;
            d.mse[k] += e*e;
            d.rel_mse[k] += e*e/(y*y + 0.01);
            d.largest[k] = fmax(d.largest[k], fabs(e));
            is_different = is_different || x != y;
            is_finite = is_finite && isfinite(x) && isfinite(y);
        }
        d.n_different += is_different;
        d.n_bad += !is_finite;
    }
    for (int k = 0; k < 3; k++) {
        d.mean_a[k] /= (double)n;
        d.mean_b[k] /= (double)n;
        d.mse[k] /= (double)n;
        d.rel_mse[k] /= (double)n;
    }
    return d;
}
