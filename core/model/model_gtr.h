/* model_gtr.h: the parameters of `gtr`, and how they are prepared.
 *
 * [vray] Dimov, Deriving the Smith shadowing function G1 for gamma in (0, 4], 2015, sections 5 and 6 (the spline).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "../gtr_fit.h"
#include "model_microfacet.h"

#ifdef FACET_PARAMETERS
static const facet_parameter gtr_parameters[] = {
    {"alpha", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along both tangents"},
    {"alpha_x", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along the tangent x, not with alpha"},
    {"alpha_y", FACET_NUMBER, 1e-4, 1, {0.3, 0, 0}, "1", "", "roughness along the bitangent y, not with alpha"},
    {"gamma", FACET_NUMBER, 1e-3, 20, {2, 0, 0}, "1", "", "exponent: 2 is GGX, less has longer tails"},
    {"anisotropy",
     FACET_CHOICE,
     0,
     1,
     {0, 0, 0},
     "1",
     "stretch|disney",
     "slopes of an isotropic gtr stretched, or Disney's D (the same for gamma 2)"},
    MICROFACET_PARAMETERS("vndf|ndf", 1),
};
#endif

#ifdef FACET_PREPARE
/* The weights of the values at 0, 1, 2, 3, 4 in the natural cubic spline through them, at gamma in [0, 4].  With the
 * second derivatives m_k at the knots, m_0 = m_4 = 0 and m_(k-1) + 4 m_k + m_(k+1) = 6 (y_(k-1) - 2 y_k + y_(k+1)), the
 * spline between two knots is a y_k + b y_(k+1) + ((a^3 - a) m_k + (b^3 - b) m_(k+1))/6, b = gamma - k, a = 1 - b. */
static inline gtr_spline gtr_spline_at(real gamma)
{
    static const real inverse[3][3] = {{15, -4, 1}, {-4, 16, -4}, {1, -4, 15}}; /* of the matrix 4 1 0, 1 4 1, 0 1 4 */
    const real x = kmin(gamma, 4);
    const int k = (int)kmin(kfloor(x), 3);
    const real b = x - (real)k, a = 1 - b;
    real weight[5];
    for (int knot = 0; knot < 5; knot++) {
        real m[5] = {0};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const real second = (real)(knot == j || knot == j + 2 ? 1 : knot == j + 1 ? -2 : 0);
                m[i + 1] += 6*inverse[i][j]*second/56;
            }
        weight[knot] = (knot == k ? a : (real)0) + (knot == k + 1 ? b : (real)0) +
                       ((a*a*a - a)*m[k] + (b*b*b - b)*m[k + 1])/6;
    }
    return (gtr_spline){weight[0], weight[1], weight[2], weight[3], weight[4]};
}

static inline gtr_shape gtr_shape_of(real alpha_x, real alpha_y, real gamma, int anisotropy)
{
    const real x = kmin(alpha_x, GTR_ROUGHEST), y = kmin(alpha_y, GTR_ROUGHEST);
    const real alpha = x == y ? x : ksqrt(x*y);
    gtr_fit fit;
    facet_gtr_fit_shape((double)alpha, (double)gamma, &fit);
    gtr_shape g = {.anisotropy = GTR_STRETCHED, .alpha = alpha, .gamma = gamma, .excess = gtr_excess(gamma)};
    g.stretch_x = x/alpha;
    g.stretch_y = y/alpha;
    g.is_isotropic = x == y;
    g.log_range = -2*klog(alpha);
    g.k0 = (1 - alpha)*(1 + alpha);
    g.survival = 1/kexpm1(-g.excess*g.log_range);
    g.peak = (real)fit.peak;
    g.T0 = (real)fit.T0;
    g.guess_scale = (real)fit.guess_scale;
    g.guess_slope = (real)fit.guess_slope;
    for (int k = 0; k < GTR_GUESS; k++) g.guess[k] = (real)fit.guess[k];
#if FACET_REAL_IS_DOUBLE
    facet_gtr_fit_pieces(alpha, gamma, &fit, g.terms);
#else
    for (int k = 0; k < GTR_TERMS; k++) g.terms[k] = (real)fit.terms[k];
#endif
    g.form = fit.form;
    g.count = fit.count;
    g.scale = (real)fit.scale;
    g.offset = (real)fit.offset;
    g.disney_peak = g.peak;
    if (anisotropy == GTR_DISNEY && x != y) {
        g.anisotropy = GTR_DISNEY;
        g.disney_peak = (real)facet_gtr_fit_disney_peak((double)x, (double)y, (double)gamma);
    }
    return g;
}

static inline microfacet_params gtr_prepare(const facet_material *m)
{
    microfacet_params p = microfacet_prepare(m, NDF_GTR);
    prepare_alpha(m, &p.d);
    const real gamma = prepare_number(m, "gamma");
    p.d.gtr = gtr_shape_of(p.d.alpha_x, p.d.alpha_y, gamma, prepare_choice(m, "anisotropy"));
    p.d.spline = gtr_spline_at(gamma);
    p.is_one = p.is_one && !distribution_is_disney(p.d);
    prepare_energy(m, &p);
    return p;
}
#endif
