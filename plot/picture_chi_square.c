/* picture_chi_square.c: samples beside the density that they should follow.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/error.h"
#include "plot/heatmap.h"
#include "plot/pictures.h"

enum { SIDE = 240 }; /* cells of a panel */

static const double DEGREE = 3.14159265358979323846/180, POOLED = 5; /* what a cell of the test expects at least */

typedef struct panels {
    sampler_cells cells;
    sampler_result result;
    double theta_o; /* [degrees] */
    axis x, y;
    double samples[SIDE*SIDE], density[SIDE*SIDE], difference[SIDE*SIDE];
} panels;

/* From the first inner border to the last, and half as far again on both sides, where the outermost cells go on to the
 * ends of the domain. */
static axis window(const char *name, double first, double last, double low, double high)
{
    const double margin = 0.5*(last - first);
    return (axis){name, AXIS_DEGREES, fmax(first - margin, low), fmin(last + margin, high)};
}

static void choose_window(panels *p)
{
    const sampler_cells *c = &p->cells;
    double first = INFINITY, last = -INFINITY;
    for (int band = 0; band < c->n_bands; band++) {
        first = fmin(first, c->azimuths[band][1]);
        last = fmax(last, c->azimuths[band][SAMPLER_SECTORS - 1]);
    }
    p->x = window("φ_i from the mean direction [degrees]", first/DEGREE, last/DEGREE, -180, 180);
    const axis round = axis_fit((axis){p->x.name, AXIS_DEGREES, 0, 0}, p->x.low, p->x.high);
    p->x.low = fmax(round.low, -180);
    p->x.high = fmin(round.high, 180);
    p->y = window("θ_i [degrees]", acos(c->cosines[c->n_bands - 1])/DEGREE, acos(c->cosines[1])/DEGREE, 0,
                  c->cosines[0] < 0 ? 180 : 90);
}

static void fill_pixel(panels *p, int pixel, int n_samples)
{
    const sampler_cells *c = &p->cells;
    const int row = pixel/SIDE, column = pixel%SIDE;
    const double x = (column + 0.5)/SIDE, y = (row + 0.5)/SIDE;
    const double cosine = cos((p->y.low + y*(p->y.high - p->y.low))*DEGREE);
    const int cell = sampler_cell_of(c, cosine, (p->x.low + x*(p->x.high - p->x.low))*DEGREE);
    const int band = cell/SAMPLER_SECTORS;
    const double *azimuth = &c->azimuths[band][cell%SAMPLER_SECTORS];
    const double solid_angle = (c->cosines[band + 1] - c->cosines[band])*(azimuth[1] - azimuth[0]);
    p->samples[pixel] = c->observed[cell]/(n_samples*solid_angle);
    p->density[pixel] = c->expected[cell]/(n_samples*solid_angle);
    p->difference[pixel] = (c->observed[cell] - c->expected[cell])/sqrt(fmax(c->expected[cell], POOLED));
}

static void draw_panels(canvas *page, box row, const panels *p, const verify_settings *settings)
{
    const double level = verify_level(settings), p_value = p->result.test.p;
    axis density = {"density [1/sr]", AXIS_LOG, 0, 0};
    double low = INFINITY, high = -INFINITY, most = 4;
    for (int i = 0; i < SIDE*SIDE; i++) {
        axis_include(&density, p->samples[i], &low, &high);
        axis_include(&density, p->density[i], &low, &high);
        most = fmax(most, fabs(p->difference[i]));
    }
    density = axis_fit(density, low, high);
    char titles[3][96];
    snprintf(titles[0], sizeof titles[0], "θₒ = %.3g°: %d samples", p->theta_o, settings->n_samples);
    snprintf(titles[1], sizeof titles[1], "θₒ = %.3g°: the pdf", p->theta_o);
    if (p_value < level) snprintf(titles[2], sizeof titles[2], "p = %.2g FAILS (below %.2g)", p_value, level);
    else snprintf(titles[2], sizeof titles[2], "p = %.2g holds (above %.2g)", p_value, level);
    const double *values[3] = {p->samples, p->density, p->difference};
    for (size_t k = 0; k < 3; k++) {
        box place = panel_place(row, 3, 3, k);
        place.width -= canvas_em(page);
        const heatmap h = {.title = titles[k],
                           .x = p->x,
                           .y = p->y,
                           .z = k < 2 ? density : (axis){"difference [standard deviations]", AXIS_LINEAR, -most, most},
                           .n_columns = SIDE,
                           .n_rows = SIDE,
                           .values = values[k],
                           .is_diverging = k == 2};
        heatmap_draw(page, place, &h);
    }
}

facet_status picture_chi_square(const picture *p, const verify_subject *s, const verify_settings *settings,
                                facet_error *why)
{
    const int n = verify_chi_square_tests(s);
    const double em = 15, width = 1320, height = 3*em + 340*n;
    canvas *page = NULL;
    panels *drawn = malloc(sizeof *drawn);
    facet_status status = drawn ? canvas_create(CANVAS_PNG, width, height, em, &page, why)
                                : facet_error_set(why, FACET_NO_MEMORY, "", "no memory for a picture");
    if (status) goto done;
    box whole = {0.6*em, 0.8*em, width - 0.6*em, height - 1.2*em};
    frame_title(page, &whole, 0.5*width, p->title);
    for (int i = 0; i < n; i++) {
        double wo[3];
        drawn->result = verify_chi_square(s, settings, i, wo, &drawn->cells);
        drawn->theta_o = acos(wo[2])/DEGREE;
        choose_window(drawn);
        for (int pixel = 0; pixel < SIDE*SIDE; pixel++) fill_pixel(drawn, pixel, settings->n_samples);
        box row = panel_place(whole, (size_t)n, 1, (size_t)i);
        row.height -= 0.8*em;
        draw_panels(page, row, drawn, settings);
    }
    status = canvas_write(page, p->path, p->texts, p->n_texts, why);
done:
    canvas_destroy(page);
    free(drawn);
    return status;
}
