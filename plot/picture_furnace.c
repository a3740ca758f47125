/* picture_furnace.c: albedos, and how far furnaces are from 1.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/error.h"
#include "plot/chart.h"
#include "plot/figure.h"
#include "plot/pictures.h"

/* Angles from the normal on one side, in degrees; the same on the other side of what transmits. */
static const double angles[] = {0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 74, 78, 81, 84, 86, 88, NAN};

enum {
    N_ANGLES = sizeof angles/sizeof *angles,
    MOST_ANGLES = 2*N_ANGLES,
    MOST_AZIMUTHS = 3,
    MOST_VARIANTS = 2,
    MOST_ITEMS = 2*(MOST_AZIMUTHS + 1) /* of a chart */
};

static const double LEAST = 1e-9; /* deviation that is shown: less is rounding */

typedef struct curve {
    char label[256];
    double x[MOST_ANGLES], y[MOST_ANGLES];
} curve;

typedef struct curves {
    curve albedo[MOST_VARIANTS][MOST_AZIMUTHS], furnace[MOST_AZIMUTHS], weak_furnace[MOST_AZIMUTHS];
    double ends[2], ones[2], least[2], allowed[2][2]; /* straight lines */
    series items[MOST_ITEMS];
    size_t n_items;
} curves;

static void label_curve(curve *c, const char *name, double azimuth, bool has_azimuths)
{
    if (has_azimuths) snprintf(c->label, sizeof c->label, "%s, φₒ = %g°", name, azimuth);
    else snprintf(c->label, sizeof c->label, "%s", name);
}

static double shown(double deviation)
{
    return deviation < LEAST ? LEAST : deviation;
}

/* Azimuths differ in their dashes. */
static void add_curve(curves *c, const curve *from, size_t n, size_t i_colour, size_t i_azimuth)
{
    series *item = &c->items[c->n_items++];
    *item = series_make(i_colour, from->label, n, from->x, from->y);
    item->dash = (dash)i_azimuth;
}

static void add_line(curves *c, const char *label, const double y[2], colour ink)
{
    series *item = &c->items[c->n_items++];
    *item = (series){.label = label, .n = 2, .x = c->ends, .y = y, .ink = ink, .dash = DASHED};
}

static void draw_albedos(canvas *page, box place, curves *c, size_t n_variants, size_t n_azimuths, size_t n_angles)
{
    c->n_items = 0;
    add_line(c, "1: all light", c->ones, GREY);
    for (size_t v = 0; v < n_variants; v++)
        for (size_t a = 0; a < n_azimuths; a++) add_curve(c, &c->albedo[v][a], n_angles, v, a);
    double most = 1;
    for (size_t k = 1; k < c->n_items; k++)
        for (size_t i = 0; i < n_angles; i++) most = fmax(most, c->items[k].y[i]);
    const chart albedo = {.title = "Albedo",
                          .x = {"θ_o [degrees]", AXIS_DEGREES, 0, c->ends[1]},
                          .y = {"albedo of the largest channel [1]", AXIS_LINEAR, 0, 1.1*most},
                          .items = c->items,
                          .n_items = c->n_items};
    chart_draw(page, place, &albedo);
}

/* The deviations, each below a line at what is allowed. */
static void draw_deviations(canvas *page, box place, curves *c, const verify_subject *s, size_t n_azimuths,
                            size_t n_angles)
{
    static const verify_check checks[2] = {VERIFY_WEAK_FURNACE, VERIFY_FURNACE};
    const curve *const found[2] = {c->weak_furnace, c->furnace};
    const bool is_there[2] = {s->D && s->G1, s->claims & (FACET_CLAIMS_LOSSLESS | FACET_CLAIMS_PASSIVE)};
    char allowed[2][64];
    c->n_items = 0;
    for (size_t k = 0; k < 2; k++) {
        if (!is_there[k]) continue;
        for (size_t a = 0; a < n_azimuths; a++) add_curve(c, &found[k][a], n_angles, k, a);
        const double tolerance = verify_tolerance(s, checks[k]);
        snprintf(allowed[k], sizeof allowed[k], "%s: allowed, %g", verify_names[checks[k]], tolerance);
        c->allowed[k][0] = c->allowed[k][1] = tolerance;
        add_line(c, allowed[k], c->allowed[k], palette_colour(k));
        c->items[c->n_items - 1].below = c->least;
        c->items[c->n_items - 1].above = c->allowed[k];
    }
    const chart deviation = {.title = "Deviation from 1, or above 1 where less is claimed",
                             .x = {"θ_o [degrees]", AXIS_DEGREES, 0, c->ends[1]},
                             .y = {"deviation, 10^{−9} or less at the bottom [1]", AXIS_LOG, 0, 0},
                             .items = c->items,
                             .n_items = c->n_items};
    if (c->n_items) chart_draw(page, place, &deviation);
}

static void measure(curves *c, const picture_subject *variants, size_t n, const double azimuths[], size_t n_azimuths,
                    size_t n_angles)
{
    const verify_subject *s = variants[0].subject;
    for (size_t a = 0; a < n_azimuths; a++) {
        for (size_t v = 0; v < n; v++) label_curve(&c->albedo[v][a], variants[v].label, azimuths[a], n_azimuths > 1);
        label_curve(&c->furnace[a], "furnace", azimuths[a], n_azimuths > 1);
        label_curve(&c->weak_furnace[a], "weak-furnace", azimuths[a], n_azimuths > 1);
        for (size_t i = 0; i < n_angles; i++) {
            const double theta = i < N_ANGLES ? angles[i] : 180 - angles[n_angles - 1 - i];
            const bool is_gap = isnan(theta);
            double wo[3];
            figure_direction(theta, azimuths[a], wo);
            for (size_t v = 0; v < n; v++) {
                c->albedo[v][a].x[i] = theta;
                c->albedo[v][a].y[i] = is_gap ? NAN : verify_albedo(variants[v].subject, wo);
            }
            c->furnace[a].x[i] = c->weak_furnace[a].x[i] = theta;
            c->furnace[a].y[i] = shown(verify_furnace_deviation(s, c->albedo[0][a].y[i]));
            c->weak_furnace[a].y[i] = is_gap || wo[2] < 0 ? NAN : shown(fabs(verify_weak_furnace(s, wo) - 1));
        }
    }
}

facet_status picture_furnace(const picture *p, const picture_subject *variants, size_t n, facet_error *why)
{
    static const double azimuths[MOST_AZIMUTHS] = {0, 45, 90};
    const verify_subject *s = variants[0].subject;
    const size_t n_azimuths = s->claims & FACET_CLAIMS_ISOTROPIC ? 1 : MOST_AZIMUTHS;
    const size_t n_angles = s->claims & FACET_CLAIMS_TRANSMITS ? MOST_ANGLES : N_ANGLES;
    const double em = 15, width = 1200, height = 500;
    canvas *page = NULL;
    curves *c = malloc(sizeof *c);
    facet_status status = c ? canvas_create(CANVAS_PNG, width, height, em, &page, why)
                            : facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a picture");
    if (status) goto done;
    for (int k = 0; k < 2; k++) {
        c->ends[k] = k ? (n_angles == N_ANGLES ? 90 : 180) : 0;
        c->ones[k] = 1;
        c->least[k] = LEAST;
    }
    measure(c, variants, n, azimuths, n_azimuths, n_angles);
    box whole = {0.6*em, 0.8*em, width - 1.2*em, height - 1.2*em};
    frame_title(page, &whole, 0.5*width, p->title);
    draw_albedos(page, panel_place(whole, 2, 2, 0), c, n, n_azimuths, n_angles);
    box right = panel_place(whole, 2, 2, 1);
    right.x += em;
    right.width -= em;
    draw_deviations(page, right, c, s, n_azimuths, n_angles);
    status = canvas_write(page, p->path, p->texts, p->n_texts, why);
done:
    canvas_destroy(page);
    free(c);
    return status;
}
