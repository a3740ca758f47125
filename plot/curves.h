/* curves.h: functions of one angle as curves, one for each material and view.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "plot/figure.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The value at the angle x of the axis; theta: one of the figure's; [degrees].  NaN where there is none. */
typedef double value_function(const figure *f, const figure_material *m, double theta, double x);

typedef struct curve_kind {
    value_function *value;
    value_function *other; /* a second curve of the same colour, dashed; NULL: none */
    double (*scale)(const figure *f, const figure_material *m, double theta); /* divides value's; NULL: 1 */
    const char *suffix, *other_suffix;                                        /* of the labels, if there are two */
    const char *title;                                                        /* NULL: none */
    const char *x_name, *y_name;
    double low, high;  /* of x */
    const char *view;  /* "θₒ = ": there is a curve for each theta, named so; NULL: there is one */
    bool is_symmetric; /* a polar plot shows -high to high */
    int n_angles;      /* 0: as many as narrow lobes need */
    bool is_integral;  /* its values are finite where f is moderate: an infinite one is an error, and no gap */
} curve_kind;

facet_status draw_curves(canvas *page, box place, const figure *f, const curve_kind *kind, facet_error *why);

#ifdef __cplusplus
}
#endif
