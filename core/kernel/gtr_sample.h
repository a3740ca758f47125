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
 * S and its inverse are elementary; T is inverted by a guess and Newton's method, the integral over phi by quartics,
 * docs/models/gtr.md.
 *
 * [disney] Burley, Physically based shading at Disney, 2012, appendix B: (2), (3), (5), (7), (9).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "gtr.h"

#if FACET_REAL_IS_DOUBLE
#define GTR_LINE_STEPS     8
#define GTR_AZIMUTH_POINTS 97 /* of panels of four */
#define GTR_PANEL_STEPS    5
#else
#define GTR_LINE_STEPS     2
#define GTR_AZIMUTH_POINTS 25
#define GTR_PANEL_STEPS    3
#endif

#define GTR_LEAST_NEAR ((real)0.01)
#define SIXTH          ((real)0.16666666666666666667)
#define SEVENTY_SECOND ((real)0.01388888888888888889)
#define TWO_45THS      ((real)0.04444444444444444444)

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

/* The line beyond which a normal of the tail lies, and what its azimuth needs. */
typedef struct gtr_tail_line {
    real q;     /* its distance */
    real z;     /* (gamma - 1) Y there */
    real total; /* Int S(q/cos phi) d phi/S(q) */
} gtr_tail_line;

/* The density S(q/cos phi) of the azimuths of the points beyond the line at distance q, in a variable y in [0, 1] that
 * resolves the two places where it changes: phi = 0, about which a steep S keeps it, and pi/2, before which it falls
 * where the line is nearer than the slopes reach.  h = tan(phi/2) = 1 + near - (1 + near) e^(-fall z), and
 * z = spread y/(1 - y (1 - spread)). */
typedef struct gtr_azimuths {
    real q2, shift; /* q^2; e^-shift keeps the density finite */
    real near, fall, spread;
} gtr_azimuths;

KERNEL gtr_azimuths gtr_azimuths_of(gtr_shape g, gtr_tail_line line)
{
    gtr_azimuths a;
    a.q2     = line.q*line.q;
    a.shift  = kmax(line.z - GTR_LARGEST_POWER, 0);
    a.near   = kmax(line.q/(line.q + 2*g.T0), GTR_LEAST_NEAR);
    a.fall   = klog(1 + 1/a.near);
    a.spread = kmin(line.total, 1);
    return a;
}

/* h at y, and dh/dy. */
KERNEL real2 gtr_azimuth_at(gtr_azimuths a, real y)
{
    real inverse = 1/(1 - y*(1 - a.spread));
    real rest    = (1 + a.near)*kexp(-a.fall*(a.spread*y*inverse));
    return make2(1 + a.near - rest, rest*a.fall*a.spread*inverse*inverse);
}

/* The density of y, times |e^(excess L) - 1| e^-shift. */
KERNEL real gtr_azimuth_density(gtr_shape g, gtr_azimuths a, real y)
{
    real2 h    = gtr_azimuth_at(a, y);
    real plus  = 1 + h.x*h.x;
    real minus = kmax(1 - h.x*h.x, 0);
    real Y     = gtr_minus_log_s(g, a.q2*plus*plus, minus*minus);
    return kabs(kexpm1(g.excess*Y - a.shift))*(2*h.y/plus);
}

/* Five values of a density at equal distances, and how far beyond the first of them, in mass, a point lies. */
typedef struct gtr_panel {
    real f0, f1, f2, f3, f4, left;
} gtr_panel;

/* The position of the point in [0, 4], by Newton's method for the integral of the quartic through the values. */
KERNEL real gtr_panel_quantile(gtr_panel p)
{
    real d1   = p.f1 - p.f0;
    real d2   = p.f2 - 2*p.f1 + p.f0;
    real d3   = p.f3 - 3*(p.f2 - p.f1) - p.f0;
    real d4   = p.f4 - 4*(p.f3 + p.f1) + 6*p.f2 + p.f0;
    real c1   = p.f0;
    real c2   = 0.5f*d1 - 0.25f*d2 + SIXTH*d3 - 0.125f*d4;
    real c3   = SIXTH*(d2 - d3) + 11*SEVENTY_SECOND*d4;
    real c4   = 0.25f*SIXTH*d3 - 0.0625f*d4;
    real c5   = (real)0.6*SEVENTY_SECOND*d4;
    real mass = 4*(c1 + 4*(c2 + 4*(c3 + 4*(c4 + 4*c5))));
    real left = kclamp(p.left, 0, mass);
    /* a density that falls or rises along a line is the start */
    real share = left/kmax(mass, REAL_MIN);
    real low   = p.f0/kmax(p.f0 + p.f4, REAL_MIN);
    real x     = 4*share/kmax(low + ksqrt(kmax(low*low + (1 - 2*low)*share, 0)), REAL_MIN);
    UNROLL
    for (int step = 0; step < GTR_PANEL_STEPS; step++) {
        real below   = x*(c1 + x*(c2 + x*(c3 + x*(c4 + x*c5))));
        real density = c1 + x*(2*c2 + x*(3*c3 + x*(4*c4 + x*(5*c5))));
        x            = kclamp(x - (below - left)/kmax(density, REAL_MIN), 0, 4);
    }
    return x;
}

/* The integral over [0, 4] from these five values. */
KERNEL real gtr_boole(real f0, real f1, real f2, real f3, real f4)
{
    return TWO_45THS*(7*(f0 + f4) + 32*(f1 + f3) + 12*f2);
}

typedef struct gtr_densities {
    real f[GTR_AZIMUTH_POINTS];
} gtr_densities;

/* The azimuth of a point beyond the line, as h = tan(phi/2) in [0, 1): a share v of the points lies below.  By Boole's
 * rule in panels of y, and the quartic in the one where v lies. */
KERNEL real gtr_azimuth(gtr_shape g, gtr_tail_line line, real v)
{
    gtr_azimuths a = gtr_azimuths_of(g, line);
    real step      = 1/(real)(GTR_AZIMUTH_POINTS - 1);
    gtr_densities at;
    UNROLL
    for (int i = 0; i < GTR_AZIMUTH_POINTS; i++) at.f[i] = gtr_azimuth_density(g, a, i*step);
    real left = 0;
    UNROLL
    for (int i = 0; i < GTR_AZIMUTH_POINTS - 1; i += 4)
        left += v*gtr_boole(at.f[i], at.f[i + 1], at.f[i + 2], at.f[i + 3], at.f[i + 4]);
    gtr_panel here;
    here.f0    = at.f[0];
    here.f1    = at.f[1];
    here.f2    = at.f[2];
    here.f3    = at.f[3];
    here.f4    = at.f[4];
    here.left  = left;
    real first = 0;
    UNROLL
    for (int i = 0; i < GTR_AZIMUTH_POINTS - 1; i += 4) {
        int is_in = left >= 0;
        first     = is_in ? i*step : first;
        here.f0   = is_in ? at.f[i] : here.f0;
        here.f1   = is_in ? at.f[i + 1] : here.f1;
        here.f2   = is_in ? at.f[i + 2] : here.f2;
        here.f3   = is_in ? at.f[i + 3] : here.f3;
        here.f4   = is_in ? at.f[i + 4] : here.f4;
        here.left = is_in ? left : here.left;
        left -= gtr_boole(at.f[i], at.f[i + 1], at.f[i + 2], at.f[i + 3], at.f[i + 4]);
    }
    return kclamp(gtr_azimuth_at(a, first + step*gtr_panel_quantile(here)).x, 0, 1 - REAL_EPSILON);
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

KERNEL gtr_tail_line gtr_draw_line(gtr_shape g, real mu, real T, real u)
{
    real2 at = gtr_line(g, kmax(T*(1 - u), REAL_MIN), mu);
    real z   = g.excess*gtr_minus_log_s(g, at.x*at.x, 1);
    real S   = g.survival*kexp(z - g.excess*g.log_range)*kexpm1(-z); /* P(radius > q) */
    gtr_tail_line line;
    line.q     = at.x;
    line.z     = z;
    line.total = kclamp(PI*at.y/kmax(S, REAL_MIN), REAL_EPSILON, HALF_PI);
    return line;
}

/* The normal on that line's far side at the azimuth with tan(phi/2) = h, on the side that the sign of `side` says. */
KERNEL real3 gtr_draw_beyond(gtr_shape g, gtr_view v, real q, real h, real side, real u)
{
    real inv  = 1/(1 + h*h);
    real cos  = (1 - h*h)*inv;
    real sin  = kcopysign(2*h*inv, side);
    real edge = q/cos;
    real Y0   = gtr_minus_log_s(g, edge*edge, 1);
    real2 Y   = gtr_quantile(g.excess, Y0, u);
    real tan2 = gtr_tan2(g.alpha*g.alpha, (g.log_range - Y0) + Y.x, Y.y);
    real r    = kmax(ksqrt(tan2), edge);
    return gtr_turn(v, r*cos, r*sin, g);
}

/* A normal with the density P22 (t - mu)+/T(mu): line, azimuth, radius. */
KERNEL real3 gtr_sample_tail(gtr_view v, real ux, real uy, real uz, gtr_shape g)
{
    gtr_tail_line line = gtr_draw_line(g, v.mu, v.T, ux);
    real side          = 2*uy - 1;
    real h             = gtr_azimuth(g, line, kabs(side));
    return gtr_draw_beyond(g, v, line.q, h, side, uz);
}

/* A normal with density D(wm) (wo.wm)+/sigma(wo), of any length; ux, uy, uz: uniform.  The tail costs ten times the
 * body and is rare; batches draw it apart (batch_staged_text.h). */
KERNEL real3 gtr_sample_vndf(real3 wo, real ux, real uy, real uz, gtr_shape g)
{
    gtr_view v = gtr_view_of(wo, g);
    real rest  = gtr_rest_of(v, ux);
    return gtr_is_tail(v, ux) ? gtr_sample_tail(v, rest, uy, uz, g) : gtr_sample_body(v, rest, uy, uz, g);
}
