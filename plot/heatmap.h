/* heatmap.h: values over two axes as colours, with a bar that tells them; and pictures over two axes.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/frame.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct heatmap {
    const char *title; /* plain text; NULL: none */
    axis x, y;         /* with their ranges */
    axis z;            /* of the values: name and scale; an open range holds all of them */
    size_t n_columns, n_rows;
    const double *values; /* [n_rows][n_columns], the row of lowest y first; NaN: grey */
    bool is_diverging;    /* blue below 0, white at 0, orange above, as far on both sides; z is linear then */
} heatmap;

void heatmap_draw(canvas *page, box place, const heatmap *h);

/* Colours that need no bar; row 0 is at the top.  The picture keeps the shape of `place` unless is_square. */
typedef struct cell_map {
    const char *title;
    axis x, y;
    size_t n_columns, n_rows;
    cell_function *cell;
    const void *context;
    bool is_square;
} cell_map;

void cell_map_draw(canvas *page, box place, const cell_map *p);

#ifdef __cplusplus
}
#endif
