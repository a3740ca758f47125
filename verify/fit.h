/* fit.h: the parameters with which a model comes nearest to given values of f.
 *
 * Near is a small root mean square of ln(1 + f cos theta_i) of the model less that of the values: peaks do not decide
 * alone, and what is dark counts as it is seen.  [low12] Low, Kronander, Ynnerman and Unger, BRDF models for accurate
 * and efficient rendering of glossy surfaces, ACM TOG 31(1), 2012.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stddef.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A pair of unit directions and f |cos theta_i| there. */
typedef struct fit_point {
    double wi[3], wo[3], value[3];
} fit_point;

typedef struct fit_points {
    size_t n;
    const fit_point *items;
} fit_points;

/* Bit k: parameter k of the model's table is to be found; numbers and colours only. */
typedef unsigned fit_keys;

/* What is usually to be found of a material: numbers and colours that are not given, but for those that tell anisotropy
 * or that others stand for (ior beside ks); taken into *m with their defaults. */
fit_keys fit_usual_keys(facet_material *m);

typedef struct fit_result {
    facet_material material;
    double error;   /* the distance, over all points */
    size_t n_least; /* of the FIT_STARTS searches, those that ended at this error */
} fit_result;

/* Finds the keys of *m, whose other parameters stay.  Many searches from different starts look at no more than FIT_FEW
 * points, evenly taken; the best goes on with FIT_MANY.  A key that makes no difference has its default and is not
 * given.  The same points give the same result.  FACET_BAD_VALUE: fewer values than unknowns, or nothing to be found;
 * FACET_NO_MEMORY. */
enum { FIT_FEW = 600, FIT_MANY = 20000, FIT_STARTS = 16 };

/* Called before each of the FIT_STARTS searches; may be NULL. */
typedef void fit_progress(void *user, size_t n_done);

facet_status fit_material(const facet_material *m, fit_keys keys, fit_points points, fit_progress *progress, void *user,
                          fit_result *result, facet_error *why);

#ifdef __cplusplus
}
#endif
