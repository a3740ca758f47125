/* gtr_sample.h: normals of a GTR distribution, all of them and the visible ones, for any gamma.
 *
 * The visible ones: with the slope t of a normal along the viewer's azimuth and mu = cot(theta_o), their density is
 * P22 (1 + t/mu)+ G1.  P22 is even, and (1 + y)+ = clamp(1 + y, 0, 2) + (y - 1)+ with y = t/mu, so that
 * - with probability G1 it is a normal of the whole distribution, turned to the other side with probability
 *   1 - clamp((1 + y)/2, 0, 1);
 * - with probability 1 - G1 it has the density P22 (t - mu)+/T(mu), T(mu) = mu Lambda(mu) = Int (t - mu)+ P22.  As
 *   (t - mu)+ = Int_mu 1[t > q] dq, draw q with P(q > x) = T(x)/T(mu), then a slope of the whole distribution beyond
 *   the line t = q, by rejection from those farther than q.
 * The inverse of T is a guess and Newton's method, docs/models/gtr.md; all else is elementary.
 *
 * [disney] Burley, Physically based shading at Disney, 2012, appendix B: (2), (3), (5), (7), (9).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr.h"

#define GTR_LINE_STEPS (FACET_REAL_IS_DOUBLE ? 8 : 2)
#define GTR_TRIALS     128 /* each succeeds with a probability of 0.3 at least, of 0.55 on average */

/* Y = -ln s at tan^2(theta) = t0/t1, to relative accuracy where s is near 1. */
KERNEL real gtr_minus_log_s(gtr_shape g, real t0, real t1)
{
    real inverse = 1/(t0 + t1);
    return -klog_near_one((t0 + g.alpha*g.alpha*t1)*inverse, -g.k0*t1*inverse);
}

/* Where a share xi of the normals beyond -ln s = Y0 lies before: Y0 - Y and Y.  P(beyond Y) is proportional to
 * e^((gamma - 1) Y) - 1: [disney, 3, 5, 7, 9] from either end, accurate where a result is small.  grown: the function
 * before, e^(+-(gamma - 1) Y0) - 1. */
KERNEL real gtr_grown(real excess, real Y0, real xi)
{
    real power = kmin(excess*Y0, GTR_LARGEST_POWER);
    return kexpm1(xi < 0.5f ? -power : power);
}

KERNEL real2 gtr_quantile_of(real excess, real Y0, real xi, real grown)
{
    real all     = excess*Y0;
    real power   = kmin(all, GTR_LARGEST_POWER);
    int is_near  = xi < 0.5f;
    real log     = klog1p((is_near ? xi : 1 - xi)*grown);
    real towards = (is_near ? -log : power - log)/excess;
    real Y       = is_near ? Y0 - towards : (log + (all - power))/excess;
    return make2(towards, Y);
}

KERNEL real2 gtr_quantile(real excess, real Y0, real xi)
{
    return gtr_quantile_of(excess, Y0, xi, gtr_grown(excess, Y0, xi));
}

/* tan^2(theta) where -ln s = Y and ln(s/alpha^2) = lift. */
KERNEL real gtr_tan2(real alpha2, real lift, real Y)
{
    return alpha2*kexpm1(kmax(lift, 0))/kmax(-kexpm1(-Y), REAL_MIN/REAL_EPSILON);
}

/* The share of the facets, by projected area, whose tan^2/alpha^2 before the stretch is above tan2, and the tan2 of a
 * share; rest = 1 - share. */
KERNEL real gtr_share_beyond(real tan2, gtr_shape g)
{
    real Y = gtr_minus_log_s(g, g.alpha*g.alpha*tan2, 1);
    return kexp(g.excess*(Y - g.log_range))*(kexpm1(-g.excess*Y)/kexpm1(-g.excess*g.log_range));
}

KERNEL real gtr_tan2_beyond(real rest, gtr_shape g)
{
    real2 Y = gtr_quantile(g.excess, g.log_range, rest);
    return gtr_tan2(1, Y.x, Y.y);
}

/* tan(theta) where -ln s is Y.y, and Y0 - Y.x. */
KERNEL real gtr_radius(gtr_shape g, real Y0, real2 Y)
{
    return ksqrt(gtr_tan2(g.alpha*g.alpha, (g.log_range - Y0) + Y.x, Y.y));
}

/* A normal with density D cos_m, of any length.  [disney, 2, 9] in its safe form. */
KERNEL real3 gtr_sample_ndf(real ux, real uy, gtr_shape g)
{
    real2 azimuth = kcossin_turn(uy);
    real r        = gtr_radius(g, g.log_range, gtr_quantile(g.excess, g.log_range, ux));
    return make3(g.stretch_x*(r*azimuth.x), g.stretch_y*(r*azimuth.y), 1);
}

/* The slope q >= lowest of the line beyond which T(q) = tau: a guess, and a step of Newton's method from q, where
 * S = -T'(q) is the probability of a slope beyond it;
 * A: gtr_A_and_slope there. */
KERNEL real gtr_line_guess(gtr_shape g, real tau, real lowest)
{
    real x    = g.guess_scale*klog(g.T0/tau) - 1;
    real near = kclamp(x, -1, 1);
    real e    = g.guess[GTR_GUESS - 1];
    UNROLL
    for (int k = GTR_GUESS - 2; k >= 0; k--) e = g.guess[k] + near*e;
    e += g.guess_slope*kmax(x - 1, 0)/g.guess_scale;
    return kmax(g.T0*kexp(e) - tau, lowest);
}

KERNEL real gtr_line_step(gtr_shape g, real tau, real lowest, real q, real2 A)
{
    real q2 = q*q;
    real M  = ksqrt(q2 + A.x);
    real T  = 0.5f*A.x/(q + M);
    real ds = 2*q*g.k0/((q2 + 1)*(q2 + g.alpha*g.alpha)); /* d(ln s)/dq */
    real S  = kmax((T - 0.25f*gtr_A_slope(g, A.y, gtr_inverse_s(g, q2, 1))*ds)/M, REAL_MIN);
    return kmax(q + 2*T*(T - tau)/((T + tau)*S), lowest);
}

/* A viewer as the isotropic GTR sees him; A: gtr_A towards him. */
typedef struct gtr_view {
    real cos_phi, sin_phi; /* his azimuth */
    real mu, T;            /* cot(theta_o), and mu Lambda(mu) */
} gtr_view;

KERNEL gtr_view gtr_view_of(real3 wo, gtr_shape g, real A)
{
    real3 w      = gtr_unstretch_direction(g, wo);
    real sin     = ksqrt(w.x*w.x + w.y*w.y);
    int has_side = sin > REAL_MIN;
    real inv     = 1/(has_side ? sin : (real)1);
    gtr_view v;
    v.cos_phi = has_side ? w.x*inv : (real)1;
    v.sin_phi = has_side ? w.y*inv : (real)0;
    v.mu      = has_side ? kmin(kabs(w.z)*inv, COT_LARGEST) : COT_LARGEST;
    v.T       = 0.5f*A/(v.mu + ksqrt(v.mu*v.mu + A));
    return v;
}

/* Whether the number u, uniform in [0, 1), chooses the tail, and what of it is uniform again. */
KERNEL int gtr_is_tail(gtr_view v, real u) { return u*(v.mu + v.T) >= v.mu; }
KERNEL real gtr_rest_of(gtr_view v, real u)
{
    real x    = u*(v.mu + v.T);
    real rest = gtr_is_tail(v, u) ? (x - v.mu)/kmax(v.T, REAL_MIN) : x/v.mu;
    return kclamp(rest, 0, 1 - REAL_EPSILON);
}

/* The normal with these slopes along and across the viewer's azimuth. */
KERNEL real3 gtr_turn(gtr_view v, real along, real across, gtr_shape g)
{
    return make3(g.stretch_x*(v.cos_phi*along - v.sin_phi*across),
                 g.stretch_y*(v.sin_phi*along + v.cos_phi*across), 1);
}

/* A normal of the whole distribution at the radius r, turned to the viewer's side or not; uy, uz: uniform. */
KERNEL real3 gtr_sample_body(gtr_view v, real r, real uy, real uz, gtr_shape g)
{
    real2 turn = kcossin_turn(uy);
    real sided = 2*uz*v.mu > v.mu + r*turn.x ? -r : r;
    return gtr_turn(v, sided*turn.x, sided*turn.y, g);
}

/* The T of the line beyond which a normal of the tail lies, and the line's distance. */
KERNEL real gtr_tail_mass(gtr_view v, real u) { return kmax(v.T*(1 - u), REAL_MIN); }

KERNEL real gtr_draw_line(gtr_shape g, real mu, real tau)
{
    real q = gtr_line_guess(g, tau, mu);
    UNROLL
    for (int k = 0; k < GTR_LINE_STEPS; k++)
        q = gtr_line_step(g, tau, mu, q, gtr_A_and_slope(g, gtr_variable(g, gtr_inverse_s(g, q*q, 1))));
    return q;
}

/* A slope at the radius r, turned by less than a quarter turn; uy: uniform. */
KERNEL real2 gtr_half_turn(real r, real uy)
{
    real2 turn = kcossin_turn(0.5f*uy - 0.25f);
    return make2(r*turn.x, r*turn.y);
}

/* The two numbers of a trial: the sample's own for the first, number 0; then what comes of its three. */
KERNEL real2 gtr_numbers_of_trial(real3 u, int trial)
{
    real_bits word = scramble(bits_of(u.x) + scramble(bits_of(u.y) + scramble(bits_of(u.z) + (real_bits)trial)));
    return trial == 0 ? make2(u.y, u.z) : make2(uniform_of(word), uniform_of(scramble(word)));
}

/* A normal with the density P22 (t - mu)+/T(mu): a line, and a slope beyond it. */
KERNEL real3 gtr_sample_tail(gtr_view v, real3 u, gtr_shape g)
{
    real q     = gtr_draw_line(g, v.mu, gtr_tail_mass(v, u.x));
    real Y0    = gtr_minus_log_s(g, q*q, 1);
    real2 tail = make2(-1, 0);
    for (int trial = 0; (trial < GTR_TRIALS) & (tail.x < q); trial++) {
        real2 numbers = gtr_numbers_of_trial(u, trial);
        tail          = gtr_half_turn(gtr_radius(g, Y0, gtr_quantile(g.excess, Y0, numbers.y)), numbers.x);
    }
    return gtr_turn(v, kmax(tail.x, q), tail.y, g);
}

/* A normal with density D(wm) (wo.wm)+/sigma(wo), of any length; ux, uy, uz: uniform.  The tail costs several times as
 * much as the body and is rare; batches draw it apart (batch_microfacet_text.h). */
KERNEL real3 gtr_sample_vndf(real3 wo, real ux, real uy, real uz, gtr_shape g)
{
    gtr_view v = gtr_view_of(wo, g, gtr_A(g, gtr_variable_at(wo, g)));
    real rest  = gtr_rest_of(v, ux);
    return gtr_is_tail(v, ux)
               ? gtr_sample_tail(v, make3(rest, uy, uz), g)
               : gtr_sample_body(v, gtr_radius(g, g.log_range, gtr_quantile(g.excess, g.log_range, rest)), uy, uz, g);
}
