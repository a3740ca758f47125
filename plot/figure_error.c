/* figure_error.c: how far masking is from the exact one, over a parameter of the material.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/error.h"
#include "plot/chart.h"
#include "plot/figure.h"

/* Values of the parameter; angles in even steps, for the mean, and as many whose tangents are in even ratios, where
 * small alpha have their errors. */
enum { N_VALUES = 121, N_ANGLES = 90 };
static const double LEAST_TANGENT = 1e-2, RATIO = 1.2, DEGREE = 3.14159265358979323846/180;

typedef struct errors {
    char labels[2][256];
    double x[N_VALUES], most[N_VALUES], mean[N_VALUES];
} errors;

static double error_at(const facet_bsdf *single, const facet_bsdf64 *exact, double theta, double phi)
{
    double v[3];
    figure_direction(theta, phi, v);
    const float rounded[3] = {(float)v[0], (float)v[1], (float)v[2]};
    return fabs((double)facet_bsdf_terms(single, rounded).G1 - facet_bsdf64_terms(exact, v).G1);
}

/* The largest error and the mean at one value of the parameter. */
static facet_status measure(const figure *f, facet_material m, double x, double *most, double *mean, facet_error *why)
{
    const double exact = 0; /* of masking's choices, the first */
    facet_bsdf single;
    facet_bsdf64 truth;
    facet_status status = facet_material_set(&m, f->x.name, &x, 1, why);
    if (!status) status = facet_bsdf_prepare(&m, &single, why);
    if (!status) status = facet_material_set(&m, "masking", &exact, 1, why);
    if (!status) status = facet_bsdf64_prepare(&m, &truth, why);
    if (status) return status;
    *most = *mean = 0;
    for (int i = 0; i < N_ANGLES; i++) {
        const double even = error_at(&single, &truth, (i + 0.5)*90/N_ANGLES, f->phi);
        const double steep = error_at(&single, &truth, atan(LEAST_TANGENT*pow(RATIO, i))/DEGREE, f->phi);
        *most = fmax(*most, fmax(even, steep));
        *mean += even/N_ANGLES;
    }
    return FACET_OK;
}

facet_status draw_G1_error(canvas *page, box place, const figure *f, facet_error *why)
{
    errors *all = malloc(f->n_materials*sizeof *all);
    series *items = malloc(2*f->n_materials*sizeof *items);
    facet_status status = figure_need_own(f, "an exact masking to compare with", why);
    if (!all || !items) {
        status = facet_error_set(why, FACET_NO_MEMORY, "", "no memory for the errors");
        goto done;
    }
    if (!status) status = figure_need_terms(f, "G1", why);
    for (size_t k = 0; k < f->n_materials && !status; k++) {
        errors *e = &all[k];
        for (int i = 0; i < N_VALUES && !status; i++) {
            e->x[i] = f->x.low + (f->x.high - f->x.low)*i/(N_VALUES - 1);
            status = measure(f, f->materials[k].material, e->x[i], &e->most[i], &e->mean[i], why);
        }
        snprintf(e->labels[0], sizeof e->labels[0], "%s", f->materials[k].label);
        snprintf(e->labels[1], sizeof e->labels[1], "%s, mean", f->materials[k].label);
        items[2*k] = series_make(k, e->labels[0], N_VALUES, e->x, e->most);
        items[2*k + 1] = series_make(k, e->labels[1], N_VALUES, e->x, e->mean);
        items[2*k].dash = SOLID;
        items[2*k + 1].dash = DASHED;
    }
    const chart c = {.title = f->title ? f->title : "Error of G1 in single precision: largest over the angle, and mean",
                     .x = {figure_variable_label(&f->x), AXIS_LINEAR, f->x.low, f->x.high},
                     .y = {"|G_1 − exact G_1| [1]", AXIS_LOG, f->low, f->high},
                     .items = items,
                     .n_items = 2*f->n_materials};
    if (!status) chart_draw(page, place, &c);
done:
    free(items);
    free(all);
    return status;
}
