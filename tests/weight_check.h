/* weight_check.h: a sample's density and weight against pdf and eval/pdf at its direction.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "tests/any_bsdf.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Fails the test unless the sample that u draws for wo has the density and the weight of the direction it returns.  A
 * sample may hold the density of the normal that it drew, while its wi is rounded, and that normal depends on wo: each
 * component by `steps` eps at most.  The values may differ by what such steps along each axis of either direction
 * change, besides 5 eps of their own arithmetic.  Returns the sample. */
facet_sample64 weight_check(const any_bsdf *bsdf, const double wo[3], const double u[3], double steps);

#ifdef __cplusplus
}
#endif
