/* gtr_fit.c: the fits of gtr with the loops of the instruction set in use.
 * SPDX-License-Identifier: MIT */
#include "gtr_fit.h"

#include "batch.h"

void facet_gtr_fit_shape(double alpha, double gamma, gtr_fit *fit)
{
    facet_batch_loops()->gtr_fit->shape(alpha, gamma, fit);
}

void facet_gtr_fit_pieces(double alpha, double gamma, gtr_fit *fit, double pieces[GTR_PIECES][GTR_TERMS])
{
    facet_batch_loops()->gtr_fit->pieces(alpha, gamma, fit, pieces);
}

double facet_gtr_fit_disney_peak(double alpha_x, double alpha_y, double gamma)
{
    return facet_batch_loops()->gtr_fit->disney_peak(alpha_x, alpha_y, gamma);
}
