/* canvas_shapes.c: what of canvas.h can be said in its other functions.
 * SPDX-License-Identifier: MIT */
#include <string.h>
#include <strings.h>

#include "plot/canvas.h"

canvas_kind canvas_kind_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (!dot || dot == path || dot[-1] == '/') return CANVAS_UNKNOWN;
    if (strcasecmp(dot, ".svg") == 0) return CANVAS_SVG;
    if (strcasecmp(dot, ".png") == 0) return CANVAS_PNG;
    return strcasecmp(dot, ".pdf") == 0 ? CANVAS_PDF : CANVAS_UNKNOWN;
}

void canvas_segment(canvas *page, point from, point to, pen p)
{
    canvas_move(page, from);
    canvas_line(page, to);
    canvas_stroke(page, p);
}

static void outline(canvas *page, box area)
{
    const double right = area.x + area.width, bottom = area.y + area.height;
    canvas_move(page, (point){area.x, area.y});
    canvas_line(page, (point){right, area.y});
    canvas_line(page, (point){right, bottom});
    canvas_line(page, (point){area.x, bottom});
    canvas_close(page);
}

void canvas_fill_box(canvas *page, box area, colour ink)
{
    outline(page, area);
    canvas_fill(page, ink);
}

void canvas_stroke_box(canvas *page, box area, pen p)
{
    outline(page, area);
    canvas_stroke(page, p);
}
