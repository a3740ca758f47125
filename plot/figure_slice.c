/* figure_slice.c: the image slice of Disney's BRDF explorer: f over theta_h and theta_d at phi_d = 90 degrees.
 *
 * Burley, Physically Based Shading at Disney, 2012, section 3.
 * SPDX-License-Identifier: MIT */
#include "plot/figure.h"
#include "plot/heatmap.h"

enum { SLICE_SIDE = 160 };

static colour slice_cell(const void *context, size_t column, size_t row)
{
    const figure *f = context;
    const double step = 90.0/SLICE_SIDE;
    double wi[3], wo[3], value[3] = {0, 0, 0};
    if (!figure_half_angles(((double)column + 0.5)*step, f->phi, 90 - ((double)row + 0.5)*step, 90, wi, wo))
        return GREY;
    figure_eval(&f->materials[0], wi, wo, value);
    for (int k = 0; k < 3; k++) value[k] *= f->times/wi[2];
    return tone(value);
}

facet_status draw_slice(canvas *page, box place, const figure *f, facet_error *why)
{
    (void)why;
    const cell_map p = {.title = f->title,
                        .x = {"θ_h [degrees]", AXIS_DEGREES, 0, 90},
                        .y = {"θ_d [degrees]", AXIS_DEGREES, 0, 90},
                        .n_columns = SLICE_SIDE,
                        .n_rows = SLICE_SIDE,
                        .cell = slice_cell,
                        .context = f,
                        .is_square = true};
    cell_map_draw(page, place, &p);
    return FACET_OK;
}
