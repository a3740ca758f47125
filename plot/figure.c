/* figure.c: the kinds of figures, and what they share.
 * SPDX-License-Identifier: MIT */
#include "plot/figure.h"

#include <math.h>

#include "plot/frame.h"

static const double DEGREE = 3.14159265358979323846/180;

const figure_kind figure_kinds[FIGURE_KINDS] = {
    {"D", draw_D, FIGURE_LOG | FIGURE_POLAR, 800, 600, 0},
    {"Lambda", draw_Lambda, FIGURE_LOG | FIGURE_POLAR, 800, 600, 0},
    {"G1", draw_G1, FIGURE_LOG | FIGURE_POLAR, 800, 600, 0},
    {"F", draw_F, FIGURE_LOG | FIGURE_POLAR, 800, 600, 0},
    {"f", draw_f, FIGURE_LOG | FIGURE_POLAR | FIGURE_VIEWS, 800, 600, 45},
    {"fcos", draw_fcos, FIGURE_LOG | FIGURE_POLAR | FIGURE_VIEWS, 800, 600, 45},
    {"pdf", draw_pdf, FIGURE_LOG | FIGURE_POLAR | FIGURE_VIEWS, 800, 600, 45},
    {"albedo", draw_albedo, FIGURE_LOG | FIGURE_POLAR, 800, 600, 0},
    {"theta-h", draw_theta_h, FIGURE_LOG | FIGURE_VIEWS, 800, 600, 0},
    {"theta-d", draw_theta_d, FIGURE_LOG | FIGURE_VIEWS, 800, 600, 0},
    {"slice", draw_slice, FIGURE_PANELS, 420, 440, 0},
    {"lobe", draw_lobe, FIGURE_PANELS, 480, 440, 45},
    {"heightfield", draw_height_field, FIGURE_PANELS | FIGURE_LOG, 480, 440, 0},
    {"samples", draw_samples, FIGURE_PANELS, 420, 440, 45},
    {"convergence", draw_convergence, 0, 800, 600, 45},
    {"G1-error", draw_G1_error, 0, 800, 600, 0},
};

/* ---- Pages ------------------------------------------------------------------------------------- */

static size_t column_count(const figure_kind *kind, size_t n_materials)
{
    if (!(kind->features & FIGURE_PANELS)) return 1;
    return n_materials <= 3 ? n_materials : n_materials == 4 ? 2 : n_materials <= 9 ? 3 : 4;
}

void figure_size(const figure_kind *kind, size_t n_materials, double *width, double *height)
{
    const size_t n_columns = column_count(kind, n_materials);
    const size_t n_rows = kind->features & FIGURE_PANELS ? (n_materials + n_columns - 1)/n_columns : 1;
    *width = kind->width*(double)n_columns;
    *height = kind->height*(double)n_rows;
}

static facet_status draw_panels(canvas *page, box whole, const figure_kind *kind, const figure *f, facet_error *why)
{
    facet_status status = FACET_OK;
    frame_title(page, &whole, whole.x + 0.5*whole.width, f->title);
    for (size_t k = 0; k < f->n_materials && !status; k++) {
        const box place = panel_place(whole, f->n_materials, column_count(kind, f->n_materials), k);
        const double edge = 0.5*canvas_em(page);
        figure one = *f;
        one.materials = &f->materials[k];
        one.n_materials = 1;
        one.title = f->materials[k].label;
        status = kind->draw(page, (box){place.x + edge, place.y, place.width - 2*edge, place.height}, &one, why);
    }
    return status;
}

facet_status figure_write(const figure_kind *kind, const figure *f, double width, double height, const char *path,
                          const image_text *texts, size_t n_texts, facet_error *why)
{
    double usual_width, usual_height;
    figure_size(kind, f->n_materials, &usual_width, &usual_height);
    const double em = 15*fmin(width/usual_width, height/usual_height);
    canvas *page;
    facet_status status = canvas_create(canvas_kind_of(path), width, height, em, &page, why);
    if (status) return status;
    const box whole = {0.6*em, 0.8*em, width - 1.2*em, height - 1.2*em};
    status = kind->features & FIGURE_PANELS ? draw_panels(page, whole, kind, f, why) : kind->draw(page, whole, f, why);
    if (!status) status = canvas_write(page, path, texts, n_texts, why);
    canvas_destroy(page);
    return status;
}

/* ---- Directions and values --------------------------------------------------------------------- */

void figure_direction(double theta, double phi, double v[3])
{
    /* Exactly in the plane at 90 degrees, where a cosine of 6e-17 would be above it. */
    const double sine = sin(theta*DEGREE), cosine = fabs(fabs(theta) - 90) < 1e-9 ? 0 : cos(theta*DEGREE);
    v[0] = sine*cos(phi*DEGREE);
    v[1] = sine*sin(phi*DEGREE);
    v[2] = cosine;
}

double figure_channel_of(const figure *f, const double rgb[3])
{
    if (f->channel != CHANNEL_LUMINANCE) return rgb[f->channel];
    return 0.2126*rgb[0] + 0.7152*rgb[1] + 0.0722*rgb[2];
}

void figure_around(double theta, double phi, double away, double turn, double v[3])
{
    double d[3];
    figure_direction(away, turn, d);
    const double ct = cos(theta*DEGREE), st = sin(theta*DEGREE), cp = cos(phi*DEGREE), sp = sin(phi*DEGREE);
    const double x = ct*d[0] + st*d[2];
    v[0] = cp*x - sp*d[1];
    v[1] = sp*x + cp*d[1];
    v[2] = ct*d[2] - st*d[0];
}

bool figure_half_angles(double theta_h, double phi_h, double theta_d, double phi_d, double wi[3], double wo[3])
{
    figure_around(theta_h, phi_h, theta_d, phi_d, wi);
    figure_around(theta_h, phi_h, -theta_d, phi_d, wo);
    return wi[2] > 0 && wo[2] > 0;
}
