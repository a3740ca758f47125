/* kmath_trig.h: circular functions and their inverses of kmath.h (include that).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath_basic.h"

/* (cos, sin) of q pi/2 + r + tail radians, |r| <= pi/4, |tail| an ulp of r, q the low two bits of `quadrant` */
KERNEL real2 cossin_in_quadrant(real_bits quadrant, real r, real tail)
{
    real r2 = r*r;
    real s  = r + (tail + r*r2*poly_sin(r2));
    real c  = 1.0f - (0.5f*r2 - r2*r2*poly_cos(r2));
    /* Exchange and negate in integers: SSE2 cannot compare 64-bit ones.  The added 0 turns -0 into 0. */
    real_bits exchange = (0u - (quadrant & 1u)) & (bits_of(c) ^ bits_of(s));
    real_bits x_sign   = ((quadrant + 1u) & 2u) << SIGN_SHIFT;
    real_bits y_sign   = (quadrant & 2u) << SIGN_SHIFT;
    real x             = real_of(bits_of(c) ^ exchange ^ x_sign) + 0.0f;
    real y             = real_of(bits_of(s) ^ exchange ^ y_sign) + 0.0f;
    return make2(x, y);
}

/* (cos(2 pi u), sin(2 pi u)) (1.6 / 1.6 ulp), |u| < 2^20; the eight zeros and ones at multiples of 1/4 are exact */
KERNEL real2 kcossin_turn(real u)
{
    real_integer quadrant = round_to_integer(4.0f*u);
    real f                = u - 0.25f*quadrant.n;
    return cossin_in_quadrant(quadrant.low, f*TWO_PI, f*TWO_PI_TAIL);
}

/* (cos x, sin x) (1.6 / 1.6 ulp to |x| = 7, 2.6 / 2.6 beyond), x in radians, |x| < 1000 / 1e5; pi/2 is taken off
 * in three parts, so that the zeros keep their relative accuracy */
KERNEL real2 kcossin(real x)
{
    real_integer quadrant = round_to_integer(x*(2.0f*INV_PI));
    real n                = quadrant.n;
    real r                = (x - n*HALF_PI_HIGH) - n*HALF_PI_MIDDLE;
    return cossin_in_quadrant(quadrant.low, r - n*HALF_PI_LOW, 0.0f);
}

KERNEL real kcos(real x) { return kcossin(x).x; }
KERNEL real ksin(real x) { return kcossin(x).y; }

/* The angle of the point (x, y) (2.0 / 2.0 ulp), in [-pi, pi], its sign that of y (of -0 too); 0 or pi, by the
 * sign of x, at the origin.  |x| + |y| <= REAL_MAX.  With v = min/max of |x|, |y|: beyond
 * tan(pi/8), atan v = pi/4 + atan((v-1)/(v+1)). */
KERNEL real katan2(real y, real x)
{
    real ax   = kabs(x);
    real ay   = kabs(y);
    real low  = kmin(ax, ay);
    real high = kmax(ax, ay);
    real far  = low > TAN_PI_8*high ? 1.0f : 0.0f;
    real num  = far > 0.0f ? low - high : low;
    real den  = far > 0.0f ? low + high : high;
    real v    = num/(den > 0.0f ? den : 1.0f);
    real v2   = v*v;
    real a    = far*QUARTER_PI + (v + (v*v2*poly_atan(v2) + far*(0.5f*HALF_PI_TAIL)));
    real b    = ay > ax ? HALF_PI - (a - HALF_PI_TAIL) : a;
    real c    = ksign(x) < 0.0f ? PI - b : b;
    return kcopysign(c, y);
}

/* arccos x in [0, pi] (2.7 / 2.6 ulp); x beyond [-1, 1] counts as the nearer end */
KERNEL real kacos(real x) { return katan2(ksqrt(kmax((1.0f - x)*(1.0f + x), 0.0f)), x); }
