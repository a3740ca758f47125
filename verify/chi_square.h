/* chi_square.h: Pearson's test of counts against expected counts.
 * SPDX-License-Identifier: MIT */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

typedef struct chi_square {
    double statistic;
    int degrees;      /* of freedom: cells after pooling, less one */
    double p;         /* of a statistic at least this large if the counts follow the expectation */
    double forbidden; /* counts in cells where nothing is expected */
} chi_square;

/* Cells are pooled, the emptiest first, until each expects 5 or more, by their expected.  A cell that expects
 * less than 1e-9 is forbidden.  */
chi_square chi_square_test(const double *expected, const double *observed, int n_cells);

/* P(chi^2 with this many degrees of freedom >= statistic). */
double chi_square_p(double statistic, int degrees);

/* The level of each of n tests that together fail by chance with probability `overall` (Sidak). */
double sidak_level(double overall, int n);

#ifdef __cplusplus
}
#endif
