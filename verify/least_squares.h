/* least_squares.h: the least sum of squares of functions of a few unknowns between 0 and 1.
 *
 * Of our own, since C libraries either know no bounds (MINPACK, GSL), at which many materials lie (kd = 0, ks = 1), or
 * do not use that it is squares that are summed (NLopt).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* residuals[0..n_residuals-1] of x[0..n-1]; false where the functions have no value. */
typedef bool least_squares_function(void *user, const double *x, double *residuals);

typedef struct least_squares {
    size_t n, n_residuals;
    least_squares_function *evaluate;
    void *user;
    double *work; /* [least_squares_room] */
} least_squares;

size_t least_squares_room(size_t n, size_t n_residuals);

/* Goes downhill from x, which stays within [0,1], by Levenberg and Marquardt's method with differences for
 * derivatives; unknowns at a bound rest there while the way down leads out.  Returns the sum of squares at x; infinite
 * where there is none at the start. */
double least_squares_descend(const least_squares *p, double *x);

#ifdef __cplusplus
}
#endif
