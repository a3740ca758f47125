/* kmath_cases.h: the tests of core/kernel/kmath.h, compiled once for each precision.
 *
 * Reference: libm in the next wider type (double for float, long double for double), so that its own error is
 * below 0.01 ulp of the tested one; where libm has no such function, a continued fraction, a recurrence or
 * Newton's method in that type, all independent of the polynomials.  The bounds are those that kmath.h states;
 * SAMPLES=4000000 on the compiler's command line repeats the measurement behind them.
 * SPDX-License-Identifier: MIT */
#pragma once

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
/* cmocka.h needs the four above */
#include <cmocka.h>

#include "core/kernel/kmath.h"

#if FACET_REAL_IS_DOUBLE
typedef long double wide;
#define WIDE(f) f##l
#define DIGITS 53
#define BOUND(f32, f64) (f64)
#ifndef SAMPLES
#define SAMPLES 12000
#endif
#else
typedef double wide;
#define WIDE(f) f
#define DIGITS 24
#define BOUND(f32, f64) (f32)
#ifndef SAMPLES
#define SAMPLES 100000
#endif
#endif

#define PI_WIDE WIDE_CONSTANT(3.14159265358979323846264338328)
#define SQRT_PI_WIDE WIDE_CONSTANT(1.77245385090551602729816748334)
#define WIDE_CONSTANT(x) ((wide)x##L)

/* Error of `got` in units of the last place of the exact result */
static double ulps(real got, wide want)
{
    int exponent;
    if (want == 0) {
        return got == 0 ? 0 : HUGE_VAL;
    }
    (void)WIDE(frexp)(want, &exponent);
    double error = (double)(WIDE(fabs)((wide)got - want)/WIDE(ldexp)(1, exponent - DIGITS));
    return error == error ? error : HUGE_VAL;
}

/* xorshift64: uniform in [0, 1) */
static double uniform(void)
{
    static uint64_t state = UINT64_C(88172645463325252);
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11)*0x1p-53;
}

/* ---- references ---------------------------------------------------------------------------------------------- */

static wide ref_exp_neg_square(wide x)
{
    return WIDE(exp)(-x*x);
}

static wide ref_pow5(wide x)
{
    return x*x*x*x*x;
}

/* exact reduction to |f| <= 1/8 turn, as the argument is exact */
static wide ref_turn(wide u, int quarter)
{
    wide n = WIDE(round)(4*u);
    wide a = 2*PI_WIDE*(u - n/4);
    int phase = (int)((int64_t)n & 3) + quarter;
    wide s = phase%2 == 0 ? WIDE(cos)(a) : -WIDE(sin)(a);
    return (phase & 3) < 2 ? s : -s;
}

static wide ref_turn_cos(wide u)
{
    return ref_turn(u, 0);
}

static wide ref_turn_sin(wide u)
{
    return ref_turn(u, 3);
}

/* K of erfc x = e^(-x^2)/(sqrt(pi) (x + K)), K = (1/2)/(x + (2/2)/(x + (3/2)/(x + ...))), for x >= 2; terms enough
 * for exp(-2 x sqrt(2 n)) < 1e-21 */
static wide erfc_fraction(wide x)
{
    wide d = x;
    for (int k = 10 + (int)(300/(x*x)); k >= 2; k--) {
        d = x + (wide)0.5*k/d;
    }
    return (wide)0.5/d;
}

static wide ref_erfcx(wide x)
{
    return x < 2 ? WIDE(exp)(x*x)*WIDE(erfc)(x) : 1/((x + erfc_fraction(x))*SQRT_PI_WIDE);
}

/* 1 - x/(x + K) = K/(x + K) where the difference would cancel */
static wide ref_mills_w(wide x)
{
    return x < 2 ? 1 - SQRT_PI_WIDE*x*ref_erfcx(x) : erfc_fraction(x)/(x + erfc_fraction(x));
}

/* Newton's method from the value under test, which only saves iterations: it would not converge to another point */
static wide ref_erfinv(wide x)
{
    wide z = kerfinv((real)x);
    for (int i = 0; i < 3; i++) {
        z -= (WIDE(erf)(z) - x)*SQRT_PI_WIDE/2*WIDE(exp)(z*z);
    }
    return z;
}

static wide ref_erfcinv(wide q)
{
    wide z = kerfcinv((real)q);
    for (int i = 0; i < 3; i++) {
        z += (WIDE(erfc)(z) - q)*SQRT_PI_WIDE/2*WIDE(exp)(z*z);
    }
    return z;
}

/* Gamma(s + 1/2)/Gamma(s + 1) by the recurrence up to s = 200, where the series in 1/(s + 1/4)^2 is good to 1e-21 */
static wide ref_gamma_half_ratio(wide s)
{
    wide factor = 1;
    for (; s < 200; s += 1) {
        factor *= (s + 1)/(s + (wide)0.5);
    }
    wide v = s + (wide)0.25;
    wide y = 1/(v*v);
    return factor/WIDE(sqrt)(v)*(1 - y/64 + 21*y*y/8192 - 671*y*y*y/524288);
}

/* ---- errors of functions of one argument
 * ------------------------------------------------------------------------- */

static real turn_cos(real u)
{
    return kcossin_turn(u).x;
}

static real turn_sin(real u)
{
    return kcossin_turn(u).y;
}

static real fall_of_one(real x)
{
    return kexp_fall(1, x);
}

static real fall_of_much(real x) /* e^-x alone is 0 for most of these x */
{
    return kexp_fall(1152921504606846976.0f, x); /* 2^60 */
}

static wide ref_fall(wide x)
{
    return WIDE(exp)(-x);
}

static wide ref_fall_of_much(wide x)
{
    return WIDE(exp)(-x)*1152921504606846976.0f;
}

/* How a case draws its arguments between low and high: evenly, evenly in the logarithm, or low plus a distance
 * from it that is even in the logarithm */
typedef enum { EVENLY, BY_MAGNITUDE, NEAR_LOW } spread;

typedef struct {
    const char *name;
    real (*f)(real);
    wide (*reference)(wide);
    spread how;
    double low, high;
    double bound; /* [ulp] */
} error_case;

#define LOWEST ((double)EXP_LOWEST)
#define HIGHEST ((double)EXP_HIGHEST)
#define TINY (4*(double)REAL_MIN)
#define LARGE (0.25*(double)REAL_MAX)
#define TAIL BOUND(9.1, 26.4) /* erfc is still normal here */

static const error_case ERROR_CASES[] = {
    {"exp", kexp, WIDE(exp), EVENLY, LOWEST, HIGHEST, BOUND(1.0, 1.0)},
    {"exp near 0", kexp, WIDE(exp), EVENLY, -1, 1, BOUND(1.0, 1.0)},
    {"exp_fall", fall_of_one, ref_fall, EVENLY, 0, -LOWEST, BOUND(1.5, 1.5)},
    {"exp_fall of 2^60", fall_of_much, ref_fall_of_much, EVENLY, 0, 41 - LOWEST, BOUND(1.5, 1.5)},
    {"exp_neg_square", kexp_neg_square, ref_exp_neg_square, EVENLY, 0, BOUND(9.34, 26.6), BOUND(1.2, 1.2)},
    {"expm1", kexpm1, WIDE(expm1), EVENLY, -50, HIGHEST, BOUND(1.6, 2.0)},
    {"expm1 near 0", kexpm1, WIDE(expm1), EVENLY, -2, 2, BOUND(1.6, 2.0)},
    {"expm1 of tiny", kexpm1, WIDE(expm1), BY_MAGNITUDE, TINY, 1, BOUND(1.6, 2.0)},
    {"log", klog, WIDE(log), BY_MAGNITUDE, TINY, LARGE, BOUND(0.9, 0.9)},
    {"log near 1", klog, WIDE(log), EVENLY, 0.5, 2, BOUND(0.9, 0.9)},
    {"log1p", klog1p, WIDE(log1p), EVENLY, -0.999999, 2, BOUND(1.5, 1.5)},
    {"log1p of tiny", klog1p, WIDE(log1p), BY_MAGNITUDE, TINY, 1, BOUND(1.5, 1.5)},
    {"log1p of -tiny", klog1p, WIDE(log1p), BY_MAGNITUDE, -TINY, -0.5, BOUND(1.5, 1.5)},
    {"log1p of large", klog1p, WIDE(log1p), BY_MAGNITUDE, 1, LARGE, BOUND(1.5, 1.5)},
    {"pow5", kpow5, ref_pow5, EVENLY, 0, 1, BOUND(3.0, 3.0)},
    {"cossin_turn.x", turn_cos, ref_turn_cos, EVENLY, 0, 1, BOUND(1.6, 1.6)},
    {"cossin_turn.y", turn_sin, ref_turn_sin, EVENLY, 0, 1, BOUND(1.6, 1.6)},
    {"cossin_turn.x at 1/4", turn_cos, ref_turn_cos, NEAR_LOW, 0.25, 0.26, BOUND(1.6, 1.6)},
    {"cossin_turn.y at 0", turn_sin, ref_turn_sin, BY_MAGNITUDE, TINY, 0.25, BOUND(1.6, 1.6)},
    {"cossin_turn.x far", turn_cos, ref_turn_cos, EVENLY, -1048576, 1048576, BOUND(1.6, 1.6)},
    {"cossin_turn.y far", turn_sin, ref_turn_sin, EVENLY, -1048576, 1048576, BOUND(1.6, 1.6)},
    {"cos", kcos, WIDE(cos), EVENLY, -7, 7, BOUND(1.6, 1.6)},
    {"sin", ksin, WIDE(sin), EVENLY, -7, 7, BOUND(1.6, 1.6)},
    {"sin of tiny", ksin, WIDE(sin), BY_MAGNITUDE, TINY, 1, BOUND(1.6, 1.6)},
    {"cos at pi/2", kcos, WIDE(cos), NEAR_LOW, 1.57079632679489662, 1.58, BOUND(1.6, 1.6)},
    {"sin at pi", ksin, WIDE(sin), NEAR_LOW, 3.14159265358979324, 3.15, BOUND(1.6, 1.6)},
    {"cos far", kcos, WIDE(cos), EVENLY, -BOUND(1e3, 1e5), BOUND(1e3, 1e5), BOUND(2.6, 2.6)},
    {"sin far", ksin, WIDE(sin), EVENLY, -BOUND(1e3, 1e5), BOUND(1e3, 1e5), BOUND(2.6, 2.6)},
    {"acos", kacos, WIDE(acos), EVENLY, -1, 1, BOUND(2.7, 2.6)},
    {"acos of tiny", kacos, WIDE(acos), BY_MAGNITUDE, TINY, 1, BOUND(2.7, 2.6)},
    {"acos at -1", kacos, WIDE(acos), NEAR_LOW, -1, -0.9, BOUND(2.7, 2.6)},
    {"erfcx", kerfcx, ref_erfcx, EVENLY, 0, 8, BOUND(2.8, 3.2)},
    {"erfcx by magnitude", kerfcx, ref_erfcx, BY_MAGNITUDE, 1e-12, 1e8, BOUND(2.8, 3.2)},
    {"mills_w", kmills_w, ref_mills_w, EVENLY, 0, 8, BOUND(3.6, 4.0)},
    {"mills_w by magnitude", kmills_w, ref_mills_w, BY_MAGNITUDE, 1e-12, 1e8, BOUND(3.6, 4.0)},
    {"erf", kerf, WIDE(erf), EVENLY, -6, 6, BOUND(1.6, 1.5)},
    {"erf of tiny", kerf, WIDE(erf), BY_MAGNITUDE, TINY, 1, BOUND(1.6, 1.5)},
    {"erfc", kerfc, WIDE(erfc), EVENLY, -6, 6, BOUND(4.4, 3.9)},
    {"erfc tail", kerfc, WIDE(erfc), EVENLY, 0.5, TAIL, BOUND(4.4, 3.9)},
    {"erfinv", kerfinv, ref_erfinv, EVENLY, -0.9999, 0.9999, BOUND(4.0, 2.4)},
    {"erfinv of tiny", kerfinv, ref_erfinv, BY_MAGNITUDE, TINY, 1e-3, BOUND(4.0, 2.4)},
    {"erfinv at -1", kerfinv, ref_erfinv, NEAR_LOW, (double)REAL_EPSILON - 1, -0.9, BOUND(4.0, 2.4)},
    {"erfcinv", kerfcinv, ref_erfcinv, EVENLY, 0.01, 1.99, BOUND(4.2, 2.6)},
    {"erfcinv of tiny", kerfcinv, ref_erfcinv, BY_MAGNITUDE, TINY, 1, BOUND(4.2, 2.6)},
    {"gamma_half_ratio", kgamma_half_ratio, ref_gamma_half_ratio, EVENLY, 0.5, 12, BOUND(2.7, 2.5)},
    {"gamma_half_ratio by magnitude", kgamma_half_ratio, ref_gamma_half_ratio, BY_MAGNITUDE, 0.5, 1e6, BOUND(2.7, 2.5)},
};

/* From low to high, both positive, evenly in the logarithm; high/low may overflow */
static double between(double low, double high, double u)
{
    return exp(log(low) + u*(log(high) - log(low)));
}

/* The i-th of n stratified arguments: one in each of n equal cells */
static real draw(const error_case *c, int i, int n)
{
    double u = (i + uniform())/n;
    double x = c->low + (c->high - c->low)*u;
    if (c->how == BY_MAGNITUDE) {
        x = copysign(between(fabs(c->low), fabs(c->high), u), c->low);
    } else if (c->how == NEAR_LOW) {
        x = c->low + (c->high - c->low)*pow((double)REAL_EPSILON, u);
    }
    return (real)x;
}

/* Reference loops cost far more for the gamma ratio (200 divisions) than for all others. */
static int samples_of(const error_case *c)
{
    return c->f == kgamma_half_ratio ? SAMPLES/10 : SAMPLES;
}

static void errors_stay_below_the_stated_bounds(void **state)
{
    (void)state;
    int failures = 0;
    for (size_t k = 0; k < sizeof ERROR_CASES/sizeof ERROR_CASES[0]; k++) {
        const error_case *c = &ERROR_CASES[k];
        double worst = 0;
        real at = 0;
        for (int i = 0; i < samples_of(c); i++) {
            real x = draw(c, i, samples_of(c));
            double error = ulps(c->f(x), c->reference((wide)x));
            if (error > worst) {
                worst = error;
                at = x;
            }
        }
        if (SAMPLES > 100000 || worst > c->bound) {
            print_message("k%s(%a = %g) = %a: %.3f ulp, stated %.1f\n", c->name, (double)at, (double)at,
                          (double)c->f(at), worst, c->bound);
        }
        failures += worst > c->bound;
    }
    assert_int_equal(failures, 0);
}

/* ---- functions of two arguments
 * --------------------------------------------------------------------------------- */

/* The stated bound for x^y: the logarithm is good to 0.07 ulp, and its error is that of the result, times y ln x. */
static double pow_bound(double log_of_result)
{
    return 1.1 + 0.07*fabs(log_of_result);
}

/* y ln x is drawn evenly in [-reach, reach], so that the result covers its range for x of any size. */
static void check_pow(double low, double high, double reach)
{
    double worst = 0;
    real at_x = 0, at_y = 0;
    for (int i = 0; i < SAMPLES; i++) {
        real x = (real)between(low, high, uniform());
        double log_x = (double)WIDE(log)((wide)x);
        real y = (real)((2*uniform() - 1)*reach/(x == 1 ? 1 : log_x));
        double share = ulps(kpow(x, y), WIDE(pow)((wide)x, (wide)y))/pow_bound((double)y*log_x);
        if (share > worst) {
            worst = share;
            at_x = x;
            at_y = y;
        }
    }
    if (SAMPLES > 100000 || worst > 1) {
        print_message("kpow(%a, %a) = %a: %.3f of the stated bound (results to e^%g)\n", (double)at_x, (double)at_y,
                      (double)kpow(at_x, at_y), worst, reach);
    }
    assert_true(worst <= 1);
}

static void pow_stays_below_the_stated_bound(void **state)
{
    (void)state;
    check_pow(0.01, 100, 10);
    check_pow(TINY, LARGE, 50);
    check_pow(0.99, 1.01, 50);
    check_pow(0.5, 1.5, BOUND(87, 708));
    check_pow(TINY, LARGE, BOUND(87, 708));
}

static void atan2_stays_below_the_stated_bound(void **state)
{
    (void)state;
    double bound = BOUND(2.0, 2.0);
    double worst = 0;
    real at_x = 0, at_y = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double wanted = 6.283185307179586*uniform() - 3.141592653589793;
        double scale = exp(40*uniform() - 20);
        double squash = exp(20*uniform() - 10);
        real x = (real)(scale*cos(wanted));
        real y = (real)(scale*squash*sin(wanted));
        double error = ulps(katan2(y, x), WIDE(atan2)((wide)y, (wide)x));
        if (error > worst) {
            worst = error;
            at_x = x;
            at_y = y;
        }
    }
    if (SAMPLES > 100000 || worst > bound) {
        print_message("katan2(%a, %a) = %a: %.3f ulp, stated %.1f\n", (double)at_y, (double)at_x,
                      (double)katan2(at_y, at_x), worst, bound);
    }
    assert_true(worst <= bound);
}

/* Gamma(x) Gamma(y)/Gamma(x + y), with libm's gamma function while it stays finite. */
static wide ref_beta_of_gammas(wide x, wide y)
{
    return WIDE(tgamma)(x)/WIDE(tgamma)(x + y)*WIDE(tgamma)(y);
}

/* B(m, y) = (m - 1)!/(y (y + 1) ... (y + m - 1)) of an integer m */
static wide ref_beta_of_integer(int m, wide y)
{
    wide product = 1/y;
    for (int k = 1; k < m; k++) {
        product *= k/(y + k);
    }
    return product;
}

/* The stated bound: an error of the exponent counts in full. */
static double beta_share(real x, real y, wide want)
{
    double share = ulps(kbeta(x, y), want)/(10 + 3*fabs((double)WIDE(log)(want)));
    if (share > 1 || kbeta(x, y) != kbeta(y, x)) {
        print_message("kbeta(%a, %a) = %a, the other way %a: %.3f of the stated bound\n", (double)x, (double)y,
                      (double)kbeta(x, y), (double)kbeta(y, x), share);
        fail();
    }
    return share;
}

static void beta_stays_below_the_stated_bound(void **state)
{
    (void)state;
    double worst[3] = {0};
    for (int i = 0; i < SAMPLES; i++) {
        real x = (real)between(1, BOUND(60, 300), uniform());
        real y = (real)between(1, BOUND(60, 300), uniform());
        worst[0] = fmax(worst[0], beta_share(x, y, ref_beta_of_gammas((wide)x, (wide)y)));
        int m = 1 + (int)(40*uniform()*uniform());
        real z = (real)between(1, exp(BOUND(80, 600)/m - 1), uniform()); /* z^-m is a normal number */
        z = kmin(z, 1e18f);
        worst[1] = fmax(worst[1], beta_share((real)m, z, ref_beta_of_integer(m, (wide)z)));
        real near = (real)(1 + uniform()*pow(0.5, 20*uniform()));
        real next = (real)(1 + uniform()*pow(0.5, 20*uniform()));
        worst[2] = fmax(worst[2], beta_share(near, next, ref_beta_of_gammas((wide)near, (wide)next)));
    }
    if (SAMPLES > 100000) {
        print_message("kbeta: %.3f, %.3f, %.3f of the stated bound\n", worst[0], worst[1], worst[2]);
    }
}

/* ---- exact values
 * ------------------------------------------------------------------------------------------------- */

#define ASSERT_SAME(got, want) assert_same(#got, (got), (want))

/* equal, and for zeros of the same sign */
static void assert_same(const char *text, real got, real want)
{
    if (!(got == want) || !signbit(got) != !signbit(want)) {
        print_message("%s = %a, should be %a\n", text, (double)got, (double)want);
        fail();
    }
}

static void special_values_are_exact(void **state)
{
    (void)state;
    ASSERT_SAME(kexp(0), 1);
    ASSERT_SAME(kexp(EXP_HIGHEST*1.01f), REAL_MAX);
    ASSERT_SAME(kexp(REAL_MAX), REAL_MAX);
    ASSERT_SAME(kexp(EXP_LOWEST*1.01f), 0);
    ASSERT_SAME(kexp(-REAL_MAX), 0);
    ASSERT_SAME(kexp_fall(3, 0), 3);
    ASSERT_SAME(kexp_fall(1, 50 - EXP_LOWEST), 0);
    ASSERT_SAME(kexp_fall(1, REAL_MAX), 0);
    ASSERT_SAME(kexpm1(0), 0);
    ASSERT_SAME(kexpm1(-REAL_MAX), -1);
    ASSERT_SAME(kexpm1(REAL_MAX), REAL_MAX);
    ASSERT_SAME(klog(1), 0);
    ASSERT_SAME(klog(0), klog(REAL_MIN));
    ASSERT_SAME(klog(-1), klog(REAL_MIN));
    ASSERT_SAME(klog1p(0), 0);
    ASSERT_SAME(klog1p(-2), klog(REAL_MIN));
    ASSERT_SAME(kpow(3, 0), 1);
    ASSERT_SAME(kpow(1, 1e30f), 1);
    ASSERT_SAME(kpow(0, 2), 0);
    ASSERT_SAME(kpow(0, 0), 1);
    ASSERT_SAME(kpow(0, -2), REAL_MAX);
    ASSERT_SAME(kpow(2, REAL_MAX), REAL_MAX);
    ASSERT_SAME(kpow(2, -REAL_MAX), 0);
    ASSERT_SAME(kexp_neg_square(0), 1);
    ASSERT_SAME(kexp_neg_square(REAL_MAX), 0);
    ASSERT_SAME(kacos(1), 0);
    ASSERT_SAME(kacos(-1), PI);
    ASSERT_SAME(kacos(0), HALF_PI);
    ASSERT_SAME(kacos(1.5f), 0);
    ASSERT_SAME(kacos(-1.5f), PI);
    ASSERT_SAME(katan2(0.0f, 1), 0.0f);
    ASSERT_SAME(katan2(-0.0f, 1), -0.0f);
    ASSERT_SAME(katan2(0.0f, -1), PI);
    ASSERT_SAME(katan2(-0.0f, -1), -PI);
    ASSERT_SAME(katan2(1, 0), HALF_PI);
    ASSERT_SAME(katan2(1, 1), QUARTER_PI);
    ASSERT_SAME(katan2(0.0f, 0.0f), 0.0f);
    ASSERT_SAME(kerf(-0.0f), -0.0f);
    ASSERT_SAME(kerf(REAL_MAX), 1);
    ASSERT_SAME(kerfc(0), 1);
    ASSERT_SAME(kerfc(REAL_MAX), 0);
    ASSERT_SAME(kerfc(-REAL_MAX), 2);
    ASSERT_SAME(kerfcx(0), 1);
    ASSERT_SAME(kerfcx(-1), 1);
    ASSERT_SAME(kmills_w(0), 1);
    ASSERT_SAME(kerfinv(0), 0);
    ASSERT_SAME(kerfinv(1), kerfinv(2));
    ASSERT_SAME(kerfcinv(1), 0);
    ASSERT_SAME(kgamma_half_ratio(0), kgamma_half_ratio(0.5f));
    ASSERT_SAME(kbeta(0, -3), kbeta(1, 1));
    ASSERT_SAME(kbeta(1e18f, 1e18f), 0);
}

static void quadrants_are_exact(void **state)
{
    (void)state;
    for (int i = -40; i <= 40; i++) {
        real2 a = kcossin_turn((real)(i*0.25));
        ASSERT_SAME(a.x, (real)((i & 3) == 0 ? 1 : (i & 3) == 2 ? -1 : 0));
        ASSERT_SAME(a.y, (real)((i & 3) == 1 ? 1 : (i & 3) == 3 ? -1 : 0));
    }
}

static void floor_and_round_agree_with_libm(void **state)
{
    (void)state;
    double top = BOUND(4194303, 2251799813685247.0);
    for (int i = 0; i < SAMPLES; i++) {
        real x = (real)((2*uniform() - 1)*exp(uniform()*log(top)));
        if (kfloor(x) != (real)floor((double)x) || kround(x) != (real)nearbyint((double)x)) {
            print_message("kfloor(%a) = %a, kround = %a\n", (double)x, (double)kfloor(x), (double)kround(x));
            fail();
        }
    }
    for (int i = -9; i <= 9; i++) {
        ASSERT_SAME(kfloor((real)i) + 1, (real)i + 1);
        assert_true(kround((real)i + 0.5f) == (real)nearbyint(i + 0.5));
    }
    assert_true(kfloor((real)top) == (real)top && kfloor(-(real)top) == -(real)top);
    assert_true(kfloor(-REAL_MIN) == -1 && kfloor(REAL_MIN) == 0);
}

static void signs_and_limits_select(void **state)
{
    (void)state;
    ASSERT_SAME(kabs(-3), 3);
    ASSERT_SAME(kabs(-0.0f), 0);
    ASSERT_SAME(kcopysign(3, -0.0f), -3);
    ASSERT_SAME(kcopysign(-3, 2), 3);
    ASSERT_SAME(ksign(-0.0f), -1);
    ASSERT_SAME(kmin(1, 2), 1);
    ASSERT_SAME(kmax(1, 2), 2);
    ASSERT_SAME(kclamp(3, 1, 2), 2);
    ASSERT_SAME(kclamp(0, 1, 2), 1);
    ASSERT_SAME(kclamp((real)NAN, 1, 2), 1);
    ASSERT_SAME(ksaturate(0.25f), 0.25f);
    ASSERT_SAME(ksaturate(-4), 0);
    ASSERT_SAME(ksaturate(4), 1);
    ASSERT_SAME(ksqrt(2), (real)WIDE(sqrt)(2));
}

/* ---- identities between functions
 * -------------------------------------------------------------------------------- */

/* Each side is rounded a few times, by the bounds above: 3 + 3 + 1 ulp at most for every line, where an ulp is at
 * most REAL_EPSILON of the value. */
static void identities_hold(void **state)
{
    (void)state;
    double limit = 8*(double)REAL_EPSILON;
    for (int i = 0; i < SAMPLES/10; i++) {
        real x = (real)(3*uniform());
        real s = (real)(0.5 + 100*uniform());
        double gap[] = {
            fabs((double)(kerf(x) + kerfc(x)) - 1),
            fabs((double)(kmills_w(x) + SQRT_PI*x*kerfcx(x)) - 1),
            fabs((double)(kerfc(x)*kexp(x*x)/kerfcx(x)) - 1)/(1 + (double)(x*x)), /* x*x is rounded here */
            fabs((double)(kexp(x)*kexp(-x)) - 1),
            fabs((double)(kgamma_half_ratio(s)*kgamma_half_ratio(s + 0.5f)*(s + 0.5f)) - 1),
            fabs((double)(kcos(x)*kcos(x) + ksin(x)*ksin(x)) - 1),
            fabs((double)(kpow(x + 1, 0.5f)/ksqrt(x + 1)) - 1),
        };
        for (size_t k = 0; k < sizeof gap/sizeof gap[0]; k++) {
            if (!(gap[k] <= limit)) {
                print_message("identity %zu at x = %a, s = %a: off by %g\n", k, (double)x, (double)s, gap[k]);
                fail();
            }
        }
    }
}

/* ---- no NaN or infinity
 * ------------------------------------------------------------------------------------------- */

static void any_finite_argument_gives_a_finite_result(void **state)
{
    (void)state;
    static real (*const TOTAL[])(real) = {
        kexp, kexpm1,  klog,     klog1p, kexp_neg_square,   kerfcx, kmills_w, kerfc,
        kerf, kerfinv, kerfcinv, kacos,  kgamma_half_ratio, kabs,   ksign,    ksaturate};
    static const real EDGES[] = {0.0f,
                                 1e-30f,
                                 REAL_MIN,
                                 REAL_MIN*0.5f,
                                 REAL_EPSILON,
                                 0.25f,
                                 0.5f,
                                 1.0f - 0.5f*REAL_EPSILON,
                                 1.0f,
                                 1.0f + REAL_EPSILON,
                                 2.0f - REAL_EPSILON,
                                 2.0f,
                                 9.5f,
                                 27.0f,
                                 1e4f,
                                 1e18f,
                                 1e30f,
                                 EXP_HIGHEST,
                                 -EXP_LOWEST,
                                 REAL_MAX*0.5f,
                                 REAL_MAX};
    size_t n_edges = sizeof EDGES/sizeof EDGES[0];
    for (size_t i = 0; i < 2*n_edges; i++) {
        real x = i < n_edges ? EDGES[i] : -EDGES[i - n_edges];
        for (size_t k = 0; k < sizeof TOTAL/sizeof TOTAL[0]; k++) {
            if (!isfinite(TOTAL[k](x))) {
                print_message("function %zu of %a gives %a\n", k, (double)x, (double)TOTAL[k](x));
                fail();
            }
        }
        for (size_t j = 0; j < 2*n_edges; j++) {
            real y = j < n_edges ? EDGES[j] : -EDGES[j - n_edges];
            const int is_finite_beta = (x > 1e18f) | (y > 1e18f) | isfinite(kbeta(x, y));
            if (!isfinite(kpow(x, y)) || !isfinite(katan2(y, x)) || !is_finite_beta) {
                print_message("kpow(%a, %a) = %a, katan2 = %a, kbeta = %a\n", (double)x, (double)y, (double)kpow(x, y),
                              (double)katan2(y, x), (double)kbeta(x, y));
                fail();
            }
        }
    }
}

static void vectors_follow_their_definitions(void **state)
{
    (void)state;
    real3 a = make3(1, 2, 3);
    real3 b = make3(-4, 5, 0.5f);
    real3 c = cross3(a, b);
    ASSERT_SAME(dot3(a, b), 7.5f);
    ASSERT_SAME(dot3(c, a), 0);
    ASSERT_SAME(dot3(c, b), 0);
    ASSERT_SAME(c.z, 13);
    ASSERT_SAME(length3(make3(2, 3, 6)), 7);
    ASSERT_SAME(normalize3(make3(0, -2, 0)).y, -1);
    ASSERT_SAME(normalize3(make3(0, 0, 0)).z, 1);
    ASSERT_SAME(madd3(a, 2, b).y, 12);
    ASSERT_SAME(sub3(add3(a, b), b).x, 1);
    ASSERT_SAME(mul3(a, scale3(2, b)).z, 3);
    ASSERT_SAME(mix3(a, b, 1).x, -4);
    ASSERT_SAME(mix(3, 5, 0), 3);
    ASSERT_SAME(select3(0, a, b).y, 5);
    ASSERT_SAME(max_of3(b), 5);
    ASSERT_SAME(max_of3(neg3(b)), 4);
    ASSERT_SAME(mean3(splat3(0)), 0);
    assert_true(ulps(mean3(a), 2) <= 1);
}

static const struct CMUnitTest KMATH_TESTS[] = {
    cmocka_unit_test(errors_stay_below_the_stated_bounds),
    cmocka_unit_test(pow_stays_below_the_stated_bound),
    cmocka_unit_test(atan2_stays_below_the_stated_bound),
    cmocka_unit_test(beta_stays_below_the_stated_bound),
    cmocka_unit_test(special_values_are_exact),
    cmocka_unit_test(quadrants_are_exact),
    cmocka_unit_test(floor_and_round_agree_with_libm),
    cmocka_unit_test(signs_and_limits_select),
    cmocka_unit_test(identities_hold),
    cmocka_unit_test(any_finite_argument_gives_a_finite_result),
    cmocka_unit_test(vectors_follow_their_definitions),
};
