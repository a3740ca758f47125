/* kmath_erf.h: the error function, its relatives and inverses, and a ratio of gamma functions, of kmath.h (include
 * that).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath_basic.h"
#include "kmath_exp.h"

/* erfcx(x) = e^(x^2) erfc(x) (2.8 / 3.2 ulp) for x >= 0; smaller x counts as 0.  (1 + 2x) erfcx(x) goes from 1 at
 * 0 to 2/sqrt(pi) at infinity and is 1 + v p(2v - 1), p a polynomial in the image v = x/(x + c) of [0, inf]. */
KERNEL real kerfcx(real x)
{
    real a = kmax(x, 0.0f);
    real v = a/(a + ERFCX_CENTRE);
    return (1.0f + v*poly_erfcx(2.0f*v - 1.0f))/(1.0f + 2.0f*a);
}

/* W(x) = 1 - sqrt(pi) x erfcx(x) (3.6 / 4.0 ulp) for x >= 0; smaller x counts as 0.  Positive: 1 at 0, 1/(2 x^2)
 * far out, where the difference itself would cancel.  The exact Smith masking of Beckmann's
 * distribution is Lambda(a) = exp(-a^2) W(a)/(2 a sqrt(pi)), a = 1/(alpha tan(theta)). */
KERNEL real kmills_w(real x)
{
    real a = kmax(x, 0.0f);
    real v = a/(a + MILLS_CENTRE);
    return (1.0f + v*(1.0f - v)*poly_mills(2.0f*v - 1.0f))/(1.0f + 2.0f*a*a);
}

/* erfc x = 1 - erf x (4.4 / 3.9 ulp); 0 for x beyond 9.34 / 26.6 */
KERNEL real kerfc(real x)
{
    real a = kabs(x);
    real c = kexp_neg_square(a)*kerfcx(a);
    return x < 0.0f ? 2.0f - c : c;
}

/* erf x = 2/sqrt(pi) Int_0^x exp(-t^2) dt (1.6 / 1.5 ulp), to relative accuracy near 0 */
KERNEL real kerf(real x)
{
    real a    = kabs(x);
    real near = a + a*poly_erf(kmin(a*a, 1.0f));
    real far  = 1.0f - kexp_neg_square(a)*kerfcx(a);
    return kcopysign(a < 1.0f ? near : far, x);
}

/* z with erf z = a and erfc z = q = 1 - a, both given because the smaller one has the accurate digits; 0 <= a < 1,
 * q >= REAL_MIN.  With w = -ln(1 - a^2), z/a is a polynomial in w, and z/sqrt(w) one in
 * t = (sqrt w - c)/(sqrt w + c) for large w. */
KERNEL real erf_inverse(real a, real q)
{
    real w    = -klog(q*(1.0f + a));
    real s    = ksqrt(kmax(w, 0.0f));
    real t    = (s - ERFINV_CENTRE)/(s + ERFINV_CENTRE);
    real near = a*poly_erfinv_near(kmin(w, ERFINV_BORDER) - 0.5f*ERFINV_BORDER);
    real z    = w < ERFINV_BORDER ? near : s*poly_erfinv_far(t);
#if FACET_REAL_IS_DOUBLE
    /* The fits give 5e-8; one step of Halley's method, with the residual relative to the derivative
     * d = (erf z - a) e^(z^2) sqrt(pi)/2 taken from erf or erfc, whichever has the digits, makes it 2 ulp. */
    real_sum z2 = multiply_exactly(z, z);
    real e      = exp_of_sum(z2.hi, z2.lo);
    real erf_z  = z + z*poly_erf(kmin(z2.hi, 1.0f));
    real d_near = ((erf_z - a) - ((1.0f - a) - q))*e; /* the difference restores what the rounding of a took */
    real d_far  = q*e - kerfcx(z);
    real d      = HALF_SQRT_PI*(z < 0.75f ? d_near : d_far);
    z           = z - d/(1.0f + z*d);
#endif
    return z;
}

/* erf^-1(x) (4.0 / 2.4 ulp) for |x| < 1; |x| >= 1 gives the value at the largest number below 1, 3.83 / 5.86 */
KERNEL real kerfinv(real x)
{
    real a = kmin(kabs(x), 1.0f - 0.5f*REAL_EPSILON);
    return kcopysign(erf_inverse(a, 1.0f - a), x);
}

/* erfc^-1(q) (4.2 / 2.6 ulp) for q in (0, 2): positive below 1, to relative accuracy for tiny q, zero at 1.  Near
 * 1 the result is only as good as the argument, which is exact there.  q is limited to
 * [REAL_MIN, 2 - REAL_EPSILON]. */
KERNEL real kerfcinv(real q)
{
    real p = kclamp(q, REAL_MIN, 2.0f - REAL_EPSILON);
    real b = kmin(p, 2.0f - p);
    real z = erf_inverse(1.0f - b, b);
    return p > 1.0f ? -z : z;
}

/* Gamma(s + 1/2)/Gamma(s + 1) (2.7 / 2.5 ulp) for s >= 1/2; smaller s counts as 1/2.
 * Times sqrt(s + 1/4) it is 1 - O(1/s^2) and a polynomial in t = (s - c)/(s + c). */
KERNEL real kgamma_half_ratio(real s)
{
    real a = kmax(s, 0.5f);
    real t = (a - GAMMA_CENTRE)/(a + GAMMA_CENTRE);
    return poly_gamma(t)/ksqrt(a + 0.25f);
}
