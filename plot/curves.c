/* curves.c: functions of one angle as curves.
 * SPDX-License-Identifier: MIT */
#include "plot/curves.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/error.h"
#include "plot/chart.h"
#include "plot/polar.h"

/* Even steps, and steps that shrink towards the angles where lobes are narrow. */
enum { EVEN = 180, NEAR = 48, MOST_CENTRES = 3, MOST_ANGLES = EVEN + 1 + 2*NEAR*MOST_CENTRES };

typedef struct curve {
    char label[256];
    size_t n;
    double x[MOST_ANGLES], y[MOST_ANGLES];
} curve;

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void add_angle(curve *c, double angle, double low, double high)
{
    if (angle > low && angle < high) c->x[c->n++] = angle;
}

static void choose_angles(curve *c, const curve_kind *kind, double low, double theta)
{
    const double centres[MOST_CENTRES] = {0, theta, -theta};
    const int n_even = kind->n_angles ? kind->n_angles : EVEN;
    for (int i = 0; i <= n_even; i++) c->x[c->n++] = low + (kind->high - low)*i/n_even;
    if (kind->n_angles) return;
    for (int k = 0; k < (kind->view ? MOST_CENTRES : 1); k++)
        for (int i = 0; i < NEAR; i++) {
            const double offset = pow(10, -3 + 4.2*i/(NEAR - 1)); /* 0.001 to 16 degrees */
            add_angle(c, centres[k] - offset, low, kind->high);
            add_angle(c, centres[k] + offset, low, kind->high);
        }
    qsort(c->x, c->n, sizeof *c->x, compare_numbers);
}

static series make_curve(curve *c, const figure *f, const curve_kind *kind, const figure_material *m, double theta,
                         bool is_other)
{
    c->n = 0;
    choose_angles(c, kind, f->is_polar && kind->is_symmetric ? -kind->high : kind->low, theta);
    value_function *value = is_other ? kind->other : kind->value;
    const double scale = kind->scale && !is_other ? kind->scale(f, m, theta) : 1;
    for (size_t i = 0; i < c->n; i++) c->y[i] = value(f, m, theta, c->x[i])/scale;
    char view[64] = "";
    if (kind->view && f->n_thetas > 1) snprintf(view, sizeof view, ", %s%g°", kind->view, theta);
    const char *suffix = !kind->other ? "" : is_other ? kind->other_suffix : kind->suffix;
    snprintf(c->label, sizeof c->label, "%s%s%s", m->label, view, suffix);
    return series_make(0, c->label, c->n, c->x, c->y);
}

/* An integral that overflows would leave a picture without its curve. */
static facet_status refuse_overflow(const curve *c, const figure_material *m, facet_error *why)
{
    for (size_t i = 0; i < c->n; i++)
        if (isinf(c->y[i]))
            return facet_error_set(
                why, FACET_BAD_VALUE, m->label,
                "its integral at %g degrees is too large for a number; f is far beyond any surface's", c->x[i]);
    return FACET_OK;
}

facet_status draw_curves(canvas *page, box place, const figure *f, const curve_kind *kind, facet_error *why)
{
    const size_t n_views = kind->view ? f->n_thetas : 1, n_each = kind->other ? 2 : 1;
    const size_t n = f->n_materials*n_views*n_each;
    curve *curves = malloc(n*sizeof *curves);
    series *items = malloc(n*sizeof *items);
    facet_status status = FACET_OK;
    if (!curves || !items) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for %zu curves", n);
        goto done;
    }
    for (size_t i = 0; i < n; i++) {
        const size_t view = i/n_each%n_views;
        const bool is_other = i%n_each == 1;
        const figure_material *m = &f->materials[i/n_each/n_views];
        items[i] = make_curve(&curves[i], f, kind, m, f->thetas[view], is_other);
        if (kind->is_integral && (status = refuse_overflow(&curves[i], m, why))) goto done;
        items[i].ink = palette_colour(i/n_each);
        items[i].dash = kind->other ? (is_other ? DASHED : SOLID) : (dash)(i%N_DASHES);
    }
    const chart c = {.title = f->title ? f->title : kind->title,
                     .x = {kind->x_name, AXIS_DEGREES, kind->low, kind->high},
                     .y = {kind->y_name, f->is_log ? AXIS_LOG : AXIS_LINEAR, f->low, f->high},
                     .items = items,
                     .n_items = n};
    if (f->is_polar) polar_draw(page, place, &c);
    else chart_draw(page, place, &c);
done:
    free(items);
    free(curves);
    return status;
}
