/* frame.h: what charts and heat maps share: a title, a frame, two axes with ticks, labels and names; and panels.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/axis.h"
#include "plot/canvas.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Sizes of text [em]. */
#define TITLE_SIZE 1.15
#define NAME_SIZE 1.0
#define LABEL_SIZE 0.9

/* The k-th of n places of one shape, in rows of n_columns from the top left. */
box panel_place(box whole, size_t n, size_t n_columns, size_t k);

/* Draws the title (NULL: none) at the top of *place, above the middle of what is at x; *place becomes what is left
 * below. */
void frame_title(canvas *page, box *place, double x, const char *title);

typedef struct frame {
    axis x, y;  /* fitted */
    box inside; /* where the data go */
} frame;

/* The room inside for two fitted axes with their labels and names in `place`. */
frame frame_make(canvas *page, box place, axis x, axis y);

/* Grid lines, to be drawn before the data. */
void frame_draw_grid(canvas *page, const frame *f);
/* The border, ticks, labels and names. */
void frame_draw(canvas *page, const frame *f);

/* Where a point lies; beyond the frame it stays within twice its size, and lines to it keep their direction nearly. */
point frame_at(const frame *f, double x, double y);

/* The width that the labels of a vertical fitted axis need, and its labels and name (NULL: none) beside a vertical line
 * at x: on the left of it, or on the right. */
double frame_label_width(canvas *page, const axis *a, double height);
void frame_draw_vertical(canvas *page, const axis *a, box beside, bool is_right);

#ifdef __cplusplus
}
#endif
