/* heatmap.c: values over two axes as colours.
 * SPDX-License-Identifier: MIT */
#include "plot/heatmap.h"

#include <math.h>

static const double BAR = 1.1, BAR_GAP = 1; /* [em] */

enum { BAR_STEPS = 256 };

/* A heat map with its values' axis fitted. */
typedef struct scaled {
    const heatmap *h;
    axis z;
} scaled;

static axis fit_values(const heatmap *h)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < h->n_columns*h->n_rows; i++) axis_include(&h->z, h->values[i], &low, &high);
    if (!h->is_diverging) return axis_fit(h->z, low, high);
    const double most = fmax(fabs(low), fabs(high));
    return axis_fit(h->z, -most, most);
}

static colour place_colour(const scaled *s, double place)
{
    return s->h->is_diverging ? diverging_colour(2*place - 1) : sequential_colour(place);
}

static colour value_cell(const void *context, size_t column, size_t row)
{
    const scaled *s = context;
    return place_colour(s, axis_place(&s->z, s->h->values[(s->h->n_rows - 1 - row)*s->h->n_columns + column]));
}

static colour bar_cell(const void *context, size_t column, size_t row)
{
    (void)column;
    return place_colour(context, 1 - ((double)row + 0.5)/BAR_STEPS);
}

/* A frame below a title that is above its middle. */
static frame make_titled(canvas *page, box place, const char *title, axis x, axis y)
{
    const axis fitted[2] = {axis_fit(x, 0, 1), axis_fit(y, 0, 1)};
    const box inside = frame_make(page, place, fitted[0], fitted[1]).inside;
    frame_title(page, &place, inside.x + 0.5*inside.width, title);
    return frame_make(page, place, fitted[0], fitted[1]);
}

void heatmap_draw(canvas *page, box place, const heatmap *h)
{
    const double em = canvas_em(page);
    const scaled s = {h, fit_values(h)};
    box left = place;
    left.width -= frame_label_width(page, &s.z, place.height) + (BAR_GAP + BAR + (h->z.name ? 2.2 : 0.7))*em;
    const frame f = make_titled(page, left, h->title, h->x, h->y);
    canvas_cells(page, f.inside, h->n_columns, h->n_rows, value_cell, &s);
    frame_draw(page, &f);
    const box bar = {left.x + left.width + BAR_GAP*em, f.inside.y, BAR*em, f.inside.height};
    canvas_cells(page, bar, 1, BAR_STEPS, bar_cell, &s);
    canvas_stroke_box(page, bar, (pen){BLACK, 0.07, SOLID});
    frame_draw_vertical(page, &s.z, bar, true);
}

void cell_map_draw(canvas *page, box place, const cell_map *p)
{
    frame f = make_titled(page, place, p->title, p->x, p->y);
    if (p->is_square) {
        const double side = fmin(f.inside.width, f.inside.height);
        f.inside.x += 0.5*(f.inside.width - side);
        f.inside.width = f.inside.height = side;
    }
    canvas_cells(page, f.inside, p->n_columns, p->n_rows, p->cell, p->context);
    frame_draw(page, &f);
}
