/* kmath_f32.h: constants and polynomials of kmath.h in float; include that.
 *
 * Written by tools/make_kmath.py, which has the derivation: change that, not this.  Beside each
 * polynomial stands the function that it approximates and the error it causes in the result, relative,
 * in units of 2^-24.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "real.h"

#define LN_TWO_HIGH    6.93145752e-01f /* ln 2 in 15 bits: n*LN_TWO_HIGH is exact for any exponent n */
#define LN_TWO_LOW     1.42860677e-06f /* ln 2 - LN_TWO_HIGH */
#define EXP_LOWEST     (-8.73365479e+01f) /* the last x with e^x >= REAL_MIN */
#define EXP_HIGHEST    8.87228317e+01f /* the last x with e^x <= REAL_MAX */
#define HALF_PI_HIGH   1.57067871e+00f /* pi/2 in parts of 14 bits, and the rest */
#define HALF_PI_MIDDLE 1.17614865e-04f
#define HALF_PI_LOW    9.92093629e-10f
#define TWO_PI_TAIL    (-1.74845553e-07f) /* 2 pi - TWO_PI */
#define HALF_PI_TAIL   (-4.37113883e-08f) /* pi/2 - HALF_PI */
#define TAN_PI_8       4.14213568e-01f
#define ERFCX_CENTRE   3.00000000e+00f
#define MILLS_CENTRE   2.50000000e+00f
#define GAMMA_CENTRE   6.99999988e-01f
#define STIRLING_CENTRE 8.00000012e-01f
#define SQRT_TWO_PI_OVER_E 1.52034688e+00f
#define ERFINV_BORDER  5.00000000e+00f
#define ERFINV_CENTRE  3.00000000e+00f

/* (e^r - 1 - r)/r^2, |r| <= ln(2)/2: 0.076 */
KERNEL real poly_exp(real r)
{
    real c0 = 4.99999940e-01f;
    real c1 = 1.66665196e-01f;
    real c2 = 4.16684039e-02f;
    real c3 = 8.36877897e-03f;
    real c4 = 1.38141401e-03f;
    return c0 + r*(c1 + r*(c2 + r*(c3 + r*c4)));
}

/* (2 atanh(s) - 2 s)/s^3 of z = s^2, s <= (sqrt(2) - 1)/(sqrt(2) + 1): 0.0073 */
KERNEL real poly_log(real z)
{
    real c0 = 6.66666627e-01f;
    real c1 = 4.00003344e-01f;
    real c2 = 2.85373688e-01f;
    real c3 = 2.35810414e-01f;
    return c0 + z*(c1 + z*(c2 + z*c3));
}

/* (sin(r) - r)/r^3 of z = r^2, r <= pi/4: 0.061 */
KERNEL real poly_sin(real z)
{
    real c0 = -1.66666672e-01f;
    real c1 = 8.33332911e-03f;
    real c2 = -1.98393071e-04f;
    real c3 = 2.71806880e-06f;
    return c0 + z*(c1 + z*(c2 + z*c3));
}

/* (cos(r) - 1 + r^2/2)/r^4 of z = r^2, r <= pi/4: 0.0022 */
KERNEL real poly_cos(real z)
{
    real c0 = 4.16666456e-02f;
    real c1 = -1.38873118e-03f;
    real c2 = 2.44326493e-05f;
    return c0 + z*(c1 + z*c2);
}

/* (atan(v) - v)/v^3 of z = v^2, v <= tan(pi/8): 0.046 */
KERNEL real poly_atan(real z)
{
    real c0 = -3.33333164e-01f;
    real c1 = 1.99984729e-01f;
    real c2 = -1.42435476e-01f;
    real c3 = 1.05939172e-01f;
    real c4 = -6.07849732e-02f;
    return c0 + z*(c1 + z*(c2 + z*(c3 + z*c4)));
}

/* erf(x)/x - 1 of z = x^2, x <= 1: 0.078 */
KERNEL real poly_erf(real z)
{
    real c0 = 1.28379166e-01f;
    real c1 = -3.76126260e-01f;
    real c2 = 1.12835847e-01f;
    real c3 = -2.68538054e-02f;
    real c4 = 5.18831890e-03f;
    real c5 = -8.01012968e-04f;
    real c6 = 7.85368757e-05f;
    real z2 = z*z;
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*(c5 + z*c6)));
}

/* ((1 + 2 x) erfcx(x) - 1)/v of t = 2 v - 1, v = x/(x + c): 0.17 */
KERNEL real poly_erfcx(real t)
{
    real c0 = 5.06016135e-01f;
    real c1 = -7.77258277e-01f;
    real c2 = 6.82133675e-01f;
    real c3 = -4.22845542e-01f;
    real c4 = 1.84298322e-01f;
    real c5 = -4.76645157e-02f;
    real c6 = 1.22825018e-04f;
    real c7 = 4.87372326e-03f;
    real c8 = -1.09505584e-03f;
    real c9 = -3.56040284e-04f;
    real c10 = 1.45230006e-04f;
    real c11 = 8.68858478e-06f;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*c11)))));
}

/* ((1 + 2 x^2) W(x) - 1)/(v (1 - v)) of t = 2 v - 1, v = x/(x + c): 0.12 */
KERNEL real poly_mills(real t)
{
    real c0 = -4.42014486e-01f;
    real c1 = 1.24333286e+00f;
    real c2 = -1.50302160e+00f;
    real c3 = 1.01306045e+00f;
    real c4 = -3.25722635e-01f;
    real c5 = -3.80059592e-02f;
    real c6 = 6.51895180e-02f;
    real c7 = -3.76575231e-03f;
    real c8 = -1.19757513e-02f;
    real c9 = 1.04569178e-03f;
    real c10 = 2.28305510e-03f;
    real c11 = -9.99001495e-05f;
    real c12 = -3.05568479e-04f;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*(c11 + t*c12))))));
}

/* z/erf(z) of w - ERFINV_BORDER/2, w = -ln(1 - erf(z)^2) <= ERFINV_BORDER: 1.3 */
KERNEL real poly_erfinv_near(real w)
{
    real c0 = 1.50140941e+00f;
    real c1 = 2.46640280e-01f;
    real c2 = -4.17738687e-03f;
    real c3 = -1.25274190e-03f;
    real c4 = 2.18344489e-04f;
    real c5 = -4.96334451e-06f;
    real c6 = -3.46271327e-06f;
    real c7 = 4.66171230e-07f;
    real c8 = 2.32330351e-08f;
    real c9 = -8.79116602e-09f;
    real w2 = w*w;
    return c0 + w*((c1 + w*c2) + w2*((c3 + w*c4) + w2*((c5 + w*c6) + w2*((c7 + w*c8) + w2*c9))));
}

/* z/sqrt(w) of t = (sqrt(w) - c)/(sqrt(w) + c), w >= ERFINV_BORDER: 0.52 */
KERNEL real poly_erfinv_far(real t)
{
    real c0 = 9.44267333e-01f;
    real c1 = 1.16789006e-01f;
    real c2 = -3.46664898e-02f;
    real c3 = -1.30942926e-01f;
    real c4 = 2.09945008e-01f;
    real c5 = 1.26764728e-02f;
    real c6 = -7.19734609e-01f;
    real c7 = 1.52215290e+00f;
    real c8 = -1.47719502e+00f;
    real c9 = 5.73677003e-01f;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*c9))));
}

/* sqrt(s + 1/4) Gamma(s + 1/2)/Gamma(s + 1) of t = (s - c)/(s + c), s >= 1/2: 0.21 */
KERNEL real poly_gamma(real t)
{
    real c0 = 9.84902084e-01f;
    real c1 = 3.96119915e-02f;
    real c2 = -3.66845541e-02f;
    real c3 = 1.56370774e-02f;
    real c4 = -4.49691294e-03f;
    real c5 = 1.41765166e-03f;
    real c6 = -4.56731301e-04f;
    real c7 = 6.93825277e-05f;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*c7)));
}

/* Gamma(1 + x)/(sqrt(2 pi) (p/e)^p), p = x + 1/2, of t = (x - c)/(x + c), x >= 1: 0.062 */
KERNEL real poly_stirling(real t)
{
    real c0 = 9.69382584e-01f;
    real c1 = 3.50945964e-02f;
    real c2 = -4.29233117e-03f;
    real c3 = -2.24766511e-04f;
    real c4 = -6.61884360e-06f;
    real c5 = 4.65366138e-05f;
    return c0 + t*(c1 + t*(c2 + t*(c3 + t*(c4 + t*c5))));
}
