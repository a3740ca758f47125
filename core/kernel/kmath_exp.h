/* kmath_exp.h: exponentials, logarithms and powers of kmath.h (include that).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath_basic.h"

/* 2^n of an integral n in [-126, 127] / [-1022, 1023]; exact */
KERNEL real two_to(real n) { return real_of((round_to_integer(n).low << FRACTION_BITS) + ONE_BITS); }

#define TWO_TO_MINUS_64 ((real)5.42101086242752217e-20)

/* exp(a + b) for |b| <= 2^-20 |a|.  With n = round(a/ln 2) and r = a + b - n ln 2 it is 2^n (1 + r + r^2 q(r));
 * adding n to the exponent multiplies by 2^n, rightly for every result that is a normal number. */
KERNEL real exp_of_sum(real a, real b)
{
    real_integer power = round_to_integer(a*INV_LN_TWO);
    real n             = power.n;
    real r             = ((a - n*LN_TWO_HIGH) - n*LN_TWO_LOW) + b;
    real m             = 1.0f + (r + r*r*poly_exp(r));
    real e             = real_of(bits_of(m) + (power.low << FRACTION_BITS));
    real bounded       = a > EXP_HIGHEST ? REAL_MAX : e;
    return a < EXP_LOWEST ? 0.0f : bounded;
}

/* e^x (1.0 / 1.0 ulp).  Below EXP_LOWEST = ln REAL_MIN, -87.33 / -708.39, the result is 0; above EXP_HIGHEST =
 * ln REAL_MAX, 88.72 / 709.78, it is REAL_MAX, which keeps 0*e^x from becoming NaN.  kexp(0) = 1. */
KERNEL real kexp(real x) { return exp_of_sum(x, 0.0f); }

/* factor e^-x (1.5 / 1.5 ulp), x >= 0, factor in [2^-60, 2^60], where e^-x alone would vanish before the product does:
 * found as (2^-64 factor) (2^64 e^-x), and 0 from where the second is. */
KERNEL real kexp_fall(real factor, real x)
{
    real_integer power = round_to_integer(-x*INV_LN_TWO);
    real n             = power.n;
    real r             = (-x - n*LN_TWO_HIGH) - n*LN_TWO_LOW;
    real m             = 1.0f + (r + r*r*poly_exp(r));
    real e             = real_of(bits_of(m) + ((power.low + 64u) << FRACTION_BITS));
    real product       = factor*TWO_TO_MINUS_64*e;
    return x < 44.0f - EXP_LOWEST ? product : 0.0f; /* 64 ln 2 > 44 */
}

/* exp(-x^2) (1.2 / 1.2 ulp); 0 for |x| > 9.34 / 26.6.  The rounding error of x^2 would grow
 * to x^2/2 ulp of the result; it is carried along instead. */
KERNEL real kexp_neg_square(real x)
{
    real_sum x2 = multiply_exactly(x, x);
    return exp_of_sum(-x2.hi, -x2.lo);
}

/* e^x - 1 for |x| <= 40 (1.6 / 2.0 ulp); keeps the relative accuracy near 0, where 2^n = 1 and e is exactly m */
KERNEL real kexpm1_within(real x)
{
    real n    = kround(x*INV_LN_TWO);
    real r    = (x - n*LN_TWO_HIGH) - n*LN_TWO_LOW;
    real m    = r + r*r*poly_exp(r); /* e^r - 1 */
    real half = two_to(n - 1.0f);    /* 2^n may exceed REAL_MAX */
    return 2.0f*(half*m + (half - 0.5f));
}

/* The same for any x: -1 below -17.4 / -37.5, REAL_MAX from EXP_HIGHEST on */
KERNEL real kexpm1(real x)
{
    real e = kexpm1_within(kclamp(x, -40.0f, EXP_HIGHEST));
    return x >= EXP_HIGHEST ? REAL_MAX : e;
}

/* x = 2^n (1 + f), 1 + f in [sqrt(1/2), sqrt(2)); for normal x > 0 */
typedef struct {
    real n, f;
} real_split;

KERNEL real_split split_binary(real x)
{
    real_bits b = bits_of(x) + (ONE_BITS - SQRT_HALF_BITS);
    real_split s;
    s.n = real_of((b >> FRACTION_BITS) | INTEGER_BITS) - real_of(INTEGER_BITS + EXPONENT_BIAS);
    s.f = real_of((b & FRACTION_MASK) + SQRT_HALF_BITS) - 1.0f;
    return s;
}

/* ln of a split number: ln(1+f) = 2 atanh(s), s = f/(2+f), arranged as f - f^2/2 + s (f^2/2 + s^2 q(s^2)) so that f is
 * not rounded. */
KERNEL real log_of_split(real_split x)
{
    real s    = x.f/(2.0f + x.f);
    real s2   = s*s;
    real half = 0.5f*x.f*x.f;
    real tail = s*(half + s2*poly_log(s2)) + x.n*LN_TWO_LOW;
    return x.n*LN_TWO_HIGH + (x.f - (half - tail));
}

/* ln x (0.9 / 0.9 ulp) for x >= REAL_MIN; whatever is smaller (0, negative, NaN) counts as REAL_MIN:
 * -87.34 / -708.4. */
KERNEL real klog(real x) { return log_of_split(split_binary(kmax(x, REAL_MIN))); }

/* ln x of a normal x >= 1 at half the cost of klog: off by 1 ulp and 7e-9 in float; klog in double.  With 1 + f as
 * above, f - f^2/2 + f^3 q(f), the minimax polynomial q of (ln(1 + f) - f + f^2/2)/f^3. */
KERNEL real klog_quick(real x)
{
#if FACET_REAL_IS_DOUBLE
    return klog(x);
#else
    real_split s = split_binary(x);
    real f       = s.f;
    real f2      = f*f;
    real q01     = 0.3333416577f - 0.2500169867f*f;
    real q23     = 0.199548801f - 0.1656442918f*f;
    real q45     = 0.1497795818f - 0.1437897461f*f;
    real q       = q01 + f2*(q23 + f2*(q45 + f2*0.08672234455f));
    return s.n*LN_TWO + (f + f2*(f*q - 0.5f));
#endif
}

/* ln x of an x >= REAL_MIN whose difference from 1 is known better than x - 1 gives it; relative to the result (1.5
 * / 1.5 ulp). */
KERNEL real klog_near_one(real x, real x_minus_1)
{
    real_split split = split_binary(x);
    split.f          = split.n == 0.0f ? x_minus_1 : split.f;
    return log_of_split(split);
}

/* ln(1+x) (1.5 / 1.5 ulp) for x > -1, to relative accuracy near 0; x <= -1 counts as 1 + x = REAL_MIN.
 * The rounding error c of 1 + x is put back to first order, c/(1+x). */
KERNEL real klog1p(real x)
{
    real u = kmax(1.0f + x, REAL_MIN);
    real c = x > 1.0f ? 1.0f - (u - x) : x - (u - 1.0f);
    return klog(u) + (x > -1.0f ? c/u : 0.0f);
}

/* ln x as an unevaluated sum, relative error 2^-28 / 2^-57: 2 s is carried to twice the digits, s^3 q(s^2), at most
 * 1/100 of it, to single ones */
KERNEL real_sum log_to_sum(real x)
{
    real_split x2n = split_binary(x);
    real n         = x2n.n;
    real f         = x2n.f;
    real d         = 2.0f + f;
    real d_lo      = f - (d - 2.0f);
    real s         = f/d;
    real_sum p     = multiply_exactly(s, d);
    real s_lo      = (((f - p.hi) - p.lo) - s*d_lo)/d;
    real s2        = s*s;
    real_sum h     = add_exactly(n*LN_TWO_HIGH, 2.0f*s);
    return add_exactly(h.hi, h.lo + (2.0f*s_lo + s*s2*poly_log(s2) + n*LN_TWO_LOW));
}

/* x^y = e^(y ln x) for x >= REAL_MIN and any y (1.1 + 0.07 |y ln x| ulp in both precisions: 7.2 / 51 for the
 * largest and smallest results; measured 4.5 / 46); 0 and REAL_MAX beyond, as kexp.  x^0 = 1, 1^y = 1.  Smaller x,
 * zero and negative numbers included, count as 0: the result is 0 if y > 0, 1 if y = 0, REAL_MAX if y < 0. */
KERNEL real kpow(real x, real y)
{
    real_sum l = log_to_sum(kmax(x, REAL_MIN));
    real_sum p = multiply_exactly(l.hi, y);
    real e     = exp_of_sum(p.hi, p.lo + l.lo*y);
    real zero  = y > 0.0f ? 0.0f : (y < 0.0f ? REAL_MAX : 1.0f);
    return x >= REAL_MIN ? e : zero;
}
