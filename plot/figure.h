/* figure.h: what is plotted of materials.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "plot/canvas.h"
#include "verify/verify.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct figure_material {
    const char *label; /* plain text */
    facet_material material;
    facet_bsdf64 bsdf;
    verify_subject foreign; /* a measurement or a plugin, if it has eval: material and bsdf are then unset */
} figure_material;

typedef enum figure_channel { CHANNEL_RED, CHANNEL_GREEN, CHANNEL_BLUE, CHANNEL_LUMINANCE } figure_channel;

/* A variable of a height field or of G1-error, and its range: a parameter of the model, or theta [degrees], cos, tan or
 * cot (of the angle to the normal). */
typedef struct figure_variable {
    char name[32];
    double low, high;
} figure_variable;

typedef struct figure {
    const figure_material *materials;
    size_t n_materials;
    const char *title;    /* NULL: the figure's own */
    const double *thetas; /* of the view, or as the kind says [degrees] */
    size_t n_thetas;
    double phi; /* azimuth of the view [degrees] */
    figure_channel channel;
    bool is_log, is_polar;
    double low, high;   /* of the axis of values; both 0: as the data ask for */
    uint64_t n_samples; /* of samples and convergence */
    uint64_t seed;
    /* Of a height field. */
    const char *quantity; /* D, Lambda, G1 or albedo */
    figure_variable x, y;
    const figure_material *minus; /* |difference| from this one; NULL: the values themselves */
    double times;
} figure;

/* Draws all materials, or one of several panels. */
typedef facet_status figure_draw(canvas *page, box place, const figure *f, facet_error *why);

/* What of a figure a kind heeds. */
enum {
    FIGURE_LOG = 1,
    FIGURE_POLAR = 2,
    FIGURE_VIEWS = 4, /* several thetas */
    FIGURE_PANELS = 8 /* a panel for each material: draw is called once for each, with n_materials 1 */
};

typedef struct figure_kind {
    const char *name; /* "D" */
    figure_draw *draw;
    unsigned features;
    double width, height; /* of the figure, or of a panel, by default [pixel] */
    double theta;         /* default [degree] */
} figure_kind;

enum { FIGURE_KINDS = 16 };
extern const figure_kind figure_kinds[FIGURE_KINDS];

/* The size of the whole by default. */
void figure_size(const figure_kind *kind, size_t n_materials, double *width, double *height);

/* Draws and writes the figure.  why->place is the label of the material that is at fault, or the option; it is empty if
 * the file is. */
facet_status figure_write(const figure_kind *kind, const figure *f, double width, double height, const char *path,
                          const image_text *texts, size_t n_texts, facet_error *why);

/* ---- For the kinds ----------------------------------------------------------------------------- */

figure_draw draw_D, draw_Lambda, draw_G1, draw_F, draw_f, draw_fcos, draw_pdf, draw_albedo, draw_theta_h, draw_theta_d,
    draw_slice, draw_lobe, draw_height_field, draw_samples, draw_convergence, draw_G1_error;

/* The variable's name with its unit, a formula. */
const char *figure_variable_label(const figure_variable *v);

/* A unit vector; theta may be negative [degrees]. */
void figure_direction(double theta, double phi, double v[3]);

/* The figure's channel of a colour. */
double figure_channel_of(const figure *f, const double rgb[3]);

/* The direction at `away` from an axis and turned about it by `turn`; the axis is theta from the normal, towards phi;
 * turn 0 is in that plane [degrees]. */
void figure_around(double theta, double phi, double away, double turn, double v[3]);

/* wi and wo by the half vector and the difference angles [degrees] (Rusinkiewicz 1998); false if one of them is below
 * the surface. */
bool figure_half_angles(double theta_h, double phi_h, double theta_d, double phi_d, double wi[3], double wo[3]);

/* Values of a material, as those of verify_subject; what it has none of must not be asked for. */
void figure_eval(const figure_material *m, const double wi[3], const double wo[3], double f[3]);
double figure_pdf(const figure_material *m, const double wi[3], const double wo[3]);
bool figure_sample(const figure_material *m, const double wo[3], const double u[3], double wi[3], double weight[3]);
double figure_D(const figure_material *m, const double normal[3]);
double figure_G1(const figure_material *m, const double v[3]);
double figure_Lambda(const figure_material *m, const double v[3]);
bool figure_transmits(const figure_material *m);

/* Shares of the light in the figure's channel, for a view from above. */
void figure_albedo(const figure *f, const figure_material *m, const double wo[3], double *reflected,
                   double *transmitted);

/* Errors that name the first material without D, G1 or Lambda (`what`); without a sampler; that is foreign, where only
 * facet's own have `what`. */
bool figure_has_terms(const figure_material *m);
facet_status figure_need_terms(const figure *f, const char *what, facet_error *why);
facet_status figure_need_sampler(const figure *f, facet_error *why);
facet_status figure_need_own(const figure *f, const char *what, facet_error *why);

#ifdef __cplusplus
}
#endif
