/* kmath_basic.h: bits, signs, rounding and exact arithmetic under the functions of kmath.h (include that).
 * SPDX-License-Identifier: MIT */
#pragma once

#include <string.h>

#include "real.h"

#if FACET_REAL_IS_DOUBLE
#define FRACTION_BITS    52
#define SIGN_SHIFT       62 /* from bit 1 to the sign */
#define SIGN_BIT         UINT64_C(0x8000000000000000)
#define ONE_BITS         UINT64_C(0x3ff0000000000000)
#define FRACTION_MASK    UINT64_C(0x000fffffffffffff)
#define SQRT_HALF_BITS   UINT64_C(0x3fe6a09e667f3bcd) /* sqrt(1/2) */
#define INTEGER_BITS     UINT64_C(0x4330000000000000) /* 2^52: its low bits count in units of one */
#define HIGH_HALF        UINT64_C(0xfffffffff8000000) /* keeps 26 of the 53 bits of a significand */
#define ROUND_TO_INTEGER 6755399441055744.0           /* 1.5 * 2^52 */
#define EXPONENT_BIAS    1023
#define SCRAMBLE_SHIFT_1 30 /* of splitmix64 [steele14] */
#define SCRAMBLE_SHIFT_2 27
#define SCRAMBLE_SHIFT_3 31
#define SCRAMBLE_TIMES_1 UINT64_C(0xbf58476d1ce4e5b9)
#define SCRAMBLE_TIMES_2 UINT64_C(0x94d049bb133111eb)
#else
#define FRACTION_BITS    23
#define SIGN_SHIFT       30
#define SIGN_BIT         UINT32_C(0x80000000)
#define ONE_BITS         UINT32_C(0x3f800000)
#define FRACTION_MASK    UINT32_C(0x007fffff)
#define SQRT_HALF_BITS   UINT32_C(0x3f3504f3)
#define INTEGER_BITS     UINT32_C(0x4b000000) /* 2^23 */
#define HIGH_HALF        UINT32_C(0xfffff000) /* keeps 12 of the 24 bits */
#define ROUND_TO_INTEGER 12582912.0f          /* 1.5 * 2^23 */
#define EXPONENT_BIAS    127
#define SCRAMBLE_SHIFT_1 16 /* of lowbias32 [wellons18] */
#define SCRAMBLE_SHIFT_2 15
#define SCRAMBLE_SHIFT_3 16
#define SCRAMBLE_TIMES_1 UINT32_C(0x7feb352d)
#define SCRAMBLE_TIMES_2 UINT32_C(0x846ca68b)
#endif

KERNEL real_bits bits_of(real x)
{
    real_bits b;
    memcpy(&b, &x, sizeof b);
    return b;
}

KERNEL real real_of(real_bits b)
{
    real x;
    memcpy(&x, &b, sizeof x);
    return x;
}

/* x where `condition` is true, else +0: a choice without a branch, for results that are tested again later (gcc would
 * merge the two tests into control flow and not vectorise the loop). */
KERNEL real keep_if(int condition, real x)
{
    return real_of(bits_of(x) & ((real_bits)0 - (real_bits)(condition != 0)));
}

/* |x|, and the smaller and larger of two (b if either is NaN); exact */
KERNEL real kabs(real x) { return real_of(bits_of(x) & ~SIGN_BIT); }
KERNEL real kmin(real a, real b) { return a < b ? a : b; }
KERNEL real kmax(real a, real b) { return a > b ? a : b; }

/* x limited to [low, high], low <= high; `low` if x is NaN */
KERNEL real kclamp(real x, real low, real high) { return kmin(kmax(x, low), high); }
KERNEL real ksaturate(real x) { return kclamp(x, 0.0f, 1.0f); }

/* |x| with the sign of s, where -0 counts as negative; and s = -1 or 1 with the sign of x */
KERNEL real kcopysign(real x, real s) { return real_of((bits_of(x) & ~SIGN_BIT) | (bits_of(s) & SIGN_BIT)); }
KERNEL real ksign(real x) { return kcopysign(1.0f, x); }

/* The integer n nearest to x (ties to even), exact for |x| < 2^22 / 2^51, and a word whose low bits are n's in two's
 * complement */
typedef struct {
    real n;
    real_bits low;
} real_integer;

KERNEL real_integer round_to_integer(real x)
{
    real shifted = x + ROUND_TO_INTEGER;
    real_integer r;
    r.n   = shifted - ROUND_TO_INTEGER;
    r.low = bits_of(shifted);
    return r;
}

/* Largest integer <= x, and the nearest one, as above */
KERNEL real kround(real x) { return round_to_integer(x).n; }
KERNEL real kfloor(real x)
{
    real n = kround(x);
    return n > x ? n - 1.0f : n;
}

/* A permutation of all words that leaves no pattern of its argument to see, and a number uniform in (0, 1) from a
 * word */
KERNEL real_bits scramble(real_bits x)
{
    real_bits a = (x ^ (x >> SCRAMBLE_SHIFT_1))*SCRAMBLE_TIMES_1;
    real_bits b = (a ^ (a >> SCRAMBLE_SHIFT_2))*SCRAMBLE_TIMES_2;
    return b ^ (b >> SCRAMBLE_SHIFT_3);
}

KERNEL real uniform_of(real_bits x)
{
    return real_of((x >> (SIGN_SHIFT + 2 - FRACTION_BITS)) | ONE_BITS) - (1 - 0.5f*REAL_EPSILON);
}

/* x^2 and x^5, the power of Schlick's Fresnel term; (x^5: 2.0 / 2.0 ulp) */
KERNEL real ksquare(real x) { return x*x; }
KERNEL real kpow5(real x)
{
    real x2 = x*x;
    return x2*x2*x;
}

/* hi + lo, an unevaluated sum that carries about twice the digits of a real */
typedef struct {
    real hi, lo;
} real_sum;

/* a + b exactly, for |a| >= |b| or a = 0 [dekker71] */
KERNEL real_sum add_exactly(real a, real b)
{
    real_sum r;
    r.hi = a + b;
    r.lo = b - (r.hi - a);
    return r;
}

/* a b, exact to 2^-104 of it (double) or exactly (float): Dekker's product, with the factors cut by a mask */
KERNEL real_sum multiply_exactly(real a, real b)
{
    real ah = real_of(bits_of(a) & HIGH_HALF);
    real bh = real_of(bits_of(b) & HIGH_HALF);
    real al = a - ah;
    real bl = b - bh;
    real_sum r;
    r.hi = a*b;
    r.lo = ((ah*bh - r.hi) + ah*bl + al*bh) + al*bl;
    return r;
}
