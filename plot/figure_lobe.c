/* figure_lobe.c: f cos over all directions of light as the distance from a point, in three dimensions.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "plot/figure.h"
#include "plot/frame.h"
#include "plot/relief.h"

static const double DEGREE = 3.14159265358979323846/180;

/* Rings around the direction of a mirror, closer to each other near it, and steps around it. */
enum { RINGS = 64, AROUND = 80, CIRCLE = 60, N_PARTS = RINGS*AROUND + 8*RELIEF_PIECES };

/* Half the side of a square that looks as wide as the unit circle. */
static const double WIDE = 0.82;

typedef struct lobe {
    double points[RINGS + 1][AROUND + 1][3]; /* of the surface; the largest has length 1 */
    double lengths[RINGS + 1][AROUND + 1];
    double largest; /* [1/sr] */
    bool has_lower_half;
} lobe;

static void measure(const figure *f, lobe *l)
{
    double wo[3], wi[3], value[3];
    figure_direction(-f->thetas[0], f->phi, wo);
    l->largest = 0;
    l->has_lower_half = figure_transmits(&f->materials[0]);
    for (int i = 0; i <= RINGS; i++)
        for (int k = 0; k <= AROUND; k++) {
            const double t = (double)i/RINGS;
            figure_around(f->thetas[0], f->phi, 180*t*t*t, 360.0*(k%AROUND)/AROUND, wi);
            figure_eval(&f->materials[0], wi, wo, value);
            l->lengths[i][k] = figure_channel_of(f, value);
            l->largest = fmax(l->largest, l->lengths[i][k]);
            for (int j = 0; j < 3; j++) l->points[i][k][j] = wi[j];
        }
    for (int i = 0; i <= RINGS; i++)
        for (int k = 0; k <= AROUND; k++) {
            l->lengths[i][k] = l->largest > 0 ? l->lengths[i][k]/l->largest : 0;
            for (int j = 0; j < 3; j++) l->points[i][k][j] *= l->lengths[i][k];
        }
}

/* Mesh lines are fewer than patches. */
static unsigned mesh_edges(int ring, int step)
{
    enum { EVERY = 8 };
    return (unsigned)(step%EVERY == 0) | (unsigned)((ring + 1)%EVERY == 0) << 1 |
           (unsigned)((step + 1)%EVERY == 0) << 2 | (unsigned)(ring%EVERY == 0) << 3;
}

static void add_surface(relief *r, const lobe *l)
{
    for (int i = 0; i < RINGS; i++)
        for (int k = 0; k < AROUND; k++) {
            double quad[4][3];
            for (int j = 0; j < 3; j++) {
                quad[0][j] = l->points[i][k][j];
                quad[1][j] = l->points[i + 1][k][j];
                quad[2][j] = l->points[i + 1][k + 1][j];
                quad[3][j] = l->points[i][k + 1][j];
            }
            const double length = 0.5*(l->lengths[i][k] + l->lengths[i + 1][k + 1]);
            if (l->lengths[i][k] + l->lengths[i + 1][k] > 1e-4)
                relief_quad(r, quad, sequential_colour(length), mesh_edges(i, k));
        }
}

static void circle(canvas *page, const relief *r, double radius)
{
    for (int k = 0; k < CIRCLE; k++) {
        const double angle = 360*DEGREE*k/CIRCLE, at[3] = {radius*cos(angle), radius*sin(angle), 0};
        if (k) canvas_line(page, relief_at(r, at));
        else canvas_move(page, relief_at(r, at));
    }
    canvas_close(page);
}

/* The surface that reflects, behind everything. */
static void draw_ground(canvas *page, const relief *r)
{
    circle(page, r, 1);
    canvas_fill(page, (colour){0.955, 0.955, 0.955, 1});
    for (int k = 1; k <= 3; k++) {
        circle(page, r, k/3.0);
        canvas_stroke(page, (pen){LIGHT_GREY, 0.06, SOLID});
    }
}

static void name_point(canvas *page, const relief *r, const double p[3], const char *name)
{
    const double at[3] = {1.1*p[0], 1.1*p[1], 1.1*p[2]};
    canvas_text(page, relief_at(r, at),
                (text_style){.size = NAME_SIZE, .ink = BLACK, .across = 0.5, .down = 0.5, .is_formula = true}, name);
}

facet_status draw_lobe(canvas *page, box place, const figure *f, facet_error *why)
{
    static const double none[3] = {0, 0, 0}, normal[3] = {0, 0, 1}, pole[3] = {0, 0, -1};
    const double em = canvas_em(page);
    lobe l;
    relief *r;
    frame_title(page, &place, place.x + 0.5*place.width, f->title);
    measure(f, &l);
    const double low[3] = {-WIDE, -WIDE, l.has_lower_half ? -1 : -0.1}, high[3] = {WIDE, WIDE, 1};
    const box inside = {place.x, place.y + 1.5*em, place.width, place.height - 4*em};
    const facet_status status = relief_create(inside, f->phi - 75, 22, low, high, N_PARTS, &r, why);
    if (status) return status;
    double wo[3], mirror[3];
    figure_direction(-f->thetas[0], f->phi, wo);
    figure_direction(f->thetas[0], f->phi, mirror);
    draw_ground(page, r);
    add_surface(r, &l);
    relief_line(r, none, normal, (pen){GREY, 0.1, SOLID});
    relief_line(r, none, wo, (pen){palette_colour(1), 0.14, SOLID});
    relief_line(r, none, mirror, (pen){GREY, 0.1, DASHED});
    if (l.has_lower_half) relief_line(r, none, pole, (pen){GREY, 0.1, SOLID});
    relief_draw(page, r);
    name_point(page, r, normal, "n");
    name_point(page, r, wo, "ω_o");
    char note[96];
    snprintf(note, sizeof note, "f cos θ_i, at most %.3g/sr; viewer at %g°", l.largest, f->thetas[0]);
    canvas_text(page, (point){place.x + 0.5*place.width, place.y + place.height - 1.2*em},
                (text_style){.size = LABEL_SIZE, .ink = BLACK, .across = 0.5, .down = 0.5, .is_formula = true}, note);
    relief_destroy(r);
    return FACET_OK;
}
