/* kmath_f32.h: constants and polynomials of kmath.h in float; include that.
 *
 * Written by tools/make_kmath.py, which has the derivation: change that, not this.  Beside each polynomial stands
 * the function that it approximates and the error it causes in the result, relative, in units of 2^-24.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "core/kernel/real.h"

#define LN_TWO_HIGH    6.93145752e-01f /* ln 2 in 15 bits: n*LN_TWO_HIGH is exact for any exponent n */
#define LN_TWO_LOW     1.42860677e-06f /* ln 2 - LN_TWO_HIGH */
#define EXP_LOWEST     (-8.73365479e+01f) /* the last x with e^x >= REAL_MIN */
#define EXP_HIGHEST    8.87228317e+01f /* the last x with e^x <= REAL_MAX */
#define HALF_PI_HIGH   1.57031250e+00f /* pi/2 in parts of 12 bits, and the rest */
#define HALF_PI_MIDDLE 4.83751297e-04f
#define HALF_PI_LOW    7.54979013e-08f
#define HALF_PI_TAIL   (-4.37113883e-08f) /* pi/2 - HALF_PI */
#define TAN_PI_8       4.14213568e-01f
#define FAR_AWAY       1.00000000e+09f /* beyond, 1/x^2 is still normal and all fits are constant */
#define ERFCX_CENTRE   2.50000000e+00f
#define MILLS_CENTRE   1.50000000e+00f
#define GAMMA_CENTRE   1.00000000e+00f
#define ERFINV_BORDER  5.00000000e+00f
#define ERFINV_CENTRE  4.00000000e+00f

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

/* sin(2 pi f)/f of z = f^2, f <= 1/8: 0.55 */
KERNEL real poly_sin(real z)
{
    real c0 = 6.28318548e+00f;
    real c1 = -4.13417015e+01f;
    real c2 = 8.16052017e+01f;
    real c3 = -7.66977768e+01f;
    real c4 = 4.14698792e+01f;
    return c0 + z*(c1 + z*(c2 + z*(c3 + z*c4)));
}

/* (cos(2 pi f) - 1)/f^2 of z = f^2, f <= 1/8: 0.18 */
KERNEL real poly_cos(real z)
{
    real c0 = -1.97392082e+01f;
    real c1 = 6.49393234e+01f;
    real c2 = -8.54432373e+01f;
    real c3 = 5.92293472e+01f;
    return c0 + z*(c1 + z*(c2 + z*c3));
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
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*c6));
}

/* (1 + 2 x) erfcx(x) of t = (x - c)/(x + c), x >= 0: 1.5 */
KERNEL real poly_erfcx(real t)
{
    real c0 = 1.26483822e+00f;
    real c1 = -1.22357488e-01f;
    real c2 = -9.90240723e-02f;
    real c3 = 1.57644570e-01f;
    real c4 = -1.02972090e-01f;
    real c5 = 3.26765440e-02f;
    real c6 = 9.51558410e-04f;
    real c7 = -4.17883461e-03f;
    real c8 = 4.57456073e-04f;
    real c9 = 4.04848106e-04f;
    real c10 = -6.14407836e-05f;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*((c6 + t*c7) + t2*((c8 + t*c9) + t2*c10))));
}

/* (1 + 2 x^2) W(x) of t = (x - c)/(x + c), x >= 0: 9.2 */
KERNEL real poly_mills(real t)
{
    real c0 = 7.97539115e-01f;
    real c1 = 3.83051068e-01f;
    real c2 = 3.84009220e-02f;
    real c3 = -4.53304499e-01f;
    real c4 = 2.03399718e-01f;
    real c5 = 9.74710584e-02f;
    real c6 = -4.39145938e-02f;
    real c7 = -3.65781933e-02f;
    real c8 = 3.96388862e-03f;
    real c9 = 1.10415993e-02f;
    real c10 = 6.11494237e-04f;
    real c11 = -1.68103352e-03f;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*((c6 + t*c7) + t2*((c8 + t*c9) + t2*(c10 +
           t*c11)))));
}

/* z/erf(z) of w - ERFINV_BORDER/2, w = -ln(1 - erf(z)^2) <= ERFINV_BORDER: 1.7 */
KERNEL real poly_erfinv_near(real w)
{
    real c0 = 1.50140941e+00f;
    real c1 = 2.46640727e-01f;
    real c2 = -4.17770678e-03f;
    real c3 = -1.25370815e-03f;
    real c4 = 2.18602232e-04f;
    real c5 = -4.39662699e-06f;
    real c6 = -3.52895722e-06f;
    real c7 = 3.43716863e-07f;
    real c8 = 2.85464647e-08f;
    real w2 = w*w;
    return (c0 + w*c1) + w2*((c2 + w*c3) + w2*((c4 + w*c5) + w2*((c6 + w*c7) + w2*c8)));
}

/* z/sqrt(w) of t = (sqrt(w) - c)/(sqrt(w) + c), w >= ERFINV_BORDER: 22.0 */
KERNEL real poly_erfinv_far(real t)
{
    real c0 = 9.59946156e-01f;
    real c1 = 9.91249979e-02f;
    real c2 = -7.91182071e-02f;
    real c3 = -1.22598503e-02f;
    real c4 = 1.19983844e-01f;
    real c5 = -1.72634408e-01f;
    real c6 = 9.23492387e-02f;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*c6));
}

/* sqrt(s + 1/4) Gamma(s + 1/2)/Gamma(s + 1) of t = (s - c)/(s + c), s >= 1/2: 8.1 */
KERNEL real poly_gamma(real t)
{
    real c0 = 9.90831912e-01f;
    real c1 = 2.71545798e-02f;
    real c2 = -3.21848802e-02f;
    real c3 = 2.23441627e-02f;
    real c4 = -1.20520229e-02f;
    real c5 = 5.07502630e-03f;
    real c6 = -1.16926071e-03f;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*c6));
}
