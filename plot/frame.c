/* frame.c: titles, frames and axes.
 * SPDX-License-Identifier: MIT */
#include "plot/frame.h"

#include <math.h>

static const text_style title_style = {.size = TITLE_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .across = 0.5, .is_bold = true};
static const text_style name_style = {
    .size = NAME_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .across = 0.5, .down = 0.5, .is_formula = true};
static const text_style label_style = {
    .size = LABEL_SIZE, .ink = {0.1, 0.1, 0.1, 1}, .across = 0.5, .is_formula = true};

/* Lengths [em]. */
static const double MAJOR = 0.35, MINOR = 0.2, GAP = 0.35;

box panel_place(box whole, size_t n, size_t n_columns, size_t k)
{
    const size_t n_rows = (n + n_columns - 1)/n_columns;
    const double width = whole.width/(double)n_columns, height = whole.height/(double)n_rows;
    const size_t row = k/n_columns, column = k%n_columns;
    return (box){whole.x + (double)column*width, whole.y + (double)row*height, width, height};
}

void frame_title(canvas *page, box *place, double x, const char *title)
{
    if (!title) return;
    const double em = canvas_em(page), width = canvas_text_width(page, title_style, title);
    text_style style = title_style;
    const double most = 2*fmin(x - place->x, place->x + place->width - x);
    if (width > most) style.size *= most/width;
    canvas_text(page, (point){x, place->y + 0.5*em}, style, title);
    place->y += 2*em;
    place->height -= 2*em;
}

/* Labels that fit along `length` when each needs `each`. */
static int label_count(double length, double each)
{
    return (int)fmin(fmax(floor(length/each), 2), 12);
}

static axis_ticks vertical_ticks(canvas *page, const axis *a, double height)
{
    return axis_make_ticks(a, label_count(height, 2.2*canvas_em(page)));
}

static axis_ticks horizontal_ticks(canvas *page, const axis *a, double width)
{
    int most = label_count(width, 3*canvas_em(page));
    for (;; most--) {
        const axis_ticks t = axis_make_ticks(a, most);
        double needed = 0;
        for (size_t i = 0; i < t.n; i++)
            if (t.ticks[i].label[0]) needed += canvas_text_width(page, label_style, t.ticks[i].label) + canvas_em(page);
        if (needed <= width || most <= 2) return t;
    }
}

double frame_label_width(canvas *page, const axis *a, double height)
{
    const axis_ticks t = vertical_ticks(page, a, height);
    double width = 0;
    for (size_t i = 0; i < t.n; i++) width = fmax(width, canvas_text_width(page, label_style, t.ticks[i].label));
    return width;
}

frame frame_make(canvas *page, box place, axis x, axis y)
{
    const double em = canvas_em(page), bottom = (MAJOR + GAP + LABEL_SIZE)*em + (x.name ? 1.9*em : 0.2*em);
    frame f = {x, y, place};
    f.inside.height = fmax(place.height - bottom - 0.7*em, em);
    f.inside.y += 0.7*em;
    const double left = frame_label_width(page, &y, f.inside.height) + (MAJOR + GAP)*em +
                        (y.name ? 2*em : 0.5*em);
    const axis_ticks t = horizontal_ticks(page, &x, place.width - left);
    double overhang = 0.5*em; /* of the last label beyond the frame */
    if (t.n) overhang = fmax(overhang, 0.5*canvas_text_width(page, label_style, t.ticks[t.n - 1].label) + 0.2*em);
    f.inside.x += left;
    f.inside.width = fmax(place.width - left - overhang, em);
    return f;
}

point frame_at(const frame *f, double x, double y)
{
    const double u = fmin(fmax(axis_place(&f->x, x), -2), 3), v = fmin(fmax(axis_place(&f->y, y), -2), 3);
    return (point){f->inside.x + u*f->inside.width, f->inside.y + (1 - v)*f->inside.height};
}

void frame_draw_grid(canvas *page, const frame *f)
{
    const pen thin = {LIGHT_GREY, 0.06, SOLID};
    const box b = f->inside;
    const axis_ticks x = horizontal_ticks(page, &f->x, b.width), y = vertical_ticks(page, &f->y, b.height);
    for (size_t i = 0; i < x.n; i++) {
        const double at = b.x + axis_place(&f->x, x.ticks[i].value)*b.width;
        if (x.ticks[i].label[0]) canvas_segment(page, (point){at, b.y}, (point){at, b.y + b.height}, thin);
    }
    for (size_t i = 0; i < y.n; i++) {
        const double at = b.y + (1 - axis_place(&f->y, y.ticks[i].value))*b.height;
        if (y.ticks[i].label[0]) canvas_segment(page, (point){b.x, at}, (point){b.x + b.width, at}, thin);
    }
}

void frame_draw_vertical(canvas *page, const axis *a, box beside, bool is_right)
{
    const double em = canvas_em(page), side = is_right ? 1 : -1, x = beside.x + (is_right ? beside.width : 0);
    const axis_ticks t = vertical_ticks(page, a, beside.height);
    text_style style = label_style;
    style.across = is_right ? 0 : 1;
    style.down = 0.5;
    for (size_t i = 0; i < t.n; i++) {
        const double y = beside.y + (1 - axis_place(a, t.ticks[i].value))*beside.height;
        const bool is_major = t.ticks[i].label[0];
        canvas_segment(page, (point){x, y}, (point){x + side*(is_major ? MAJOR : MINOR)*em, y},
                       (pen){BLACK, 0.07, SOLID});
        canvas_text(page, (point){x + side*(MAJOR + GAP)*em, y}, style, t.ticks[i].label);
    }
    if (!a->name) return;
    const double width = frame_label_width(page, a, beside.height) + (MAJOR + GAP + 1)*em;
    text_style turned = name_style;
    turned.angle = 90;
    canvas_text(page, (point){x + side*width, beside.y + 0.5*beside.height}, turned, a->name);
}

static void draw_horizontal(canvas *page, const frame *f)
{
    const double em = canvas_em(page), y = f->inside.y + f->inside.height;
    const axis_ticks t = horizontal_ticks(page, &f->x, f->inside.width);
    for (size_t i = 0; i < t.n; i++) {
        const double x = f->inside.x + axis_place(&f->x, t.ticks[i].value)*f->inside.width;
        const bool is_major = t.ticks[i].label[0];
        canvas_segment(page, (point){x, y}, (point){x, y + (is_major ? MAJOR : MINOR)*em}, (pen){BLACK, 0.07, SOLID});
        canvas_text(page, (point){x, y + (MAJOR + GAP)*em}, label_style, t.ticks[i].label);
    }
    if (f->x.name)
        canvas_text(page, (point){f->inside.x + 0.5*f->inside.width, y + (MAJOR + GAP + LABEL_SIZE + 1)*em},
                    name_style, f->x.name);
}

void frame_draw(canvas *page, const frame *f)
{
    canvas_stroke_box(page, f->inside, (pen){BLACK, 0.07, SOLID});
    draw_horizontal(page, f);
    frame_draw_vertical(page, &f->y, f->inside, false);
}
