/* kmath_beta.h: the beta function of kmath.h (include that).
 * SPDX-License-Identifier: MIT */
#pragma once

#include "kmath_basic.h"
#include "kmath_exp.h"

/* B(x, y) = Gamma(x) Gamma(y)/Gamma(x + y) = Int_0^1 u^(x-1) (1 - u)^(y-1) du (10 + 3 |ln B| ulp in both precisions)
 * for x, y in [1, 1e18]; smaller ones count as 1.  B(x, y) and B(y, x) are the same bits.  With
 * Gamma(1 + x) = sqrt(2 pi) (p/e)^p poly(x), p = x + 1/2, only quotients of the p remain. */
KERNEL real kbeta(real x, real y)
{
    real a     = kmax(kmin(x, y), 1.0f);
    real b     = kmax(kmax(x, y), 1.0f);
    real sum   = a + b;
    real r     = sum + 0.5f;
    real power = a*klog((a + 0.5f)/r) + (b + 0.5f)*klog1p(-a/r);
    real ta    = (a - STIRLING_CENTRE)/(a + STIRLING_CENTRE);
    real tb    = (b - STIRLING_CENTRE)/(b + STIRLING_CENTRE);
    real ts    = (sum - STIRLING_CENTRE)/(sum + STIRLING_CENTRE);
    real scale = SQRT_TWO_PI_OVER_E*poly_stirling(ta)*poly_stirling(tb)/poly_stirling(ts);
    return scale*kexp(power)*(ksqrt(a + 0.5f)*(sum/b)/a);
}
