/* axis.h: an axis: its range, where a value lies on it, and round numbers to mark.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum axis_scale { AXIS_LINEAR, AXIS_LOG, AXIS_DEGREES } axis_scale;

typedef struct axis {
    const char *name; /* with its unit; a formula (text_style) */
    axis_scale scale;
    double low, high; /* low < high, or both 0: as the data ask for */
} axis;

/* A fitted axis: finite low < high, more than rounding apart, positive if it is logarithmic, and ends at round numbers
 * where the caller had left the range open.  low and high are those of the data; a linear range of values that are not
 * negative starts at 0, and a logarithmic one reaches down at most eight decades.  Data without a range (NaN, infinite,
 * all the same, on a logarithmic axis not positive) give a range around them, or the unit range. */
axis axis_fit(axis a, double low, double high);

/* Grows *low and *high to hold the value, unless it is not finite or, on a logarithmic axis, not positive; they start
 * at INFINITY and -INFINITY. */
void axis_include(const axis *a, double value, double *low, double *high);

/* 0 at low to 1 at high, beyond them outside; -INFINITY for what a logarithm cannot show, NaN for NaN. */
double axis_place(const axis *a, double value);

enum { AXIS_MOST_TICKS = 128, AXIS_LABEL_CAP = 32 };

typedef struct axis_tick {
    double value;
    char label[AXIS_LABEL_CAP]; /* a formula; empty for a minor tick */
} axis_tick;

typedef struct axis_ticks {
    size_t n;
    axis_tick ticks[AXIS_MOST_TICKS];
} axis_ticks;

/* Ticks of a fitted axis, in increasing order; at most `most` of them (2 or more) have labels. */
axis_ticks axis_make_ticks(const axis *a, int most);

#ifdef __cplusplus
}
#endif
