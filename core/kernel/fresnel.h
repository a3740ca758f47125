/* fresnel.h: how much of the light a smooth interface reflects.
 *
 * [cs500]     CS500 Project 3, "F factor".
 * [schlick94] Schlick, An inexpensive BRDF model for physically-based rendering, 1994.
 * [born]      Born and Wolf, Principles of Optics, 7th edition, section 14.2 (metals).
 * [hoffman19] Hoffman, Fresnel equations considered harmful, 2019 (the dip of metals).
 * [kutz21]    Kutz, Hasan and Edmondson, Novel aspects of the Adobe Standard Material, 2021 (the dip as a tint).
 * [walsh26]   Walsh, The reflection factor of a polished glass surface for diffused light, 1926.
 *
 * c is the cosine between the light and the normal, in [0,1].  An average is weighted by it, 2 Int_0^1 F(c) c dc: the
 * share of perfectly diffuse light that is reflected.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath.h"
#include "real.h"

/* Schlick's approximation, F0 + (F90 - F0)(1 - c)^5, c = |wi.wm| in [0,1].  [cs500, F(d)], where F90 = 1. */
KERNEL real3 fresnel_schlick(real3 F0, real3 F90, real c) { return add3(F0, scale3(kpow5(1 - c), sub3(F90, F0))); }

/* Unpolarised reflectance of a dielectric interface; c = |w.wm| in [0,1] on the side of the light,
 * eta = n_t/n_i.  [cs500, "exact formulation"].  Departures: total internal reflection gives 1 where the
 * radicand is not positive, and g - c is written as (eta^2 - 1)/(g + c), which does not cancel. */
KERNEL real fresnel_dielectric(real c, real eta)
{
    real eta2_1   = (eta - 1)*(eta + 1);
    real radicand = eta2_1 + c*c;
    real g        = ksqrt(kmax(radicand, 0));
    real sum      = g + c;
    real diff     = eta2_1/kmax(sum, REAL_MIN);
    real ratio    = diff/kmax(sum, REAL_MIN);
    real quotient = (c*sum - 1)/(c*diff + 1);
    real F        = 0.5f*ratio*ratio*(1 + quotient*quotient);
    return radicand > 0 ? kmin(F, 1) : (real)1;
}

/* Reflectance at normal incidence, ((eta - 1)/(eta + 1))^2. */
KERNEL real fresnel_normal_incidence(real eta)
{
    real r = (eta - 1)/(eta + 1);
    return r*r;
}

/* Unpolarised reflectance of a conductor of index eta + i k against a medium of index 1.  [born], with a + i b the
 * square root of (eta + i k)^2 - sin^2.  eta > 0, 0 <= k <= 1e9; at k = 0 it is fresnel_dielectric.
 * Departures: a^2 - b^2 from the smaller of sin^2 and cos^2; of a^2 and b^2 the one that would cancel is taken from
 * a b = eta k; a - c, which cancels at the index of the surroundings, is (eta^2 - 1 + b^2 - k^2)/(a + c) with
 * b^2 - k^2 = k^2 sin^2/(a^2 + k^2) (where that is less exact, a^2 + c^2 is far below b^2); and the tangent of the
 * second factor is multiplied out. */
KERNEL real fresnel_conductor(real c, real eta, real k)
{
    real sin2    = (1 - c)*(1 + c);
    real k2      = k*k;
    real eta2_1  = (eta - 1)*(eta + 1);
    real eta2    = eta*eta;
    real re      = sin2 < c*c ? eta2 - sin2 - k2 : eta2_1 + c*c - k2; /* a^2 - b^2 */
    real ab2     = eta2*k2;
    real larger  = 0.5f*(ksqrt(re*re + 4*ab2) + kabs(re));
    real smaller = ab2/kmax(larger, REAL_MIN);
    real a2      = re > 0 ? larger : smaller;
    real b2      = re > 0 ? smaller : larger;
    real a       = ksqrt(a2);
    real sum     = a + c;
    real diff    = (eta2_1 + k2*sin2/kmax(a2 + k2, REAL_MIN))/kmax(sum, REAL_MIN);
    real bottom  = sum*sum + b2;
    real Rs      = (diff*diff + b2)/kmax(bottom, REAL_MIN);
    real less    = a*c - sin2;
    real more    = a*c + sin2;
    real b2c2    = b2*c*c;
    real Rp_Rs   = (less*less + b2c2)/(more*more + b2c2);
    real F       = 0.5f*Rs*(1 + Rp_Rs);
    return bottom > REAL_MIN ? kmin(F, 1) : (real)1;
}

/* ... of three channels */
KERNEL real3 fresnel_conductor3(real c, real3 eta, real3 k)
{
    return make3(fresnel_conductor(c, eta.x, k.x), fresnel_conductor(c, eta.y, k.y), fresnel_conductor(c, eta.z, k.z));
}

/* What metals reflect less than Schlick's F says: strength c (1 - c)^6, a dip near c = 1/7, 81.8 degrees.  [hoffman19].
 * Departure: F at most, which it would exceed between normal and grazing for small F0 and a dark tint. */
KERNEL real3 fresnel_dip(real3 F, real3 strength, real c)
{
    real d     = kmax(1 - c, 0);
    real3 less = scale3(c*d*kpow5(d), strength);
    return make3(kmin(less.x, F.x), kmin(less.y, F.y), kmin(less.z, F.z));
}

KERNEL real3 fresnel_f82(real3 F0, real3 strength, real c)
{
    real3 F = fresnel_schlick(F0, splat3(1), c);
    return sub3(F, fresnel_dip(F, strength, c));
}

#define F82_AT     ((real)0.142857142857142857142857142857) /* 1/7 */
#define F82_FACTOR ((real)17.6513846021947873799725651578)  /* 1/(c (1 - c)^6) there, 7^7/6^6 */

/* The strength with which F(1/7) is `tint` times Schlick's.  [kutz21] */
KERNEL real3 fresnel_f82_strength(real3 F0, real3 tint)
{
    return scale3(F82_FACTOR, mul3(sub3(splat3(1), tint), fresnel_schlick(F0, splat3(1), F82_AT)));
}

/* Which interface, and its numbers. */
#define FRESNEL_SCHLICK    0
#define FRESNEL_DIELECTRIC 1
#define FRESNEL_CONDUCTOR  2
#define FRESNEL_F82        3

typedef struct fresnel {
    int kind;
    real3 F0;  /* Schlick, F82: reflectance at normal incidence */
    real3 dip; /* F82: fresnel_f82_strength */
    real3 eta; /* dielectric: n_t/n_i, three times; conductor: index of refraction, eta + i k */
    real3 k;
} fresnel;

/* Reflectance at c = |w.wm| in [0,1].  The dip is cut off by keep_if: of a third choice by ?: gcc makes a branch. */
KERNEL real3 fresnel_reflectance(fresnel f, real c)
{
    real3 schlick    = fresnel_schlick(f.F0, splat3(1), c);
    real3 dip        = fresnel_dip(schlick, f.dip, c);
    int has_dip      = f.kind == FRESNEL_F82;
    real3 coloured   = sub3(schlick, make3(keep_if(has_dip, dip.x), keep_if(has_dip, dip.y), keep_if(has_dip, dip.z)));
    real3 dielectric = splat3(fresnel_dielectric(c, f.eta.x));
    real3 conductor  = fresnel_conductor3(c, f.eta, f.k);
    real3 clear      = select3(f.kind == FRESNEL_DIELECTRIC, dielectric, coloured);
    return select3(f.kind == FRESNEL_CONDUCTOR, conductor, clear);
}

#define ONE_21ST  ((real)0.0476190476190476190476190476190)  /* 2 Int (1 - c)^5 c dc */
#define ONE_126TH ((real)0.00793650793650793650793650793651) /* 2 Int (1 - c)^6 c^2 dc */

/* Average of fresnel_schlick; exact. */
KERNEL real3 fresnel_schlick_average(real3 F0, real3 F90) { return add3(F0, scale3(ONE_21ST, sub3(F90, F0))); }

/* Average of fresnel_f82; exact where F is nowhere held at 0 (a tint from .51 on, or F0 from .3 on with a tint from
 * .1 on); else too small, by .022 at most (F0 = tint = 0). */
KERNEL real3 fresnel_f82_average(real3 F0, real3 strength)
{
    real3 average = sub3(fresnel_schlick_average(F0, splat3(1)), scale3(ONE_126TH, strength));
    return make3(kmax(average.x, 0), kmax(average.y, 0), kmax(average.z, 0));
}

/* The border of kmath's polynomial of atanh, (sqrt 2 - 1)/(sqrt 2 + 1), where the index is sqrt 2. */
#define ATANH_BORDER ((real)0.171572875253809902396622551581)
#define ONE_SIXTH    ((real)0.166666666666666666666666666667)

/* (atanh(x)/x - 1)/x^2 for x in [0,1); absolute error 2 eps where x > ATANH_BORDER, else relative. */
KERNEL real atanh_tail(real x)
{
    real x2  = x*x;
    real far = (klog((1 + x)/kmax(1 - x, REAL_MIN))/kmax(2*x, ATANH_BORDER) - 1)/
               kmax(x2, ATANH_BORDER*ATANH_BORDER);
    return x > ATANH_BORDER ? far : 0.5f*poly_log(x2);
}

/* Average of fresnel_dielectric; eta > 0; absolute error 4 eps.  [walsh26].  Departures: in x = (n - 1)/(n + 1), n the
 * larger index over the smaller, with the part of ln n = 2 atanh(x) that cancels taken out; from the denser side
 * 1 - F = (1 - F')/n^2. */
KERNEL real fresnel_dielectric_average(real eta)
{
    real n       = eta < 1 ? 1/eta : eta;
    real x       = (n - 1)/(n + 1);
    real x2      = x*x;
    real plus    = 1 + x;
    real both    = 1 + x2;
    real both3   = both*both*both;
    real reduced = 7 + x*(44 + x2*(-24 + x*(6 + x*(36 + x*(16 + x*(8 + 3*x))))));
    real quartic = ksquare((1 - x)*plus*plus)*(1 + x2*(6 + x2));
    real logs    = 0.25f*quartic*atanh_tail(x) + 2*x*plus*plus*klog(kmax(x, REAL_MIN));
    real outside = x*(0.5f*ONE_SIXTH*reduced + logs)/both3;
    return eta < 1 ? 1 - (1 - outside)*eta*eta : outside;
}

#define AVERAGE_STEP  ((real)0.2)
#define AVERAGE_STEPS 11

/* Average of fresnel_conductor, for prepare functions (a loop): error 5e-8 for k >= .5, where all metals are, and 2e-6
 * for any eta >= .01 and k >= 0, in double; 1e-6 more in float.  The tanh-sinh rule on both sides of the cosine where F
 * is steep when k is small, the end of total reflection. */
LARGE_KERNEL real fresnel_conductor_average(real eta, real k)
{
    real border  = ksqrt(ksaturate((1 - eta)*(1 + eta) + k*k));
    real sum     = 0;
    real weights = 0;
    for (int i = -AVERAGE_STEPS; i <= AVERAGE_STEPS; i++) {
        real e       = kexp(AVERAGE_STEP*(real)i);
        real q       = kexp(-HALF_PI*(e - 1/e));
        real y       = 1/(1 + q);
        real weight  = (e + 1/e)*q*y*y;
        real below   = border*y;
        real above   = border + (1 - border)*y;
        real F_below = border*below*fresnel_conductor(below, eta, k);
        real F_above = (1 - border)*above*fresnel_conductor(kmin(above, 1), eta, k);
        sum += weight*(F_below + F_above);
        weights += weight;
    }
    return 2*sum/weights;
}

/* Average of fresnel_reflectance, for prepare functions, with the errors above. */
KERNEL real3 fresnel_average(fresnel f)
{
    real3 dielectric = splat3(fresnel_dielectric_average(f.eta.x));
    real3 coloured   = select3(f.kind == FRESNEL_F82, fresnel_f82_average(f.F0, f.dip),
                               fresnel_schlick_average(f.F0, splat3(1)));
    real3 conductor  = make3(fresnel_conductor_average(f.eta.x, f.k.x), fresnel_conductor_average(f.eta.y, f.k.y),
                             fresnel_conductor_average(f.eta.z, f.k.z));
    real3 clear      = select3(f.kind == FRESNEL_DIELECTRIC, dielectric, coloured);
    return select3(f.kind == FRESNEL_CONDUCTOR, conductor, clear);
}
