/* quadrature.c: see quadrature.h.
 * SPDX-License-Identifier: MIT */
#include "verify/quadrature.h"

#include <math.h>

#define PI 3.14159265358979323846
#define DEEPEST 9
#define REACH 3.8 /* exp(pi/2 sinh(3.8)) = 2e15 */

quadrature gauss_legendre(int n, double low, double high)
{
    quadrature rule = {.n = n};
    for (int i = 0; i < n; i++) {
        double x = cos(PI*(i + 0.75)/(n + 0.5)), derivative = 1;
        for (int step = 0; step < 8; step++) { /* Newton's method from Tricomi's start */
            double p = 1, previous = 0;
            for (int k = 1; k <= n; k++) {
                const double next = ((2*k - 1)*x*p - (k - 1)*previous)/k;
                previous = p;
                p = next;
            }
            derivative = n*(x*p - previous)/(x*x - 1);
            x -= p/derivative;
        }
        rule.x[i] = 0.5*(low + high) + 0.5*(high - low)*x;
        rule.w[i] = (high - low)/((1 - x*x)*derivative*derivative);
    }
    return rule;
}

quadrature periodic_rule(int n, double low, double high)
{
    quadrature rule = {.n = n};
    for (int i = 0; i < n; i++) {
        rule.x[i] = low + (high - low)*(i + 0.5)/n;
        rule.w[i] = (high - low)/n;
    }
    return rule;
}

quadrature whole_line(double h)
{
    quadrature rule = {0};
    for (double t = -REACH; t <= REACH && rule.n < QUADRATURE_NODES; t += h) {
        rule.x[rule.n] = sinh(0.5*PI*sinh(t));
        rule.w[rule.n++] = h*0.5*PI*cosh(t)*cosh(0.5*PI*sinh(t));
    }
    return rule;
}

quadrature half_line(double h)
{
    quadrature rule = {0};
    for (double t = -REACH; t <= REACH && rule.n < QUADRATURE_NODES; t += h) {
        rule.x[rule.n] = exp(0.5*PI*sinh(t));
        rule.w[rule.n] = h*0.5*PI*cosh(t)*rule.x[rule.n];
        rule.n++;
    }
    return rule;
}

quadrature unit_interval(double h)
{
    quadrature rule = {0};
    for (double t = -REACH; t <= REACH && rule.n < QUADRATURE_NODES; t += h) {
        const double e = exp(-PI*sinh(t)); /* x = 1/(1 + e) */
        rule.x[rule.n] = 1/(1 + e);
        rule.w[rule.n++] = h*PI*cosh(t)*e/((1 + e)*(1 + e));
    }
    return rule;
}

double quadrature_tolerance(double tolerance, double estimate)
{
    return fabs(estimate) > 1e3 ? fmax(tolerance, 1e-4*fabs(estimate)) : tolerance;
}

static double gauss_5x5(plane_function f, const void *context, const double low[2], const double high[2])
{
    static const double x[] = {0.04691007703066800, 0.23076534494715845, 0.5, 0.76923465505284155, 0.95308992296933200};
    static const double w[] = {0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324,
                               0.11846344252809454};
    const double dx = high[0] - low[0], dy = high[1] - low[1];
    double sum = 0;
    for (int i = 0; i < 5; i++)
        for (int j = 0; j < 5; j++) sum += w[i]*w[j]*f(low[0] + dx*x[i], low[1] + dy*x[j], context);
    return sum*dx*dy;
}

static double refine(plane_function f, const void *context, const double low[2], const double high[2], double whole,
                     double tolerance, int least_depth, int depth)
{
    const double middle[2] = {0.5*(low[0] + high[0]), 0.5*(low[1] + high[1])};
    double lows[4][2], highs[4][2], parts[4], sum = 0;
    for (int q = 0; q < 4; q++) {
        for (int k = 0; k < 2; k++) {
            const int upper = q >> k & 1;
            lows[q][k] = upper ? middle[k] : low[k];
            highs[q][k] = upper ? high[k] : middle[k];
        }
        parts[q] = gauss_5x5(f, context, lows[q], highs[q]);
        sum += parts[q];
    }
    if ((!(fabs(sum - whole) > tolerance) && depth >= least_depth) || depth == DEEPEST) return sum; /* NaN stays so */
    double refined = 0;
    /* Half the tolerance for each quarter: they rarely all need it. */
    for (int q = 0; q < 4; q++)
        refined += refine(f, context, lows[q], highs[q], parts[q], 0.5*tolerance, least_depth, depth + 1);
    return refined;
}

double cubature(plane_function f, const void *context, const double low[2], const double high[2], double tolerance,
                int least_depth)
{
    const double whole = gauss_5x5(f, context, low, high);
    return refine(f, context, low, high, whole, quadrature_tolerance(tolerance, whole), least_depth, 0);
}

/* [QUADPACK] nodes from the end to the middle, the weights of Kronrod's rule, and of Gauss's at every other node. */
static const double kronrod_x[8] = {0.991455371120812639206854697526329, 0.949107912342758524526189684047851,
                                    0.864864423359769072789712788640926, 0.741531185599394439863864773280788,
                                    0.586087235467691130294144691693013, 0.405845151377397166906606412076961,
                                    0.207784955007898467600689403773245, 0};
static const double kronrod_w[8] = {0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                                    0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                                    0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                                    0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
static const double gauss_w[4] = {0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                                  0.381830050505118944950369775488975, 0.417959183673469387755102040816327};

double gauss_kronrod(line_function f, const void *context, double low, double high, double tolerance, int depth)
{
    const double middle = 0.5*(low + high), half = 0.5*(high - low);
    double kronrod = 0, gauss = 0;
    for (int i = 0; i < 8; i++) {
        const double value = f(middle - half*kronrod_x[i], context) +
                             (i < 7 ? f(middle + half*kronrod_x[i], context) : 0);
        kronrod += half*kronrod_w[i]*value;
        if (i%2) gauss += half*gauss_w[i/2]*value;
    }
    if (!(fabs(kronrod - gauss) > tolerance) || depth == 0) return kronrod;
    return gauss_kronrod(f, context, low, middle, tolerance, depth - 1) +
           gauss_kronrod(f, context, middle, high, tolerance, depth - 1);
}
