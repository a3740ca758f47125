/* fit_points.h: values of f that `facet fit` is given: a CSV file, or one of the MERL database.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "verify/fit.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads FILE.binary as MERL and all others, or stdin for "-", as CSV.  Returns 0, with *points to be freed by
 * fit_points_free, or the exit status of the error that it printed. */
int fit_points_read(const char *path, fit_points *points);
void fit_points_free(fit_points *points);

#ifdef __cplusplus
}
#endif
