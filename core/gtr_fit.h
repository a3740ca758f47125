/* gtr_fit.h: the constants of a GTR distribution of normals that its kernel does not compute: polynomials of its
 * effective roughness.  Found once per material, in double precision, with the same bits everywhere.
 *
 * Numbers only, so that files of either precision of kernel/real.h can include it.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kernel/gtr_terms.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct gtr_fit {
    double peak;             /* D at the normal */
    double T0;               /* T(mu) = mu Lambda(mu) at mu = 0 */
    int form;                /* GTR_LOGARITHM, GTR_QUOTIENT */
    double scale, offset;    /* the polynomial's variable is scale v + offset, v by the form */
    int count;               /* terms that are not 0; a multiple of 4 */
    double terms[GTR_TERMS]; /* coefficients of its powers */
    double guess_scale, guess_slope;
    double guess[GTR_GUESS];
} gtr_fit;

/* What both builds need, and the polynomial of the float build.  alpha in [1e-4, 1], gamma in (0, 20]. */
void facet_gtr_fit_shape(double alpha, double gamma, gtr_fit *fit);

/* A instead over GTR_PIECES equal parts of ln s, from s = alpha^2 on, each in powers of a variable from -1 to 1.  The
 * variable scale v + offset of `fit` then runs from 0 to GTR_PIECES. */
void facet_gtr_fit_pieces(double alpha, double gamma, gtr_fit *fit, double pieces[GTR_PIECES][GTR_TERMS]);

/* D at the normal of Disney's anisotropic D. */
double facet_gtr_fit_disney_peak(double alpha_x, double alpha_y, double gamma);

/* The same, by instruction set; those above take the table of the loops in use (batch.h). */
typedef struct gtr_fit_loops {
    void (*shape)(double alpha, double gamma, gtr_fit *fit);
    void (*pieces)(double alpha, double gamma, gtr_fit *fit, double pieces[GTR_PIECES][GTR_TERMS]);
    double (*disney_peak)(double alpha_x, double alpha_y, double gamma);
} gtr_fit_loops;
extern const gtr_fit_loops facet_gtr_fit_base;
#if defined(__x86_64__)
extern const gtr_fit_loops facet_gtr_fit_avx2;
extern const gtr_fit_loops facet_gtr_fit_avx512;
#endif

#ifdef __cplusplus
}
#endif
