/* gtr_sample.h: normals of a GTR distribution, all of them and the visible ones, for any gamma.
 *
 * The visible ones: with the slope t of a normal along the viewer's azimuth and mu = cot(theta_o), their density is
 * P22 (1 + t/mu)+ G1.  P22 is even, and (1 + y)+ = clamp(1 + y, 0, 2) + (y - 1)+ with y = t/mu, so that
 * - with probability G1 it is a normal of the whole distribution, turned to the other side with probability
 *   1 - clamp((1 + y)/2, 0, 1);
 * - with probability 1 - G1 it has the density P22 (t - mu)+/T(mu), T(mu) = mu Lambda(mu) = Int (t - mu)+ P22.  As
 *   (t - mu)+ = Int_mu 1[t > q] dq, draw q with P(q > x) = T(x)/T(mu), then a slope of the whole distribution beyond
 *   the line t = q: first its azimuth phi, with a density proportional to S(q/cos phi), S(r) = P(radius > r), then its
 *   radius beyond q/cos phi.
 * S and its inverse are elementary; T and phi are inverted by a guess and Newton's method, docs/models/gtr.md.
 *
 * [disney] Burley, Physically based shading at Disney, 2012, appendix B: (2), (3), (5), (7), (9).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr.h"

#if FACET_REAL_IS_DOUBLE
#define GTR_LINE_STEPS     8
#define GTR_AZIMUTH_STEPS  5
#define GTR_AZIMUTH_PANELS 8
#else
#define GTR_LINE_STEPS     2
#define GTR_AZIMUTH_STEPS  2
#define GTR_AZIMUTH_PANELS 1
#endif

/* Gauss's rule of five nodes on [-1/2, 1/2]. */
#define GAUSS_5_NEAR        ((real)0.26923465505284154552)
#define GAUSS_5_FAR         ((real)0.4530899229693319964)
#define GAUSS_5_WEIGHT      ((real)0.28444444444444444444)
#define GAUSS_5_NEAR_WEIGHT ((real)0.23931433524968323402)
#define GAUSS_5_FAR_WEIGHT  ((real)0.11846344252809454376)

/* Y = -ln s at tan^2(theta) = t0/t1, to relative accuracy where s is near 1. */
KERNEL real gtr_minus_log_s(gtr_shape g, real t0, real t1)
{
    real inverse = 1/(t0 + t1);
    return -klog_near_one((t0 + g.alpha*g.alpha*t1)*inverse, -g.k0*t1*inverse);
}

/* Where a share xi of the normals beyond -ln s = Y0 lies before: Y0 - Y and Y.  P(beyond Y) is proportional to
 * e^((gamma - 1) Y) - 1: [disney, 3, 5, 7, 9] from either end, accurate where a result is small. */
KERNEL real2 gtr_quantile(real excess, real Y0, real xi)
{
    real all     = excess*Y0;
    real power   = kmin(all, GTR_LARGEST_POWER);
    int is_near  = xi < 0.5f;
    real grown   = kexpm1(is_near ? -power : power);
    real log     = klog1p((is_near ? xi : 1 - xi)*grown);
    real towards = (is_near ? -log : power - log)/excess;
    real Y       = is_near ? Y0 - towards : (log + (all - power))/excess;
    return make2(towards, Y);
}

/* tan^2(theta) where -ln s = Y and ln(s/alpha^2) = lift. */
KERNEL real gtr_tan2(real alpha2, real lift, real Y)
{
    return alpha2*kexpm1(kmax(lift, 0))/kmax(-kexpm1(-Y), REAL_MIN/REAL_EPSILON);
}

/* A normal with density D cos_m, of any length.  [disney, 2, 9] in its safe form. */
KERNEL real3 gtr_sample_ndf(real ux, real uy, gtr_shape g)
{
    real2 azimuth = kcossin_turn(uy);
    real2 Y       = gtr_quantile(g.excess, g.log_range, ux);
    real r        = ksqrt(gtr_tan2(g.alpha*g.alpha, Y.x, Y.y));
    return make3(g.stretch_x*(r*azimuth.x), g.stretch_y*(r*azimuth.y), 1);
}

/* The slope q >= lowest of the line beyond which T(q) = tau, and -T'(q), the probability of a slope beyond it. */
KERNEL real2 gtr_line(gtr_shape g, real tau, real lowest)
{
    real x    = g.guess_scale*klog(g.T0/tau) - 1;
    real near = kclamp(x, -1, 1);
    real e    = g.guess[GTR_GUESS - 1];
    UNROLL
    for (int k = GTR_GUESS - 2; k >= 0; k--) e = g.guess[k] + near*e;
    e += g.guess_slope*kmax(x - 1, 0)/g.guess_scale;
    real q = kmax(g.T0*kexp(e) - tau, lowest);
    real S = 0;
    UNROLL
    for (int k = 0; k < GTR_LINE_STEPS; k++) {
        real q2 = q*q;
        real2 A = gtr_A(g, gtr_inverse_s(g, q2, 1));
        real M  = ksqrt(q2 + A.x);
        real T  = 0.5f*A.x/(q + M);
        real ds = 2*q*g.k0/((q2 + 1)*(q2 + g.alpha*g.alpha)); /* d(ln s)/dq */
        S       = kmax((T - 0.25f*A.y*ds)/M, REAL_MIN);
        q       = kmax(q + 2*T*(T - tau)/((T + tau)*S), lowest);
    }
    return make2(q, S);
}

/* S(q/cos phi) d phi/dh at h = tan(phi/2), times e^(excess L) - 1, and e^-shift against overflow. */
KERNEL real gtr_azimuth_density(gtr_shape g, real q2, real shift, real h)
{
    real plus  = 1 + h*h;
    real minus = 1 - h*h;
    real Y     = gtr_minus_log_s(g, q2*plus*plus, minus*minus);
    return 2*kexpm1(g.excess*Y - shift)/plus;
}

/* Its integral from `low` over `width`, by Gauss's rule of five nodes. */
KERNEL real gtr_azimuth_integral(gtr_shape g, real q2, real shift, real low, real width)
{
    real middle = low + 0.5f*width;
    real near   = gtr_azimuth_density(g, q2, shift, middle - GAUSS_5_NEAR*width) +
                gtr_azimuth_density(g, q2, shift, middle + GAUSS_5_NEAR*width);
    real far = gtr_azimuth_density(g, q2, shift, middle - GAUSS_5_FAR*width) +
               gtr_azimuth_density(g, q2, shift, middle + GAUSS_5_FAR*width);
    return width*(GAUSS_5_WEIGHT*gtr_azimuth_density(g, q2, shift, middle) + GAUSS_5_NEAR_WEIGHT*near +
                  GAUSS_5_FAR_WEIGHT*far);
}

/* The azimuth of a point beyond the line at distance q, as h = tan(phi/2) in [0, 1): a share v of the points lies
 * below.  The density of phi is S(q/cos phi)/S(q), its integral up to pi/2 is `total`.  It resembles a power of
 * cos(phi), for which cos^2 = (1 - v^2)^(total^2) is a good guess; Halley's method for a power of 1 - h improves it. */
KERNEL real gtr_azimuth(gtr_shape g, real q, real total, real v)
{
    real q2    = q*q;
    real all   = g.excess*gtr_minus_log_s(g, q2, 1);
    real shift = kmax(all - GTR_LARGEST_POWER, 0);
    real scale = 1/(kexpm1(all - shift)*total);
    real above = 1 - v;
    real power = total*total*klog1p(-kmin(v*v, 1 - REAL_EPSILON));
    real h     = ksqrt(-kexpm1(power))/(1 + kexp(0.5f*power));
    UNROLL
    for (int step = 0; step < GTR_AZIMUTH_STEPS; step++) {
        real width = h/GTR_AZIMUTH_PANELS;
        real sum   = 0;
        UNROLL
        for (int i = 0; i < GTR_AZIMUTH_PANELS; i++) sum += gtr_azimuth_integral(g, q2, shift, i*width, width);
        real rest = kmax(1 - scale*sum, REAL_EPSILON);
        real d    = scale*gtr_azimuth_density(g, q2, shift, h)*(1 - h); /* rest goes as (1 - h)^(d/rest) */
        real up   = (d - rest)*rest + (d + rest)*above;
        real down = (d + rest)*rest + (d - rest)*above;
        h         = kclamp(1 - (1 - h)*up/down, 0, 1 - REAL_EPSILON);
    }
    return h;
}

/* A viewer as the isotropic GTR sees him. */
typedef struct gtr_view {
    real cos_phi, sin_phi; /* his azimuth */
    real mu, T;            /* cot(theta_o), and mu Lambda(mu) */
} gtr_view;

KERNEL gtr_view gtr_view_of(real3 wo, gtr_shape g)
{
    real3 w      = gtr_unstretch_direction(g, wo);
    real sin     = ksqrt(w.x*w.x + w.y*w.y);
    int has_side = sin > REAL_MIN;
    real inv     = 1/(has_side ? sin : (real)1);
    gtr_view v;
    v.cos_phi = has_side ? w.x*inv : (real)1;
    v.sin_phi = has_side ? w.y*inv : (real)0;
    v.mu      = has_side ? kmin(kabs(w.z)*inv, COT_LARGEST) : COT_LARGEST;
    real A    = gtr_A(g, gtr_inverse_s(g, v.mu*v.mu, 1)).x;
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

/* A normal of the whole distribution, turned to the viewer's side or not; ux, uy, uz: uniform. */
KERNEL real3 gtr_sample_body(gtr_view v, real ux, real uy, real uz, gtr_shape g)
{
    real2 Y    = gtr_quantile(g.excess, g.log_range, ux);
    real r     = ksqrt(gtr_tan2(g.alpha*g.alpha, Y.x, Y.y));
    real2 turn = kcossin_turn(uy);
    real sided = 2*uz*v.mu > v.mu + r*turn.x ? -r : r;
    return gtr_turn(v, sided*turn.x, sided*turn.y, g);
}

/* A normal with the density P22 (t - mu)+/T(mu): line, azimuth, radius. */
KERNEL real3 gtr_sample_tail(gtr_view v, real ux, real uy, real uz, gtr_shape g)
{
    real2 line = gtr_line(g, kmax(v.T*(1 - ux), REAL_MIN), v.mu);
    real q     = line.x;
    real z     = g.excess*gtr_minus_log_s(g, q*q, 1);
    real all   = g.excess*g.log_range;
    real S     = kexp(z - all)*kexpm1(-z)/kexpm1(-all); /* P(radius > q) */
    real side  = 2*uy - 1;
    real h     = gtr_azimuth(g, q, kclamp(PI*line.y/kmax(S, REAL_MIN), REAL_EPSILON, HALF_PI), kabs(side));
    real inv   = 1/(1 + h*h);
    real cos   = (1 - h*h)*inv;
    real sin   = kcopysign(2*h*inv, side);
    real edge  = q/cos;
    real Y0    = gtr_minus_log_s(g, edge*edge, 1);
    real2 Y    = gtr_quantile(g.excess, Y0, uz);
    real tan2  = gtr_tan2(g.alpha*g.alpha, (g.log_range - Y0) + Y.x, Y.y);
    real r     = kmax(ksqrt(tan2), edge);
    return gtr_turn(v, r*cos, r*sin, g);
}

/* A normal with density D(wm) (wo.wm)+/sigma(wo), of any length; ux, uy, uz: uniform.  The tail costs ten times the
 * body and is rare; batches draw it apart (batch_staged.h). */
KERNEL real3 gtr_sample_vndf(real3 wo, real ux, real uy, real uz, gtr_shape g)
{
    gtr_view v = gtr_view_of(wo, g);
    real rest  = gtr_rest_of(v, ux);
    return gtr_is_tail(v, ux) ? gtr_sample_tail(v, rest, uy, uz, g) : gtr_sample_body(v, rest, uy, uz, g);
}
