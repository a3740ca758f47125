/* quadrature.h: rules for integrals in one dimension, and cubature over rectangles.
 * SPDX-License-Identifier: MIT */
#pragma once

#ifdef __cplusplus
extern "C" {
#endif

enum { QUADRATURE_NODES = 512 };

/* Int f = sum of w[i] f(x[i]). */
typedef struct quadrature {
    int n;
    double x[QUADRATURE_NODES], w[QUADRATURE_NODES];
} quadrature;

/* Gauss-Legendre on [low, high]: exact for polynomials of degree 2n - 1. */
quadrature gauss_legendre(int n, double low, double high);

/* The trapezoidal rule over one period, offset by half a step: exponentially convergent for smooth functions. */
quadrature periodic_rule(int n, double low, double high);

/* Double-exponential rules of step h in t (their error falls like exp(-c/h)), for functions that are smooth inside:
 * the whole line with x = sinh(pi/2 sinh t); [0, inf) with x = exp(pi/2 sinh t); [0, 1] with
 * x = (1 + tanh(pi/2 sinh t))/2.  Nodes reach 1e15 and 1e-15. */
quadrature whole_line(double h);
quadrature half_line(double h);
quadrature unit_interval(double h);

/* The absolute tolerance for an integral of which this is an estimate.  A density or an albedo is about 1, where the
 * caller's tolerance has room for what rounding leaves, some 30 ulp.  At 1e20 it has not, nor for the kinks of a table
 * of measurements, and every part would be halved to the end.  What is above 1000 is wrong by so much that four digits
 * say it: the tolerance is then 1e-4 of it, and for an estimate that overflows infinite, which ends the halving. */
double quadrature_tolerance(double tolerance, double estimate);

/* Int f(x, y) over a rectangle, by halving until a 5 x 5 Gauss rule and its four quarters agree within
 * quadrature_tolerance(`tolerance`, the first estimate), of the whole; at least `least_depth` times, at most 9. */
typedef double (*plane_function)(double x, double y, const void *context);
double cubature(plane_function f, const void *context, const double low[2], const double high[2], double tolerance,
                int least_depth);

/* Int f(x) over an interval by halving until Kronrod's rule of 15 points and Gauss's of 7 agree within `tolerance`
 * (absolute, of each part), at most `depth` times. */
typedef double (*line_function)(double x, const void *context);
double gauss_kronrod(line_function f, const void *context, double low, double high, double tolerance, int depth);

#ifdef __cplusplus
}
#endif
