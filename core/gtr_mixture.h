/* gtr_mixture.h: a GTR as a mixture of GGX with complex roughness, and what it gives for a few directions.
 *
 * In numbers of type double whatever the precision of the file that includes it, so that the loop is compiled once for
 * each instruction set (batch.h); only + - * / and square roots, so that all give the same bits.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kernel/gtr_terms.h"

enum { GTR_NODES = 128, GTR_POINTS = GTR_TERMS };

/* Its upper half: nodes a = roughness^2, and a times their weights w; the sum of Im w is 1.  gtr_fit.c. */
typedef struct gtr_mixture {
    int n;
    double re[GTR_NODES], im[GTR_NODES], b_re[GTR_NODES], b_im[GTR_NODES];
} gtr_mixture;

/* GTR_POINTS directions: cos, sin^2, and (M - mu)/sin, M = mu (1 + 2 Lambda). */
typedef struct gtr_directions {
    double cosine[GTR_POINTS], sin2[GTR_POINTS], excess[GTR_POINTS];
} gtr_directions;

/* The sum of Im(a w/(sqrt(cos^2 + a sin^2) + cos)), which has no cancellation at small roughness.  The elements of a
 * vector are directions, so that the order of the sum does not depend on the processor. */
static inline __attribute__((unused, always_inline)) void gtr_find_excess(const gtr_mixture *m, gtr_directions *d)
{
    double sum[GTR_POINTS] = {0};
    for (int k = 0; k < m->n; k++) {
        const double re = m->re[k], im = m->im[k], b_re = m->b_re[k], b_im = m->b_im[k];
#pragma omp simd
        for (int j = 0; j < GTR_POINTS; j++) {
            const double cosine = d->cosine[j];
            const double x = cosine*cosine + re*d->sin2[j], y = im*d->sin2[j];
            const double size = x > 0 ? x : -x;
            const double big = __builtin_sqrt(0.5*(__builtin_sqrt(x*x + y*y) + size)), small = 0.5*y/big;
            const double u = x > 0 ? big : small, v = x > 0 ? small : big; /* the root is u + i v */
            const double c = u + cosine;
            sum[j] += (b_im*c - b_re*v)/(c*c + v*v);
        }
    }
    for (int j = 0; j < GTR_POINTS; j++) d->excess[j] = sum[j];
}
