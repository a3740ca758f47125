/* any_bsdf.h: a prepared material in either precision behind one interface, so that one test text covers both.
 *
 * Everything is passed as double; the single-precision build rounds its inputs once, at the call.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct any_bsdf {
    char spec[160];
    int is_double;
    facet_bsdf single;
    facet_bsdf64 twice;
} any_bsdf;

/* Prepares the material `spec`; a fault in it ends the test. */
any_bsdf any_bsdf_of(const char *spec, int is_double);

/* The rounding unit's double, 2^-23 or 2^-52. */
double any_epsilon(const any_bsdf *bsdf);

void any_eval(const any_bsdf *bsdf, const double wi[3], const double wo[3], double f[3]);
double any_pdf(const any_bsdf *bsdf, const double wi[3], const double wo[3]);
facet_sample64 any_sample(const any_bsdf *bsdf, const double wo[3], const double u[3]);
facet_terms64 any_terms(const any_bsdf *bsdf, const double m[3]);

/* The unit vector with this cosine to the normal and this azimuth [rad]. */
void any_direction(double cos_theta, double phi, double v[3]);

/* The prepared material of `spec` in single precision, for batches. */
facet_bsdf single_bsdf_of(const char *spec);

#ifdef __cplusplus
}
#endif
