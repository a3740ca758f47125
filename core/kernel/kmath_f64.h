/* kmath_f64.h: constants and polynomials of kmath.h in double; include that.
 *
 * Written by tools/make_kmath.py, which has the derivation: change that, not this.  Beside each polynomial stands
 * the function that it approximates and the error it causes in the result, relative, in units of 2^-53.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "core/kernel/real.h"

#define LN_TWO_HIGH    6.9314718055966296e-01 /* ln 2 in 41 bits: n*LN_TWO_HIGH is exact for any exponent n */
#define LN_TWO_LOW     2.8235290563031577e-13 /* ln 2 - LN_TWO_HIGH */
#define EXP_LOWEST     (-7.0839641853226419e+02) /* the last x with e^x >= REAL_MIN */
#define EXP_HIGHEST    7.0978271289338397e+02 /* the last x with e^x <= REAL_MAX */
#define HALF_PI_HIGH   1.5707963267341256e+00 /* pi/2 in parts of 33 bits, and the rest */
#define HALF_PI_MIDDLE 6.0771005063039660e-11
#define HALF_PI_LOW    2.0222662487959506e-21
#define HALF_PI_TAIL   6.1232339957367660e-17 /* pi/2 - HALF_PI */
#define TAN_PI_8       4.1421356237309503e-01
#define FAR_AWAY       1.0000000000000000e+16 /* beyond, 1/x^2 is still normal and all fits are constant */
#define ERFCX_CENTRE   2.5000000000000000e+00
#define MILLS_CENTRE   1.5000000000000000e+00
#define GAMMA_CENTRE   1.0000000000000000e+00
#define ERFINV_BORDER  5.0000000000000000e+00
#define ERFINV_CENTRE  4.0000000000000000e+00

/* (e^r - 1 - r)/r^2, |r| <= ln(2)/2: 0.0066 */
KERNEL real poly_exp(real r)
{
    real c0 = 5.0000000000000000e-01;
    real c1 = 1.6666666666666682e-01;
    real c2 = 4.1666666666666095e-02;
    real c3 = 8.3333333333169366e-03;
    real c4 = 1.3888888889116266e-03;
    real c5 = 1.9841269896636167e-04;
    real c6 = 2.4801586926232982e-05;
    real c7 = 2.7557234600439298e-06;
    real c8 = 2.7557581560593661e-07;
    real c9 = 2.5112130785721760e-08;
    real c10 = 2.0826887632481942e-09;
    real r2 = r*r;
    return (c0 + r*c1) + r2*((c2 + r*c3) + r2*((c4 + r*c5) + r2*((c6 + r*c7) + r2*((c8 + r*c9) + r2*c10))));
}

/* (2 atanh(s) - 2 s)/s^3 of z = s^2, s <= (sqrt(2) - 1)/(sqrt(2) + 1): 0.0025 */
KERNEL real poly_log(real z)
{
    real c0 = 6.6666666666666663e-01;
    real c1 = 4.0000000000006208e-01;
    real c2 = 2.8571428569097163e-01;
    real c3 = 2.2222222645183545e-01;
    real c4 = 1.8181775788613283e-01;
    real c5 = 1.5387085606340833e-01;
    real c6 = 1.3250229635353417e-01;
    real c7 = 1.3250353069034948e-01;
    real z2 = z*z;
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*(c6 + z*c7)));
}

/* sin(2 pi f)/f of z = f^2, f <= 1/8: 0.44 */
KERNEL real poly_sin(real z)
{
    real c0 = 6.2831853071795862e+00;
    real c1 = -4.1341702240399762e+01;
    real c2 = 8.1605249276074929e+01;
    real c3 = -7.6705859752996716e+01;
    real c4 = 4.2058693928732829e+01;
    real c5 = -1.5094640379976605e+01;
    real c6 = 3.8197870109319170e+00;
    real c7 = -7.1161557977604661e-01;
    real z2 = z*z;
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*(c6 + z*c7)));
}

/* (cos(2 pi f) - 1)/f^2 of z = f^2, f <= 1/8: 0.26 */
KERNEL real poly_cos(real z)
{
    real c0 = -1.9739208802178716e+01;
    real c1 = 6.4939394022668296e+01;
    real c2 = -8.5456817206693557e+01;
    real c3 = 6.0244641371818766e+01;
    real c4 = -2.6426256772565260e+01;
    real c5 = 7.9035351925944770e+00;
    real c6 = -1.7143159969600135e+00;
    real c7 = 2.7945433043292672e-01;
    real z2 = z*z;
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*(c6 + z*c7)));
}

/* (atan(v) - v)/v^3 of z = v^2, v <= tan(pi/8): 0.041 */
KERNEL real poly_atan(real z)
{
    real c0 = -3.3333333333333198e-01;
    real c1 = 1.9999999999953280e-01;
    real c2 = -1.4285714280169820e-01;
    real c3 = 1.1111110782330741e-01;
    real c4 = -9.0908977307032707e-02;
    real c5 = 7.6920598207534358e-02;
    real c6 = -6.6631004392094434e-02;
    real c7 = 5.8478686277611047e-02;
    real c8 = -5.0392339112609263e-02;
    real c9 = 3.8063272021847602e-02;
    real c10 = -1.7906303117669876e-02;
    real z2 = z*z;
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*((c6 + z*c7) + z2*((c8 + z*c9) + z2*c10))));
}

/* erf(x)/x - 1 of z = x^2, x <= 1: 0.1 */
KERNEL real poly_erf(real z)
{
    real c0 = 1.2837916709551259e-01;
    real c1 = -3.7612638903183748e-01;
    real c2 = 1.1283791670954857e-01;
    real c3 = -2.6866170645072813e-02;
    real c4 = 5.2239776247800769e-03;
    real c5 = -8.5483269786965999e-04;
    real c6 = 1.2055331035222116e-04;
    real c7 = -1.4925593466288065e-05;
    real c8 = 1.6460972162932791e-06;
    real c9 = -1.6350018282689731e-07;
    real c10 = 1.4657833283582959e-08;
    real c11 = -1.1365487024660487e-09;
    real c12 = 5.9449616322490317e-11;
    real z2 = z*z;
    return (c0 + z*c1) + z2*((c2 + z*c3) + z2*((c4 + z*c5) + z2*((c6 + z*c7) + z2*((c8 + z*c9) + z2*((c10 +
           z*c11) + z2*c12)))));
}

/* (1 + 2 x) erfcx(x) of t = (x - c)/(x + c), x >= 0: 0.7 */
KERNEL real poly_erfcx(real t)
{
    real c0 = 1.2648381843668615e+00;
    real c1 = -1.2235676308240212e-01;
    real c2 = -9.9024539573598788e-02;
    real c3 = 1.5762991902299064e-01;
    real c4 = -1.0296705603870973e-01;
    real c5 = 3.2760893275722729e-02;
    real c6 = 9.3189281972611709e-04;
    real c7 = -4.3820784416669038e-03;
    real c8 = 4.9186579269777252e-04;
    real c9 = 6.3212515235111304e-04;
    real c10 = -8.8479147242486776e-05;
    real c11 = -1.1352635078022508e-04;
    real c12 = 6.2658125617785947e-06;
    real c13 = 2.2712320068473575e-05;
    real c14 = 2.6091061286360060e-06;
    real c15 = -4.2447409161124258e-06;
    real c16 = -1.5850797547532157e-06;
    real c17 = 5.6523911902291947e-07;
    real c18 = 5.3300424123581424e-07;
    real c19 = -2.7042509235450906e-09;
    real c20 = -1.2544248918679069e-07;
    real c21 = -1.9485051479565966e-08;
    real c22 = 1.9424300912887564e-08;
    real c23 = 3.3425721408324675e-09;
    real c24 = -1.4969666771410445e-09;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*((c6 + t*c7) + t2*((c8 + t*c9) + t2*((c10 +
           t*c11) + t2*((c12 + t*c13) + t2*((c14 + t*c15) + t2*((c16 + t*c17) + t2*((c18 + t*c19) + t2*((c20 +
           t*c21) + t2*((c22 + t*c23) + t2*c24)))))))))));
}

/* (1 + 2 x^2) W(x) of t = (x - c)/(x + c), x >= 0: 1.9e+2 */
KERNEL real poly_mills(real t)
{
    real c0 = 7.9753869423654644e-01;
    real c1 = 3.8305227228574118e-01;
    real c2 = 3.8433761452768271e-02;
    real c3 = -4.5332753598207187e-01;
    real c4 = 2.0297981569522505e-01;
    real c5 = 9.7584414862648211e-02;
    real c6 = -4.1934828723605364e-02;
    real c7 = -3.6724643651507183e-02;
    real c8 = -3.5902991974991986e-04;
    real c9 = 1.0758889905642230e-02;
    real c10 = 5.2096288257923477e-03;
    real c11 = -6.7784566949591622e-04;
    real c12 = -2.0967420447702625e-03;
    real c13 = -1.0529077453798159e-03;
    real c14 = 3.8483991499578001e-05;
    real c15 = 3.7660701415777564e-04;
    real c16 = 2.5540483546444300e-04;
    real c17 = 9.1421771209625598e-05;
    real c18 = -2.9527039386671672e-05;
    real c19 = -1.1090729807745352e-04;
    real c20 = -6.9255403680144596e-05;
    real c21 = 3.2865104956109252e-05;
    real c22 = 4.4094173789610939e-05;
    real c23 = -2.1138948995889954e-06;
    real c24 = -1.1754084852459419e-05;
    real c25 = -5.1670294424722547e-07;
    real c26 = 1.2540049590736553e-06;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*((c6 + t*c7) + t2*((c8 + t*c9) + t2*((c10 +
           t*c11) + t2*((c12 + t*c13) + t2*((c14 + t*c15) + t2*((c16 + t*c17) + t2*((c18 + t*c19) + t2*((c20 +
           t*c21) + t2*((c22 + t*c23) + t2*((c24 + t*c25) + t2*c26))))))))))));
}

/* z/erf(z) of w - ERFINV_BORDER/2, w = -ln(1 - erf(z)^2) <= ERFINV_BORDER: 5.0e+7 */
KERNEL real poly_erfinv_near(real w)
{
    real c0 = 1.5014093593376343e+00;
    real c1 = 2.4664028617490208e-01;
    real c2 = -4.1773868955855588e-03;
    real c3 = -1.2527418986751926e-03;
    real c4 = 2.1834449346001076e-04;
    real c5 = -4.9633445435458931e-06;
    real c6 = -3.4627132692245383e-06;
    real c7 = 4.6617122168353948e-07;
    real c8 = 2.3233034270754149e-08;
    real c9 = -8.7911663780558488e-09;
    real w2 = w*w;
    return (c0 + w*c1) + w2*((c2 + w*c3) + w2*((c4 + w*c5) + w2*((c6 + w*c7) + w2*(c8 + w*c9))));
}

/* z/sqrt(w) of t = (sqrt(w) - c)/(sqrt(w) + c), w >= ERFINV_BORDER: 5.9e+10 */
KERNEL real poly_erfinv_far(real t)
{
    real c0 = 9.5994425131907124e-01;
    real c1 = 9.9201543128880465e-02;
    real c2 = -7.8862384627935961e-02;
    real c3 = -1.5374567612708561e-02;
    real c4 = 1.1840909938335456e-01;
    real c5 = -1.4494095224284528e-01;
    real c6 = 6.4029435253973463e-02;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*c6));
}

/* sqrt(s + 1/4) Gamma(s + 1/2)/Gamma(s + 1) of t = (s - c)/(s + c), s >= 1/2: 7.9e+2 */
KERNEL real poly_gamma(real t)
{
    real c0 = 9.9083182440141948e-01;
    real c1 = 2.7159966353024128e-02;
    real c2 = -3.2179013052928460e-02;
    real c3 = 2.2204145008630452e-02;
    real c4 = -1.1933574483258472e-02;
    real c5 = 5.7871108352622229e-03;
    real c6 = -2.7656309510770312e-03;
    real c7 = 1.3217663093163991e-03;
    real c8 = -6.3347687877503495e-04;
    real c9 = 3.0958456309048207e-04;
    real c10 = -1.5419779951165338e-04;
    real c11 = 7.5438414786078902e-05;
    real c12 = -3.2146308296896686e-05;
    real c13 = 9.5951445704363536e-06;
    real c14 = -1.3915563407659727e-06;
    real t2 = t*t;
    return (c0 + t*c1) + t2*((c2 + t*c3) + t2*((c4 + t*c5) + t2*((c6 + t*c7) + t2*((c8 + t*c9) + t2*((c10 +
           t*c11) + t2*((c12 + t*c13) + t2*c14))))));
}
