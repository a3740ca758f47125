/* gtr_fit_text.h: polynomials of the effective roughness of a GTR distribution of normals, written once for every
 * instruction set.  Included by gtr_fit_base.c, gtr_fit_avx2.c and gtr_fit_avx512.c, which define GTR_FIT_LOOPS, the
 * table's symbol.
 *
 * M(mu) = mu + 2 mu Lambda(mu) is the mean of |p - mu| over the slopes p along one axis.  For 0 < gamma < 2 a GTR is a
 * mixture of GGX of roughness^2 a in (alpha^2, 1) [docs/models/gtr.md], and M mixes sqrt(mu^2 + a) linearly:
 *
 *     M(mu) = C Int ((1 - a)/(a - alpha^2))^(gamma - 1) sqrt(mu^2 + a) da/a.
 *
 * The power is one function outside the segment [alpha^2, 1], so the integral over the segment is one around it; and
 * that one exists for every gamma.  In p = sqrt(a) the segment [alpha, 1] lies in the right half plane, on whose border
 * sqrt(mu^2 + p^2) is singular whatever mu is.  Gauss's transformation P = (p + alpha/p)/2 maps the half plane to
 * itself, twice, and the segment to [sqrt(alpha), (1 + alpha)/2]; after a few of them it is nearly a point, around
 * which circles are best.  The trapezoidal rule on a circle converges geometrically, and its nodes are carried back.
 * The function 1 has no integral around the segment, so 1 is taken off the power, and gamma = 1 is a limit.
 *
 * Everything is +-*, /, square roots and core/kernel/kmath.h in double: the same bits on every processor.
 * SPDX-License-Identifier: MIT */
#define FACET_REAL_IS_DOUBLE 1
#define FACET_LOOPS
#include "gtr_fit.h"

#include "kernel/kmath.h"

enum { LEVELS = 4, NODES = 128, POINTS = GTR_TERMS };

/* Tuned so that G1 is exact to 1e-8 (decay 18) and 1e-14 (decay 34) with the fewest nodes. */
#define LARGEST_EXTENT 0.12
#define SHORTEST_REACH 3.0 /* of ln a beyond ln alpha^2 */
#define LARGEST_LOW 0.9
#define LARGEST_SHARE 0.44
#define SHARE_POWER 0.35
#define FLOAT_DECAY 18.0
#define DOUBLE_DECAY 34.0

#define ROUGHEST (1 - 4*REAL_EPSILON) /* alpha beyond gives the same to the last bits, but 0/0 */
#define FLOAT_RANGE 12.5              /* of (gamma - 1) ln s: beyond, Lambda is below 1e-6 */
#define FLOAT_NEGLIGIBLE 5e-8         /* relative error of sqrt(A), A by leaving terms out */
#define DOUBLE_RANGE 36.0             /* ... and 1e-15 */
#define LEAST_EXCESS 1e-16            /* of gamma - 1, in place of 0 */

typedef struct complex_number {
    double re, im;
} complex_number;

/* The upper half of a mixture: nodes a = roughness^2, and a times their weights w; the sum of Im w is 1. */
typedef struct gtr_mixture {
    int n;
    double re[NODES], im[NODES], b_re[NODES], b_im[NODES];
} gtr_mixture;

/* Directions: cos, sin^2, and (M - mu)/sin, M = mu (1 + 2 Lambda). */
typedef struct gtr_directions {
    double cosine[POINTS], sin2[POINTS], excess[POINTS];
} gtr_directions;

typedef struct complex_array {
    double re[NODES], im[NODES];
} complex_array;

static inline complex_number get(const complex_array *a, int j)
{
    return (complex_number){a->re[j], a->im[j]};
}

static inline void put(complex_array *a, int j, complex_number x)
{
    a->re[j] = x.re;
    a->im[j] = x.im;
}

static inline complex_number times(complex_number a, complex_number b)
{
    return (complex_number){a.re*b.re - a.im*b.im, a.re*b.im + a.im*b.re};
}

static inline complex_number over(complex_number a, complex_number b)
{
    const double inverse = 1/(b.re*b.re + b.im*b.im);
    return (complex_number){(a.re*b.re + a.im*b.im)*inverse, (a.im*b.re - a.re*b.im)*inverse};
}

/* The root with a positive real part, of a number with a positive imaginary part. */
static inline complex_number root(complex_number a)
{
    const double length = ksqrt(a.re*a.re + a.im*a.im);
    const double big = ksqrt(0.5*(length + kabs(a.re))), small = 0.5*kabs(a.im)/big;
    return a.re > 0 ? (complex_number){big, small} : (complex_number){small, big};
}

/* The nodes of a circle about the segment [low, high] of p, moved outwards by `share` of the way to the border of the
 * half plane, exact to e^-decay.  node: p, step: i times the derivative of ln p by the angle. */
static int ring(double low, double high, double share, double decay, complex_array *node, complex_array *step)
{
    double mean[LEVELS];
    int levels = 0;
    double centre = ksqrt(low*high), extent = (high - centre)/(high + centre);
    while (extent > LARGEST_EXTENT && levels < LEVELS) {
        mean[levels++] = centre;
        high = 0.5*(low + high);
        low = centre;
        centre = ksqrt(low*high);
        extent = (high - centre)/(high + centre);
    }
    const double depth = klog(2/extent);
    const double radius = kexp(-share*depth);
    int n = (int)(decay/(2*share*depth)) + 1;
    if (n > NODES >> levels) n = NODES >> levels;
#pragma omp simd
    for (int j = 0; j < n; j++) {
        const real2 turn = kcossin_turn((j + 0.5)/(2*n));
        const complex_number z = {radius*turn.x, radius*turn.y}, z2 = times(z, z);
        const complex_number up = {1 + z.re, z.im}, down = {1 - z.re, -z.im};
        const complex_number p = over(up, down);
        put(node, j, (complex_number){centre*p.re, centre*p.im});
        put(step, j, over((complex_number){-2*z.im, 2*z.re}, (complex_number){1 - z2.re, -z2.im}));
    }
    for (int level = levels - 1; level >= 0; level--) {
        const double g2 = mean[level]*mean[level];
#pragma omp simd
        for (int j = 0; j < n; j++) {
            const complex_number P = get(node, j), P2 = times(P, P);
            const complex_number r = root((complex_number){P2.re - g2, P2.im});
            const complex_number p = {P.re + r.re, P.im + r.im}, q = over((complex_number){g2, 0}, p);
            const complex_number d = over(times(get(step, j), P), r);
            put(node, j, p);
            put(step, j, d);
            put(node, n + j, (complex_number){q.re, -q.im});
            put(step, n + j, (complex_number){d.re, -d.im});
        }
        n *= 2;
    }
    return n;
}

/* The mixture, exact to about e^-decay.  A steep power is so small away from alpha^2 that the ring may cross the
 * segment there; it is large on a tight ring. */
static void mix_ggx(double alpha, double gamma, double decay, gtr_mixture *m)
{
    const double reach = kmax(SHORTEST_REACH, decay/kmax(gamma - 1.5, REAL_MIN));
    const double high = kmin(1, alpha*kexp(0.5*kmin(reach, 40)));
    const double share = LARGEST_SHARE*kpow(2/kmax(gamma, 2), SHARE_POWER);
    complex_array node = {{0}, {0}}, step = {{0}, {0}};
    const int n = ring(kmin(alpha, LARGEST_LOW*high), high, share, decay, &node, &step);
    const double alpha2 = alpha*alpha, k0 = (1 - alpha)*(1 + alpha), excess = gamma - 1;
    const double power = kabs(excess) > LEAST_EXCESS ? excess : LEAST_EXCESS;
    double sum = 0;
#pragma omp simd
    for (int j = 0; j < n; j++) {
        const complex_number p = get(&node, j), a = times(p, p);
        /* the logarithm of (a - 1)/(a - alpha^2) = 1 + t, and the power less 1 */
        const complex_number t = over((complex_number){-k0, 0}, (complex_number){a.re - alpha2, a.im});
        const double l_re = 0.5*klog1p(t.re*(2 + t.re) + t.im*t.im), l_im = katan2(t.im, 1 + t.re);
        const real2 half = kcossin(0.5*power*l_im);
        const double fall = 2*half.y*half.y, grown = kexpm1(power*l_re); /* 1 - cos */
        const complex_number f = {(grown*(1 - fall) - fall)/power, 2*(grown + 1)*half.x*half.y/power};
        const complex_number w = times(f, get(&step, j)), b = times(w, a);
        put(&node, j, a);
        put(&step, j, w);
        m->b_re[j] = b.re;
        m->b_im[j] = b.im;
    }
    m->n = n;
    for (int j = 0; j < n; j++) sum += step.im[j];
    for (int j = 0; j < n; j++) {
        m->re[j] = node.re[j];
        m->im[j] = node.im[j];
        m->b_re[j] /= sum;
        m->b_im[j] /= sum;
    }
}

/* cos(2 pi k/(4 n)), k < 4 n; those of the odd k < 2 n are the zeros of Chebyshev's polynomial T_n. */
static inline void cosines(int n, double *wave)
{
#pragma omp simd
    for (int k = 0; k < n; k++) wave[k] = kcossin_turn(k/(4.0*n)).x;
    wave[n] = 0;
    for (int k = 0; k <= n; k++) {
        wave[2*n - k] = -wave[k];
        wave[2*n + k] = -wave[k];
        wave[k ? 4*n - k : 0] = wave[k];
    }
}

/* The coefficients of the powers of x of the polynomial through n values at the zeros of T_n, n even and at most
 * POINTS,
 * without the highest terms if leaving them out changes it by less than the tolerance; how many are left, a multiple of
 * 4.  wave: cosines of n. */
static inline int interpolate(int n, const double *wave, const double *value, double tolerance, double *terms)
{
    double c[POINTS] = {0}; /* of Chebyshev's polynomials T_k, which are even or odd */
    for (int k = 0; k < n; k++) {
        for (int j = 0, at = k; j < n/2; j++) { /* at = k (2 j + 1) modulo 4 n */
            const double mirrored = value[n - 1 - j];
            c[k] += (value[j] + (k%2 ? -mirrored : mirrored))*wave[at];
            at += 2*k;
            at -= at < 4*n ? 0 : 4*n;
        }
        c[k] *= (k ? 2.0 : 1.0)/n;
    }
    int count = n;
    double left_out = 0;
    for (int k = n - 1; k >= 4 && left_out <= tolerance; k--) {
        count = k%4 == 3 ? k + 1 : count;
        left_out += kabs(c[k]);
    }
    double older[POINTS + 1] = {0}, old[POINTS + 1] = {0}, next[POINTS + 1] = {0}; /* powers of T_k, from [1] on */
    for (int i = 0; i < n; i++) terms[i] = 0;
    for (int k = 0; k < count; k++) {
#pragma omp simd
        for (int i = 1; i <= POINTS; i++) next[i] = 2*old[i - 1] - older[i];
        if (k < 2) next[k + 1] = 1;
#pragma omp simd
        for (int i = 1; i <= POINTS; i++) {
            older[i] = old[i];
            old[i] = next[i];
        }
        for (int i = 0; i < count; i++) terms[i] += c[k]*next[i + 1];
    }
    return count;
}

/* x/(e^x - 1). */
static double over_expm1(double x)
{
    return kabs(x) > REAL_MIN ? x/kexpm1(x) : 1;
}

/* The excess of each direction: the sum of Im(a w/(sqrt(cos^2 + a sin^2) + cos)), which has no cancellation at small
 * roughness.  The elements of a vector are directions, so that the order of the sum does not depend on the
 * processor. */
static inline void find_excess(const gtr_mixture *m, gtr_directions *d)
{
    double sum[POINTS] = {0};
    for (int k = 0; k < m->n; k++) {
        const double re = m->re[k], im = m->im[k], b_re = m->b_re[k], b_im = m->b_im[k];
#pragma omp simd
        for (int j = 0; j < POINTS; j++) {
            const double cosine = d->cosine[j];
            const double x = cosine*cosine + re*d->sin2[j], y = im*d->sin2[j];
            const double size = x > 0 ? x : -x;
            const double big = ksqrt(0.5*(ksqrt(x*x + y*y) + size)), small = 0.5*y/big;
            const double u = x > 0 ? big : small, v = x > 0 ? small : big; /* the root is u + i v */
            const double c = u + cosine;
            sum[j] += (b_im*c - b_re*v)/(c*c + v*v);
        }
    }
    for (int j = 0; j < POINTS; j++) d->excess[j] = sum[j];
}

/* The directions at POINTS values y of ln(s/alpha^2). */
static inline void look(const gtr_mixture *m, double alpha, const double *y, gtr_directions *d)
{
    const double k0 = (1 - alpha)*(1 + alpha), L = -2*klog(alpha);
#pragma omp simd
    for (int j = 0; j < POINTS; j++) {
        d->cosine[j] = ksqrt(alpha*alpha*kexpm1(y[j])/k0);
        d->sin2[j] = -kexpm1(y[j] - L)/k0;
    }
    find_excess(m, d);
}

/* (M - mu)(M + mu), without the negative numbers that rounding makes of the smallest */
static double effective_alpha2(const gtr_directions *d, int j)
{
    return kmax(d->excess[j]*(2*d->cosine[j] + d->sin2[j]*d->excess[j]), 0);
}

/* The guess at the inverse of T, ln((T + mu)/T0) by ln(T0/T), from the known points: the values at the zeros of
 * Chebyshev's polynomial by the cubics through four neighbours, in Newton's form. */
static inline void fit_guess(const gtr_directions *d, gtr_fit *fit)
{
    double l[POINTS], e[POINTS], d1[POINTS] = {0}, d2[POINTS] = {0}, d3[POINTS] = {0};
    fit->T0 = 0.5*
              (d->excess[POINTS - 1]*ksqrt(d->sin2[POINTS - 1]) + d->cosine[POINTS - 1]/ksqrt(d->sin2[POINTS - 1]));
    const double T0 = fit->T0;
#pragma omp simd
    for (int j = 0; j < POINTS; j++) { /* from mu = 0 on */
        const double sine = ksqrt(d->sin2[POINTS - 1 - j]), mu = d->cosine[POINTS - 1 - j]/sine;
        const double T = 0.5*d->excess[POINTS - 1 - j]*sine;
        l[j] = klog(T0/T);
        e[j] = klog((T + mu)/T0);
    }
    for (int j = 0; j < POINTS - 1; j++) d1[j] = (e[j + 1] - e[j])/(l[j + 1] - l[j]);
    for (int j = 0; j < POINTS - 2; j++) d2[j] = (d1[j + 1] - d1[j])/(l[j + 2] - l[j]);
    for (int j = 0; j < POINTS - 3; j++) d3[j] = (d2[j + 1] - d2[j])/(l[j + 3] - l[j]);
    const double range = l[POINTS - 1];
    fit->guess_scale = 2/range;
    fit->guess_slope = d1[POINTS - 2];
    double wave[4*GTR_GUESS], value[GTR_GUESS];
    cosines(GTR_GUESS, wave);
    for (int j = GTR_GUESS - 1, i = 0; j >= 0; j--) { /* x grows */
        const double x = 0.5*range*(1 + wave[2*j + 1]);
        while (i < POINTS - 4 && l[i + 2] < x) i++;
        value[j] = e[i] + (x - l[i])*(d1[i] + (x - l[i + 1])*(d2[i] + (x - l[i + 2])*d3[i]));
    }
    interpolate(GTR_GUESS, wave, value, 0, fit->guess);
}

static void fit_shape(double alpha, double gamma, gtr_fit *fit)
{
    alpha = kmin(alpha, ROUGHEST);
    const double L = -2*klog(alpha), k0 = (1 - alpha)*(1 + alpha);
    *fit = (gtr_fit){.form = gamma < GTR_STEEP ? GTR_LOGARITHM : GTR_QUOTIENT};
    fit->peak = INV_PI/(alpha*alpha)*over_expm1(-(gamma - 1)*L)/over_expm1(-L);
    gtr_mixture m;
    mix_ggx(alpha, gamma, FLOAT_DECAY, &m);
    gtr_directions d;
    double wave[4*POINTS], y[POINTS], f[POINTS];
    cosines(POINTS, wave);
    const double range = kmin(L, FLOAT_RANGE/kmax(gamma - 1, REAL_MIN));
    for (int j = 0; j < POINTS; j++) y[j] = 0.5*range*(1 + wave[2*j + 1]);
    look(&m, alpha, y, &d);
    fit_guess(&d, fit);
    if (fit->form == GTR_QUOTIENT) {
#pragma omp simd
        for (int j = 0; j < POINTS; j++) y[j] = -klog1p(-0.5*k0*(1 + wave[2*j + 1]));
        look(&m, alpha, y, &d);
    }
    double least = REAL_MAX;
    for (int j = 0; j < POINTS; j++) {
        const double A = effective_alpha2(&d, j);
        f[j] = fit->form == GTR_LOGARITHM ? ksqrt(A) : A;
        least = kmin(least, f[j]);
    }
    fit->count = interpolate(POINTS, wave, f, FLOAT_NEGLIGIBLE*least, fit->terms);
    fit->scale = fit->form == GTR_LOGARITHM ? -2/range : -2*alpha*alpha/k0;
    fit->offset = fit->form == GTR_LOGARITHM ? 2*L/range - 1 : 2/k0 - 1;
}

static void fit_pieces(double alpha, double gamma, gtr_fit *fit, double pieces[GTR_PIECES][GTR_TERMS])
{
    alpha = kmin(alpha, ROUGHEST);
    const double L = -2*klog(alpha);
    const double range = kmin(L, DOUBLE_RANGE/kmax(gamma - 1, REAL_MIN));
    fit->form = GTR_LOGARITHM;
    fit->count = GTR_TERMS;
    fit->scale = -GTR_PIECES/range;
    fit->offset = GTR_PIECES*L/range;
    gtr_mixture m;
    mix_ggx(alpha, gamma, DOUBLE_DECAY, &m);
    double wave[4*POINTS];
    cosines(POINTS, wave);
    for (int piece = 0; piece < GTR_PIECES; piece++) {
        gtr_directions d;
        double y[POINTS], A[POINTS];
        for (int j = 0; j < POINTS; j++) y[j] = range/GTR_PIECES*(piece + 0.5 + 0.5*wave[2*j + 1]);
        look(&m, alpha, y, &d);
        for (int j = 0; j < POINTS; j++) A[j] = effective_alpha2(&d, j);
        interpolate(POINTS, wave, A, 0, pieces[piece]);
    }
}

/* Along each azimuth (alpha_x cos psi, alpha_y sin psi) of slope space the distribution is a GTR of the roughness^2
 * a = (alpha_x cos psi)^2 + (alpha_y sin psi)^2, so that 1/D(n) is 2 alpha_x alpha_y times the integral of
 * (1 - a^(gamma - 1))/((gamma - 1)(1 - a)) over a quarter turn of psi.  tan psi = sqrt(alpha_x/alpha_y) tan chi spreads
 * its narrow places; the trapezoidal rule then errs by e^(-4 n atanh(root)), root that of the ratio below 1. */
static double fit_disney_peak(double alpha_x, double alpha_y, double gamma)
{
    const double spread = ksqrt(alpha_x/alpha_y), root_of_ratio = kmin(spread, 1/spread);
    const int n = (int)(10/root_of_ratio) + 10;
    const double excess = kabs(gamma - 1) > LEAST_EXCESS ? gamma - 1 : LEAST_EXCESS;
    double sum = 0;
    for (int i = 0; i < n; i++) {
        const real2 chi = kcossin_turn((i + 0.5)/(4.0*n));
        const double x = chi.x, y = spread*chi.y, inverse = 1/(x*x + y*y);
        const double a = kmin((alpha_x*alpha_x*x*x + alpha_y*alpha_y*y*y)*inverse, ROUGHEST);
        sum += spread*inverse*kexpm1(excess*klog(a))/(excess*(a - 1));
    }
    return n/(PI*alpha_x*alpha_y*sum);
}

const gtr_fit_loops GTR_FIT_LOOPS = {fit_shape, fit_pieces, fit_disney_peak};
