/* polar.c: curves over an angle around a point.
 * SPDX-License-Identifier: MIT */
#include "plot/polar.h"

#include <math.h>
#include <stdio.h>

static const double DEGREE = 3.14159265358979323846/180;

static const text_style label_style = {
    .size = LABEL_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .across = 0.5, .down = 0.5, .is_formula = true};

typedef struct dial {
    point centre;
    double radius;
    bool is_whole; /* or the upper half */
    axis y;
} dial;

static point around(const dial *d, double share, double degrees)
{
    return (point){d->centre.x + share*d->radius*sin(degrees*DEGREE),
                   d->centre.y - share*d->radius*cos(degrees*DEGREE)};
}

static void draw_ring(canvas *page, const dial *d, double share, pen p)
{
    const int end = d->is_whole ? 180 : 90;
    canvas_move(page, around(d, share, -end));
    for (int degrees = -end + 2; degrees <= end; degrees += 2) canvas_line(page, around(d, share, degrees));
    canvas_stroke(page, p);
}

static axis_ticks distance_ticks(canvas *page, const dial *d)
{
    const double most = d->radius/(3.2*canvas_em(page)); /* wide enough for a power of ten */
    return axis_make_ticks(&d->y, most > 8 ? 8 : most < 2 ? 2 : (int)most);
}

static void draw_grid(canvas *page, const dial *d)
{
    const double em = canvas_em(page);
    const pen thin = {LIGHT_GREY, 0.06, SOLID};
    const axis_ticks t = distance_ticks(page, d);
    for (size_t i = 0; i < t.n; i++)
        if (t.ticks[i].label[0]) draw_ring(page, d, axis_place(&d->y, t.ticks[i].value), thin);
    const int end = d->is_whole ? 180 : 90;
    for (int degrees = -end; degrees <= end; degrees += 30) {
        char label[16];
        canvas_segment(page, d->centre, around(d, 1, degrees), thin);
        if (degrees == -180) continue;
        snprintf(label, sizeof label, "%s%d°", degrees < 0 ? "−" : "", degrees < 0 ? -degrees : degrees);
        canvas_text(page, around(d, 1 + 1.5*em/d->radius, degrees), label_style, label);
    }
    draw_ring(page, d, 1, (pen){BLACK, 0.07, SOLID});
    canvas_segment(page, around(d, 1, -90), around(d, 1, 90), (pen){BLACK, 0.07, SOLID});
}

/* Below the horizontal diameter, on the right; on a whole dial that is inside. */
static void draw_labels(canvas *page, const dial *d, const char *name)
{
    const double em = canvas_em(page);
    const axis_ticks t = distance_ticks(page, d);
    for (size_t i = 0; i < t.n; i++) {
        const double share = axis_place(&d->y, t.ticks[i].value);
        const point at = {d->centre.x + share*d->radius, d->centre.y};
        if (!t.ticks[i].label[0] || (share > 0.97 && d->is_whole)) continue;
        canvas_segment(page, at, (point){at.x, at.y + 0.35*em}, (pen){BLACK, 0.07, SOLID});
        canvas_text(page, (point){at.x, at.y + 1.1*em}, label_style, t.ticks[i].label);
    }
    if (name) canvas_text(page, (point){d->centre.x + 0.5*d->radius, d->centre.y + 2.6*em}, label_style, name);
}

static void draw_series(canvas *page, const dial *d, const series *s)
{
    bool is_begun = false;
    for (size_t i = 0; i < s->n; i++) {
        const double share = axis_place(&d->y, s->y[i]);
        if (isnan(share)) {
            is_begun = false;
            continue;
        }
        const point at = around(d, fmin(fmax(share, 0), 1.5), s->x[i]);
        if (is_begun) canvas_line(page, at);
        else canvas_move(page, at);
        is_begun = true;
    }
    canvas_stroke(page, (pen){s->ink, 0.13, s->dash});
}

static axis fit_distance(const chart *c)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < c->n_items; i++)
        for (size_t k = 0; k < c->items[i].n; k++) axis_include(&c->y, c->items[i].y[k], &low, &high);
    return axis_fit(c->y, low, high);
}

void polar_draw(canvas *page, box place, const chart *c)
{
    const double em = canvas_em(page), side = 3*em; /* for the labels of angles */
    frame_title(page, &place, place.x + 0.5*place.width, c->title);
    legend_draw(page, &place, c->items, c->n_items);
    dial d = {.is_whole = c->x.high > 90, .y = fit_distance(c)};
    const double below = d.is_whole ? side : 3.4*em, height = place.height - side - below;
    d.radius = fmax(fmin(0.5*place.width - side, d.is_whole ? 0.5*height : height), em);
    d.centre.x = place.x + 0.5*place.width;
    const double used = d.is_whole ? 2*d.radius : d.radius;
    d.centre.y = place.y + side + 0.5*(height - used) + d.radius;
    draw_grid(page, &d);
    canvas_clip(page, (box){d.centre.x - d.radius, d.centre.y - d.radius, 2*d.radius, used});
    for (size_t i = 0; i < c->n_items; i++) draw_series(page, &d, &c->items[i]);
    canvas_unclip(page);
    draw_labels(page, &d, c->y.name);
}
