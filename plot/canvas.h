/* canvas.h: a page to draw on, kept as SVG, PNG or PDF.
 *
 * Coordinates are pixels (1/96 inch in SVG and PDF), x to the right, y downwards.  The same drawing gives the same
 * bytes: no file holds a date, and text is drawn as outlines of one font.  An error while drawing shows when the page
 * is written.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdbool.h>
#include <stddef.h>

#include "facet/facet.h"
#include "io/image_file.h"
#include "plot/palette.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct point {
    double x, y;
} point;

typedef struct box {
    double x, y, width, height;
} box;

typedef struct canvas canvas;

/* What the name's extension, in any case, asks for. */
typedef enum canvas_kind { CANVAS_SVG, CANVAS_PNG, CANVAS_PDF, CANVAS_UNKNOWN } canvas_kind;
canvas_kind canvas_kind_of(const char *path);

/* A white page; width and height in [1, 16384].  em: the height of a line of small text, which other sizes follow.
 * FACET_UNSUPPORTED if the library was built without Cairo. */
facet_status canvas_create(canvas_kind kind, double width, double height, double em, canvas **page, facet_error *why);
void canvas_destroy(canvas *page);

/* Writes the page, whole or not at all.  The texts go into the file as its metadata: the first one's value is the
 * title. */
facet_status canvas_write(canvas *page, const char *path, const image_text *texts, size_t n_texts, facet_error *why);

double canvas_em(const canvas *page);

typedef enum dash { SOLID, DASHED, DOTTED, DASH_DOTTED, N_DASHES } dash;

typedef struct pen {
    colour ink;
    double width; /* [em] */
    dash dash;
} pen;

/* A path is begun with canvas_move, goes on with canvas_line, may go back to its start with canvas_close, and ends in
 * canvas_stroke or canvas_fill. */
void canvas_move(canvas *page, point to);
void canvas_line(canvas *page, point to);
void canvas_close(canvas *page);
void canvas_stroke(canvas *page, pen p);
void canvas_fill(canvas *page, colour ink);

void canvas_segment(canvas *page, point from, point to, pen p);
void canvas_fill_box(canvas *page, box area, colour ink);
void canvas_stroke_box(canvas *page, box area, pen p);
void canvas_circle(canvas *page, point centre, double radius, pen p);
void canvas_disc(canvas *page, point centre, double radius, colour ink);

/* Until canvas_unclip nothing is drawn outside of the area. */
void canvas_clip(canvas *page, box area);
void canvas_unclip(canvas *page);

/* n_rows of n_columns opaque cells, row 0 at the top, fill the area without being smoothed. */
typedef colour cell_function(const void *context, size_t column, size_t row);
void canvas_cells(canvas *page, box area, size_t n_columns, size_t n_rows, cell_function *cell, const void *context);

typedef struct text_style {
    double size; /* [em] */
    colour ink;
    double across;   /* where the text has the point: 0 at its left end, 0.5, 1 at its right end */
    double down;     /* ... and 0 at its top, 0.5, 1 on its base line */
    double angle;    /* counter-clockwise [degrees] */
    bool is_formula; /* `_` lowers and `^` raises the next character, or what stands in braces */
    bool is_bold;
} text_style;

/* UTF-8; what is not is drawn as `?`. */
void canvas_text(canvas *page, point at, text_style style, const char *text);
double canvas_text_width(canvas *page, text_style style, const char *text);

#ifdef __cplusplus
}
#endif
