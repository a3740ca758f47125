/* no_canvas.c: in place of canvas.c where Cairo was not found: no page can be created.
 * SPDX-License-Identifier: MIT */
#include "core/error.h"
#include "plot/canvas.h"

facet_status canvas_create(canvas_kind kind, double width, double height, double em, canvas **page, facet_error *why)
{
    (void)kind, (void)width, (void)height, (void)em, (void)page;
    return facet_error_set(why, FACET_UNSUPPORTED, "",
                           "this build of facet cannot draw; install libcairo2-dev and build it again");
}

void canvas_destroy(canvas *page)
{
    (void)page;
}

facet_status canvas_write(canvas *page, const char *path, const image_text *texts, size_t n_texts, facet_error *why)
{
    (void)page, (void)path, (void)texts, (void)n_texts;
    return facet_error_set(why, FACET_UNSUPPORTED, "", "this build of facet cannot draw");
}

double canvas_em(const canvas *page)
{
    (void)page;
    return 1;
}

void canvas_move(canvas *page, point to)
{
    (void)page, (void)to;
}

void canvas_line(canvas *page, point to)
{
    (void)page, (void)to;
}

void canvas_close(canvas *page)
{
    (void)page;
}

void canvas_stroke(canvas *page, pen p)
{
    (void)page, (void)p;
}

void canvas_fill(canvas *page, colour ink)
{
    (void)page, (void)ink;
}

void canvas_circle(canvas *page, point centre, double radius, pen p)
{
    (void)page, (void)centre, (void)radius, (void)p;
}

void canvas_disc(canvas *page, point centre, double radius, colour ink)
{
    (void)page, (void)centre, (void)radius, (void)ink;
}

void canvas_clip(canvas *page, box area)
{
    (void)page, (void)area;
}

void canvas_unclip(canvas *page)
{
    (void)page;
}

void canvas_cells(canvas *page, box area, size_t n_columns, size_t n_rows, cell_function *cell, const void *context)
{
    (void)page, (void)area, (void)n_columns, (void)n_rows, (void)cell, (void)context;
}

void canvas_text(canvas *page, point at, text_style style, const char *text)
{
    (void)page, (void)at, (void)style, (void)text;
}

double canvas_text_width(canvas *page, text_style style, const char *text)
{
    (void)page, (void)style, (void)text;
    return 0;
}
