/* search.h: the largest errors of a distribution's single-precision terms, and of albedos, hunted for over the domain.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <stdint.h>

#include "facet/facet.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum search_term { SEARCH_D, SEARCH_LAMBDA, SEARCH_G1, SEARCH_ALBEDO, SEARCH_TERMS } search_term;

/* "D", "Lambda" (relative errors, of values above 1e-30), "G1" and "albedo" (absolute). */
extern const char *const search_names[SEARCH_TERMS];

enum { SEARCH_PARAMETERS = 4 };

/* A parameter that is searched over, in its logarithm if low > 0. */
typedef struct search_parameter {
    const char *name;
    double low, high;
} search_parameter;

typedef struct search_result {
    double error, found, truth;
    double values[SEARCH_PARAMETERS]; /* of the parameters, exact in single precision */
    float m[3];
} search_result;

/* The largest error of a term of `material` with n of its parameters varied, against the double-precision build of
 * the same formulas, which is within 1e-13 of 25-digit truth; for albedos, of facet_bsdf64_albedo against another
 * quadrature.  Random points of the domain, many of them near normal and near grazing, and from the worst of them
 * uphill in shrinking steps.  An albedo takes milliseconds, and gets a hundredth of the evaluations.  The same for
 * the same seed. */
search_result search_worst(const facet_material *material, const search_parameter *parameters, int n, search_term term,
                           int evaluations, uint64_t seed);

#ifdef __cplusplus
}
#endif
