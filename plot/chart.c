/* chart.c: curves and points over two axes.
 * SPDX-License-Identifier: MIT */
#include "plot/chart.h"

#include <math.h>

static const double LINE_WIDTH = 0.13, POINT_RADIUS = 0.1; /* [em] */

series series_make(size_t k, const char *label, size_t n, const double *x, const double *y)
{
    return (series){.label = label, .n = n, .x = x, .y = y, .ink = palette_colour(k), .dash = (dash)(k%N_DASHES)};
}

/* ---- Legend ------------------------------------------------------------------------------------ */

static const text_style legend_style = {.size = LABEL_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .down = 0.5};
static const double KEY = 2.6, KEY_GAP = 0.5, COLUMN_GAP = 1.8, ROW = 1.35; /* [em] */

enum { LEGEND_MOST = 128 };

static void draw_key(canvas *page, point left, const series *s)
{
    const double em = canvas_em(page);
    if (s->shape == SERIES_POINTS)
        canvas_disc(page, (point){left.x + 0.5*KEY*em, left.y}, 2*POINT_RADIUS*em, s->ink);
    else canvas_segment(page, left, (point){left.x + KEY*em, left.y}, (pen){s->ink, LINE_WIDTH, s->dash});
}

typedef struct legend {
    const series *items[LEGEND_MOST];
    double widths[LEGEND_MOST]; /* of the labels */
    size_t n;
} legend;

/* The width with this many rows, filled column by column. */
static double legend_width(const legend *l, size_t n_rows, double other, double columns[LEGEND_MOST])
{
    double width = 0;
    for (size_t first = 0; first < l->n; first += n_rows) {
        double widest = 0;
        for (size_t i = first; i < l->n && i < first + n_rows; i++) widest = fmax(widest, l->widths[i]);
        columns[first/n_rows] = widest + other;
        width += widest + other;
    }
    return width;
}

void legend_draw(canvas *page, box *place, const series *items, size_t n_items)
{
    const double em = canvas_em(page), key = (KEY + KEY_GAP)*em, gap = COLUMN_GAP*em;
    legend l = {.n = 0};
    text_style style = legend_style;
    for (size_t i = 0; i < n_items && l.n < LEGEND_MOST; i++) {
        if (!items[i].label) continue;
        l.items[l.n] = &items[i];
        l.widths[l.n++] = canvas_text_width(page, style, items[i].label);
    }
    if (l.n == 0) return;
    double columns[LEGEND_MOST], width = 0;
    size_t n_rows = 1;
    while ((width = legend_width(&l, n_rows, key + gap, columns)) - gap > place->width && n_rows < l.n) n_rows++;
    const double room = place->width - key, needed = columns[0] - key - gap;
    if (n_rows == l.n && needed > room) style.size *= room/needed; /* one column, and too wide */
    double x = fmax(place->x, place->x + 0.5*(place->width - width + gap));
    for (size_t i = 0; i < l.n; i++) {
        if (i > 0 && i%n_rows == 0) x += columns[i/n_rows - 1];
        const double y = place->y + ((double)(i%n_rows) + 0.5)*ROW*em;
        draw_key(page, (point){x, y}, l.items[i]);
        canvas_text(page, (point){x + key, y}, style, l.items[i]->label);
    }
    place->y += (double)n_rows*ROW*em;
    place->height -= (double)n_rows*ROW*em;
}

/* ---- Data -------------------------------------------------------------------------------------- */

static bool is_shown(const frame *f, double x, double y)
{
    return isfinite(axis_place(&f->x, x)) && isfinite(axis_place(&f->y, y));
}

static void draw_band(canvas *page, const frame *f, const series *s)
{
    bool is_begun = false;
    for (size_t i = 0; i < 2*s->n; i++) {
        const size_t k = i < s->n ? i : 2*s->n - 1 - i;
        const double edge = i < s->n ? s->above[k] : s->below[k];
        if (!isfinite(edge) || !isfinite(axis_place(&f->x, s->x[k]))) continue;
        const point at = frame_at(f, s->x[k], edge);
        if (is_begun) canvas_line(page, at);
        else canvas_move(page, at);
        is_begun = true;
    }
    canvas_fill(page, (colour){s->ink.r, s->ink.g, s->ink.b, 0.2});
}

static void draw_line(canvas *page, const frame *f, const series *s)
{
    bool is_begun = false;
    point last = {0, 0};
    for (size_t i = 0; i < s->n; i++) {
        if (!is_shown(f, s->x[i], s->y[i])) {
            is_begun = false;
            continue;
        }
        const point at = frame_at(f, s->x[i], s->y[i]);
        /* Steps that nobody sees would only make files large. */
        const bool is_end = i + 1 == s->n || !is_shown(f, s->x[i + 1], s->y[i + 1]);
        if (is_begun && !is_end && hypot(at.x - last.x, at.y - last.y) < 0.02*canvas_em(page)) continue;
        if (is_begun) canvas_line(page, at);
        else canvas_move(page, at);
        is_begun = true;
        last = at;
    }
    canvas_stroke(page, (pen){s->ink, LINE_WIDTH, s->dash});
}

static void draw_points(canvas *page, const frame *f, const series *s)
{
    for (size_t i = 0; i < s->n; i++)
        if (is_shown(f, s->x[i], s->y[i]))
            canvas_disc(page, frame_at(f, s->x[i], s->y[i]), POINT_RADIUS*canvas_em(page), s->ink);
}

static frame fit_frame(canvas *page, box place, const chart *c)
{
    double x[2] = {INFINITY, -INFINITY}, y[2] = {INFINITY, -INFINITY};
    for (size_t i = 0; i < c->n_items; i++) {
        const series *s = &c->items[i];
        for (size_t k = 0; k < s->n; k++) {
            axis_include(&c->x, s->x[k], &x[0], &x[1]);
            axis_include(&c->y, s->y[k], &y[0], &y[1]);
            if (!s->below) continue;
            axis_include(&c->y, s->below[k], &y[0], &y[1]);
            axis_include(&c->y, s->above[k], &y[0], &y[1]);
        }
    }
    return frame_make(page, place, axis_fit(c->x, x[0], x[1]), axis_fit(c->y, y[0], y[1]));
}

void chart_draw(canvas *page, box place, const chart *c)
{
    frame_title(page, &place, place.x + 0.5*place.width, c->title);
    legend_draw(page, &place, c->items, c->n_items);
    const frame f = fit_frame(page, place, c);
    frame_draw_grid(page, &f);
    frame_draw(page, &f);
    /* A line along an end of an axis is seen whole. */
    const double edge = LINE_WIDTH*canvas_em(page);
    canvas_clip(page,
                (box){f.inside.x - edge, f.inside.y - edge, f.inside.width + 2*edge, f.inside.height + 2*edge});
    for (size_t i = 0; i < c->n_items; i++)
        if (c->items[i].below) draw_band(page, &f, &c->items[i]);
    for (size_t i = 0; i < c->n_items; i++) {
        if (c->items[i].shape == SERIES_POINTS) draw_points(page, &f, &c->items[i]);
        else draw_line(page, &f, &c->items[i]);
    }
    canvas_unclip(page);
}
