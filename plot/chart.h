/* chart.h: curves and points over two axes, with a legend above them that hides nothing.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum series_shape { SERIES_LINE, SERIES_POINTS } series_shape;

/* n points; those that are not finite interrupt a line, and so does what a logarithm cannot show. */
typedef struct series {
    const char *label; /* plain text; NULL: not in the legend */
    size_t n;
    const double *x, *y;
    const double *below, *above; /* [n], the edges of a band around the line; both or NULL */
    series_shape shape;
    colour ink;
    dash dash;
} series;

/* The k-th of many: no two of 28 look the same, and neighbours differ in colour and in dashes. */
series series_make(size_t k, const char *label, size_t n, const double *x, const double *y);

typedef struct chart {
    const char *title; /* plain text; NULL: none */
    axis x, y;
    const series *items;
    size_t n_items;
} chart;

/* Draws the chart in `place`; ranges that are left open hold all data. */
void chart_draw(canvas *page, box place, const chart *c);

/* The legend of the items, up to 128, in as few rows as fit at the top of *place, which becomes what is left below. */
void legend_draw(canvas *page, box *place, const series *items, size_t n_items);

#ifdef __cplusplus
}
#endif
