/* figure_angles.c: f, f cos, the sampler's density and the albedo over angles.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>

#include "plot/curves.h"

static const double DEGREE = 3.14159265358979323846/180;

/* The viewer is at -theta, so that a mirror sends light to theta. */
static void directions(const figure *f, double theta, double x, double wi[3], double wo[3])
{
    figure_direction(x, f->phi, wi);
    figure_direction(-theta, f->phi, wo);
}

static double value_fcos(const figure *f, const figure_material *m, double theta, double x)
{
    double wi[3], wo[3], value[3];
    directions(f, theta, x, wi, wo);
    figure_eval(m, wi, wo, value);
    return figure_channel_of(f, value);
}

static double value_f(const figure *f, const figure_material *m, double theta, double x)
{
    const double cosine = fabs(cos(x*DEGREE));
    return cosine > 1e-9 ? value_fcos(f, m, theta, x)/cosine : NAN;
}

static double albedo(const figure *f, const figure_material *m, double theta)
{
    double wo[3], reflected, transmitted;
    figure_direction(-theta, f->phi, wo);
    figure_albedo(f, m, wo, &reflected, &transmitted);
    return reflected + transmitted;
}

static double value_pdf(const figure *f, const figure_material *m, double theta, double x)
{
    double wi[3], wo[3];
    directions(f, theta, x, wi, wo);
    return figure_pdf(m, wi, wo);
}

static double value_albedo(const figure *f, const figure_material *m, double theta, double x)
{
    (void)theta;
    double wo[3], reflected, transmitted;
    if (x >= 90) return NAN;
    figure_direction(x, f->phi, wo);
    figure_albedo(f, m, wo, &reflected, &transmitted);
    return reflected;
}

static double value_by_half(const figure *f, const figure_material *m, double theta_h, double theta_d)
{
    double wi[3], wo[3], value[3];
    if (!figure_half_angles(theta_h, f->phi, theta_d, 90, wi, wo)) return NAN;
    figure_eval(m, wi, wo, value);
    return figure_channel_of(f, value)/wi[2];
}

static double value_theta_h(const figure *f, const figure_material *m, double theta, double x)
{
    return value_by_half(f, m, x, theta);
}

static double value_theta_d(const figure *f, const figure_material *m, double theta, double x)
{
    return value_by_half(f, m, theta, x);
}

/* ---- Figures ----------------------------------------------------------------------------------- */

/* Curves over the angle of the light, all around where something is transmitted. */
static facet_status draw_plane(canvas *page, box place, const figure *f, curve_kind kind, facet_error *why)
{
    char title[128] = "In the plane of incidence, viewer at −θₒ";
    bool has_lower_half = false;
    for (size_t k = 0; k < f->n_materials; k++) has_lower_half |= figure_transmits(&f->materials[k]);
    kind.high = has_lower_half ? 180 : 90;
    kind.low = -kind.high;
    kind.view = "θₒ = ";
    kind.x_name = "θ_i, angle between light and surface normal [degrees]";
    if (f->n_thetas == 1)
        snprintf(title, sizeof title, "In the plane of incidence, viewer at %s%g°", f->thetas[0] > 0 ? "−" : "",
                 f->thetas[0]);
    kind.title = title;
    return draw_curves(page, place, f, &kind, why);
}

facet_status draw_f(canvas *page, box place, const figure *f, facet_error *why)
{
    return draw_plane(page, place, f, (curve_kind){.value = value_f, .y_name = "f [1/sr]"}, why);
}

facet_status draw_fcos(canvas *page, box place, const figure *f, facet_error *why)
{
    return draw_plane(page, place, f, (curve_kind){.value = value_fcos, .y_name = "f cos θ_i [1/sr]"}, why);
}

facet_status draw_pdf(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_fcos,
                             .scale = albedo,
                             .other = value_pdf,
                             .suffix = ": f cos θᵢ / albedo",
                             .other_suffix = ": pdf",
                             .y_name = "density of directions [1/sr]"};
    const facet_status status = figure_need_sampler(f, why);
    return status ? status : draw_plane(page, place, f, kind, why);
}

facet_status draw_albedo(canvas *page, box place, const figure *f, facet_error *why)
{
    const curve_kind kind = {.value = value_albedo,
                             .x_name = "θ_o, angle between viewer and surface normal [degrees]",
                             .y_name = "directional albedo [1]",
                             .high = 90,
                             .is_symmetric = true,
                             .n_angles = 45,
                             .is_integral = true};
    return draw_curves(page, place, f, &kind, why);
}

facet_status draw_theta_h(canvas *page, box place, const figure *f, facet_error *why)
{
    char title[64];
    snprintf(title, sizeof title, "Difference angle %g°, azimuth 90°", f->thetas[0]);
    const curve_kind kind = {.value = value_theta_h,
                             .title = f->n_thetas == 1 ? title : NULL,
                             .x_name = "θ_h, angle between half vector and surface normal [degrees]",
                             .y_name = "f [1/sr]",
                             .high = 90,
                             .view = "difference angle "};
    return draw_curves(page, place, f, &kind, why);
}

facet_status draw_theta_d(canvas *page, box place, const figure *f, facet_error *why)
{
    char title[64];
    snprintf(title, sizeof title, "Half angle %g°, azimuth of the difference 90°", f->thetas[0]);
    const curve_kind kind = {.value = value_theta_d,
                             .title = f->n_thetas == 1 ? title : NULL,
                             .x_name = "θ_d, angle between light and half vector [degrees]",
                             .y_name = "f [1/sr]",
                             .high = 90,
                             .view = "half angle "};
    return draw_curves(page, place, f, &kind, why);
}
