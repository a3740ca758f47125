/* kmath_f64.h: constants and polynomials of kmath.h in double; include that.
 *
 * Written by tools/make_kmath.py, which has the derivation: change that, not this.  Beside each
 * polynomial stands the function that it approximates and the error it causes in the result, relative,
 * in units of 2^-53.
 * SPDX-License-Identifier: MIT */
#pragma once

#include "real.h"

#define LN_TWO_HIGH    6.9314718055966296e-01 /* ln 2 in 41 bits: n*LN_TWO_HIGH is exact for any exponent n */
#define LN_TWO_LOW     2.8235290563031577e-13 /* ln 2 - LN_TWO_HIGH */
#define EXP_LOWEST     (-7.0839641853226419e+02) /* the last x with e^x >= REAL_MIN */
#define EXP_HIGHEST    7.0978271289338397e+02 /* the last x with e^x <= REAL_MAX */
#define HALF_PI_HIGH   1.5707963267341256e+00 /* pi/2 in parts of 33 bits, and the rest */
#define HALF_PI_MIDDLE 6.0771005063039660e-11
#define HALF_PI_LOW    2.0222662487959506e-21
#define TWO_PI_TAIL    2.4492935982947064e-16 /* 2 pi - TWO_PI */
#define HALF_PI_TAIL   6.1232339957367660e-17 /* pi/2 - HALF_PI */
#define TAN_PI_8       4.1421356237309503e-01
#define ERFCX_CENTRE   4.0000000000000000e+00
#define MILLS_CENTRE   4.0000000000000000e+00
#define GAMMA_CENTRE   9.0000000000000002e-01
#define STIRLING_CENTRE 1.2500000000000000e+00
#define SQRT_TWO_PI_OVER_E 1.5203469010662809e+00
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
    return c0 + r*((c1 + r*c2) + r2*((c3 + r*c4) + r2*((c5 + r*c6) + r2*((c7 + r*c8) + r2*(c9 + r*c10)))));
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
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*((c5 + z*c6) + z2*c7)));
}

/* (sin(r) - r)/r^3 of z = r^2, r <= pi/4: 0.057 */
KERNEL real poly_sin(real z)
{
    real c0 = -1.6666666666666666e-01;
    real c1 = 8.3333333333333228e-03;
    real c2 = -1.9841269841254687e-04;
    real c3 = 2.7557319214003829e-06;
    real c4 = -2.5052104865326214e-08;
    real c5 = 1.6058360984050658e-10;
    real c6 = -7.5784286800876516e-13;
    real z2 = z*z;
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*(c5 + z*c6)));
}

/* (cos(r) - 1 + r^2/2)/r^4 of z = r^2, r <= pi/4: 0.011 */
KERNEL real poly_cos(real z)
{
    real c0 = 4.1666666666666664e-02;
    real c1 = -1.3888888888888872e-03;
    real c2 = 2.4801587301570378e-05;
    real c3 = -2.7557319214925600e-07;
    real c4 = 2.0876754270469041e-09;
    real c5 = -1.1470282966430943e-11;
    real c6 = 4.7376663842121137e-14;
    real z2 = z*z;
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*(c5 + z*c6)));
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
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*((c5 + z*c6) + z2*((c7 + z*c8) + z2*(c9 + z*c10)))));
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
    return c0 + z*((c1 + z*c2) + z2*((c3 + z*c4) + z2*((c5 + z*c6) + z2*((c7 + z*c8) + z2*((c9 + z*c10) +
           z2*(c11 + z*c12))))));
}

/* ((1 + 2 x) erfcx(x) - 1)/v of t = 2 v - 1, v = x/(x + c): 0.63 */
KERNEL real poly_erfcx(real t)
{
    real c0 = 4.6599023725110500e-01;
    real c1 = -7.4523247093223000e-01;
    real c2 = 7.7599177513746920e-01;
    real c3 = -6.3979766662809023e-01;
    real c4 = 4.3771953455548779e-01;
    real c5 = -2.5025386455855825e-01;
    real c6 = 1.1759313293420576e-01;
    real c7 = -4.3258101863091564e-02;
    real c8 = 1.0862633743315456e-02;
    real c9 = -7.9869375212469310e-04;
    real c10 = -7.1685276976958230e-04;
    real c11 = 3.1833918979282691e-04;
    real c12 = -1.7096212299924717e-05;
    real c13 = -3.1701586391372939e-05;
    real c14 = 9.2590171602587882e-06;
    real c15 = 2.1592018340097647e-06;
    real c16 = -1.5752609166342255e-06;
    real c17 = -7.4299310196103952e-08;
    real c18 = 2.2924335939571689e-07;
    real c19 = -9.3188614623222021e-09;
    real c20 = -3.1804059969866820e-08;
    real c21 = 2.5522048496603322e-09;
    real c22 = 3.7871664104681910e-09;
    real c23 = -2.6639300092911901e-10;
    real c24 = -2.6549157826418479e-10;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*((c11 + t*c12) + t2*((c13 + t*c14) + t2*((c15 + t*c16) + t2*((c17 + t*c18) + t2*((c19 + t*c20) +
           t2*((c21 + t*c22) + t2*(c23 + t*c24))))))))))));
}

/* ((1 + 2 x^2) W(x) - 1)/(v (1 - v)) of t = 2 v - 1, v = x/(x + c): 0.17 */
KERNEL real poly_mills(real t)
{
    real c0 = -2.1171417445976021e-01;
    real c1 = 7.2082162714524134e-01;
    real c2 = -1.2355148573865797e+00;
    real c3 = 1.4888771403022749e+00;
    real c4 = -1.3899640760106693e+00;
    real c5 = 1.0382618734267997e+00;
    real c6 = -6.2050105351315266e-01;
    real c7 = 2.8725092813315489e-01;
    real c8 = -9.3018149869438349e-02;
    real c9 = 1.3045464151705327e-02;
    real c10 = 5.4248419968689465e-03;
    real c11 = -3.6833860933829219e-03;
    real c12 = 5.1834654272005340e-04;
    real c13 = 3.5150216608580170e-04;
    real c14 = -1.6266471182425804e-04;
    real c15 = -1.6305314189970218e-05;
    real c16 = 2.7774355166975971e-05;
    real c17 = -1.7098692975686721e-06;
    real c18 = -4.2488122864489577e-06;
    real c19 = 6.9170314591150121e-07;
    real c20 = 6.3951868795451052e-07;
    real c21 = -1.4340994696509277e-07;
    real c22 = -8.6884469967231918e-08;
    real c23 = 2.1211222374283254e-08;
    real c24 = 7.4237078232998584e-09;
    real c25 = -1.7417808005211246e-09;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*((c11 + t*c12) + t2*((c13 + t*c14) + t2*((c15 + t*c16) + t2*((c17 + t*c18) + t2*((c19 + t*c20) +
           t2*((c21 + t*c22) + t2*((c23 + t*c24) + t2*c25))))))))))));
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
    return c0 + w*((c1 + w*c2) + w2*((c3 + w*c4) + w2*((c5 + w*c6) + w2*((c7 + w*c8) + w2*c9))));
}

/* z/sqrt(w) of t = (sqrt(w) - c)/(sqrt(w) + c), w >= ERFINV_BORDER: 3.7e+8 */
KERNEL real poly_erfinv_far(real t)
{
    real c0 = 9.5994593422452423e-01;
    real c1 = 9.9097924204263305e-02;
    real c2 = -7.9057740419928871e-02;
    real c3 = -1.0176200704514266e-02;
    real c4 = 1.1521472535714966e-01;
    real c5 = -2.0997694149594434e-01;
    real c6 = 2.1176218985146950e-01;
    real c7 = 8.9935013226833463e-02;
    real c8 = -7.8862436685424386e-01;
    real c9 = 1.3354891181436712e+00;
    real c10 = -1.0453486729207571e+00;
    real c11 = 3.2362745551902172e-01;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*c11)))));
}

/* sqrt(s + 1/4) Gamma(s + 1/2)/Gamma(s + 1) of t = (s - c)/(s + c), s >= 1/2: 0.063 */
KERNEL real poly_gamma(real t)
{
    real c0 = 9.8930988275198739e-01;
    real c1 = 3.0653791750228573e-02;
    real c2 = -3.4080109923036984e-02;
    real c3 = 2.1006694543612661e-02;
    real c4 = -9.8241534473469984e-03;
    real c5 = 4.2124823824279964e-03;
    real c6 = -1.8386388698478340e-03;
    real c7 = 8.0425532478011982e-04;
    real c8 = -3.5551965634311115e-04;
    real c9 = 1.6252379070437391e-04;
    real c10 = -7.5184709303768664e-05;
    real c11 = 3.5578926449857914e-05;
    real c12 = -1.7208428208340177e-05;
    real c13 = 8.4112780866883267e-06;
    real c14 = -4.2141504184786902e-06;
    real c15 = 2.0612595354502729e-06;
    real c16 = -8.8859681792172394e-07;
    real c17 = 2.7831352371797893e-07;
    real c18 = -4.2540013398603789e-08;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*((c11 + t*c12) + t2*((c13 + t*c14) + t2*((c15 + t*c16) + t2*(c17 + t*c18)))))))));
}

/* Gamma(1 + x)/(sqrt(2 pi) (p/e)^p), p = x + 1/2, of t = (x - c)/(x + c), x >= 1: 0.38 */
KERNEL real poly_stirling(real t)
{
    real c0 = 9.7687708133905748e-01;
    real c1 = 3.1579209141928397e-02;
    real c2 = -1.0952231508575980e-02;
    real c3 = 3.1087802264407926e-03;
    real c4 = -7.6402288000329208e-04;
    real c5 = 1.9606794960260699e-04;
    real c6 = -5.8650447480526289e-05;
    real c7 = 1.7996881983515117e-05;
    real c8 = -5.7132448204768721e-06;
    real c9 = 1.9835863758409832e-06;
    real c10 = -6.6417598991682345e-07;
    real c11 = 2.1422299198619924e-07;
    real c12 = -5.8972757706862686e-08;
    real c13 = 7.5306317482976299e-09;
    real c14 = 3.5061549397083834e-10;
    real t2 = t*t;
    return c0 + t*((c1 + t*c2) + t2*((c3 + t*c4) + t2*((c5 + t*c6) + t2*((c7 + t*c8) + t2*((c9 + t*c10) +
           t2*((c11 + t*c12) + t2*(c13 + t*c14)))))));
}
